"""Find the faces of a part that carry a dimension, from the model's declaration and the faces' sizes.

A face never gets the tolerance of another dimension: if no face has the parameter's size, or two dimensions
claim the same face, the build is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isclose

from cadquery import Shape, Vector

from cad.errors import GeometryError
from cad.surfaces import AXES, FaceReadback, faces_of
from cad.tolerances import REPEATED, ToleranceFaces

_CLOSE = 1e-6  # [mm]: a face of this size is the parameter's
ROUND = ("cylinders", "beside", "along", "askew", "spheres")
"""The sorts of faces whose size is their diameter."""


@dataclass(frozen=True)
class Place:
    """The faces of a dimension by their numbers in the part; those of a distance lie on two sides.

    Of a wall of two parts, `inside` is the part that has the first faces.
    """

    first: tuple[int, ...]
    second: tuple[int, ...] = ()
    inside: str = ""


def located(
    declared: Mapping[str, ToleranceFaces],
    solids: Mapping[str, Shape],
    sizes: Mapping[str, float],
    names: Iterable[str],
) -> dict[str, ToleranceFaces]:
    """Return the declarations, with what only the solids show of the named dimensions.

    The planes of lengths that repeat along an axis are counted; two sides are on the part that has them.

    Raises
    ------
    GeometryError
        `tolerance`, where no planes show such a dimension.
    """
    carriers = Carriers(solids, declared, sizes)
    found = {name: carriers.counted(name) for name in names if declared[name].faces in REPEATED}
    found |= {name: carriers.sided(name) for name in names if declared[name].faces == "sides"}
    return {**declared, **found}


class Carriers:
    """Finds faces of the parts of one model; `sizes` [mm] are those of all declared parameters."""

    def __init__(
        self, solids: Mapping[str, Shape], declared: Mapping[str, ToleranceFaces], sizes: Mapping[str, float]
    ) -> None:
        self._solids, self._declared, self._sizes = solids, declared, sizes
        self._seen: dict[str, list[FaceReadback]] = {}

    def places(self, name: str) -> list[Place]:
        """Return the position of a dimension for each pair of levels.

        Raises
        ------
        GeometryError
            `tolerance`.
        """
        one, size = self._declared[name], self._sizes[name]
        match one.faces:
            case "planes":
                return [self._levels(one, size, low, high) for low, high in one.levels]
            case "sides":
                return [self._sides(one, size) or Place(self._missing(one, size))]
            case "walls":
                return [self._walls(one, size)]
            case "between":
                return [self._between(one, size)]
        faces = self._round(one)
        for other in (n for n, o in self._declared.items() if n != name and _is_beside(o, one)):
            if not set(faces).isdisjoint(self._round(self._declared[other])):
                detail = f"the same faces are {size:g} mm for {name} and for {other}; change one by 0.1 %"
                raise GeometryError("tolerance", detail, (name, other))
        return [Place(faces or self._missing(one, size))]

    def counted(self, name: str) -> ToleranceFaces:
        """Return a dimension that repeats along an axis, as pairs of planes across that.

        Raises
        ------
        GeometryError
            `tolerance`, where no planes show it.
        """
        one = self._declared[name]
        of = self._declared[one.others_named[0]]
        levels = self._levels_along(one, AXES[of.where])
        pairs = tuple((levels.index(low), levels.index(high)) for low, high in self.spans(name))
        if not pairs:
            self._missing(one, self._sizes[name])
        for other in (n for n, o in self._declared.items() if n != name and o.faces in REPEATED):
            if not {*self.spans(name)}.isdisjoint(self.spans(other)):
                size = self._sizes[name]
                detail = (
                    f"the same planes are {size:g} mm apart for {name} and for {other}; change one by 0.1 %"
                )
                raise GeometryError("tolerance", detail, (name, other))
        return replace(one, faces="planes", where=of.where, levels=pairs)

    def sided(self, name: str) -> ToleranceFaces:
        """Return a dimension between two sides of a part, on the first of its parts that has both."""
        one, size = self._declared[name], self._sizes[name]
        standing = (replace(one, part=part) for part in (one.part, *one.others) if part in self._solids)
        return next((each for each in standing if self._sides(each, size)), one)

    def spans(self, name: str) -> list[tuple[float, float]]:
        """Return the start and end of each repetition of a dimension along an axis [mm]."""
        one, size = self._declared[name], self._sizes[name]
        of = [self._declared[other] for other in one.others_named]
        axis = AXES[of[0].where]
        reaches = [face.surface.turned(axis).reach for other in of for face in self._of_size(other)]
        return [
            (low, high)
            for low, high in pairwise(self._levels_along(one, axis))
            if isclose(high - low, size, abs_tol=2 * _CLOSE)
            and any(low - _CLOSE < (a + b) / 2 < high + _CLOSE for a, b in reaches)
            == (one.faces == "shoulders")
        ]

    def _levels_along(self, one: ToleranceFaces, axis: Vector) -> list[float]:
        """Return the positions of planes across an axis, from low to high."""
        planes = (f for f in self._faces(one) if f.kind == "plane" and f.surface.along(axis))
        return sorted({round(f.surface.point.dot(axis), 6) for f in planes})

    def _round(self, one: ToleranceFaces) -> tuple[int, ...]:
        """Return the faces of a diameter; without those that belong to the dimension of an end."""
        faces = self._of_size(one)
        if one.end:
            return tuple(face.number for face in _at_end(faces, one))
        ends = (o for o in self._declared.values() if o.end and (o.part, o.where) == (one.part, one.where))
        taken = {number for end in ends for number in self._round(end)}
        return tuple(face.number for face in faces if face.number not in taken)

    def _of_size(self, one: ToleranceFaces) -> list[FaceReadback]:
        size = self._sizes[one.name]
        return [f for f in self._faces(one) if abs(f.surface.diameter - size) < _CLOSE and _is_meant(f, one)]

    def _levels(self, one: ToleranceFaces, size: float, low: int, high: int) -> Place:
        axis = AXES[one.where]
        planes = [f for f in self._faces(one) if f.kind == "plane" and f.surface.along(axis)]
        levels = self._levels_along(one, axis)
        count = len(levels)
        if not (-count <= low < count and -count <= high < count):
            self._missing(one, size)
        ends = levels[low], levels[high]
        first, second = (
            tuple(f.number for f in planes if abs(f.surface.point.dot(axis) - z) < _CLOSE) for z in ends
        )
        if not isclose(abs(ends[1] - ends[0]), size, abs_tol=2 * _CLOSE):
            self._missing(one, size)
        return Place(first, second)

    def _sides(self, one: ToleranceFaces, size: float) -> Place | None:
        """Return the planes across an axis on both sides of the origin; None if the part lacks one."""
        axis = AXES[one.where]
        planes = [f for f in self._faces(one) if f.kind == "plane" and f.surface.along(axis)]
        low, high = (
            tuple(f.number for f in planes if abs(f.surface.point.dot(axis) - side * size / 2) < _CLOSE)
            for side in (-1, 1)
        )
        return Place(low, high) if low and high else None

    def _walls(self, one: ToleranceFaces, size: float) -> Place:
        inner = self._about(replace(one, part=one.inside[0]) if one.inside else one)
        thinnest = min((f.surface.diameter for f in inner), default=0.0)
        first, second = (
            tuple(f.number for f in faces if abs(f.surface.diameter - diameter) < 2 * _CLOSE)
            for faces, diameter in ((inner, thinnest), (self._about(one), thinnest + 2 * size))
        )
        if not (first and second):
            self._missing(one, size)
        return Place(first, second, one.inside[0] if one.inside else "")

    def _about(self, one: ToleranceFaces) -> list[FaceReadback]:
        """Return the cylinders of a part about an axis."""
        axis = AXES[one.where]
        return [f for f in self._faces(one) if f.kind == "cylinder" and f.surface.about(axis)]

    def _between(self, one: ToleranceFaces, size: float) -> Place:
        (first,), (second,) = (self.places(name) for name in one.where)
        by_number = {face.number: face.surface for face in self._faces(one)}
        start = by_number[first.first[0]]
        for number in second.first:
            apart = by_number[number].point - start.point
            if not isclose(apart.cross(start.direction).Length, size, abs_tol=2 * _CLOSE):
                self._missing(one, size)
        return Place(first.first, second.first)

    def _faces(self, one: ToleranceFaces) -> list[FaceReadback]:
        if one.part not in self._seen:
            solid = self._solids.get(one.part)
            self._seen[one.part] = [] if solid is None else faces_of(solid)
        return self._seen[one.part]

    def _missing(self, one: ToleranceFaces, size: float) -> tuple[int, ...]:
        detail = f"{one.name} has a tolerance, but no face of {one.part} shows its {size:g} mm"
        raise GeometryError(
            "tolerance", f"{detail}; omit the tolerance, or give the dimension a size above 0", (one.name,)
        )


def _is_beside(other: ToleranceFaces, one: ToleranceFaces) -> bool:
    """Return whether another dimension might claim the same faces."""
    return other.faces in ROUND and other.part == one.part


def _is_meant(face: FaceReadback, one: ToleranceFaces) -> bool:
    """Return whether a face is of the sort, and lies as the declaration says."""
    if one.faces == "spheres":
        return face.kind == "sphere"
    if face.kind != "cylinder":
        return False
    if one.faces == "askew":
        return not any(face.surface.along(axis) for axis in AXES.values())
    axis = AXES[one.where]
    if one.faces != "along" and face.surface.about(axis) != (one.faces == "cylinders"):
        return False
    return face.surface.along(axis)


def _at_end(faces: list[FaceReadback], one: ToleranceFaces) -> Iterator[FaceReadback]:
    """Yield the cylinders about an axis that begin first, or end last, along it."""
    axis: Vector = AXES[one.where]
    reaches = {face.number: face.surface.turned(axis).reach for face in faces}
    if one.end == "low":
        last = min((low for low, _ in reaches.values()), default=0.0)
        yield from (face for face in faces if abs(reaches[face.number][0] - last) < _CLOSE)
    else:
        last = max((high for _, high in reaches.values()), default=0.0)
        yield from (face for face in faces if abs(reaches[face.number][1] - last) < _CLOSE)
