"""Balloons (ISO 6433): each part of an assembly has a number, with a leader to a point on it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import dist

from cad.drafting.curves import Point
from cad.drafting.views import View
from cad.step import Body

_MOST = 24  # parts of a sheet that get balloons


def balloons(section: View, bodies: Sequence[Body]) -> Iterator[tuple[int, Point]]:
    """Yield the number of each part, as in the parts list, and a point of it in the section."""
    if not 1 < len(bodies) <= _MOST:
        return
    for number, body in enumerate(bodies):
        yield number + 1, _on_cut(section, number) or _within(section, body)


def _on_cut(section: View, part: int) -> Point | None:
    """Return a point within the largest cut face of a part: its centroid, or the middle of a side."""
    outlines = [[(x, y) for x, y, _ in cut.outlines[0]] for cut in section.cut if cut.part == part]
    if not outlines:
        return None
    line = max(outlines, key=lambda one: abs(_area(one)))
    sides = [*zip(line, [*line[1:], line[0]], strict=True)]
    crosses = [(x * v - u * y, x + u, y + v) for (x, y), (u, v) in sides]
    middle = tuple(sum(c[0] * c[n] for c in crosses) / (6 * _area(line)) for n in (1, 2))
    if _is_inside(middle, sides):
        return middle[0], middle[1]
    (x, y), (u, v) = max(sides, key=lambda side: round(dist(*side), 4))
    return (x + u) / 2, (y + v) / 2


def _area(line: Sequence[Point]) -> float:
    """Return the area within a closed line, with its sign."""
    return sum(x * v - u * y for (x, y), (u, v) in zip(line, [*line[1:], line[0]], strict=True)) / 2


def _is_inside(point: Sequence[float], sides: Sequence[tuple[Point, Point]]) -> bool:
    """Return whether an odd number of sides cross the ray from a point to the right."""
    x, y = point
    over = [(a, b) for a, b in sides if (a[1] > y) != (b[1] > y)]
    return sum(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x for a, b in over) % 2 == 1


def _within(section: View, body: Body) -> Point:
    """Return the middle of the box of a part that is not cut."""
    middle = body.shape.moved(body.places[0]).BoundingBox().center
    return section.frame.flat(middle)
