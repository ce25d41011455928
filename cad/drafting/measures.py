"""Find the sizes that can be dimensioned in the two views of a drawing, from the surfaces of a model."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from math import atan2, degrees, hypot, isclose
from typing import Literal

from cadquery import Vector

from cad.drafting.curves import Point
from cad.drafting.section import Arc, Frame
from cad.drafting.views import View
from cad.step import Body, rigid
from cad.surfaces import Face, PartSurfaces, Size, Surface, X, Y, Z

Sort = Literal["diameter", "radius", "length", "width", "gap", "offset", "angle", "chamfer", "edge", "pitch"]
Form = Literal["across", "up", "aligned", "circle", "arc", "angle"]
Place = Literal["section", "end"]

_CLEAR = 1e-6  # [mm], and as the sine of an angle
_ARC = 1e-5  # [mm]: how near to its surface an edge of the section lies
_ECCENTRIC = 0.05  # between axes that enclose a wall, as a share of the inner diameter
_MOST_LEVELS = 14  # planes across one axis; drawings of more would not be read


@dataclass(frozen=True)
class Measure:
    """A size that a view shows.

    The form `across` is horizontal, `up` vertical, `aligned` parallel to the line between its two points. The
    points of a `circle` or an `arc` are its centre and a point on it; those of an `angle` are its corner and
    a point on each leg. `first` and `second` are the faces between which the size is measured; `second` is
    empty for a diameter and for a distance from an axis.
    """

    sort: Sort
    value: float  # [mm], an angle in degrees
    place: Place
    form: Form
    points: tuple[Point, ...]
    count: int = 1  # of equal parts that have it
    first: frozenset[Face] = frozenset()
    second: frozenset[Face] = frozenset()
    is_spherical: bool = field(default=False, kw_only=True)


def measures(
    bodies: Sequence[Body],
    seen: Mapping[str, PartSurfaces],
    section: View,
    end: View,
    most: int = _MOST_LEVELS,
) -> list[Measure]:
    """Return every size that the views show.

    If there are more than `most` planes across the shaft, the first of them and the last are used.
    """
    results: list[Measure] = []
    for one in seen.values():
        results += _of_cylinders(one, section, end)
        results += _of_planes(one, section, end, most)
        results += flank_angles(one, end)
    results += _of_axes([c for one in seen.values() for c in one.cylinders if c.along(Z)], section)
    standing = list(_standing(bodies, seen))
    results += _of_arcs(section, standing, {name: one.count for name, one in seen.items()})
    results += _of_slopes(section, standing)
    return results


def lengths(sizes: Iterable[Size], seen: Mapping[str, PartSurfaces], section: View) -> Iterator[Measure]:
    """Yield the lengths between faces along the shaft, at each place where a length occurs."""
    levels = {plane.face: plane.point.z for one in seen.values() for plane in one.planes if plane.along(Z)}
    for size in sizes:
        for place in size.places if size.kind == "distance" else ():
            if {*place.first[:1], *place.second[:1]} <= levels.keys() and place.second:
                low, high = sorted((levels[place.first[0]], levels[place.second[0]]))
                yield length_between(seen[place.first[0][0]], low, high, section)


def _standing(bodies: Sequence[Body], seen: Mapping[str, PartSurfaces]) -> Iterator[Surface]:
    """Yield every surface at each position of its part."""
    for body in bodies:
        for place in body.places:
            moved = rigid(place)
            yield from (one.moved(*moved) for one in seen[body.name].surfaces)


def _of_cylinders(seen: PartSurfaces, section: View, end: View) -> Iterator[Measure]:
    about, counts = [], _counts(seen)
    for cylinder in seen.cylinders:
        if cylinder.along(Z):
            turned = cylinder.turned(Z)
            yield from _lengthwise(turned, section, end, seen.count * counts[turned.face])
            about += [turned] if _within(cylinder, section.frame.towards) else []
        elif _within(cylinder, section.frame.towards):
            yield _drilled(cylinder, section, seen.count)
    for one, other in combinations(about, 2):
        inner, outer = sorted((one, other), key=lambda cylinder: cylinder.diameter)
        if one.point.cross(Z).sub(other.point.cross(Z)).Length > _ECCENTRIC * inner.diameter:
            continue
        low, high = (section.frame.flat(c.point)[1] + c.diameter / 2 for c in (inner, outer))
        ends = [_edge_at(section, radius, c.reach) for radius, c in ((low, inner), (high, outer))]
        if high - low > _CLEAR and ends[0] is not None and ends[1] is not None:
            points = ((ends[0], low), (ends[1], high))
            yield Measure("gap", high - low, "section", "up", points, 1, on(inner), on(outer))


def _counts(seen: PartSurfaces) -> dict[Face, int]:
    """Return how many cylinders along the shaft are equal and begin and end together, by their faces."""
    groups = defaultdict[tuple[float, ...], dict[Face, tuple[float, float]]](dict)
    for one in (c.turned(Z) for c in seen.cylinders if c.along(Z)):
        low, high = one.reach
        foot = round(one.point.x, 4) + 0.0, round(one.point.y, 4) + 0.0
        groups[round(one.diameter, 5), round(low, 5), round(high, 5)][one.face] = foot
    return {face: len({*feet.values()}) for feet in groups.values() for face in feet}


def alike(cylinder: Surface, seen: PartSurfaces) -> int:
    """Return the number of equal cylinders in a pattern: at the same position along parallel axes."""
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
            yield Measure("diameter", cylinder.diameter, "section", "up", points, count, on(cylinder))
        else:
            points = (-radius, middle), (radius, middle)
            yield Measure("diameter", cylinder.diameter, "end", "across", points, count, on(cylinder))
    else:
        points = (side, middle), (side + radius, middle)
        yield Measure("diameter", cylinder.diameter, "end", "circle", points, count, on(cylinder))
    if arc := _on_circle(end, (side, middle), radius):
        yield Measure("radius", radius, "end", "arc", ((side, middle), arc), count, on(cylinder))


def on(*surfaces: Surface) -> frozenset[Face]:
    """Return the faces of surfaces."""
    return frozenset(one.face for one in surfaces)


def _edge_at(section: View, v: float, reach: tuple[float, float]) -> float | None:
    """Return the middle of the longest edge of the section at a height, within a range along the shaft."""
    level = [
        (min(a[0], b[0]), max(a[0], b[0])) for a, b in section.edges if abs(a[1] - v) + abs(b[1] - v) < 1e-4
    ]
    within = [(a, b) for a, b in level if a > reach[0] - 1e-4 and b < reach[1] + 1e-4]
    if not within:
        return None
    start, stop = max(within, key=lambda ends: ends[1] - ends[0])
    return (start + stop) / 2


def _on_circle(view: View, centre: Point, radius: float) -> Point | None:
    """Return a point on the longest visible run of a circle, away from the middle of the run."""
    runs = [
        [p for p in curve.points if abs(hypot(p[0] - centre[0], p[1] - centre[1]) - radius) < 1e-4]
        for curve in view.visible
    ]
    run = max(runs, key=len, default=[])
    return run[len(run) // 4] if len(run) > 2 else None


def _within(cylinder: Surface, normal: Vector) -> bool:
    """Return whether the axis of a cylinder lies in the plane of the section."""
    return abs(cylinder.point.dot(normal)) < _CLEAR and abs(cylinder.direction.dot(normal)) < _CLEAR


def _drilled(cylinder: Surface, section: View, count: int) -> Measure:
    """Return the diameter of a drilling in the plane of the section, measured at its outer mouth."""
    flat, away = section.frame.flat(cylinder.point), section.frame.flat(cylinder.direction)
    start = cylinder.point.dot(cylinder.direction)
    r, end = cylinder.diameter / 2, max(cylinder.reach, key=abs)
    walls = (point for edge in section.edges if _are_off(edge, flat, away, r) for point in edge)
    mouths = (start + (x - flat[0]) * away[0] + (y - flat[1]) * away[1] for x, y in walls)
    reach = min(mouths, key=lambda mouth: abs(mouth - end), default=end) - start
    x, y = flat[0] + away[0] * reach, flat[1] + away[1] * reach
    points = (x - away[1] * r, y + away[0] * r), (x + away[1] * r, y - away[0] * r)
    form: Form = "across" if abs(away[0]) < _CLEAR else "aligned"
    return Measure("diameter", cylinder.diameter, "section", form, points, count, on(cylinder))


def _are_off(points: Iterable[Point], foot: Point, way: Point, away: float) -> bool:
    """Return whether points lie at a distance from a line, given by its foot and direction."""
    return all(abs(abs((x - foot[0]) * way[1] - (y - foot[1]) * way[0]) - away) < _ARC for x, y in points)


def length_between(seen: PartSurfaces, low: float, high: float, section: View) -> Measure:
    """Return the length between two planes across the shaft."""
    points = (low, foot(section, low)), (high, foot(section, high))
    sides = (on(*seen.planes_at(Z, level)) for level in (low, high))
    return Measure("length", high - low, "section", "across", points, seen.count, *sides)


def _of_planes(seen: PartSurfaces, section: View, end: View, most: int) -> Iterator[Measure]:
    levels = seen.levels(Z)
    for low, high in _spans(levels if len(levels) <= most else [*levels[: most - 1], levels[-1]]):
        yield length_between(seen, low, high, section)
    yield from plane_widths(seen, end)


def plane_widths(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the distances between planes along the shaft, level or upright in the end view."""
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
            sides = (on(*seen.planes_at(axis, level)) for level in (one, other))
            yield Measure("width", high - low, "end", flat[1], flat[0], seen.count, *sides)  # type: ignore[arg-type]


