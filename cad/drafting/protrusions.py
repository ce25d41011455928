"""Sizes of lugs that protrude from a cylinder, of joints beside the shaft, and of chamfers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import acos, degrees, hypot, isclose

from cadquery import Vector

from cad.drafting.measures import Form, Measure, Sort, alike, on
from cad.drafting.parts_features import relief_height
from cad.drafting.views import View
from cad.surfaces import PartSurfaces, Surface, X, Y, Z

_CLEAR = 1e-6  # [mm]
_SLIGHT = 0.05  # offset of the axis of an eccentric bore at most, as a share of its diameter
_ARC = 1e-5  # [mm]: how near to its surface an edge of the section lies


def standing(seen: Sequence[PartSurfaces], section: View, end: View) -> list[Measure]:
    """Return all sizes of lugs, joints and chamfers that the views show."""
    kinds = (of_circles, of_levels, of_floors, of_arms, of_uprights, of_slots)
    beside = [measure for one in seen for kind in kinds for measure in kind(one, end)]
    return [*beside, *of_walls(seen, section), *of_bevels(seen, section)]


def of_circles(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the pitch circles about the shaft through the axes of holes."""
    for cylinder in seen.cylinders:
        if cylinder.along(Z) and not cylinder.about(Z):
            right, up = end.frame.flat(cylinder.point)
            points = ((0.0, 0.0), (right, up))
            yield Measure("diameter", 2 * hypot(right, up), "end", "circle", points, 1, on(cylinder))


