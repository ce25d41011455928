"""Find the sizes that can be dimensioned in the two views of a drawing, from the surfaces of a model."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import atan2, degrees, hypot, isclose
from typing import Literal

from cadquery import Vector

from cad.drafting.curves import Point
from cad.drafting.views import View
from cad.inspect import look_at
from cad.step import Body
from cad.surfaces import PartSurfaces, Surface, X, Y, Z

Sort = Literal["diameter", "radius", "length", "width", "gap", "offset", "angle"]
Form = Literal["across", "up", "aligned", "circle", "arc", "angle"]
Place = Literal["section", "end"]

_CLEAR = 1e-6  # [mm], and as the sine of an angle
_MOST_LEVELS = 14  # planes across one axis; drawings of more would not be read


@dataclass(frozen=True)
class Measure:
    """A size that a view shows.

    `across` lies level between two points, `up` upright, `aligned` along them; `circle` and `arc` are given
    by centre and a point on them, `angle` by its corner and a point on each leg.
    """

    sort: Sort
    value: float  # [mm], an angle in degrees
    place: Place
    form: Form
    points: tuple[Point, ...]
    count: int = 1  # of equal parts that have it


def measures(bodies: Sequence[Body], section: View, end: View, most: int = _MOST_LEVELS) -> list[Measure]:
    """Return every size that the views show; of more planes along the shaft than `most` those at its ends."""
    results: list[Measure] = []
    seen = look_at(bodies)
    for one in seen.values():
        results += _of_cylinders(one, section, end)
        results += _of_planes(one, section, end, most)
        results += _of_flanks(one, end)
    results += _of_axes([c for one in seen.values() for c in one.cylinders if c.along(Z)], section)
    results += _of_arcs(section, {d: one.count for one in seen.values() for d in one.spheres})
    results += _of_slopes(section)
    return results


def _of_cylinders(seen: PartSurfaces, section: View, end: View) -> Iterator[Measure]:
    about = []
    for cylinder in seen.cylinders:
        if cylinder.along(Z):
            turned = cylinder.turned(Z)
            yield from _lengthwise(turned, section, end, seen.count * alike(turned, seen))
            about += [turned] if cylinder.about(Z) else []
        elif _within(cylinder, section.frame.towards):
            yield _drilled(cylinder, section, seen.count)
    for one, other in combinations(about, 2):
        inner, outer = sorted((one, other), key=lambda cylinder: cylinder.diameter)
        low, high = inner.diameter / 2, outer.diameter / 2
        ends = [_edge_at(section, c.diameter / 2, c.reach) for c in (inner, outer)]
        if high - low > _CLEAR and ends[0] is not None and ends[1] is not None:
            yield Measure("gap", high - low, "section", "up", ((ends[0], low), (ends[1], high)))


def alike(cylinder: Surface, seen: PartSurfaces) -> int:
    """Return the number of equal cylinders in a pattern with one: at its place along parallel axes."""
    axis = cylinder.direction
    feet = {
        (
            round(one.point.cross(axis).x, 4),
            round(one.point.cross(axis).y, 4),
            round(one.point.cross(axis).z, 4),
        )
        for one in (c.turned(axis) for c in seen.cylinders if c.along(axis))
        if isclose(one.diameter, cylinder.diameter, abs_tol=_CLEAR)
        and isclose(one.reach[0], cylinder.reach[0], abs_tol=_CLEAR)
        and isclose(one.reach[1], cylinder.reach[1], abs_tol=_CLEAR)
    }
    return max(len(feet), 1)


def _lengthwise(cylinder: Surface, section: View, end: View, count: int) -> Iterator[Measure]:
    """Yield the diameter and radius of a cylinder along the shaft."""
    radius, centre = cylinder.diameter / 2, section.frame.flat(cylinder.point)[1]
    side, middle = end.frame.flat(cylinder.point)
    if abs(side) < _CLEAR:
        low, high = centre - radius, centre + radius
        z = [_edge_at(section, v, cylinder.reach) for v in (low, high)]
        if z[0] is not None and z[1] is not None:
            points = (z[0], low), (z[1], high)
            yield Measure("diameter", cylinder.diameter, "section", "up", points, count)
        else:
            points = (-radius, middle), (radius, middle)
            yield Measure("diameter", cylinder.diameter, "end", "across", points, count)
    else:
        points = (side, middle), (side + radius, middle)
        yield Measure("diameter", cylinder.diameter, "end", "circle", points, count)
    if on := _on_circle(end, (side, middle), radius):
        yield Measure("radius", radius, "end", "arc", ((side, middle), on), count)


def _edge_at(section: View, v: float, reach: tuple[float, float]) -> float | None:
    """Return the middle of an edge of the section at that height within a reach along the shaft."""
    level = [
        (min(a[0], b[0]), max(a[0], b[0])) for a, b in section.edges if abs(a[1] - v) + abs(b[1] - v) < 1e-4
    ]
    within = [(a, b) for a, b in level if a > reach[0] - 1e-4 and b < reach[1] + 1e-4]
    if not within:
        return None
    start, stop = max(within, key=lambda ends: ends[1] - ends[0])
    return (start + stop) / 2


def _on_circle(view: View, centre: Point, radius: float) -> Point | None:
    """Return a point of a visible line on a circle, beside the middle of its longest visible run."""
    runs = [
        [p for p in curve.points if abs(hypot(p[0] - centre[0], p[1] - centre[1]) - radius) < 1e-4]
        for curve in view.visible
    ]
    run = max(runs, key=len, default=[])
    return run[len(run) // 4] if len(run) > 2 else None


def _within(cylinder: Surface, normal: Vector) -> bool:
    """Return whether the axis lies in the plane of the section."""
    return abs(cylinder.point.dot(normal)) < _CLEAR and abs(cylinder.direction.dot(normal)) < _CLEAR


def _drilled(cylinder: Surface, section: View, count: int) -> Measure:
    """Return the diameter of a drilling in the plane of the section, at its outer mouth."""
    flat, away = section.frame.flat(cylinder.point), section.frame.flat(cylinder.direction)
    start = cylinder.point.dot(cylinder.direction)
    reach = max(cylinder.reach, key=abs) - start
    x, y = flat[0] + away[0] * reach, flat[1] + away[1] * reach
    r = cylinder.diameter / 2
    points = (x - away[1] * r, y + away[0] * r), (x + away[1] * r, y - away[0] * r)
    form: Form = "across" if abs(away[0]) < _CLEAR else "aligned"
    return Measure("diameter", cylinder.diameter, "section", form, points, count)


def length_between(low: float, high: float, section: View, count: int = 1) -> Measure:
    """Return the length between two planes across the shaft."""
    points = (low, _foot(section, low)), (high, _foot(section, high))
    return Measure("length", high - low, "section", "across", points, count)


def _of_planes(seen: PartSurfaces, section: View, end: View, most: int) -> Iterator[Measure]:
    levels = seen.levels(Z)
    for low, high in _spans(levels if len(levels) <= most else [*levels[: most - 1], levels[-1]]):
        yield length_between(low, high, section, seen.count)
    for axis in (X, Y):
        right, up = end.frame.flat(axis)
        sign = right + up  # one of them is 0
        for one, other in combinations(seen.levels(axis)[:_MOST_LEVELS], 2):
            low, high = sorted((one * sign, other * sign))
            (left, bottom), _ = end.box
            flat = (
                (((low, bottom), (high, bottom)), "across")
                if up == 0
                else (((left, low), (left, high)), "up")
            )
            yield Measure("width", high - low, "end", flat[1], flat[0], seen.count)  # type: ignore[arg-type]


def _spans(levels: Sequence[float]) -> list[tuple[float, float]]:
    """From each level to the next, between two that lie alike on either side of the origin, and the whole."""
    ends = (levels[0], levels[-1]) if levels else ()
    return [
        (low, high)
        for i, (low, high) in ((j - i, pair) for (i, j), pair in _pairs(levels))
        if i == 1 or (low, high) == ends or abs(low + high) < _CLEAR
    ]


def _pairs(levels: Sequence[float]) -> Iterator[tuple[tuple[int, int], tuple[float, float]]]:
    return zip(combinations(range(len(levels)), 2), combinations(levels, 2), strict=True)


def _foot(section: View, z: float) -> float:
    """Return the lowest point of the section at that place along the shaft."""
    ends = [p[1] for edge in section.edges for p in edge if abs(p[0] - z) < 1e-4]
    return min(ends, default=section.box[0][1])


def _of_axes(cylinders: Iterable[Surface], section: View) -> Iterator[Measure]:
    """Yield the distances of axes along the shaft that lie in the section from the shaft's own."""
    heights = {
        round(section.frame.flat(c.point)[1], 6) for c in cylinders if _within(c, section.frame.towards)
    }
    right = section.box[1][0]
    for height in sorted(heights - {0.0}):
        ends = sorted((0.0, height))
        yield Measure("offset", abs(height), "section", "up", ((right, ends[0]), (right, ends[1])))