def _spans(levels: Sequence[float]) -> list[tuple[float, float]]:
    """Yield the spans between adjacent levels, between mirrored levels, and over all levels."""
    ends = (levels[0], levels[-1]) if levels else ()
    return [
        (low, high)
        for i, (low, high) in ((j - i, pair) for (i, j), pair in _pairs(levels))
        if i == 1 or (low, high) == ends or abs(low + high) < _CLEAR
    ]


def _pairs(levels: Sequence[float]) -> Iterator[tuple[tuple[int, int], tuple[float, float]]]:
    return zip(combinations(range(len(levels)), 2), combinations(levels, 2), strict=True)


def foot(section: View, z: float) -> float:
    """Return the lowest point of the section at a position along the shaft."""
    ends = [p[1] for edge in section.edges for p in edge if abs(p[0] - z) < 1e-4]
    return min(ends, default=section.box[0][1])


def _of_axes(cylinders: Iterable[Surface], section: View) -> Iterator[Measure]:
    """Yield the distances from the shaft's axis to the parallel axes that lie in the section."""
    heights = defaultdict[float, list[Surface]](list)
    for cylinder in cylinders:
        if _within(cylinder, section.frame.towards):
            heights[round(section.frame.flat(cylinder.point)[1], 6) + 0.0].append(cylinder)
    right = section.box[1][0]
    for height in sorted(heights.keys() - {0.0}):
        ends = sorted((0.0, height))
        points = ((right, ends[0]), (right, ends[1]))
        yield Measure("offset", abs(height), "section", "up", points, 1, on(*heights[height]))


