"""Surfaces of a finished solid (planes, cylinders, spheres, tori, cones), from which dimensions are read.

A dimension read from faces is a `Size`: a number with references to its faces. The STEP file states a
tolerance on these faces, and a drawing uses them to place the dimension.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import cos, sin
from typing import Any, Literal, Self

from cadquery import Face as Face3d
from cadquery import Shape, Vector
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_SurfaceType as _Kind
from OCP.TopAbs import TopAbs_Orientation

from cad.on_demand import constant
from templates.core.arrays import Array

X = constant(lambda: Vector(1, 0, 0))
Y = constant(lambda: Vector(0, 1, 0))
Z = constant(lambda: Vector(0, 0, 1))
AXES = constant(lambda: {"x": Vector(1, 0, 0), "y": Vector(0, 1, 0), "z": Vector(0, 0, 1)})
"""The directions by letter; while the kernel is postponed, a placeholder that loading the kernel replaces."""

_COINCIDENT = 1e-6  # [mm], also used as the sine of an angle: ten times the kernel's own precision


Face = tuple[str, int]
"""The name of a part, and the number of one of its faces in the order of the solid."""
Form = Literal["plane", "cylinder", "sphere", "torus", "cone"]
Kind = Literal["diameter", "sphere", "radius", "distance", "circle", "chamfer", "angle", "edge"]
"""Kind of a size. The faces of a `distance` from an axis lie around that axis; a `circle` is the pitch
circle through the axes of its first faces, which are holes, about the axis of its second ones; a `chamfer`
has 45°; an `edge` is where its faces meet, dimensioned from the axis of the first ones."""


@dataclass(frozen=True)
class Place:
    """The faces of a size; a distance or an angle has faces on two sides."""

    first: tuple[Face, ...]
    second: tuple[Face, ...] = ()


class Size(float):
    """A length [mm] or an angle [deg] read from faces, which can be used as a number.

    A repeated length, such as the length of all pins of a shaft, has a place for each repetition.
    """

    kind: Kind
    places: tuple[Place, ...]

    def __new__(cls, value: float, kind: Kind, *places: Place) -> Self:
        """Return a number that refers to the faces from which it was read."""
        size = super().__new__(cls, value)
        size.kind, size.places = kind, places
        return size

    @staticmethod
    def diameter(surfaces: Sequence[Surface]) -> Size:
        """Return the common diameter of cylinders."""
        value = alike((one.diameter for one in surfaces), "diameters")
        return Size(value, "diameter", Place(faces_of(surfaces)))

    @staticmethod
    def sphere(surfaces: Sequence[Surface]) -> Size:
        """Return the common diameter of spheres."""
        value = alike((one.diameter for one in surfaces), "balls")
        return Size(value, "sphere", Place(faces_of(surfaces)))

    @staticmethod
    def radius(surfaces: Sequence[Surface]) -> Size:
        """Return the common radius of cylinders, or of the tubes of tori."""
        value = alike((one.diameter / 2 for one in surfaces), "radii")
        return Size(value, "radius", Place(faces_of(surfaces)))

    @staticmethod
    def distance(value: float, first: Iterable[Surface], second: Iterable[Surface]) -> Size:
        """Return a distance [mm] between two groups of faces."""
        return Size(value, "distance", Place(faces_of(first), faces_of(second)))

    @staticmethod
    def wall(inner: Sequence[Surface], outer: Sequence[Surface]) -> Size:
        """Return the wall thickness between cylinders about one axis."""
        return Size.distance((outer[0].diameter - inner[0].diameter) / 2, inner, outer)

    @staticmethod
    def circle(holes: Sequence[Surface], about: Sequence[Surface]) -> Size:
        """Return the diameter of the pitch circle of holes along z, about z, the axis of other surfaces."""
        value = alike((2 * one.point.cross(Z).Length for one in holes), "distances of holes from the axis")
        return Size(value, "circle", Place(faces_of(holes), faces_of(about)))

    @staticmethod
    def repeated(sizes: Iterable[float], what: str) -> float:
        """Return the common value of equal sizes, with the faces of all of them.

        Raises
        ------
        LookupError
            If there are no sizes, or they differ.
        """
        every = list(sizes)
        value = alike(every, what)
        known = [one for one in every if isinstance(one, Size)]
        if not known:
            return value
        places = dict.fromkeys(place for one in known for place in one.places)
        if known[0].kind != "distance":  # all faces of a diameter form one feature
            places = {Place(tuple(dict.fromkeys(face for place in places for face in place.first))): None}
        return Size(value, known[0].kind, *places)


def alike(values: Iterable[float], what: str) -> float:
    """Return the common value of a dimension that several features share.

    Raises
    ------
    LookupError
        If there are no features, or their values differ.
    """
    found = [float(value) for value in values]
    if not found or max(found) - min(found) > 2 * _COINCIDENT:
        raise LookupError(f"all {what} must have the same size; the file has {found}")
    return sum(found) / len(found)


def faces_of(surfaces: Iterable[Surface]) -> tuple[Face, ...]:
    """Return the faces of surfaces, each once."""
    return tuple(dict.fromkeys(one.face for one in surfaces))


@dataclass(frozen=True)
class Surface:
    """A plane, cylinder, sphere, torus or cone with its position, its normal or axis, and its diameter.

    Attributes
    ----------
    point, direction
        A point of the plane and its normal; of other surfaces a point of the axis and its direction. The
        point of a sphere or torus is its centre.
    diameter
        Of a cylinder or sphere; of a torus that of its tube, of a cone the mean one of its ends [mm].
    reach
        Of a cylinder or cone: where along its axis it begins and ends [mm].
    about_radius
        Of a torus: the radius of the circle on which the middle of its tube runs [mm].
    half_angle
        Of a cone: between its axis and its side [rad].
    face
        The part and the number of its face.
    middle
        Of a plane: the centre of area of its face.
    is_reversed
        Whether the material is outside a cylinder, or on the side of a plane to which its normal points.
    form
        What it is.
    """

    point: Vector
    direction: Vector
    diameter: float = 0.0
    reach: tuple[float, float] = (0.0, 0.0)
    about_radius: float = 0.0
    half_angle: float = field(default=0.0, compare=False)
    face: Face = field(default=("", -1), compare=False)
    middle: Vector | None = field(default=None, compare=False)
    form: Form = field(default="plane", compare=False)
    is_reversed: bool = field(default=False, compare=False)

    def along(self, axis: Vector) -> bool:
        """Return whether the surface's direction is parallel to the axis."""
        return bool(self.direction.cross(axis).Length < _COINCIDENT)

    def moved(self, turn: Array, shift: Array) -> Surface:
        """Return the surface after its part was turned (3, 3) and then shifted (3,) [mm]."""
        point = Vector(*(turn @ self.point.toTuple() + shift))
        middle = None if self.middle is None else Vector(*(turn @ self.middle.toTuple() + shift))
        direction = Vector(*(turn @ self.direction.toTuple()))
        along = point.dot(direction) - self.point.dot(self.direction)
        low, high = self.reach
        reach = (low + along, high + along) if self.reach != (0.0, 0.0) else self.reach
        return replace(self, point=point, direction=direction, reach=reach, middle=middle)

    def about(self, axis: Vector) -> bool:
        """Return whether the surface is coaxial with that axis through the origin."""
        turns, through = self.direction.cross(axis), self.point.cross(axis)
        return bool(turns.Length < _COINCIDENT and through.Length < _COINCIDENT)

    def holds(self, axis: Vector) -> bool:
        """Return whether the plane contains that axis through the origin."""
        flat, upright = self.point.dot(self.direction), self.direction.dot(axis)
        return bool(abs(flat) < _COINCIDENT and abs(upright) < _COINCIDENT)

    def turned(self, axis: Vector) -> Surface:
        """Return the same surface with its direction reversed if it points against the axis."""
        if self.direction.dot(axis) >= 0:
            return self
        low, high = self.reach
        flips = self.form == "plane"
        return replace(
            self, direction=-self.direction, reach=(-high, -low), is_reversed=self.is_reversed != flips
        )


