"""Choose the side of a view for each dimension: in lanes beside the view, or at a position within it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from cad.drafting.curves import Point
from cad.drafting.parameter_match import Dimension
from cad.drafting.views import View

_CLEAR = 1e-4  # [mm]

Box = tuple[Point, Point]
Side = list[Dimension]


@dataclass(frozen=True)
class Lane:
    """The dimensions on one side of a view, the shortest nearest to the view.

    `along` is the index of the coordinate that they measure, `edge` the position of that side of the view,
    and `out` the sign of the direction away from the view.
    """

    dimensions: Side
    along: int
    edge: float
    out: int
    is_of_end: bool


@dataclass(frozen=True)
class Lanes:
    """Dimensions, grouped by the side of the view on which they stand."""

    section: View
    end: View
    left: Side
    right: Side
    between: Side  # to the left of the end view
    beyond: Side  # to the right of it
    below: Side
    end_below: Side
    above: Side
    end_above: Side
    local: Side

    @staticmethod
    def sorted(dimensions: Iterable[Dimension], section: View, end: View) -> Lanes:
        """Return the dimensions, each on the side nearest to its feature."""
        sides = Lanes(section, end, [], [], [], [], [], [], [], [], [])
        (left, low), (right, high) = section.box
        middle = (left + right) / 2, (low + high) / 2
        for one in dimensions:
            side, out = sides._side(one, middle)
            view = end if one.measure.place == "end" else section
            side.append(_from_its_edges(one, view, out) if out else one)
        return sides

    def _side(self, one: Dimension, middle: Point) -> tuple[Side, int]:
        """Return the side of a dimension and its sign: -1 below or left, 1 above or right, 0 for neither."""
        measure = one.measure
        place = sum(x for x, _ in measure.points) / len(measure.points)
        match measure.form, measure.place:
            case "up", "end":
                at_left, at_right = self._away(one)
                return (self.between, -1) if at_left + _CLEAR < at_right else (self.beyond, 1)
            case "up", _:
                return (self.right, 1) if place > middle[0] else (self.left, -1)
            case "across", "end":
                at_foot, at_top = self._away(one)
                return (self.end_above, 1) if at_top + _CLEAR < at_foot else (self.end_below, -1)
            case "across", _:
                feet = [y for _, y in measure.points]
                if measure.sort != "diameter":
                    feet = [_edge_at(one, self.section, number)[0] for number in (0, 1)]
                return (self.above, 1) if min(feet) > middle[1] else (self.below, -1)
        return self.local, 0

    def _away(self, one: Dimension) -> tuple[float, float]:
        """Return how far a size's edges are from the left or lower side of the end view, and the other."""
        across = int(one.measure.form == "across")
        low, high = (corner[across] for corner in self.end.box)
        ranges = [edge for number in (0, 1) if (edge := _edge_at(one, self.end, number))[0] < edge[1]]
        return sum(start - low for start, _ in ranges), sum(high - stop for _, stop in ranges)

    @property
    def counts(self) -> tuple[int, int, int, int, int]:
        """Return the largest number of lanes: left, between the views, right, below, above."""
        below = max(len(self.below), len(self.end_below))
        above = max(len(self.above), min(len(self.end_above), 4))
        between = len(self.right) + len(self.between)
        return len(self.left), between, len(self.beyond), min(below, 4), above

    def sides(self) -> Iterator[Lane]:
        """Yield every side with its dimensions, those of the end view first."""
        (left, low), (right, high) = self.section.box
        (end_left, end_low), (end_right, end_high) = self.end.box
        every = (
            (self.between, 1, end_left, -1, True),
            (self.beyond, 1, end_right, 1, True),
            (self.end_below, 0, end_low, -1, True),
            (self.end_above, 0, end_high, 1, True),
            (self.left, 1, left, -1, False),
            (self.right, 1, right, 1, False),
            (self.below, 0, low, -1, False),
            (self.above, 0, high, 1, False),
        )
        for side, along, edge, out, is_of_end in every:
            ordered = sorted(side, key=lambda one: (one.measure.value, one.measure.points))
            yield Lane(ordered, along, edge, out, is_of_end)


def _from_its_edges(one: Dimension, view: View, out: int) -> Dimension:
    """Return the dimension with extension lines that begin at the edges nearest to its side."""
    along = int(one.measure.form == "up")
    points = []
    for number, point in enumerate(one.measure.points):
        end = _edge_at(one, view, number)[out > 0]
        points.append((end, point[1]) if along else (point[0], end))
    return replace(one, measure=replace(one.measure, points=tuple(points)))


def _edge_at(one: Dimension, view: View, number: int) -> tuple[float, float]:
    """Return the range that edges or axes through a point of a dimension cover across the dimension.

    For a diameter only edges that contain its point count, because others may belong to the foot of a circle.
    """
    along, point = int(one.measure.form == "up"), one.measure.points[number]
    at, across = point[along], point[1 - along]
    for lines in (view.straight, view.unseen, view.axes):
        spans = [
            (min(a[1 - along], b[1 - along]), max(a[1 - along], b[1 - along]))
            for a, b in lines
            if abs(a[along] - at) + abs(b[along] - at) < _CLEAR
        ]
        if one.measure.sort == "diameter":
            spans = [(low, high) for low, high in spans if low - _CLEAR < across < high + _CLEAR]
        if spans:
            return min(low for low, _ in spans), max(high for _, high in spans)
    return across, across
