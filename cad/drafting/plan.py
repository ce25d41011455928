"""Plan the sheet: its areas, a scale at which everything has room, and the positions of the views."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cad.drafting.curves import Point
from cad.drafting.formats import FORMATS, Format
from cad.drafting.lanes import Lanes
from cad.drafting.parameter_match import Dimension
from cad.drafting.views import View

LANE = 9.0  # from one dimension line to the next
FILLED, MORE = 0.35, 0.005
"""Least share of the area's width or height that views without their dimensions take, if a sheet has it; and
by how much it grows with each dimension."""

_ROOM = 24.0  # around and between views, beside the dimensions
SCALES = [f * 10.0**n for n in range(3, -5, -1) for f in (5, 2, 1)]
"""The scales of ISO 5455, the largest first."""


@dataclass(frozen=True)
class Plan:
    """The sheet, its scale and the places of its views, in the coordinates of the section."""

    scale: float  # of the paper: mm on paper for each mm of the part
    beside: float  # by how much the end view is moved to the right
    corner: Point  # lower left corner of the sheet
    lanes: Lanes
    format: Format = FORMATS[0]

    def at(self, x: float, y: float) -> Point:
        """Convert a position on the paper [mm from its lower left corner] to the drawing's coordinates."""
        return self.corner[0] + x / self.scale, self.corner[1] + y / self.scale

    def paper(self, point: Sequence[float], right: float = 0.0) -> Point:
        """Convert a point of a view that is moved to the right to its position on the paper [mm]."""
        x, y = point[0] + right - self.corner[0], point[1] - self.corner[1]
        return x * self.scale, y * self.scale

    @property
    def scale_text(self) -> str:
        """Return the scale as text, such as `1:2`."""
        return f"{self.scale:g}:1" if self.scale >= 1 else f"1:{1 / self.scale:g}"


def plans(section: View, end: View, wanted: Sequence[Dimension], elsewhere: int = 0) -> Iterator[Plan]:
    """Yield the plans in the order of preference.

    Sheets and scales whose views fill the sheet come first, beginning with the smallest sheet and its largest
    scale. All others with enough room follow, the fullest first.

    Parameters
    ----------
    section, end
        The two views.
    wanted
        The dimensions of the two views.
    elsewhere
        The number of dimensions in removed sections.
    """
    lanes = Lanes.sorted(wanted, section, end)
    (left, low), (right, high) = section.box
    (end_left, end_low), (end_right, end_high) = end.box
    across, bottom, top = right - left + end_right - end_left, min(low, end_low), max(high, end_high)
    sides = [n * LANE for n in lanes.counts]
    taken = 3 * _ROOM + sides[0] + sides[1] + sides[2], 2 * _ROOM + sides[3] + sides[4]

    def share(format: Format, scale: float) -> float:
        return max(scale * across / format.room[0], scale * (top - bottom) / format.room[1])

    fitting = [
        (format, s)
        for format in FORMATS
        for s in SCALES
        if s * across + taken[0] <= format.room[0] and s * (top - bottom) + taken[1] <= format.room[1]
    ]
    wanted_share = min(FILLED + MORE * (len(wanted) + elsewhere), 0.55)
    full = [one for one in fitting if share(*one) >= wanted_share]
    others = sorted((one for one in fitting if one not in full), key=lambda one: -share(*one))
    for format, scale in [*full, *others] or [(FORMATS[-1], SCALES[-1])]:
        area, room = format.area, format.room
        gap = (_ROOM + sides[1]) / scale
        spare = (room[0] - scale * across - taken[0]) / 2, (room[1] - scale * (top - bottom) - taken[1]) / 2
        x = left - (area[0] + _ROOM + sides[0] + spare[0]) / scale
        y = bottom - (area[1] + _ROOM + sides[3] + spare[1]) / scale
        yield Plan(scale, right + gap - end_left, (x, y), lanes, format)
