"""The pool of calculation processes: what a calculation costs, who waits, and what a job takes over."""
