"""Loads of the crank mechanism over the cycle."""
