"""Errors that prevent the processes of a team from running."""


class Missing(Exception):
    """A component is not installed; the text names it and explains how to install it."""


class DidNotStart(Exception):
    """A process ended, or did not answer in time; the text has the last lines of its log."""
