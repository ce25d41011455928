"""Numerical methods and array helpers, free of physics."""
