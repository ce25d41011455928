"""Evaluating and solving single templates."""
