"""Overlaps and distances between the parts of a model, by the names of the parts."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, combinations
from math import inf

from cadquery import Shape
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_State

from cad.errors import GeometryError
from cad.step import Body

MOST_CLEARANCES = 200
"""Largest number of pairs of parts whose distance is measured; pairs with the closest boxes come first."""
MOST_MEETING = 2000
"""Largest number of pairs of solids with intersecting boxes: two plain solids take 10 ms, two filleted
bolts 250 ms."""
_SHOWN_EVERY = 0.1  # [s] between progress reports; a pair may take less
_MOST_NAMED = 3  # number of fixed parts with the most pairs that are named
_TOUCHING = 1e-6  # [mm]; parts that are closer touch or overlap
_OFF = 1e-3  # [mm]; a corner that is closer to a face lies on it
_MOST_CORNERS = 500  # largest number of a part's corners that are tried
_SPECK = 1e-6  # [mm³]; touching faces share less volume


@dataclass(frozen=True)
class Overlap:
    """Two overlapping parts and their shared volume [mm³]."""

    one: str
    other: str
    volume: float

    def __str__(self) -> str:
        return f"{self.one} and {self.other} overlap by {self.volume:.6g} mm³"


def overlaps(bodies: Sequence[Body]) -> Iterator[Overlap]:
    """Yield every pair of bodies that overlap at their positions; touching bodies do not overlap.

    Raises
    ------
    GeometryError
        `kernel`, if two bodies cannot be compared.
    """
    for (one, shape), (other, beside) in _meeting(bodies):
        volume = _shared_volume(one, shape, other, beside)
        if volume > _SPECK:
            yield Overlap(one, other, volume)


def _shared_volume(one: str, shape: Shape, other: str, beside: Shape) -> float:
    common, properties = BRepAlgoAPI_Common(shape.wrapped, beside.wrapped), GProp_GProps()
    if not common.IsDone():
        raise GeometryError("kernel", f"the kernel cannot determine whether {one} and {other} overlap")
    BRepGProp.VolumeProperties_s(common.Shape(), properties)
    return float(properties.Mass())


def count_meeting(bodies: Sequence[Body]) -> int:
    """Return the number of pairs of bodies whose boxes meet; these are the pairs that `overlaps` compares."""
    return sum(1 for _ in _meeting(bodies))


def _meeting(bodies: Sequence[Body]) -> Iterator[tuple[tuple[str, Shape], tuple[str, Shape]]]:
    """Yield each pair of bodies, by name and shape at a position, whose boxes meet."""
    standing = [
        (name, body.shape.moved(place))
        for body in bodies
        for name, place in zip(body.names, body.places, strict=True)
    ]
    boxes = [_box(shape) for _, shape in standing]
    for i, j in combinations(range(len(standing)), 2):
        if not boxes[i].IsOut(boxes[j]):
            yield standing[i], standing[j]


@dataclass(frozen=True)
class Clearance:
    """The distance [mm] between two parts, or 0 and their shared volume [mm³]."""

    one: str
    other: str
    distance: float
    overlap: float = 0.0

    def __str__(self) -> str:
        if self.overlap:
            return f"{self.one} and {self.other} overlap by {self.overlap:.6g} mm³"
        return f"{self.one} and {self.other} are {self.distance:.6g} mm apart"


Report = Callable[[float, str], None]
Group = Callable[[str], str | None]


def clearances(bodies: Sequence[Body], group: Group, report: Report | None = None) -> Iterator[Clearance]:
    """Yield the clearance between each fixed part and every other part.

    `group` returns the fixed part of a body.

    Solids of the same fixed part are not compared with each other, nor are solids that belong to no fixed
    part. All pairs whose boxes meet are compared. Of the other pairs, only two kinds are compared: pairs with
    the closest boxes, and pairs that may be closer to a fixed part than the parts already compared with it.
    `report` receives the progress.

    Raises
    ------
    GeometryError
        `too_large`, if more than `MOST_MEETING` pairs of boxes meet; `kernel`, if two parts cannot be
        compared. The message names the parts.
    """
    standing = _standing(bodies, group)
    pairs = _pairs(standing)
    _require_few(standing, pairs)
    chosen = [pair for n, pair in enumerate(pairs) if n < MOST_CLEARANCES or pair.between <= _TOUCHING]
    rest = (pair for n, pair in enumerate(pairs) if n >= MOST_CLEARANCES and pair.between > _TOUCHING)
    nearest: dict[str | None, float] = {}
    shown = 0.0
    for number, pair in enumerate(chain(chosen, rest)):
        one, other = standing[pair.i], standing[pair.j]
        groups = {one.group, other.group} - {None}
        if number >= len(chosen) and all(nearest.get(name, inf) <= pair.between for name in groups):
            continue
        if report is not None and time.monotonic() - shown >= _SHOWN_EVERY:
            what = f"comparing {one.name} with {other.name}, pair {number + 1} of {len(chosen)}"
            report(min(number / len(chosen), 1.0), what)
            shown = time.monotonic()
        found = _between(one.name, one.shape, other.name, other.shape)
        nearest.update((name, min(found.distance, nearest.get(name, inf))) for name in groups)
        yield found


def require_few_meeting(bodies: Sequence[Body], group: Group) -> None:
    """Refuse an assembly in which the boxes of too many pairs meet, before any slow operation.

    Raises
    ------
    GeometryError
        `too_large`, with the number of pairs, the limit, and the fixed parts with the most of them.
    """
    if any(group(body.name) for body in bodies):
        standing = _standing(bodies, group)
        _require_few(standing, _pairs(standing))


@dataclass(frozen=True)
class _PlacedSolid:
    """A solid at its position, and the fixed part to which it belongs."""

    name: str
    group: str | None
    shape: Shape


@dataclass(frozen=True, order=True)
class _Pair:
    """The numbers of two solids, and the distance of their boxes [mm]."""

    between: float
    i: int
    j: int


def _standing(bodies: Sequence[Body], group: Group) -> list[_PlacedSolid]:
    return [
        _PlacedSolid(name, group(body.name), body.shape.moved(place))
        for body in bodies
        for name, place in zip(body.names, body.places, strict=True)
    ]


def _pairs(standing: Sequence[_PlacedSolid]) -> list[_Pair]:
    """Return all pairs to compare, those with the closest boxes first."""
    boxes = [_box(one.shape) for one in standing]
    return sorted(
        _Pair(boxes[i].Distance(boxes[j]), i, j)
        for (i, one), (j, other) in combinations(enumerate(standing), 2)
        if one.group != other.group
    )


def _require_few(standing: Sequence[_PlacedSolid], pairs: Sequence[_Pair]) -> None:
    """Raise an error if the boxes of more pairs meet than can be compared; see `clearances`."""
    meeting = [pair for pair in pairs if pair.between <= _TOUCHING]
    if len(meeting) <= MOST_MEETING:
        return
    whose = Counter(
        standing[n].group or standing[n].name for pair in meeting for n in (pair.i, pair.j)
    ).most_common(_MOST_NAMED)
    listed = ", ".join(f"{name} ({count})" for name, count in whose)
    detail = (
        f"{len(meeting)} pairs of solids have boxes that meet, and at most {MOST_MEETING} are compared; the "
        f"most are of {listed}. Move the components apart, or remove solids from their files"
    )
    raise GeometryError("too_large", detail)


def _between(one: str, shape: Shape, other: str, beside: Shape) -> Clearance:
    measured = BRepExtrema_DistShapeShape(shape.wrapped, beside.wrapped)
    if not measured.IsDone():
        raise GeometryError("kernel", f"the distance between {one} and {other} cannot be measured")
    if (distance := float(measured.Value())) > _TOUCHING:
        return Clearance(one, other, distance)
    volume = _shared_volume(one, shape, other, beside)
    if volume > _SPECK:
        return Clearance(one, other, 0.0, volume)
    if _has_corner_inside(shape, beside) or _has_corner_inside(beside, shape):
        raise GeometryError(
            "kernel", f"{one} and {other} overlap, but the shared volume cannot be determined"
        )
    return Clearance(one, other, 0.0)


def _has_corner_inside(shape: Shape, other: Shape) -> bool:
    """Return whether a vertex of a shape lies inside another shape, clearly away from its faces."""
    inside = [BRepClass3d_SolidClassifier(solid.wrapped) for solid in other.Solids()]
    for corner in shape.Vertices()[:_MOST_CORNERS]:
        point = BRep_Tool.Pnt_s(corner.wrapped)
        for classifier in inside:
            classifier.Perform(point, _OFF)
            if classifier.State() == TopAbs_State.TopAbs_IN:
                return True
    return False


def _box(shape: Shape) -> Bnd_Box:
    """Return a box that contains a shape, with an optional margin."""
    around = Bnd_Box()
    BRepBndLib.Add_s(shape.wrapped, around, False)
    return around


def gap(one: Body, other: Body) -> float:
    """Return the smallest distance between two bodies at their positions [mm]."""
    shapes = (body.shape.moved(body.places[0]).wrapped for body in (one, other))
    return float(BRepExtrema_DistShapeShape(*shapes).Value())
