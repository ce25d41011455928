"""Balloons (ISO 6433): each part of an assembly gets a number, with a leader to a point on the part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import dist

from cad.drafting.curves import Point
from cad.drafting.views import View
from cad.step import Body

_MOST = 24  # parts of a sheet that get balloons


def balloons(section: View, end: View, bodies: Sequence[Body]) -> Iterator[tuple[int, View, Point]]:
    """Yield the number of each part in the parts list, and a point on that part in a view that shows it."""
    if not 1 < len(bodies) <= _MOST:
        return
    for part, body in enumerate(bodies):
        if (point := _on_cut(section, part)) is not None:
            yield part + 1, section, point
        elif (point := _on_cut(end, part) or _in_break(end, body)) is not None:
            yield part + 1, end, point
        else:
            yield part + 1, section, _middles(section, body)[0]


def _on_cut(view: View, part: int) -> Point | None:
    """Return a point on the largest cut face of a part.

    The point is the centroid of the face if it lies within the face, otherwise the point in its material that
    is opposite to the middle of its longest side.
    """
    outlines = [[(x, y) for x, y, _ in cut.outlines[0]] for cut in view.cut if cut.part == part]
    if not outlines:
        return None
    line = max(outlines, key=lambda one: abs(_area(one)))
    sides = [*zip(line, [*line[1:], line[0]], strict=True)]
    crosses = [(x * v - u * y, x + u, y + v) for (x, y), (u, v) in sides]
    middle = tuple(sum(c[0] * c[n] for c in crosses) / (6 * _area(line)) for n in (1, 2))
    if _is_inside(middle, sides):
        return middle[0], middle[1]
    (x, y), (u, v) = max(sides, key=lambda side: round(dist(*side), 4))
    return _across((x + u) / 2, (y + v) / 2, (u - x, v - y), sides)


def _across(x: float, y: float, along: Point, sides: Sequence[tuple[Point, Point]]) -> Point:
    """Return the middle of the line across a polygon that starts on a side, square to that side."""
    size = dist(along, (0.0, 0.0))
    for a, b in ((-along[1] / size, along[0] / size), (along[1] / size, -along[0] / size)):
        if not _is_inside((x + 1e-3 * a, y + 1e-3 * b), sides):
            continue
        reaches = [
            ((p - x) * (s - q) - (q - y) * (r - p)) / (a * (s - q) - b * (r - p))
            for (p, q), (r, s) in sides
            if (a * (q - y) - b * (p - x)) * (a * (s - y) - b * (r - x)) <= 0.0
            and abs(a * (s - q) - b * (r - p)) > 1e-9
        ]
        half = min(reach for reach in reaches if reach > 1e-4) / 2
        return x + a * half, y + b * half
    return x, y


def _area(line: Sequence[Point]) -> float:
    """Return the signed area of a closed polygon, positive if its corners run counter-clockwise."""
    return sum(x * v - u * y for (x, y), (u, v) in zip(line, [*line[1:], line[0]], strict=True)) / 2


def _is_inside(point: Sequence[float], sides: Sequence[tuple[Point, Point]]) -> bool:
    """Return whether a point is inside a polygon, by the parity of the sides that a ray crosses."""
    x, y = point
    over = [(a, b) for a, b in sides if (a[1] > y) != (b[1] > y)]
    return sum(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x for a, b in over) % 2 == 1


def _in_break(view: View, body: Body) -> Point | None:
    """Return the middle of a part that is in a broken-out section of a view."""
    corners = [point for curve in view.broken for point in curve.points]
    if not corners:
        return None
    low, high = (tuple(pick(point[n] for point in corners) for n in (0, 1)) for pick in (min, max))
    inside = (m for m in _middles(view, body) if all(low[n] < m[n] < high[n] for n in (0, 1)))
    return next(inside, None)


def _middles(view: View, body: Body) -> list[Point]:
    """Return the centres of the bounding boxes of a part at all its places."""
    boxes = (body.shape.moved(place).BoundingBox() for place in body.places)
    return [view.frame.flat(box.center) for box in boxes]
