"""Evaluate and solve single templates, and read curves from files."""