def _of_arcs(section: View, spheres: dict[float, int]) -> Iterator[Measure]:
    for arc in section.arcs:
        points = (arc.centre, arc.middle)
        count = next((n for d, n in spheres.items() if abs(d - 2 * arc.radius) < _CLEAR), 1)
        if arc.whole or count > 1:
            yield Measure("diameter", 2 * arc.radius, "section", "circle", points, count)
        yield Measure("radius", arc.radius, "section", "arc", points)


def _of_slopes(section: View) -> Iterator[Measure]:
    """Yield the angles of sloping edges of the section against a plane across the shaft."""
    ends = [sorted((a, b), key=lambda point: point[1]) for a, b in section.edges]
    sloping = [(a, b) for a, b in ends if abs(b[0] - a[0]) > _CLEAR < b[1] - a[1]]
    longest = max((hypot(b[0] - a[0], b[1] - a[1]) for a, b in sloping), default=0.0)
    for low, high in sloping:
        lean, rise = high[0] - low[0], high[1] - low[1]
        size = hypot(lean, rise)
        if size > longest / 2:  # on a short one an angle could not be read
            points = low, (low[0], low[1] + size), high
            yield Measure("angle", degrees(atan2(abs(lean), rise)), "section", "angle", points)


def _of_flanks(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the angles between planes that hold the shaft's axis, on the side of the material."""
    flanks = [plane for plane in seen.planes if plane.holds(Z)]
    legs = [_leg(plane, end) for plane in flanks]
    for one, other in combinations([leg for leg in legs if leg], 2):
        turn = degrees(atan2(one[0] * other[1] - one[1] * other[0], one[0] * other[0] + one[1] * other[1]))
        if abs(turn) > _CLEAR:
            first, second = (one, other) if turn > 0 else (other, one)
            yield Measure("angle", abs(turn), "end", "angle", ((0.0, 0.0), first, second))


def _leg(plane: Surface, end: View) -> Point | None:
    """Return the end of a visible line that runs away from the shaft within a plane."""
    normal = end.frame.flat(plane.direction)
    on = [p for curve in end.visible for p in curve.points if abs(p[0] * normal[0] + p[1] * normal[1]) < 1e-4]
    return max(on, key=lambda p: hypot(*p), default=None)
