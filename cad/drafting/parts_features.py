"""The features that a sheet must dimension: levels, radii, axes and directions of the faces of its parts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import atan2, cos, degrees, hypot, isclose, pi, tan
from typing import Literal

from cadquery import Vector

from cad.drafting.curves import Point
from cad.drafting.section import Frame
from cad.surfaces import Face, Surface, Z

_CLEAR = 1e-4  # [mm]
_FLAT = 1e-6  # as the sine of an angle

Words = dict[float, str]
BarCut = tuple[float, frozenset[Face]]
"""The height of a section across a bar, and the planes that it cuts where the bar tapers."""

Sort = Literal["diameter", "radius", "chamfer", "angle", "width"]
"""Sizes that a feature has of itself: a hole its diameter, a fillet its radius, a slope its angle, a slot
and a bar with round ends their width."""


@dataclass(frozen=True)
class Hole:
    """The axis of a hole, pin or round end that is parallel to the shaft, as a point in the end view."""

    axis: Point
    diameter: float
    words: str

    @property
    def turn(self) -> float:
        """Return the direction from the shaft to the axis [deg]."""
        return degrees(atan2(self.axis[1], self.axis[0]))

    def is_like(self, other: Hole) -> bool:
        """Return whether another hole has the same diameter and the same distance from the shaft."""
        away = abs(hypot(*self.axis) - hypot(*other.axis))
        return away < _CLEAR and abs(self.diameter - other.diameter) < _CLEAR


@dataclass
class Features:
    """Positions of faces by direction, with descriptions; sizes of features; axes parallel to the shaft.

    Attributes
    ----------
    rays
        Directions of planes that are oblique to the centre lines of the end view [deg].
    round_at
        Positions along the shaft at which radii occur that belong to no cylinder.
    centres
        Positions along the shaft at which the section has a centre line.
    bars
        By the height of a section across a tapered bar, how far the bar reaches to the right there.
    """

    along: Words = field(default_factory=dict)
    across: Words = field(default_factory=dict)
    up: Words = field(default_factory=dict)
    round: Words = field(default_factory=dict)
    rays: Words = field(default_factory=dict)
    own: dict[tuple[Sort, float], str] = field(default_factory=dict)
    holes: list[Hole] = field(default_factory=list)
    centres: list[float] = field(default_factory=list)
    round_at: dict[float, float] = field(default_factory=dict)
    bars: dict[float, float] = field(default_factory=dict)

    @staticmethod
    def of(surfaces: Sequence[Surface], frame: Frame, cuts: Sequence[BarCut] = ()) -> Features:
        """Return the features of placed surfaces; `frame` is that of the end view."""
        return _Reader(surfaces, frame, cuts).read()


class _Reader:
    """Reads features from surfaces."""

    def __init__(self, surfaces: Sequence[Surface], frame: Frame, cuts: Sequence[BarCut]) -> None:
        self.frame, self.found, self.cuts = frame, Features(), cuts
        self.planes = [s for s in surfaces if s.form == "plane"]
        self.cylinders = [s.turned(Z) for s in surfaces if s.form == "cylinder"]
        self.cones = [s.turned(Z) for s in surfaces if s.form == "cone"]
        self.tori = [s for s in surfaces if s.form == "torus"]
        self.spheres = [s for s in surfaces if s.form == "sphere"]
        self.levels = sorted({round(p.point.z, 6) for p in self.planes if p.along(Z)})
        self.fillets = [c for c in self.cylinders if self._is_fillet(c)]

    def read(self) -> Features:
        for plane in self.planes:
            self._plane(plane)
        for cylinder in self.cylinders:
            self._cylinder(cylinder)
        for cone in self.cones:
            self._cone(cone)
        for torus in self.tori:
            self._torus(torus)
        for ball in self.spheres:
            self.found.own["diameter", ball.diameter] = f"Ø of {_name(ball)}"
        self._drilling()
        self._centres()
        return self.found

    def _plane(self, plane: Surface) -> None:
        normal, words = plane.direction, f"a plane of {_name(plane)}"
        if plane.along(Z):
            self.found.along[plane.point.z] = f"{words} at z = {plane.point.z:.6g} mm"
            return
        right, up = self.frame.flat(normal)
        if abs(normal.dot(Z)) > _FLAT:
            self._slope(plane)
        elif abs(up) < _FLAT:
            at = plane.point.dot(normal) * right
            self.found.across[at] = f"{words} across at {at:.6g} mm"
        elif abs(right) < _FLAT:
            at = plane.point.dot(normal) * up
            self.found.up[at] = f"{words} upright at {at:.6g} mm"
        else:
            self._askew(plane, words)

    def _askew(self, plane: Surface, words: str) -> None:
        """Record a plane parallel to the shaft that is oblique to both centre lines."""
        if self._is_tangent(plane) or self._tapers(plane, words):
            return
        away = plane.point.dot(plane.direction)
        if self._is_of_hexagon(plane):
            self.found.own["width", 2 * abs(away)] = f"width across flats of {_name(plane)}"
            return
        x, y = self.frame.flat(plane.middle) if plane.middle is not None else (0.0, 0.0)
        u, v = self.frame.flat(plane.direction)
        foot = x - away * u, y - away * v  # on the line through the shaft beside which the plane runs
        turn = degrees(atan2(foot[1], foot[0])) if hypot(*foot) > _CLEAR else degrees(atan2(-u, v))
        self.found.rays[round(turn % 360, 4)] = f"{words} at {turn % 360:.6g}°"
        if abs(away) > _CLEAR:
            self.found.own["width", 2 * abs(away)] = f"width between planes of {_name(plane)}"

    def _is_of_hexagon(self, plane: Surface) -> bool:
        """Return whether a plane is a flat of a regular hexagon about the axis, which its width defines."""
        away = plane.point.dot(plane.direction)
        flats = [p for p in self.planes if p.face[0] == plane.face[0] and abs(p.direction.dot(Z)) < _FLAT]
        alike = (p for p in flats if abs(abs(p.point.dot(p.direction)) - abs(away)) < _CLEAR)
        turns = {round(degrees(atan2(p.direction.y, p.direction.x)) % 60, 3) % 60 for p in alike}
        return len(flats) == 6 and len(turns) == 1

    def _tapers(self, plane: Surface, words: str) -> bool:
        """Return whether sections across a bar cut a plane; record taper and place in each section."""
        across, up = self.frame.flat(plane.direction)
        heights = [height for height, faces in self.cuts if plane.face in faces]
        for height in heights:
            at = (plane.point.dot(plane.direction) - up * height) / across
            self.found.across[at] = f"{words} at {at:.6g} mm, {height:.6g} mm high"
            self.found.bars[height] = max(at, self.found.bars.get(height, at))
            self.found.up[height] = f"the section of {_name(plane)} at {height:.6g} mm"
            taper = 2 * degrees(atan2(abs(up), abs(across)))
            self.found.own["angle", taper] = f"taper of {_name(plane)}"
        return bool(heights)

    def _is_tangent(self, plane: Surface) -> bool:
        """Return whether a plane is located by round ends that it touches.

        It touches two round ends of a bar, or one end along a radius from the shaft.
        """
        touched: list[Vector] = []
        for end in (c for c in self.cylinders if c.along(Z) and not c.about(Z) and c not in self.fillets):
            away = (end.point - plane.point).dot(plane.direction)
            if abs(abs(away) - end.diameter / 2) < _CLEAR:
                foot = end.point - Z * end.point.z
                if abs(foot.dot(plane.direction)) < _CLEAR or any(
                    (foot - o).Length > _CLEAR for o in touched
                ):
                    return True
                touched.append(foot)
        return False

    def _slope(self, plane: Surface) -> None:
        """Record the angle of an inclined plane, and its distance from the shaft where it begins."""
        if any(_touch(cone, plane) for cone in self.cones):
            return  # a chamfer that goes straight on
        normal = plane.direction
        flat = hypot(normal.x, normal.y)
        self.found.own["angle", degrees(atan2(flat, abs(normal.z)))] = f"slope of {_name(plane)}"
        if plane.middle is None:
            return
        out = Vector(normal.x, normal.y, 0).normalized()
        reach = plane.middle.dot(out)
        out, reach = (out, reach) if reach > 0 else (-out, -reach)
        fall = -normal.dot(out) / normal.z  # of the plane along the shaft, for each millimetre outwards
        middle = plane.middle.z
        before = [z for z in self.levels if (z - middle) * fall < 0]
        if before:
            level = min(before, key=lambda z: abs(z - middle))
            start = reach + (level - middle) / fall
            self.found.round[start] = f"the start of a slope at {start:.6g} mm"
            self.found.round_at[start] = level

    def _cylinder(self, cylinder: Surface) -> None:
        name, radius = _name(cylinder), cylinder.diameter / 2
        if cylinder.about(Z):
            self.found.round[radius] = f"Ø{cylinder.diameter:.6g} of {name}"
            return
        if self._is_relief(cylinder):
            return
        if cylinder in self.fillets:
            self.found.own["radius", radius] = f"R{radius:.6g} of {name}"
            return
        sort: Sort = "width" if self._is_round_end(cylinder) else "diameter"
        self.found.own[sort, cylinder.diameter] = f"Ø{cylinder.diameter:.6g} of {name}"
        if cylinder.along(Z):
            x, y = self.frame.flat(cylinder.point)
            self.found.holes.append(
                Hole((x, y), cylinder.diameter, f"an axis of {name} at {x:.6g}, {y:.6g} mm")
            )
        elif abs(cylinder.direction.dot(Z)) < _FLAT:
            self._cross_hole(cylinder, name)

    def _is_fillet(self, cylinder: Surface) -> bool:
        """Return whether a cylinder along the shaft touches two faces, as a rounded edge does."""
        if not cylinder.along(Z) or cylinder.about(Z):
            return False
        coaxial = (c for c in self.cylinders if _are_in_line(c, cylinder))
        if any(abs(c.diameter - cylinder.diameter) > _CLEAR for c in coaxial):
            return False
        planes = [p for p in self.planes if abs(p.direction.dot(Z)) < _FLAT and _touches(cylinder, p)]
        rounds = [c for c in self.cylinders if c.along(Z) and _touches_round(cylinder, c)]
        are_parallel = not rounds and all(p.along(planes[0].direction) for p in planes)
        return len(planes) + len(rounds) > 1 and not are_parallel

    def _is_round_end(self, cylinder: Surface) -> bool:
        """Return whether planes touch a cylinder on two sides and no larger cylinder is coaxial."""
        larger = (c for c in self.cylinders if c.diameter > cylinder.diameter + _CLEAR)
        if any(_are_in_line(c, cylinder) for c in larger):
            return False
        beside = [p for p in self.planes if cylinder.along(Z) and abs(p.direction.dot(Z)) < _FLAT]
        away = [(cylinder.point - p.point).dot(p.direction) for p in beside if p.face[0] == cylinder.face[0]]
        return sum(abs(abs(one) - cylinder.diameter / 2) < _CLEAR for one in away) > 1

    def _cross_hole(self, hole: Surface, name: str) -> None:
        right, up = self.frame.flat(hole.direction)
        x, y = self.frame.flat(hole.point)
        self.found.along[hole.point.z] = f"the axis of a hole of {name} at z = {hole.point.z:.6g} mm"
        self.found.centres.append(hole.point.z)
        if abs(right) < _FLAT:
            self.found.across[x] = f"the axis of a hole of {name} at {x:.6g} mm"
        elif abs(up) < _FLAT:
            self.found.up[y] = f"the axis of a hole of {name} at {y:.6g} mm"

    def _is_relief(self, cylinder: Surface) -> bool:
        """Return whether a cylinder relieves a bore beside its joint; if so, record its height and depth."""
        x, y = self.frame.flat(cylinder.point)
        bores = [c for c in self.cylinders if c.about(Z)]
        if not cylinder.along(Z) or not bores:
            return False
        bore = min(bores, key=lambda c: c.diameter)
        deep = hypot(x, y) + cylinder.diameter / 2 - bore.diameter / 2
        is_wide = hypot(x, y) < cylinder.diameter / 2 < bore.diameter / 2 + _CLEAR
        if not is_wide or deep < _CLEAR:
            return False
        edge = relief_height(hypot(x, y), cylinder.diameter / 2, bore.diameter / 2)
        along, at = (self.found.up, edge) if abs(x) > abs(y) else (self.found.across, edge)
        self.found.round[bore.diameter / 2 + deep] = f"the depth of the relief of {_name(cylinder)}"
        along[at] = f"the height of the relief of {_name(cylinder)}"
        return True

    def _cone(self, cone: Surface) -> None:
        low, high = cone.reach
        self.found.own["chamfer", high - low] = f"chamfer of {high - low:.4g} mm of {_name(cone)}"
        if not isclose(cone.half_angle, pi / 4, rel_tol=1e-6):
            self.found.own["angle", degrees(cone.half_angle)] = f"angle of a cone of {_name(cone)}"

    def _torus(self, torus: Surface) -> None:
        tube = torus.diameter / 2
        self.found.own["radius", tube] = f"R{tube:.6g} of {_name(torus)}"
        beside = [
            c
            for c in self.cylinders
            if c.along(Z) and c.point.cross(Z).sub(torus.point.cross(Z)).Length < _CLEAR
        ]
        touches_wall = any(abs(abs(c.diameter / 2 - torus.about_radius) - tube) < _CLEAR for c in beside)
        touches_end = any(abs(abs(z - torus.point.z) - tube) < _CLEAR for z in self.levels)
        if not (touches_wall and touches_end):
            self.found.along[torus.point.z] = f"the middle of a groove of {_name(torus)}"
            root = torus.about_radius - tube if self._is_below(torus) else torus.about_radius + tube
            self.found.round[root] = f"the root of a groove of {_name(torus)}"
            self.found.round_at[root] = torus.point.z

    def _is_below(self, torus: Surface) -> bool:
        """Return whether a round groove opens outwards, so that the nearest cylinder is below its centre."""
        radii = [c.diameter / 2 for c in self.cylinders if c.about(Z) and c.face[0] == torus.face[0]]
        return (
            min((abs(r - torus.about_radius), r) for r in radii)[1] < torus.about_radius if radii else False
        )

    def _drilling(self) -> None:
        """Record the ends of the axis of one oblique hole; the other holes are equal to it."""
        slanted = [c for c in self.cylinders if not c.along(Z) and abs(c.direction.dot(Z)) > _FLAT]
        upright = self.frame.right
        within = [c for c in slanted if abs(c.point.dot(upright)) + abs(c.direction.dot(upright)) < _CLEAR]
        for hole in (within or slanted)[:1]:
            one_line = [c.turned(hole.direction) for c in slanted if _are_in_line(c, hole)]
            reaches = min(c.reach[0] for c in one_line), max(c.reach[1] for c in one_line)
            crossings = sorted(self._crossings(hole))
            for reach in reaches if crossings else ():
                place = min(crossings, key=lambda at: abs(at - reach))
                foot = hole.point + hole.direction * (place - hole.point.dot(hole.direction))
                self.found.along[foot.z] = (
                    f"the mouth of the drilling of {_name(hole)} at z = {foot.z:.6g} mm"
                )

    def _crossings(self, hole: Surface) -> Iterator[float]:
        """Yield the coordinates along the axis of a hole at which it crosses cylinders along the shaft."""
        for other in (c for c in self.cylinders if c.along(Z)):
            start, way = hole.point - other.point, hole.direction
            a, b = way.x**2 + way.y**2, start.x * way.x + start.y * way.y
            c = start.x**2 + start.y**2 - other.diameter**2 / 4
            if (root := b * b - a * c) > 0:
                for side in (1, -1):
                    t = (-b + side * root**0.5) / a
                    if other.reach[0] < (hole.point + way * t).z < other.reach[1]:
                        yield (hole.point + way * t).dot(way)

    def _centres(self) -> None:
        """Record a centre line in the middle of the part if pairs of planes are symmetric about it."""
        pairs = [
            z for z in self.levels if z > _CLEAR and any(abs(z + other) < _CLEAR for other in self.levels)
        ]
        is_outermost = self.levels and abs(self.levels[0] + self.levels[-1]) < _CLEAR
        if is_outermost and len(pairs) > 1:
            self.found.centres.append(0.0)


def _are_in_line(one: Surface, other: Surface) -> bool:
    """Return whether two cylinders are coaxial."""
    return one.along(other.direction) and (one.point - other.point).cross(other.direction).Length < _CLEAR


def _touches(cylinder: Surface, plane: Surface) -> bool:
    """Return whether a plane of the same part touches a cylinder along it."""
    away = abs((cylinder.point - plane.point).dot(plane.direction))
    return plane.face[0] == cylinder.face[0] and abs(away - cylinder.diameter / 2) < _CLEAR


def _touches_round(one: Surface, other: Surface) -> bool:
    """Return whether a parallel cylinder of the same part touches another from outside or inside."""
    apart = (one.point - other.point).cross(one.direction).Length
    radii = one.diameter / 2, other.diameter / 2
    is_near = abs(apart - sum(radii)) < _CLEAR or abs(apart - abs(radii[0] - radii[1])) < _CLEAR < apart
    return one.face[0] == other.face[0] and is_near


def _touch(cone: Surface, plane: Surface) -> bool:
    """Return whether a plane is tangent to a cone about the shaft."""
    lean = hypot(plane.direction.x, plane.direction.y)
    if not cone.about(Z) or abs(lean - cos(cone.half_angle)) > _FLAT:
        return False
    far = cone.diameter / 2 / tan(cone.half_angle)
    tips = (Vector(0, 0, sum(cone.reach) / 2 + side * far) for side in (1, -1))
    return any(abs((tip - plane.point).dot(plane.direction)) < _CLEAR for tip in tips)


def relief_height(axis: float, radius: float, bore: float) -> float:
    """Return the height above the joint at which the circle of a relief meets the bore [mm].

    Parameters
    ----------
    axis
        Distance of the centre of the relief from the shaft [mm].
    radius
        Radius of the relief [mm].
    bore
        Radius of the bore [mm].
    """
    along = (bore**2 - radius**2 + axis**2) / (2 * axis)
    return float(max(bore**2 - along**2, 0.0) ** 0.5)


def _name(surface: Surface) -> str:
    return surface.face[0].replace("_", " ") or "the part"