def _of_arcs(section: View, standing: Sequence[Surface], counts: Mapping[str, int]) -> Iterator[Measure]:
    """Yield the arcs of the section: those of balls, fillets, and cylinders seen end-on."""
    for arc in section.arcs:
        points = (arc.centre, arc.middle)
        faces = on(*(one for one in standing if _is_cut_in(one, arc, section.frame)))
        count = max((counts[part] for part, _ in faces), default=1)
        is_ball = any(one.form == "sphere" and one.face in faces for one in standing)
        if arc.whole or is_ball:
            diameter = Measure("diameter", 2 * arc.radius, "section", "circle", points, count, faces)
            yield replace(diameter, is_spherical=is_ball)
        tubes = {one.face for one in standing if one.form == "torus" and one.face in faces}
        alike = [
            o for o in standing if tubes and o.form == "torus" and abs(o.diameter / 2 - arc.radius) < _CLEAR
        ]
        yield Measure("radius", arc.radius, "section", "arc", points, max(len(alike), 1), faces)


def _is_cut_in(surface: Surface, arc: Arc, frame: Frame) -> bool:
    """Return whether the plane of the section cuts a surface along an arc."""
    if abs(surface.diameter / 2 - arc.radius) > _CLEAR:
        return False
    x, y = frame.flat(surface.point)
    if surface.about_radius == 0 and surface.reach == (0.0, 0.0):
        return hypot(x - arc.centre[0], y - arc.centre[1]) < _ARC  # a sphere
    if not surface.along(Z):
        return surface.along(frame.towards) and hypot(x - arc.centre[0], y - arc.centre[1]) < _ARC
    away = abs(arc.centre[1] - y)
    return surface.about_radius > 0 and abs(arc.centre[0] - x) < _ARC > abs(away - surface.about_radius)


