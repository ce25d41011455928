"""Plan the sheet: its areas, a scale at which everything has room, and the positions of the views."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cad.drafting.curves import Point
from cad.drafting.formats import FORMATS, Format
from cad.drafting.labels import TEXT, label_of
from cad.drafting.lanes import Lanes
from cad.drafting.parameter_match import Dimension
from cad.drafting.views import View

LANE = 9.0  # from one dimension line to the next
FILLED, MORE = 0.4, 0.005
"""Least share of the area's width or height that views without their dimensions take, if a sheet has it; and
by how much it grows with each dimension."""

_LEAST = 0.4  # of that share: views that take less are tried only if no others have room
_COST = {"A3": 0.0, "A2": 1.0, "A1": 2.0, "A0": 4.0}
"""Of a sheet: the smallest that does is taken, and A0, which no desk holds, only if nothing else does."""
_EMPTY, _REDUCED = 4.0, 0.5
"""Cost of a sheet without views, in sheets; smaller views leave it emptier. Cost of a reduced scale."""

_BELOW = 1.8  # of the room above views that have others below them, from below to the middle
_ROOM = 24.0  # around and between views, beside the dimensions
_BESIDE = 3.0  # from a narrow dimension to its words, and from these to the next view [mm on paper]
_LEADER = 10.0  # from a view to the words at the end of a leader [mm on paper]
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


def plans(
    section: View, end: View, wanted: Sequence[Dimension], elsewhere: int = 0, *, below: bool = False
) -> Iterator[Plan]:
    """Yield the plans in the order of preference.

    A smaller sheet comes before a larger one, unless its scale leaves it emptier than the larger one.

    Parameters
    ----------
    section, end
        The two views.
    wanted
        The dimensions of the two views.
    elsewhere
        The number of dimensions in removed sections.
    below
        Whether removed sections stand in rows below the views.
    """
    lanes = Lanes.sorted(wanted, section, end)
    (left, low), (right, high) = section.box
    (end_left, end_low), (end_right, end_high) = end.box
    across, bottom, top = right - left + end_right - end_left, min(low, end_low), max(high, end_high)
    sides = [n * LANE for n in lanes.counts]
    led = max((_LEADER + label_of(one).width(TEXT) for one in lanes.local), default=0.0)

    def between(scale: float) -> float:
        """Return the room between the views for lanes, leaders and words beside narrow dimensions."""
        words = (_beyond(one, right, scale) for one in (*lanes.below, *lanes.above))
        more = _LEADER if lanes.between else 0.0  # for leaders beside the lanes of both views
        return max(_ROOM + more + sides[1], sides[1] + led, *words)

    def taken(scale: float) -> tuple[float, float]:
        return 2 * _ROOM + sides[0] + between(scale) + sides[2], 2 * _ROOM + sides[3] + sides[4]

    def share(format: Format, scale: float) -> float:
        return max(scale * across / format.room[0], scale * (top - bottom) / format.room[1])

    fitting = [
        (format, s)
        for format in FORMATS
        for s in SCALES
        if s * across + taken(s)[0] <= format.room[0] and s * (top - bottom) + taken(s)[1] <= format.room[1]
    ]
    wanted_share = min(FILLED + MORE * (len(wanted) + elsewhere), 0.5)

    def cost(format: Format, scale: float) -> float:
        emptiness = max(wanted_share - share(format, scale), 0.0) / wanted_share
        return _COST[format.name] + _EMPTY * emptiness + _REDUCED * (scale < 1)

    readable = [one for one in fitting if share(*one) >= _LEAST * wanted_share]
    ordered = sorted(readable or fitting, key=lambda one: (cost(*one), -one[1]))
    for format, scale in ordered or [(FORMATS[-1], SCALES[-1])]:
        area, room = format.area, format.room
        gap, needed = between(scale) / scale, taken(scale)
        spare = (room[0] - scale * across - needed[0]) / 2, (room[1] - scale * (top - bottom) - needed[1]) / 2
        x = left - (area[0] + _ROOM + sides[0] + spare[0]) / scale
        y = bottom - (area[1] + _ROOM + sides[3] + spare[1] * (_BELOW if below else 1.0)) / scale
        yield Plan(scale, right + gap - end_left, (x, y), lanes, format)


def _beyond(one: Dimension, right: float, scale: float) -> float:
    """Return how far the words beside a narrow dimension reach beyond the right side of a view [mm]."""
    ends, width = sorted(x for x, _ in one.measure.points), label_of(one).width(TEXT)
    if scale * (ends[-1] - ends[0]) > width:
        return 0.0
    return scale * (ends[-1] - right) + width + 2 * _BESIDE
