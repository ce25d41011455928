"""Checks of a template that somebody wrote: the faults of it, where, and what would be right."""
