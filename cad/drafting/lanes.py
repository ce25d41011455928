"""On which side of a view a dimension stands: in lanes beside it, or at its own place within it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from cad.drafting.curves import Point
from cad.drafting.matching import Dimension

Box = tuple[Point, Point]
Side = list[Dimension]


@dataclass(frozen=True)
class Lane:
    """The dimensions on one side of a view, the short ones nearest to it.

    `along` is the coordinate that they measure, `edge` that of the view's side, `out` the direction away.
    """

    dimensions: Side
    along: int
    edge: float
    out: int
    is_of_end: bool


@dataclass(frozen=True)
class Lanes:
    """Dimensions by the side of the view on which they stand."""

    section: Box
    end: Box
    left: Side
    right: Side
    beyond: Side  # to the right of the end view
    below: Side
    end_below: Side
    above: Side
    local: Side

    @staticmethod
    def sorted(dimensions: Iterable[Dimension], section: Box, end: Box) -> Lanes:
        """Every dimension on the side that is nearest to what it measures."""
        sides = Lanes(section, end, [], [], [], [], [], [], [])
        middle = (section[0][0] + section[1][0]) / 2, (section[0][1] + section[1][1]) / 2
        for one in dimensions:
            sides._side(one, middle).append(one)
        return sides

    def _side(self, one: Dimension, middle: Point) -> Side:
        measure = one.measure
        place = sum(x for x, _ in measure.points) / len(measure.points)
        match measure.form, measure.place:
            case "up", "end":
                return self.beyond
            case "up", _:
                return self.right if place > middle[0] else self.left
            case "across", "end":
                return self.end_below
            case "across", _:
                high = min(y for _, y in measure.points) > middle[1]
                return self.above if high and measure.sort == "diameter" else self.below
        return self.local

    @property
    def counts(self) -> tuple[int, int, int, int, int]:
        """How many lanes there can be at most: left, between the views, right, below, above."""
        below = max(len(self.below), len(self.end_below))
        return len(self.left), len(self.right), len(self.beyond), min(below, 4), len(self.above)

    def sides(self) -> Iterator[Lane]:
        """Every side that has dimensions."""
        (left, low), (right, high) = self.section
        (_, end_low), (end_right, _) = self.end
        every = (
            (self.left, 1, left, -1, False),
            (self.right, 1, right, 1, False),
            (self.beyond, 1, end_right, 1, True),
            (self.below, 0, low, -1, False),
            (self.end_below, 0, end_low, -1, True),
            (self.above, 0, high, 1, False),
        )
        for side, along, edge, out, is_of_end in every:
            ordered = sorted(side, key=lambda one: (one.measure.value, one.measure.points))
            yield Lane(ordered, along, edge, out, is_of_end)
