"""Whether parts that stand together take the same space: an interference, by the names of the parts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from cad.step import Body

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


def gap(one: Body, other: Body) -> float:
    """The smallest distance between two bodies where they stand [mm]."""
    shapes = (body.shape.moved(body.places[0]).wrapped for body in (one, other))
    return float(BRepExtrema_DistShapeShape(*shapes).Value())
