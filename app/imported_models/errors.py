"""Errors of a model import, beyond those of its file and of its program."""


class ModelIdTaken(Exception):
    """Something else has the id."""
