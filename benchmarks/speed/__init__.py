"""Measurements of `python -m benchmarks.all`, one module for each kind of work."""