@dataclass(frozen=True)
class PartSurfaces:
    """The surfaces of one part in its own coordinates, and the number of its copies."""

    count: int
    planes: tuple[Surface, ...]
    cylinders: tuple[Surface, ...]
    spheres: tuple[Surface, ...]
    tori: tuple[Surface, ...] = ()
    cones: tuple[Surface, ...] = ()

    @property
    def surfaces(self) -> tuple[Surface, ...]:
        """Return every surface of the part."""
        return (*self.planes, *self.cylinders, *self.spheres, *self.tori, *self.cones)

    def moved(self, turn: Array, shift: Array) -> PartSurfaces:
        """Return the surfaces after the part was turned (3, 3) and then shifted (3,) [mm]."""
        kinds = (self.planes, self.cylinders, self.spheres, self.tori, self.cones)
        return PartSurfaces(self.count, *(tuple(one.moved(turn, shift) for one in kind) for kind in kinds))

    def levels(self, axis: Vector) -> list[float]:
        """Return the coordinates along an axis of the planes perpendicular to it [mm], ascending."""
        return _distinct(plane.point.dot(axis) for plane in self.planes if plane.along(axis))

    def planes_at(self, axis: Vector, level: float) -> list[Surface]:
        """Return the planes perpendicular to the axis at a coordinate [mm]."""
        across = (plane for plane in self.planes if plane.along(axis))
        return [plane for plane in across if abs(plane.point.dot(axis) - level) < _COINCIDENT]

    def between(self, axis: Vector, first: int, last: int) -> float:
        """Return the distance between two planes perpendicular to the axis, numbered from the lowest.

        The number -1 stands for the last plane.
        """
        levels = self.levels(axis)
        return self.apart(axis, levels[first], levels[last])

    def apart(self, axis: Vector, low: float, high: float, near: Vector | None = None) -> float:
        """Return the distance between the planes perpendicular to the axis at two coordinates [mm].

        The result has no faces if one of the planes is missing. With `near`, a point, only the nearest plane
        at each coordinate is used.
        """
        first, second = self.planes_at(axis, low), self.planes_at(axis, high)
        if near is not None:
            first, second = (sorted(some, key=lambda p: _distance(p, near))[:1] for some in (first, second))
        return Size.distance(high - low, first, second) if first and second else high - low

    def length(self, axis: Vector) -> float:
        """Return the distance from the first to the last plane perpendicular to the axis [mm]."""
        return self.between(axis, 0, -1)

    def chamfer(self, value: float, ring: Sequence[Surface]) -> float:
        """Return the size [mm] of a 45° chamfer at the ends of cylinders about z.

        The result has no faces if there is no cone of that size.
        """
        low, high = min(one.reach[0] for one in ring), max(one.reach[1] for one in ring)
        cones = [cone.turned(Z) for cone in self.cones if cone.about(Z)]
        beyond = [
            cone
            for cone in cones
            if abs(cone.diameter - ring[0].diameter) / 2 < value
            and any(
                abs(abs(cone.diameter - ring[0].diameter) / 2 - away) < _COINCIDENT
                for away in (sum(cone.reach) / 2 - high, low - sum(cone.reach) / 2)
            )
        ]
        return Size(value, "chamfer", Place(faces_of(beyond))) if beyond else value

    def about(self, axis: Vector) -> list[Surface]:
        """Return the cylinders about the axis, with their directions along it."""
        return [cylinder.turned(axis) for cylinder in self.cylinders if cylinder.about(axis)]

    def rings(self, axis: Vector) -> list[list[Surface]]:
        """Return the cylinders about the axis by their diameter, the smallest first."""
        about = self.about(axis)
        sizes = _distinct(cylinder.diameter for cylinder in about)
        return [[c for c in about if abs(c.diameter - size) < _COINCIDENT] for size in sizes]

    def diameters(self, axis: Vector) -> list[Size]:
        """Return the diameters of the cylinders about the axis [mm], ascending."""
        return [Size.diameter(ring) for ring in self.rings(axis)]


