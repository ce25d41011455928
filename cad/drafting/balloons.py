"""Balloons (ISO 6433): each part of an assembly gets a number, with a leader to a point on the part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import dist

from cad.drafting.curves import Point
from cad.drafting.views import View
from cad.step import Body

_MOST = 24  # parts of a sheet that get balloons


def balloons(section: View, bodies: Sequence[Body]) -> Iterator[tuple[int, Point]]:
    """Yield the number of each part in the parts list, and a point on that part in the section."""
    if not 1 < len(bodies) <= _MOST:
        return
    for number, body in enumerate(bodies):
        yield number + 1, _on_cut(section, number) or _within(section, body)


def _on_cut(section: View, part: int) -> Point | None:
    """Return a point on the largest cut face of a part.

    The point is the centroid of the face if it lies within the face, otherwise the middle of the longest
    side.
    """
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
    """Return the signed area of a closed polygon, positive if its corners run counter-clockwise."""
    return sum(x * v - u * y for (x, y), (u, v) in zip(line, [*line[1:], line[0]], strict=True)) / 2


def _is_inside(point: Sequence[float], sides: Sequence[tuple[Point, Point]]) -> bool:
    """Return whether a point is inside a polygon, by the parity of the sides that a ray crosses."""
    x, y = point
    over = [(a, b) for a, b in sides if (a[1] > y) != (b[1] > y)]
    return sum(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x for a, b in over) % 2 == 1


def _within(section: View, body: Body) -> Point:
    """Return the centre of the bounding box of a part that the section does not cut."""
    middle = body.shape.moved(body.places[0]).BoundingBox().center
    return section.frame.flat(middle)
