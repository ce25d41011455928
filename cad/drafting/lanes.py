"""Where dimension lines run: in lanes beside a view, the short ones nearest to it, none across another."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from cad.drafting.matching import Dimension
from cad.drafting.views import Point

Box = tuple[Point, Point]
Side = list[Dimension]

_LETTER = 2.6  # width of a letter with the room around it [mm on paper]
_FIRST = 10.0  # from the view to its first dimension line [mm on paper]


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

    def placed(self, scale: float, lane: float) -> Iterator[tuple[Dimension, Point]]:
        """Every dimension with a point of its dimension line, before the end view is moved to its place."""
        (left, low), (right, high) = self.section
        (_, end_low), (end_right, _) = self.end
        yield from _laned(self.left, 1, left, -1, scale, lane)
        yield from _laned(self.right, 1, right, 1, scale, lane)
        yield from _laned(self.beyond, 1, end_right, 1, scale, lane)
        yield from _laned(self.below, 0, low, -1, scale, lane)
        yield from _laned(self.end_below, 0, end_low, -1, scale, lane)
        yield from _laned(self.above, 0, high, 1, scale, lane)
        yield from ((one, one.measure.points[0]) for one in self.local)


def _laned(
    side: Side, along: int, edge: float, out: int, scale: float, lane: float
) -> Iterator[tuple[Dimension, Point]]:
    """Each in the first lane in which it has room; `along` is the coordinate that it measures."""
    taken: list[list[tuple[float, float]]] = []
    for one in sorted(side, key=lambda one: (one.measure.value, one.measure.points)):
        low, high = _extent(one, along, scale)
        number = next((i for i, lane in enumerate(taken) if not _crosses(lane, low, high)), len(taken))
        if number == len(taken):
            taken.append([])
        taken[number].append((low, high))
        away = edge + out * (_FIRST + lane * number) / scale
        yield one, ((away, low) if along else (low, away))


def _crosses(lane: list[tuple[float, float]], low: float, high: float) -> bool:
    return any(low < there[1] and there[0] < high for there in lane)


def _extent(one: Dimension, along: int, scale: float) -> tuple[float, float]:
    """The length that a dimension occupies in its lane, its words included."""
    ends = sorted(point[along] for point in one.measure.points)
    words = _LETTER * (len(f"{one.measure.value:.6g}") + 2) / scale
    spare = max(0.0, words - (ends[1] - ends[0])) / 2
    return ends[0] - spare, ends[1] + spare
