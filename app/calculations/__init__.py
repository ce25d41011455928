"""Evaluate and solve single templates."""
