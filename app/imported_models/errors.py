"""Errors of a model import, in addition to those of its file and of its program."""


class ModelIdTaken(Exception):
    """Another object already has this id."""
