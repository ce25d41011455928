"""Errors of reports; this module knows nothing of HTTP."""


class Unprintable(Exception):
    """A report that cannot be set on paper within the time and memory that a job may have."""
