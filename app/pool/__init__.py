"""The pool of calculation processes: costs of calculations, turns of clients, and hand-over to jobs."""
