"""Errors of calculations, besides the inputs that templates refuse.

InvalidBody     a body that a calculation process read does not fit the operation
NoArray         the client asked for an array, but the answer does not fit into one
TooManyValues   an answer would hold more values than the service gives at once
"""

from __future__ import annotations

from typing import Self

from pydantic import ValidationError
from pydantic_core import ErrorDetails


class TooManyValues(Exception):
    """The answer would hold more values than the service gives at once."""


class NoArray(Exception):
    """The outputs do not fit one array of numbers."""


class InvalidBody(Exception):
    """A body that is not what the operation takes; `errors()` are in pydantic's form."""

    def __init__(self, listed: list[ErrorDetails]) -> None:
        super().__init__(listed)
        self._listed = listed

    @classmethod
    def of(cls, error: ValidationError) -> Self:
        """Convert a pydantic error to one located as in FastAPI, without large values."""
        listed = error.errors(include_url=False, include_input=False, include_context=False)
        return cls([{**entry, "loc": ("body", *entry["loc"])} for entry in listed])

    @classmethod
    def not_json(cls, reason: str) -> Self:
        """Return the error for a body that cannot be parsed, worded as in FastAPI."""
        entry = ErrorDetails(type="json_invalid", loc=("body", 0), msg="JSON decode error", input=None)
        return cls([{**entry, "ctx": {"error": reason}}])

    def errors(self) -> list[ErrorDetails]:
        """Return the faults, one by one."""
        return self._listed
