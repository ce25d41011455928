"""JSON objects with a limited number of names, so that a large wrong object causes few errors.

Without this, Pydantic validates every entry of an object before it counts the entries, and reports each
invalid one.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from pydantic import BaseModel, BeforeValidator, model_validator
from pydantic_core import PydanticCustomError

MOST_FIELDS = 100


class Bounded(BaseModel):
    """A model that refuses an object with too many names before it validates their values."""

    @model_validator(mode="before")
    @classmethod
    def few_fields(cls, raw: object) -> object:
        """Refuse an object with too many names before its values are validated.

        Raises
        ------
        PydanticCustomError
            If it has too many names.
        """
        return _few(raw, MOST_FIELDS)


def at_most(count: int) -> BeforeValidator:
    """Return an annotation that limits the number of entries of a dictionary.

    The number is checked before the entries themselves.
    """
    return BeforeValidator(partial(_few, most=count))


def _few(raw: object, most: int) -> object:
    if isinstance(raw, Mapping) and len(raw) > most:
        message = "an object here may have at most {most} names, not {count}"
        raise PydanticCustomError("too_long", message, {"most": most, "count": len(raw)})
    return raw
