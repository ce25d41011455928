"""Offer the tables of the library as values for limits: `"limits": {"bearing_material": "tin_bronze"}`."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from templates.core.criteria.limits import Library, Row, RowValue, register
from templates.library.tables import limits_of, table

CHOICES = ("bearing_material",)
"""The tables whose rows give limits. Their files are read when a request first names a row."""


def register_choices() -> None:
    """Register the tables of the library, so that limits can be taken from their rows."""
    for name in CHOICES:
        register(name, Library(partial(_rows, name), partial(_row, name)))


def _rows(name: str) -> Iterator[str]:
    return (row.id for row in table(name).rows)


def _row(name: str, row_id: str) -> Row:
    return {
        limit: RowValue(f"{cited.value!r} {cited.unit}", cited.source)
        for limit, cited in limits_of(name, row_id).items()
    }
