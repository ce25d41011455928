"""A long array in a table cell: least and largest value, their places, and a sparkline."""

from __future__ import annotations

from dataclasses import dataclass

from app.presentation import numbers

WIDTH, HEIGHT = 120, 24
MOST_POINTS = 240


@dataclass(frozen=True)
class Course:
    """A long array as a cell shows it."""

    ends: str  # `-5.3 … 12.1`
    count: str
    where: str  # `least at 30°, largest at 372°`
    path: str  # of an SVG of 120 × 24


def course(values: object, axis: object = None, unit: str | None = None) -> Course | None:
    """Return the course of a long list of numbers, along an axis where there is one.

    None of anything else.
    """
    if not isinstance(values, list) or len(values) <= numbers.FEW or numbers.size(values) != len(values):
        return None
    ends = numbers.extremes(values)
    if ends is None:
        return None
    places = [_place(end, axis, unit, len(values)) for end in ends]
    shown = " … ".join(numbers.plain(values[end]) for end in ends)
    return Course(
        shown, f"{len(values)} values", f"least {places[0]}, largest {places[1]}", _path(values, ends)
    )


def _place(end: int, axis: object, unit: str | None, count: int) -> str:
    if isinstance(axis, list) and len(axis) == count and isinstance(axis[end], int | float):
        return f"at {numbers.in_line({'value': axis[end], 'unit': unit})}"
    return f"no. {end + 1}"


def _path(values: list[float | None], ends: tuple[int, int]) -> str:
    """Return the line; begun again after values that are missing."""
    low, high = values[ends[0]], values[ends[1]]
    assert low is not None
    assert high is not None
    every = -(-len(values) // MOST_POINTS)
    pieces, down = [], False
    for place in range(0, len(values), every):
        value = values[place]
        if isinstance(value, int | float):
            share = (value - low) / (high - low) if high > low else 0.5
            x, y = WIDTH * place / (len(values) - 1), 1 + (HEIGHT - 2) * (1 - share)
            pieces.append(f"{'L' if down else 'M'}{x:.1f},{y:.1f}")
        down = isinstance(value, int | float)
    return "".join(pieces)
