"""Arrange sections across a shaft in rows below the views, in the order of their letters.

The axes of the shaft in a row are on one line. Equal gaps separate the sections of a row, the rows, and the
first row from the views.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate

from cad.drafting.curves import Point
from cad.drafting.dimension_layout import NoRoom
from cad.drafting.plan import Plan
from cad.drafting.removed_section import Extent, RemovedSection
from cad.drafting.room import Room


def in_rows(plan: Plan, room: Room, sections: Sequence[RemovedSection]) -> dict[str, Point]:
    """Return the origin of each section across the shaft on the paper [mm], by letter.

    Raises
    ------
    NoRoom
        If the rows do not fit below the views.
    """
    across = [(one.letter, Extent.of(one, plan)) for one in sections if one.stations]
    if not across:
        return {}
    left, low, right, _ = room.area
    rows = next(iter(_rows(across, right - left)), None)
    if rows is None:
        raise NoRoom
    above = [max(extent.above for _, extent in row) for row in rows]
    below = [max(extent.below for _, extent in row) for row in rows]
    gap = (room.lowest - low - sum(above) - sum(below)) / len(rows)
    if gap < 0.0:
        raise NoRoom
    tops = accumulate(((one + other + gap) for one, other in zip(above, below, strict=True)), initial=0.0)
    levels = [room.lowest - gap / 2 - down - up for down, up in zip(tops, above, strict=False)]
    return {
        letter: (x, level)
        for row, level in zip(rows, levels, strict=True)
        for letter, x in _along(row, left, right)
    }


Row = Sequence[tuple[str, Extent]]


def _rows(across: Row, width: float) -> Iterator[list[Row]]:
    """Yield the divisions into equal rows that are not too wide, those of few rows first."""
    for count in range(1, len(across) + 1):
        size = -(-len(across) // count)
        rows = [across[start : start + size] for start in range(0, len(across), size)]
        if all(_width(row) <= width for row in rows):
            yield rows


def _width(row: Row) -> float:
    return sum(extent.left + extent.right for _, extent in row)


def _along(row: Row, left: float, right: float) -> Iterator[tuple[str, float]]:
    """Yield the horizontal position of the origin of each section in a row."""
    gap = (right - left - _width(row)) / len(row)
    start = left + gap / 2
    for letter, extent in row:
        yield letter, start + extent.left
        start += extent.left + extent.right + gap
