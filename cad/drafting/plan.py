"""The sheet: its areas, the scale at which everything has room, and where the views stand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cad.drafting.curves import Point
from cad.drafting.lanes import Lanes
from cad.drafting.matching import Dimension
from cad.drafting.room import Rectangle
from cad.drafting.title import HEIGHT
from cad.drafting.views import View

SHEET = (420.0, 297.0)  # A3 [mm]
LEFT, EDGE = 20.0, 10.0  # margins (ISO 5457)
COLUMN = 104.0  # of the table of parameters
LANE = 9.0  # from one dimension line to the next

AREA: Rectangle = (LEFT, EDGE + HEIGHT, SHEET[0] - EDGE - COLUMN, SHEET[1] - EDGE)
"""Where the views and their dimensions are [mm on paper]."""

_ROOM = 24.0  # around and between views, beside the dimensions
SCALES = [f * 10.0**n for n in range(3, -5, -1) for f in (5, 2, 1)]
"""The scales of ISO 5455, the largest first."""


@dataclass(frozen=True)
class Plan:
    """Size of the drawing and places of its views, in the coordinates of the section."""

    scale: float  # of the paper: mm on paper for each mm of the part
    beside: float  # by how much the end view is moved to the right
    corner: Point  # lower left corner of the sheet
    lanes: Lanes

    def at(self, x: float, y: float) -> Point:
        """A place on the paper [mm from its lower left corner] in the drawing's coordinates."""
        return self.corner[0] + x / self.scale, self.corner[1] + y / self.scale

    def paper(self, point: Sequence[float], right: float = 0.0) -> Point:
        """A point of a view, moved to the right, on the paper [mm]."""
        x, y = point[0] + right - self.corner[0], point[1] - self.corner[1]
        return x * self.scale, y * self.scale

    @property
    def scale_text(self) -> str:
        """The scale in words."""
        return f"{self.scale:g}:1" if self.scale >= 1 else f"1:{1 / self.scale:g}"


def plans(section: View, end: View, wanted: Sequence[Dimension]) -> Iterator[Plan]:
    """Plans at the largest common scale at which everything should have room, then at smaller ones."""
    lanes = Lanes.sorted(wanted, section.box, end.box)
    (left, low), (right, high) = section.box
    (end_left, end_low), (end_right, end_high) = end.box
    across, bottom, top = right - left + end_right - end_left, min(low, end_low), max(high, end_high)
    width, height = AREA[2] - AREA[0], AREA[3] - AREA[1]
    sides = [n * LANE for n in lanes.counts]
    taken = 3 * _ROOM + sides[0] + sides[1] + sides[2], 2 * _ROOM + sides[3] + sides[4]
    fitting = [
        s for s in SCALES if s * across + taken[0] <= width and s * (top - bottom) + taken[1] <= height
    ]
    for scale in fitting or SCALES[-1:]:
        gap = (_ROOM + sides[1]) / scale
        spare = (width - scale * across - taken[0]) / 2, (height - scale * (top - bottom) - taken[1]) / 2
        x = left - (AREA[0] + _ROOM + sides[0] + spare[0]) / scale
        y = bottom - (AREA[1] + _ROOM + sides[3] + spare[1]) / scale
        yield Plan(scale, right + gap - end_left, (x, y), lanes)
