"""Declare a template, read its inputs, and evaluate it at every level."""
