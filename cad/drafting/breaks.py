"""Broken-out sections (ISO 128-3): cut a view open down to the axis of a hole that no section shows.

Of several equal holes, the one farthest to the right in the view is opened, together with coaxial ones. The
removed material is a box, whose sides are drawn as thin lines with zigzags (ISO 128-2, 01.1.19).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cadquery import BoundBox, Compound, Face, Location, Plane, Shape, Solid, Vector

from cad.drafting.curves import Curve, Point, Polyline
from cad.surfaces import Surface, look

_CLEAR = 1e-5  # [mm]
_ON = 1e-4  # [mm]: how near to a side a line lies that is drawn there
_SHARES = (0.6, 0.5, 0.4, 0.3, 0.2)  # of a hole's diameter, from its wall to the side of the box
_MORE = 0.15  # of the diameter, by which the material reaches beyond a side
_SAMPLES = 7  # points of a side that are to lie in the material
_MOST = 3  # in a view


@dataclass(frozen=True)
class Break:
    """A rectangle in a view, by two corners; the material in front of the plane at `depth` is removed."""

    low: Point
    high: Point
    depth: float

    def solid(self, plane: Plane, reach: float) -> Solid:
        """Return the removed box as a solid."""
        corner = plane.toWorldCoords((*self.low, self.depth))
        placed = Location(Plane(corner, plane.xDir, plane.zDir))
        return Solid.makeBox(self.high[0] - self.low[0], self.high[1] - self.low[1], reach).moved(placed)

    def faces(self, plane: Plane, shape: Shape) -> list[Face]:
        """Return the faces of a shape that the bottom of the box exposes."""
        (x, y), (u, v) = self.low, self.high
        middle = plane.toWorldCoords(((x + u) / 2, (y + v) / 2, self.depth))
        bottom = Face.makePlane(v - y, u - x, Vector(), Vector(0, 0, 1))  # length is along y
        placed = bottom.moved(Location(Plane(middle, plane.xDir, plane.zDir)))
        return list(placed.intersect(shape).Faces())

    def holds(self, curve: Curve) -> bool:
        """Return whether a curve lies within the rectangle: the lines that a section hides are not drawn."""
        (x, y), (u, v) = self.low, self.high
        return all(x - _ON < a < u + _ON and y - _ON < b < v + _ON for a, b in curve.points)

    def bounds(self, curve: Curve) -> bool:
        """Return whether a curve lies on one side of the rectangle."""
        (x, y), (u, v) = self.low, self.high
        for along, side, ends in ((0, x, (y, v)), (0, u, (y, v)), (1, y, (x, u)), (1, v, (x, u))):
            if all(
                abs(point[along] - side) < _ON and ends[0] - _ON < point[1 - along] < ends[1] + _ON
                for point in curve.points
            ):
                return True
        return False


def breaks(shapes: Sequence[Shape], plane: Plane, shown: Sequence[float]) -> list[Break]:
    """Return the broken-out sections of a view; holes with a diameter in `shown` need none."""
    holes: dict[tuple[float, ...], list[tuple[Point, Point, Surface, float]]] = {}
    for hole in (c for shape in shapes for c in look(shape).cylinders if _is_across(c, plane)):
        if any(abs(hole.diameter - diameter) < _ON for diameter in shown):
            continue
        low, high = _ends(hole, plane)
        if _is_hollow(hole, shapes):
            turn = round(abs(high[0] - low[0]) / max(abs(high[1] - low[1]), _ON), 3)
            depth = hole.point.dot(plane.zDir)
            holes.setdefault((round(hole.diameter, 4), turn), []).append((low, high, hole, depth))
    if not holes:
        return []
    box = _box(shapes, plane)
    lines = list[list[tuple[Point, Point, Surface, float]]]()
    for group in holes.values():
        chosen = max(group, key=lambda one: (round(one[0][0] + one[1][0], 3), one[0][1] + one[1][1]))
        joined = [one for one in group if _are_in_line(one, chosen)]
        if coaxial := next((line for line in lines if _are_in_line(line[0], chosen)), None):
            coaxial += joined  # a hole with its counterbore, or narrower in the next part
        else:
            lines.append(joined)
    found = []
    for line in lines:
        corners = [point for low, high, *_ in line for point in (low, high)]
        widest = max(hole.diameter for *_, hole, _ in line)
        found.append(_region(corners, widest, line[0][3], shapes, plane, box))
    return found[:_MOST]


def _is_across(cylinder: Surface, plane: Plane) -> bool:
    """Return whether the axis of a cylinder is horizontal or vertical in the view."""
    along = (abs(cylinder.direction.dot(axis)) for axis in (plane.xDir, plane.yDir))
    return max(along) > 1 - 1e-9


def _ends(cylinder: Surface, plane: Plane) -> tuple[Point, Point]:
    foot = cylinder.point - cylinder.direction * cylinder.point.dot(cylinder.direction)
    ends = (foot + cylinder.direction * reach for reach in cylinder.reach)
    low, high = sorted((end.dot(plane.xDir), end.dot(plane.yDir)) for end in ends)
    return low, high


def _is_hollow(hole: Surface, shapes: Sequence[Shape]) -> bool:
    """Return whether a cylinder is a hole: its middle is empty and there is material all around it."""
    foot = hole.point - hole.direction * hole.point.dot(hole.direction)
    middle = foot + hole.direction * (sum(hole.reach) / 2)
    across = hole.direction.cross(
        Vector(0, 0, 1) if abs(hole.direction.z) < 0.9 else Vector(1, 0, 0)
    ).normalized()
    other = hole.direction.cross(across)
    around = [middle + side * (hole.diameter * 0.5 + 1e-3) for side in (across, other, -across, -other)]
    return not _is_in(middle, shapes) and all(_is_in(point, shapes) for point in around)


def _is_in(point: Vector, shapes: Sequence[Shape]) -> bool:
    return any(solid.isInside(point, 1e-6) for shape in shapes for solid in shape.Solids())


def _are_in_line(
    one: tuple[Point, Point, Surface, float], other: tuple[Point, Point, Surface, float]
) -> bool:
    apart = one[2].point - other[2].point
    return bool(apart.cross(other[2].direction).Length < _ON)


def _region(
    corners: Sequence[Point],
    size: float,
    depth: float,
    shapes: Sequence[Shape],
    plane: Plane,
    box: tuple[Point, Point],
) -> Break:
    """Return the box around a hole.

    Each side lies in the material if possible. A side that would lie near the edge of the part moves beyond
    it.
    """
    low = [min(point[n] for point in corners) for n in (0, 1)]
    high = [max(point[n] for point in corners) for n in (0, 1)]
    along = 0 if high[0] - low[0] > high[1] - low[1] else 1
    low[1 - along] -= size / 2
    high[1 - along] += size / 2
    sides: dict[tuple[int, int], float] = {}
    for axis in (0, 1):
        for out, start in ((-1, low[axis]), (1, high[axis])):
            edge = box[out > 0][axis]
            reach = low[1 - axis], high[1 - axis]
            places = [start + out * share * size for share in _SHARES]
            in_part = (
                place
                for place in places
                if _is_within(place, axis, reach, depth, shapes, plane)
                and _is_within(place + out * size * _MORE, axis, reach, depth, shapes, plane)
            )
            place = next(in_part, places[-1])
            gone = (at for at in reversed(places) if not any(_held(at, axis, reach, depth, shapes, plane)))
            if (beyond := next(gone, None)) is not None:
                sides[axis, out] = beyond  # no line is drawn where nothing is left
                continue
            is_near = (edge - place) * out < size / 2
            sides[axis, out] = edge + out * size if is_near else place
    return Break((sides[0, -1], sides[1, -1]), (sides[0, 1], sides[1, 1]), depth)


def _is_within(
    place: float, axis: int, reach: tuple[float, float], depth: float, shapes: Sequence[Shape], plane: Plane
) -> bool:
    """Return whether sample points along a side of the box are all inside the material."""
    return all(_held(place, axis, reach, depth, shapes, plane))


def _held(
    place: float, axis: int, reach: tuple[float, float], depth: float, shapes: Sequence[Shape], plane: Plane
) -> Iterator[bool]:
    """Yield whether each sample point along a side of the box is inside the material."""
    for number in range(_SAMPLES):
        across = reach[0] + (reach[1] - reach[0]) * (number + 0.5) / _SAMPLES
        point = (place, across) if axis == 0 else (across, place)
        yield _is_in(plane.toWorldCoords((*point, depth)), shapes)


def _box(shapes: Sequence[Shape], plane: Plane) -> tuple[Point, Point]:
    """Return the bounding box of the shapes in the coordinates of the view."""
    flat = Compound.makeCompound([shape.moved(Location(plane).inverse) for shape in shapes])
    box = BoundBox._fromTopoDS(flat.wrapped)
    return (box.xmin, box.ymin), (box.xmax, box.ymax)


def opened(shape: Shape, cuts: Sequence[Break], plane: Plane, reach: float) -> Shape:
    """Return a shape without the material that the broken-out sections remove."""
    for cut in cuts:
        shape = shape.cut(cut.solid(plane, reach))
    return shape


def zigzag(line: Polyline, scale: float) -> Polyline:
    """Return a straight line with a zigzag for each 60 mm on paper, at least one if longer than 8 mm."""
    (x, y), (u, v) = line[0], line[-1]
    size = ((u - x) ** 2 + (v - y) ** 2) ** 0.5
    count = int(size * scale // 60) or int(size * scale > 8)
    a, b = (u - x) / size, (v - y) / size
    points: Polyline = [(x, y)]
    for middle in _middles(count, size):
        for ahead, aside in ((-1.5, 0.0), (-0.75, 1.5), (0.75, -1.5), (1.5, 0.0)):
            t, s = middle + ahead / scale, aside / scale
            points.append((x + a * t - b * s, y + b * t + a * s))
    return [*points, (u, v)]


def _middles(count: int, size: float) -> Iterator[float]:
    return (size * (number + 0.5) / count for number in range(count))
