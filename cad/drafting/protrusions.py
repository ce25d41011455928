"""Sizes of lugs that protrude from a cylinder, of joints beside the shaft, and of chamfers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import acos, degrees, hypot, isclose

from cadquery import Vector

from cad.drafting.measures import Measure, Sort, alike
from cad.drafting.views import View
from cad.inspect import look_at
from cad.step import Body
from cad.surfaces import PartSurfaces, X, Y, Z

_CLEAR = 1e-6  # [mm]


def standing(bodies: Sequence[Body], section: View, end: View) -> list[Measure]:
    """Return every such size that the views show."""
    seen = look_at(bodies).values()
    kinds = (of_circles, of_levels, of_arms, of_uprights)
    beside = [measure for one in seen for kind in kinds for measure in kind(one, end)]
    return [*beside, *of_walls(list(seen), section), *of_bevels(section)]


def of_circles(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the circles about the shaft on which the axes of holes lie."""
    for cylinder in seen.cylinders:
        if cylinder.along(Z) and not cylinder.about(Z):
            right, up = end.frame.flat(cylinder.point)
            yield Measure("diameter", 2 * hypot(right, up), "end", "circle", ((0.0, 0.0), (right, up)))


def of_walls(parts: Sequence[PartSurfaces], section: View) -> Iterator[Measure]:
    """From the bore of one part to the outside of another; from a bore to a circle beside it, its relief."""
    left = section.box[0][0]
    bores = {min(one.diameters(Z), default=0.0) / 2 for one in parts}
    for low in sorted(bores):
        for high in sorted({diameter / 2 for one in parts for diameter in one.diameters(Z)}):
            if high > low + _CLEAR:
                yield Measure("gap", high - low, "section", "up", ((left, low), (left, high)))
        for circle in (c for one in parts for c in one.cylinders if c.along(Z) and not c.about(Z)):
            reach = circle.point.dot(X) + circle.diameter / 2
            if abs(circle.point.dot(Y)) < _CLEAR < reach - low:
                yield Measure("gap", reach - low, "end", "across", ((low, 0.0), (reach, 0.0)))


def of_arms(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield angles at the shaft between planes through it, on the side of the crown."""
    arms = []
    for plane in seen.planes:
        if plane.holds(Z) and not plane.along(Y):
            arm = plane.direction.cross(Z)
            arms.append(end.frame.flat(arm if arm.y > 0 else -arm))
    reach = max(seen.diameters(Z), default=0.0) / 2
    for one, other in combinations(arms, 2):
        angle = degrees(acos(max(-1.0, min(1.0, one[0] * other[0] + one[1] * other[1]))))
        if angle > _CLEAR:
            points = [(reach * x, reach * y) for x, y in (one, other)]
            yield Measure("angle", angle, "end", "angle", ((0.0, 0.0), *points))


def of_uprights(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the holes along y: their diameter, their depth, and how far apart their axes are."""
    feet = []
    for hole in (cylinder.turned(Y) for cylinder in seen.cylinders if cylinder.along(Y)):
        x, (low, high) = hole.point.x, hole.reach
        left, right = (end.frame.flat(Vector(x + side * hole.diameter / 2, high, 0)) for side in (-1, 1))
        foot = end.frame.flat(Vector(x, low, 0))
        if end.frame.flat(Y)[1] == 1:
            several = alike(hole, seen)
            yield Measure("diameter", hole.diameter, "end", "across", (left, right), several)
            yield Measure("length", high - low, "end", "up", ((right[0], foot[1]), right))
            feet.append(foot)
    for one, other in combinations(feet, 2):
        if abs(one[0] - other[0]) > _CLEAR:
            yield Measure("width", abs(one[0] - other[0]), "end", "across", (one, other))


def of_levels(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """From the largest cylinder about the shaft to planes beyond it, and from the shaft to each plane."""
    radii = [0.0, *(diameter / 2 for diameter in seen.diameters(Z))]
    for axis in (X, Y):
        right, up = end.frame.flat(axis)
        for level in seen.levels(axis):
            if abs(level) < _CLEAR:
                continue
            side = level * (right + up)
            for radius in radii:
                start = radius if side > 0 else -radius
                if abs(side) > radius + _CLEAR:
                    ends = ((start, 0.0), (side, 0.0)) if up == 0 else ((0.0, start), (0.0, side))
                    sort: Sort = "gap" if start else "offset"
                    yield Measure(sort, abs(side - start), "end", "across" if up == 0 else "up", ends)


def of_bevels(section: View) -> Iterator[Measure]:
    """Yield the width of edges of the section at 45°, along the shaft."""
    for (x, y), (z, v) in section.edges:
        if abs(z - x) > _CLEAR and isclose(abs(z - x), abs(v - y), rel_tol=1e-6):
            low, high = sorted(((x, y), (z, v)))
            yield Measure("length", abs(z - x), "section", "across", (low, high))
