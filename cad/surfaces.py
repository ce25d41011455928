"""Surfaces of a finished solid (planes, cylinders, spheres, tori), from which dimensions are read."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from cadquery import Shape, Vector
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_SurfaceType as Kind

from cad.on_demand import constant

X = constant(lambda: Vector(1, 0, 0))
Y = constant(lambda: Vector(0, 1, 0))
Z = constant(lambda: Vector(0, 0, 1))
AXES = constant(lambda: {"x": Vector(1, 0, 0), "y": Vector(0, 1, 0), "z": Vector(0, 0, 1)})
"""The directions by their letters; one stand-in where the kernel is postponed, which loading it replaces."""

_COINCIDENT = 1e-6  # [mm], and as the sine of an angle: ten times the kernel's own precision


@dataclass(frozen=True)
class Surface:
    """A plane or a cylinder: a point on it or its axis, normal or axis, diameter unless it is flat."""

    point: Vector
    direction: Vector
    diameter: float = 0.0  # [mm]
    reach: tuple[float, float] = (0.0, 0.0)  # of a cylinder: where along its axis it begins and ends [mm]

    def along(self, axis: Vector) -> bool:
        """Return whether the surface's direction is that of the axis, either way round."""
        return bool(self.direction.cross(axis).Length < _COINCIDENT)

    def about(self, axis: Vector) -> bool:
        """Return whether the surface turns about that axis through the origin."""
        turns, through = self.direction.cross(axis), self.point.cross(axis)
        return bool(turns.Length < _COINCIDENT and through.Length < _COINCIDENT)

    def holds(self, axis: Vector) -> bool:
        """Return whether the plane holds that axis through the origin."""
        flat, upright = self.point.dot(self.direction), self.direction.dot(axis)
        return bool(abs(flat) < _COINCIDENT and abs(upright) < _COINCIDENT)

    def turned(self, axis: Vector) -> Surface:
        """Return the same surface, its direction that of the axis and not against it."""
        if self.direction.dot(axis) >= 0:
            return self
        low, high = self.reach
        return replace(self, direction=-self.direction, reach=(-high, -low))


@dataclass(frozen=True)
class PartSurfaces:
    """The surfaces of one part, in its own coordinates, and how many of it there are."""

    count: int
    planes: tuple[Surface, ...]
    cylinders: tuple[Surface, ...]
    spheres: tuple[float, ...]  # diameters [mm]
    tori: tuple[float, ...] = ()  # radii of their tubes [mm]

    def levels(self, axis: Vector) -> list[float]:
        """Return the coordinates [mm] at which planes cross the axis at a right angle, ascending."""
        return _distinct(plane.point.dot(axis) for plane in self.planes if plane.along(axis))

    def length(self, axis: Vector) -> float:
        """Return the distance from the first to the last plane across the axis [mm]."""
        levels = self.levels(axis)
        return levels[-1] - levels[0]

    def about(self, axis: Vector) -> list[Surface]:
        """Return the cylinders about the axis, each pointing along it."""
        return [cylinder.turned(axis) for cylinder in self.cylinders if cylinder.about(axis)]

    def diameters(self, axis: Vector) -> list[float]:
        """Return the diameters of the cylinders about the axis [mm], ascending."""
        return _distinct(cylinder.diameter for cylinder in self.about(axis))


@dataclass(frozen=True)
class FaceReadback:
    """A face of a solid by its number, of which sort it is, and its plane or cylinder.

    Of a sphere the surface is its centre and diameter; other sorts, with the kind "", have none to speak of.
    """

    number: int
    kind: str
    surface: Surface


def faces_of(solid: Shape) -> list[FaceReadback]:
    """Return every face of a solid, in the order of the solid."""
    return [_face(n, BRepAdaptor_Surface(face.wrapped)) for n, face in enumerate(solid.Faces())]


def _face(number: int, adaptor: BRepAdaptor_Surface) -> FaceReadback:
    match adaptor.GetType():
        case Kind.GeomAbs_Plane:
            return FaceReadback(number, "plane", _surface(adaptor.Plane().Axis()))
        case Kind.GeomAbs_Cylinder:
            return FaceReadback(number, "cylinder", _cylinder(adaptor))
        case Kind.GeomAbs_Sphere:
            sphere = adaptor.Sphere()
            return FaceReadback(number, "sphere", Surface(Vector(sphere.Location()), Z, 2 * sphere.Radius()))
    return FaceReadback(number, "", Surface(Vector(), Z))


def look(solid: Shape, count: int = 1) -> PartSurfaces:
    """Look at every face of a solid of which there are `count`."""
    of = defaultdict[Any, list[BRepAdaptor_Surface]](list)
    for face in solid.Faces():
        adaptor = BRepAdaptor_Surface(face.wrapped)
        of[adaptor.GetType()].append(adaptor)
    return PartSurfaces(
        count,
        planes=tuple(_surface(a.Plane().Axis()) for a in of[Kind.GeomAbs_Plane]),
        cylinders=tuple(map(_cylinder, of[Kind.GeomAbs_Cylinder])),
        spheres=tuple(2 * a.Sphere().Radius() for a in of[Kind.GeomAbs_Sphere]),
        tori=tuple(a.Torus().MinorRadius() for a in of[Kind.GeomAbs_Torus]),
    )


def _cylinder(adaptor: BRepAdaptor_Surface) -> Surface:
    cylinder = adaptor.Cylinder()
    surface = _surface(cylinder.Axis())
    start = surface.point.dot(surface.direction)
    reach = start + adaptor.FirstVParameter(), start + adaptor.LastVParameter()
    return replace(surface, diameter=2 * cylinder.Radius(), reach=reach)


def _surface(axis: Any) -> Surface:
    return Surface(Vector(axis.Location()), Vector(axis.Direction()))


def _distinct(values: Iterable[float]) -> list[float]:
    """Return the values in ascending order, those that coincide once."""
    ordered = sorted(values)
    return ordered[:1] + [high for low, high in pairwise(ordered) if high - low > _COINCIDENT]