def look(solid: Shape, count: int = 1, part: str = "") -> PartSurfaces:
    """Return the surfaces of a solid that is called `part` and occurs `count` times."""
    of = defaultdict[Any, list[Surface]](list)
    for number, face in enumerate(solid.Faces()):
        adaptor = BRepAdaptor_Surface(face.wrapped)
        kind = adaptor.GetType()
        if read := _READERS.get(kind):
            middle = face.Center() if kind == _Kind.GeomAbs_Plane else None
            surface = replace(read(adaptor), face=(part, number), middle=middle)
            of[kind].append(replace(surface, is_reversed=_is_reversed(face, adaptor, kind)))
    return PartSurfaces(
        count,
        planes=tuple(of[_Kind.GeomAbs_Plane]),
        cylinders=tuple(of[_Kind.GeomAbs_Cylinder]),
        spheres=tuple(of[_Kind.GeomAbs_Sphere]),
        tori=tuple(of[_Kind.GeomAbs_Torus]),
        cones=tuple(of[_Kind.GeomAbs_Cone]),
    )


def _is_reversed(face: Face3d, adaptor: BRepAdaptor_Surface, kind: Any) -> bool:
    """Return whether the outward normal of a plane or cylindrical face is reversed; False for other faces."""
    if kind not in (_Kind.GeomAbs_Plane, _Kind.GeomAbs_Cylinder):
        return False
    surface = adaptor.Plane() if kind == _Kind.GeomAbs_Plane else adaptor.Cylinder()
    is_turned = face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    return bool(is_turned == surface.Position().Direct())


