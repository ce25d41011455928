"""Designs combine calculations and shapes."""
