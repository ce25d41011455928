"""Errors of the maintenance commands."""


class CannotRun(Exception):
    """A maintenance command cannot run; the message tells the operator why, and the remedy."""
