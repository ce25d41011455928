"""Errors of calculations, besides the inputs that templates refuse.

InvalidBody     the body of a request does not fit the operation
NoArray         the client wants an array, but the answer does not fit into one
TooManyValues   the answer would hold more values than the service returns at once
"""

from __future__ import annotations

from typing import Self

from pydantic import ValidationError
from pydantic_core import ErrorDetails


class TooManyValues(Exception):
    """The answer would hold more values than the service returns at once."""


class NoArray(Exception):
    """The outputs do not fit into one array of numbers."""


class InvalidBody(Exception):
    """The body of a request does not fit the operation; `errors()` has Pydantic's form."""

    def __init__(self, listed: list[ErrorDetails]) -> None:
        super().__init__(listed)
        self._listed = listed

    @classmethod
    def of(cls, error: ValidationError) -> Self:
        """Convert a Pydantic error to one with FastAPI's locations, without large values."""
        listed = error.errors(include_url=False, include_input=False, include_context=False)
        return cls([{**entry, "loc": ("body", *entry["loc"])} for entry in listed])

    @classmethod
    def not_json(cls, reason: str) -> Self:
        """Return the error for a body that cannot be parsed, worded as in FastAPI."""
        entry = ErrorDetails(type="json_invalid", loc=("body", 0), msg="JSON decode error", input=None)
        return cls([{**entry, "ctx": {"error": reason}}])

    def errors(self) -> list[ErrorDetails]:
        """Return the list of faults."""
        return self._listed
