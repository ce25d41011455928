"""Measured errors of a template's levels as a table: what a level costs, how far off its results may be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from statistics import median
from typing import Any, NamedTuple

SHOWN = 6  # outputs; all are in the answer of the interface


class Level(NamedTuple):
    """One level: milliseconds of one point, microseconds of a point among many, errors by output."""

    name: str
    single: float | None
    vectorised: float | None
    errors: dict[str, tuple[float, float]]  # median and largest


class Table(NamedTuple):
    """All levels, and the outputs that are shown of them."""

    levels: list[Level]
    outputs: list[str]


def table(measured: Mapping[str, Any]) -> Table:
    """The levels of the answer to `GET …/accuracy`, with the outputs that were measured."""
    levels = [_level(name, told) for name, told in measured["levels"].items()]
    outputs = list(dict.fromkeys(name for level in levels for name in level.errors))
    return Table(levels, outputs[:SHOWN])


def _level(name: str, told: Mapping[str, Any]) -> Level:
    cost = told.get("cost") or {}
    errors = {output: sorted(_numbers(cells)) for output, cells in told["errors"].items()}
    return Level(
        name,
        cost["single"] * 1e3 if "single" in cost else None,
        cost["vectorised"] * 1e6 if "vectorised" in cost else None,
        {output: (median(found), found[-1]) for output, found in errors.items() if found},
    )


def _numbers(cells: Any) -> Iterator[float]:
    if isinstance(cells, list):
        for cell in cells:
            yield from _numbers(cell)
    elif cells is not None:
        yield float(cells)
