"""Designs: the one place where calculation and shape meet."""
