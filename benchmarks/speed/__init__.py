"""The lines of issue 20's table, a module for each kind of work; `python -m benchmarks.all` runs them."""
