"""The pool of calculation processes: cost estimates, turns of clients, and hand-over to jobs."""
