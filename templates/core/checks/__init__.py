"""Checks of a template that somebody wrote: what is wrong with it, where, and what would be right."""
