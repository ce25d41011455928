"""Balloons (ISO 6433): each part of an assembly gets a number, with a leader to a point on the part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import dist

from cadquery import BoundBox, Vector

from cad.drafting.curves import Point
from cad.drafting.views import View
from cad.step import Body

_LARGE = 0.5  # share of the largest cut face of a part, from which a face may have the leader
_ENDS = (0.5, 0.03, 0.97)  # of a bolt's length: its middle, its head and its tip
_MOST = 24  # parts of a sheet that get balloons


def balloons(section: View, end: View, bodies: Sequence[Body]) -> Iterator[tuple[int, View, Sequence[Point]]]:
    """Yield the number of each part in the parts list, and points on that part in a view that shows it."""
    if not 1 < len(bodies) <= _MOST:
        return
    for part, body in enumerate(bodies):
        if points := _on_cuts(section, part):
            yield part + 1, section, points
        elif points := _on_cuts(end, part) or _in_break(end, body):
            yield part + 1, end, points
        else:
            yield part + 1, section, _middles(section, body)[:1]


def _on_cuts(view: View, part: int) -> list[Point]:
    """Return a point on each large cut face of a part."""
    outlines = [[(x, y) for x, y, _ in cut.outlines[0]] for cut in view.cut if cut.part == part]
    largest = max((abs(_area(one)) for one in outlines), default=0.0)
    return [_on_cut(one) for one in outlines if abs(_area(one)) > _LARGE * largest]


def _on_cut(line: Sequence[Point]) -> Point:
    """Return the centroid of a cut face.

    If that lies outside the face, return the point in its material opposite to the middle of the longest
    side.
    """
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


def _in_break(view: View, body: Body) -> list[Point]:
    """Return points along the axis of a part whose middle is in a broken-out section of a view."""
    corners = [point for curve in view.broken for point in curve.points]
    if not corners:
        return []
    low, high = (tuple(pick(point[n] for point in corners) for n in (0, 1)) for pick in (min, max))
    for place in body.places:
        box = body.shape.moved(place).BoundingBox()
        one, other = (view.frame.flat(Vector(*corner)) for corner in _corners(box))
        middle = (one[0] + other[0]) / 2, (one[1] + other[1]) / 2
        if all(low[n] < middle[n] < high[n] for n in (0, 1)):
            along = int(abs(other[1] - one[1]) > abs(other[0] - one[0]))
            places = (one[along] + share * (other[along] - one[along]) for share in _ENDS)
            return [(middle[0], at) if along else (at, middle[1]) for at in places]
    return []


def _corners(box: BoundBox) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    return (box.xmin, box.ymin, box.zmin), (box.xmax, box.ymax, box.zmax)


def _middles(view: View, body: Body) -> list[Point]:
    """Return the centres of the bounding boxes of a part at all its places."""
    boxes = (body.shape.moved(place).BoundingBox() for place in body.places)
    return [view.frame.flat(box.center) for box in boxes]
