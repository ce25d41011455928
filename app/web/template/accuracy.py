"""Prepare the table of a template's levels: cost and measured errors."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median
from typing import NamedTuple

from pydantic import BaseModel, JsonValue

from app.catalogue.schemas.templates import Accuracy

SHOWN = 6  # number of outputs shown; the interface returns all


class Level(NamedTuple):
    """One level: milliseconds for one point, microseconds for a point among many, errors by output."""

    name: str
    single: float | None
    vectorised: float | None
    errors: dict[str, tuple[float, float]]  # median and largest


class Table(NamedTuple):
    """All levels, and the outputs whose errors are shown."""

    levels: list[Level]
    outputs: list[str]


class _Cost(BaseModel):
    """The seconds for one point, and for a point among many."""

    single: float | None = None
    vectorised: float | None = None


class _MeasuredErrors(BaseModel):
    """The measured errors of one level by output, for every cell of the plane."""

    cost: _Cost | None = None
    errors: dict[str, JsonValue]


def table(measured: Accuracy) -> Table:
    """Return the levels in an answer of `GET …/accuracy`, with the outputs whose errors were measured."""
    levels = [_level(name, _MeasuredErrors.model_validate(level)) for name, level in measured.levels.items()]
    outputs = list(dict.fromkeys(name for level in levels for name in level.errors))
    return Table(levels, outputs[:SHOWN])


def _level(name: str, measured: _MeasuredErrors) -> Level:
    cost = measured.cost or _Cost()
    errors = {output: sorted(_numbers(cells)) for output, cells in measured.errors.items()}
    return Level(
        name,
        cost.single if cost.single is None else cost.single * 1e3,
        cost.vectorised if cost.vectorised is None else cost.vectorised * 1e6,
        {output: (median(cells), cells[-1]) for output, cells in errors.items() if cells},
    )


def _numbers(cells: JsonValue) -> Iterator[float]:
    if isinstance(cells, list):
        for cell in cells:
            yield from _numbers(cell)
    elif isinstance(cells, int | float):
        yield float(cells)
