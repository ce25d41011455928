"""Parts that all tables share: names of constraints, canonical JSON, and the JSON column type."""

import json

from sqlalchemy import Dialect, MetaData, Text, TypeDecorator
from sqlalchemy.orm import DeclarativeBase

from app import plain
from app.plain import JsonObject

NAMING = {
    "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    "ck": "ck_%(table_name)s_%(constraint_name)s",
    "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
    "pk": "pk_%(table_name)s",
}


canonical_json = json.JSONEncoder(
    sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
).encode
"""Write a JSON value in its one canonical form; raises ValueError for NaN and infinity."""


class NotWritten(ValueError):
    """A column has a value that this program has not written."""


class JsonText(TypeDecorator[plain.Json]):
    """A JSON value in a text column; None is NULL. Changes inside a value are not tracked: replace it."""

    impl = Text
    cache_ok = True

    def process_bind_param(self, value: plain.Json, dialect: Dialect) -> str | None:
        """Return the JSON text of a Python value."""
        return None if value is None else canonical_json(value)

    def process_result_value(self, value: str | None, dialect: Dialect | None = None) -> plain.Json:
        """Return the Python value of a JSON text.

        Raises
        ------
        NotWritten
            If the text is not JSON, so that this program has not written it.
        """
        try:
            return None if value is None else json.loads(value)
        except ValueError as error:
            raise NotWritten(f"a stored text is not JSON: {error}") from error


class Base(DeclarativeBase):
    """Base class of all tables; migrations rely on its way to name constraints."""

    metadata = MetaData(naming_convention=NAMING)
    type_annotation_map = {str: Text, JsonObject: JsonText, list[JsonObject]: JsonText, list[str]: JsonText}