def of_slots(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the widths of slots and bars along the shaft that are oblique in the end view."""
    sides = [p for p in seen.planes if abs(p.direction.dot(Z)) < _CLEAR and p.middle is not None]
    askew = [p for p in sides if not (p.along(X) or p.along(Y))]
    for one, other in combinations(askew, 2):
        if one.along(other.direction) and one.middle and other.middle:
            way = one.direction * (other.middle - one.middle).dot(one.direction)
            if _CLEAR < way.Length and (other.middle - one.middle - way).Length < way.Length:
                points = end.frame.flat(one.middle), end.frame.flat(one.middle + way)
                yield Measure("width", way.Length, "end", "aligned", points, 1, on(one), on(other))


def of_walls(parts: Sequence[PartSurfaces], section: View) -> Iterator[Measure]:
    """Yield wall thicknesses: from a bore to an outer cylinder, or to the circle of a relief.

    For a relief, the height at which it meets the bore follows.
    """
    left = section.box[0][0]
    rings = [one.rings(Z) for one in parts]
    beside = [c for one in parts for c in one.cylinders if c.along(Z) and not c.about(Z)]
    eccentric = [
        [c] for c in beside if abs(c.point.dot(X)) < _CLEAR and abs(c.point.dot(Y)) < _SLIGHT * c.diameter
    ]
    for bore in [*(some[0] for some in rings if some), *eccentric]:
        low = bore[0].diameter / 2 - abs(bore[0].point.dot(Y))
        for ring in [ring for some in rings for ring in some]:
            high = ring[0].diameter / 2
            if high > low + _CLEAR:
                points = ((left, low), (left, high))
                yield Measure("gap", high - low, "section", "up", points, 1, on(*bore), on(*ring))
        for circle in beside:
            reach = circle.point.dot(X) + circle.diameter / 2
            if abs(circle.point.dot(Y)) < _CLEAR < reach - low:
                points = ((low, 0.0), (reach, 0.0))
                yield Measure("gap", reach - low, "end", "across", points, 1, on(*bore), on(circle))
                edge = relief_height(abs(circle.point.dot(X)), circle.diameter / 2, low)
                side = (low**2 - edge**2) ** 0.5
                ends = ((side, 0.0), (side, edge))
                yield Measure("edge", edge, "end", "up", ends, 1, on(*bore), on(circle))


def of_arms(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the angles between planes through the shaft's axis, on the side of the crown."""
    arms = []
    for plane in seen.planes:
        if plane.holds(Z) and not plane.along(Y):
            arm = plane.direction.cross(Z)
            arms.append((end.frame.flat(arm if arm.y > 0 else -arm), plane))
    reach = max(seen.diameters(Z), default=0.0) / 2
    for (one, plane), (other, second) in combinations(arms, 2):
        angle = degrees(acos(max(-1.0, min(1.0, one[0] * other[0] + one[1] * other[1]))))
        if angle > _CLEAR:
            points = ((0.0, 0.0), *((reach * x, reach * y) for x, y in (one, other)))
            yield Measure("angle", angle, "end", "angle", points, 1, on(plane), on(second))


def of_uprights(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the sizes of holes along y: diameter, depth, and the distance between axes."""
    feet = []
    for hole in (cylinder.turned(Y) for cylinder in seen.cylinders if cylinder.along(Y)):
        x, (low, high) = hole.point.x, hole.reach
        left, right = (end.frame.flat(Vector(x + side * hole.diameter / 2, high, 0)) for side in (-1, 1))
        foot = end.frame.flat(Vector(x, low, 0))
        if end.frame.flat(Y)[1] == 1:
            several = alike(hole, seen)
            yield Measure("diameter", hole.diameter, "end", "across", (left, right), several, on(hole))
            sides = (on(*seen.planes_at(Y, level)) for level in (low, high))
            yield Measure("length", high - low, "end", "up", ((right[0], foot[1]), right), 1, *sides)
            feet.append((foot, hole))
    for (one, hole), (other, second) in combinations(feet, 2):
        apart = abs(one[0] - other[0])
        if apart > _CLEAR:
            yield Measure("width", apart, "end", "across", (one, other), 1, on(hole), on(second))


def of_levels(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the distances from the shaft's axis, and from cylinders about it, to planes beyond them."""
    rings = [(0.0, on()), *((ring[0].diameter / 2, on(*ring)) for ring in seen.rings(Z))]
    for axis in (X, Y):
        right, up = end.frame.flat(axis)
        for level in seen.levels(axis):
            if abs(level) < _CLEAR:
                continue
            side = level * (right + up)
            for radius, faces in rings:
                start = radius if side > 0 else -radius
                if abs(side) > radius + _CLEAR:
                    ends = ((start, 0.0), (side, 0.0)) if up == 0 else ((0.0, start), (0.0, side))
                    sort: Sort = "gap" if start else "offset"
                    form: Form = "across" if up == 0 else "up"
                    plane = on(*seen.planes_at(axis, level))
                    yield Measure(sort, abs(side - start), "end", form, ends, 1, plane, faces)


def of_floors(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the depths of keyways: from a floor between two walls to the cylinder above it."""
    for floor in (p for p in seen.planes if p.along(X) or p.along(Y)):
        if (middle := floor.middle) is None:
            continue
        flat = end.frame.flat(middle)
        level = bool(abs(flat[0]) > abs(flat[1]))
        low = flat[0] if level else flat[1]
        for bar in (c for c in seen.about(Z) if not c.is_reversed and c.reach[0] < middle.z < c.reach[1]):
            high = bar.diameter / 2 * (1 if low > 0 else -1)
            walls = [p for p in seen.planes if _is_wall(p, floor, abs(low), abs(high))]
            if len(walls) == 2:
                ends = ((low, 0.0), (high, 0.0)) if level else ((0.0, low), (0.0, high))
                form: Form = "across" if level else "up"
                yield Measure("gap", abs(high - low), "end", form, ends, 1, on(floor), on(bar))


def _is_wall(plane: Surface, floor: Surface, low: float, high: float) -> bool:
    """Return whether a plane along the shaft stands on a floor, with its middle between two heights."""
    if plane.middle is None or floor.middle is None or abs(plane.direction.dot(Z)) > _CLEAR:
        return False
    height, away = abs(plane.middle.dot(floor.direction)), (plane.middle - floor.middle).Length
    return abs(plane.direction.dot(floor.direction)) < _CLEAR and low < height < high and away < high


def of_bevels(parts: Sequence[PartSurfaces], section: View) -> Iterator[Measure]:
    """Yield the widths along the shaft of edges of the section at 45°."""
    cones = [cone.turned(Z) for one in parts for cone in one.cones if cone.about(Z)]
    for (x, y), (z, v) in section.edges:
        if abs(z - x) > _CLEAR and isclose(abs(z - x), abs(v - y), rel_tol=1e-6):
            low, high = sorted(((x, y), (z, v)))
            cut = [c for c in cones if _is_cut_at(c, (x + z) / 2, abs(y + v))]
            faces = on(*(c for c in cones if any(_are_alike(c, one) for one in cut)))
            yield Measure("chamfer", abs(z - x), "section", "across", (low, high), max(len(faces), 1), faces)


def _is_cut_at(cone: Surface, middle: float, diameter: float) -> bool:
    """Return whether an edge of the section with the given middle and mean diameter lies on a cone."""
    return abs(sum(cone.reach) / 2 - middle) < _ARC and abs(cone.diameter - diameter) < _ARC


def _are_alike(one: Surface, other: Surface) -> bool:
    """Return whether two cones of one part are chamfers of the same size."""
    sizes = (one.diameter - other.diameter, one.reach[1] - one.reach[0] - other.reach[1] + other.reach[0])
    return one.face[0] == other.face[0] and all(abs(size) < _ARC for size in sizes)