def _cylinder(adaptor: BRepAdaptor_Surface) -> Surface:
    cylinder = adaptor.Cylinder()
    surface = _surface(cylinder.Axis())
    start = surface.point.dot(surface.direction)
    reach = start + adaptor.FirstVParameter(), start + adaptor.LastVParameter()
    return replace(surface, form="cylinder", diameter=2 * cylinder.Radius(), reach=reach)


def _sphere(adaptor: BRepAdaptor_Surface) -> Surface:
    sphere = adaptor.Sphere()
    return Surface(Vector(sphere.Location()), Z, 2 * sphere.Radius(), form="sphere")


def _torus(adaptor: BRepAdaptor_Surface) -> Surface:
    torus = adaptor.Torus()
    tube, about = 2 * torus.MinorRadius(), torus.MajorRadius()
    return replace(_surface(torus.Axis()), form="torus", diameter=tube, about_radius=about)


def _cone(adaptor: BRepAdaptor_Surface) -> Surface:
    cone = adaptor.Cone()
    surface, angle = _surface(cone.Axis()), cone.SemiAngle()
    start = surface.point.dot(surface.direction)
    ends = adaptor.FirstVParameter(), adaptor.LastVParameter()
    low, high = sorted(start + v * cos(angle) for v in ends)
    mean = 2 * cone.RefRadius() + sum(ends) * sin(angle)
    return replace(surface, form="cone", diameter=mean, reach=(low, high), half_angle=abs(angle))


def _surface(axis: Any) -> Surface:
    return Surface(Vector(axis.Location()), Vector(axis.Direction()))


_READERS = constant(
    lambda: {
        _Kind.GeomAbs_Plane: lambda adaptor: _surface(adaptor.Plane().Axis()),
        _Kind.GeomAbs_Cylinder: _cylinder,
        _Kind.GeomAbs_Sphere: _sphere,
        _Kind.GeomAbs_Torus: _torus,
        _Kind.GeomAbs_Cone: _cone,
    }
)


def _distance(plane: Surface, point: Vector) -> float:
    """Return the distance of the centroid of a plane from a point [mm]."""
    return float((plane.middle - point).Length) if plane.middle is not None else 0.0


def _distinct(values: Iterable[float]) -> list[float]:
    """Return the values in ascending order, without repeating values that coincide."""
    ordered = sorted(values)
    return ordered[:1] + [high for low, high in pairwise(ordered) if high - low > _COINCIDENT]
