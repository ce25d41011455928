"""Declaring a template, reading its inputs, evaluating it, at every level."""
