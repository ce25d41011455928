"""Solids drawn in the browser."""
