"""Errors of an import of a model, beyond those of its file and of its program."""


class ModelIdTaken(Exception):
    """Something else has the id."""