def _of_slopes(section: View, standing: Sequence[Surface]) -> Iterator[Measure]:
    """Yield the angles between sloping edges of the section and a plane across the shaft."""
    planes = [one for one in standing if one.diameter == 0]
    ends = [sorted((a, b), key=lambda point: point[1]) for a, b in section.edges]
    sloping = [(a, b) for a, b in ends if abs(b[0] - a[0]) > _CLEAR < b[1] - a[1]]
    longest = max((hypot(b[0] - a[0], b[1] - a[1]) for a, b in sloping), default=0.0)
    for low, high in sloping:
        lean, rise = high[0] - low[0], high[1] - low[1]
        size = hypot(lean, rise)
        if size > longest / 2:  # on a short one an angle could not be read
            points = low, (low[0], low[1] + size), high
            faces = on(*(p for p in planes if all(_holds(p, end, section.frame) for end in (low, high))))
            angle = degrees(atan2(abs(lean), rise))
            yield Measure("angle", angle, "section", "angle", points, 1, faces)


def _holds(plane: Surface, point: Point, frame: Frame) -> bool:
    """Return whether a plane contains a point of a view, placed in the view plane through the origin."""
    at = frame.right * point[0] + frame.up * point[1]
    return abs((at - plane.point).dot(plane.direction)) < _ARC


def flank_angles(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the angles between planes through the shaft's axis, measured on the side of the material."""
    yield from _of_tapers(seen, end)
    flanks = [plane for plane in seen.planes if plane.holds(Z)]
    legs = [(leg, plane) for plane in flanks if (leg := _leg(plane, end))]
    for (one, plane), (other, second) in combinations(legs, 2):
        turn = degrees(atan2(one[0] * other[1] - one[1] * other[0], one[0] * other[0] + one[1] * other[1]))
        if abs(turn) > _CLEAR:
            legs_of = (one, other) if turn > 0 else (other, one)
            points = ((0.0, 0.0), *legs_of)
            yield Measure("angle", abs(turn), "end", "angle", points, 1, on(plane), on(second))


def _of_tapers(seen: PartSurfaces, end: View) -> Iterator[Measure]:
    """Yield the angles between planes along the shaft that are mirrored in the upright centre line."""
    askew = [p for p in seen.planes if abs(p.direction.dot(Z)) < _CLEAR and not p.holds(Z)]
    lines = [(p, *end.frame.flat(p.direction), p.point.dot(p.direction)) for p in askew]
    right = [one for one in lines if one[1] * one[3] > 0 and min(abs(one[1]), abs(one[2])) > _CLEAR]
    for plane, across, up, away in right:
        lean, at = up / across, away / across  # x = at - lean y
        for other, u, v, d in lines:
            if abs(u) > _CLEAR and abs(d / u + at) < _ARC and abs(v / u + lean) < _CLEAR:
                x, y = _middle(end, at, lean)
                points = (0.0, at / lean), (x, y), (-x, y)
                angle = 2 * degrees(atan2(abs(lean), 1.0))
                yield Measure("angle", angle, "end", "angle", points, 1, on(plane), on(other))


def _middle(end: View, at: float, lean: float) -> Point:
    """Return the middle of the longest visible line x = at - lean y."""
    runs = [
        [y for x, y in curve.points if abs(x + lean * y - at) < 1e-4 and x * at > 0] for curve in end.visible
    ]
    run = max(runs, key=lambda ys: max(ys) - min(ys) if ys else 0.0, default=[])
    y = (min(run) + max(run)) / 2 if run else 0.0
    return at - lean * y, y


def _leg(plane: Surface, end: View) -> Point | None:
    """Return the point farthest from the shaft on visible lines that lie in a plane."""
    normal = end.frame.flat(plane.direction)
    on = [p for curve in end.visible for p in curve.points if abs(p[0] * normal[0] + p[1] * normal[1]) < 1e-4]
    return max(on, key=lambda p: hypot(*p), default=None)
