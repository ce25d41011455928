"""Finite-element analyses as several pages show them."""
