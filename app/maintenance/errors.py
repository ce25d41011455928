"""Errors of the maintenance commands."""


class CannotRun(Exception):
    """The sentence for the operator, with the remedy."""
