"""Whether parts that stand together take the same space, and how far apart they are, by their names."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

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
from cad.model import names_at
from cad.step import Body

MOST_CLEARANCES = 200
"""Pairs of parts of which the distance is measured, those with the closest boxes first."""
_TOUCHING = 1e-6  # [mm]; parts that are closer touch or overlap
_OFF = 1e-3  # [mm]; a corner that is closer to a face lies on it
_MOST_CORNERS = 500  # of a part that are tried
_SPECK = 1e-6  # [mm³]; touching faces have less in common


@dataclass(frozen=True)
class Overlap:
    """Two parts that take the same space, and how much of it [mm³]."""

    one: str
    other: str
    volume: float

    def __str__(self) -> str:
        return f"{self.one} and {self.other} overlap by {self.volume:.6g} mm³"


def overlaps(bodies: Sequence[Body]) -> Iterator[Overlap]:
    """Every two bodies that overlap where they stand; those that touch do not."""
    standing = [(body.name, body.shape.moved(place)) for body in bodies for place in body.places]
    for (one, shape), (other, beside) in combinations(standing, 2):
        properties = GProp_GProps()
        common = BRepAlgoAPI_Common(shape.wrapped, beside.wrapped).Shape()
        BRepGProp.VolumeProperties_s(common, properties)
        if properties.Mass() > _SPECK:
            yield Overlap(one, other, properties.Mass())


@dataclass(frozen=True)
class Clearance:
    """What lies between two parts: a distance [mm]; or none, and the space [mm³] that both take."""

    one: str
    other: str
    distance: float
    overlap: float = 0.0

    def __str__(self) -> str:
        if self.overlap:
            return f"{self.one} and {self.other} overlap by {self.overlap:.6g} mm³"
        return f"{self.one} and {self.other} are {self.distance:.6g} mm apart"


def clearances(bodies: Sequence[Body], group: Callable[[str], str | None]) -> Iterator[Clearance]:
    """What lies between each fixed part and every other part; `group` says to which one a body belongs.

    Solids of one fixed part are not compared with each other, nor are those of none. All parts of which the
    boxes meet are compared; of the others those whose boxes are closest.

    Raises
    ------
    GeometryError
        `kernel`, if two parts cannot be compared; they are named.
    """
    standing = [
        (name, group(body.name), body.shape.moved(place))
        for body in bodies
        for name, place in zip(names_at(body.name, len(body.places)), body.places, strict=True)
    ]
    boxes = [_box(shape) for _, _, shape in standing]
    pairs = [
        (boxes[i].Distance(boxes[j]), i, j)
        for (i, one), (j, other) in combinations(enumerate(standing), 2)
        if one[1] != other[1]
    ]
    for number, (between, i, j) in enumerate(sorted(pairs)):
        if between > _TOUCHING and number >= MOST_CLEARANCES:
            return
        yield _between(standing[i][0], standing[i][2], standing[j][0], standing[j][2])


def _between(one: str, shape: Shape, other: str, beside: Shape) -> Clearance:
    measured = BRepExtrema_DistShapeShape(shape.wrapped, beside.wrapped)
    if not measured.IsDone():
        raise GeometryError("kernel", f"the distance between {one} and {other} cannot be measured")
    if (distance := float(measured.Value())) > _TOUCHING:
        return Clearance(one, other, distance)
    common, properties = BRepAlgoAPI_Common(shape.wrapped, beside.wrapped), GProp_GProps()
    if not common.IsDone():
        raise GeometryError("kernel", f"whether {one} and {other} overlap cannot be found")
    BRepGProp.VolumeProperties_s(common.Shape(), properties)
    volume = float(properties.Mass())
    if volume > _SPECK:
        return Clearance(one, other, 0.0, volume)
    if _has_corner_inside(shape, beside) or _has_corner_inside(beside, shape):
        raise GeometryError("kernel", f"{one} and {other} overlap, and how much of it cannot be found")
    return Clearance(one, other, 0.0)


def _has_corner_inside(shape: Shape, other: Shape) -> bool:
    """Whether a corner of a shape lies within another, well off its faces."""
    inside = [BRepClass3d_SolidClassifier(solid.wrapped) for solid in other.Solids()]
    for corner in shape.Vertices()[:_MOST_CORNERS]:
        point = BRep_Tool.Pnt_s(corner.wrapped)
        for classifier in inside:
            classifier.Perform(point, _OFF)
            if classifier.State() == TopAbs_State.TopAbs_IN:
                return True
    return False


def _box(shape: Shape) -> Bnd_Box:
    """A box that holds a shape, perhaps with some room."""
    around = Bnd_Box()
    BRepBndLib.Add_s(shape.wrapped, around, False)
    return around


def gap(one: Body, other: Body) -> float:
    """The smallest distance between two bodies where they stand [mm]."""
    shapes = (body.shape.moved(body.places[0]).wrapped for body in (one, other))
    return float(BRepExtrema_DistShapeShape(*shapes).Value())
