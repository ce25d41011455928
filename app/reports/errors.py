"""Errors of reports, independent of HTTP."""


class Unprintable(Exception):
    """The report cannot be typeset within a job's limits of time and memory."""
