"""Measure a finished STEP file: read back the bytes that a user gets, and measure them.

This module does not use the built shape. A part at several positions is measured once.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from cadquery import Location
from numpy.typing import NDArray
from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from cad.model import Box
from cad.step import Body, rigid
from cad.surfaces import PartSurfaces, look
from templates.core.arrays import Array

MEASURES = {
    "mass": "kg",
    "volume": "mm**3",
    **{f"centre_{axis}": "mm" for axis in "xyz"},
    **{f"inertia_{axes}": "kg*m**2" for axes in ("xx", "xy", "xz", "yy", "yz", "zz")},
    "polar_inertia": "kg*m**2",
    **{f"{side}_{axis}": "mm" for side in ("low", "high") for axis in "xyz"},
}
"""Every measure of a model with its unit.

Inertia is the tensor about the centre of mass: inertia_xy = -∫ x y dm. The polar inertia is that about the
model's z axis, on which its shaft turns: ∫ (x² + y²) dm. Low and high are the bounding box.
"""

Number = float | complex
Numbers = NDArray[np.inexact[Any]]
Standing = tuple[Number, Numbers, Numbers]
"""Mass [kg], centre [mm] and inertia about the centre [kg·mm²] of a body at its position."""

_PAIRS = [(i, j) for i in range(3) for j in range(i, 3)]
_PRECISION = 1e-6  # [mm]


@dataclass(frozen=True)
class BodyMeasures:
    """Mass properties of one body at density 1."""

    solids: int
    valid: bool
    volume: float  # [mm³]
    centre: Array  # [mm], in the body's own coordinates
    inertia: Array  # [mm⁵], about the centre


def measure(body: Body) -> BodyMeasures:
    """Return the mass properties of one body in its own coordinates."""
    shape = body.shape.wrapped
    properties = GProp_GProps()
    # Shape.Volume() does not integrate to a given accuracy and is off by 5e-5 on a half shell. The accuracy
    # here applies to the volume: at 1e-6 the inertia of a ring was still off by 9e-6, at 1e-11 it is within
    # 1e-8.
    BRepGProp.VolumeProperties_s(shape, properties, 1e-11, False)
    centre, inertia = properties.CentreOfMass(), properties.MatrixOfInertia()
    return BodyMeasures(
        solids=len(body.shape.Solids()),
        valid=BRepCheck_Analyzer(shape).IsValid(),
        volume=properties.Mass(),
        centre=np.array([centre.X(), centre.Y(), centre.Z()]),
        inertia=np.array([[inertia.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)]),
    )


def look_at(bodies: Iterable[Body]) -> dict[str, PartSurfaces]:
    """Return the surfaces of every body by its name."""
    return {body.name: look(body.shape, len(body.places), body.name) for body in bodies}


def summarise(
    bodies: Sequence[Body], measured: Sequence[BodyMeasures], densities: Mapping[str, float], box: Box
) -> dict[str, float]:
    """Return the measures of all bodies together, in the units of `MEASURES`.

    Densities [kg/m³] are given by body name.
    """
    standing = [
        _stand(one, place, densities[body.name] * 1e-9)
        for body, one in zip(bodies, measured, strict=True)
        for place in body.places
    ]
    volume = sum(one.volume * len(body.places) for body, one in zip(bodies, measured, strict=True))
    return {
        **{name: float(value.real) for name, value in mass_measures(volume, standing).items()},
        **{f"low_{axis}": value for axis, value in zip("xyz", box.low, strict=True)},
        **{f"high_{axis}": value for axis, value in zip("xyz", box.high, strict=True)},
    }


def mass_measures(volume: Number, standing: Sequence[Standing]) -> dict[str, Number]:
    """Return the volume [mm³] with mass, centre and inertia of all bodies, in the units of `MEASURES`.

    Numbers may be complex: their imaginary parts are then changes of the first order.
    """
    mass = sum(weight for weight, _, _ in standing)
    centre = np.sum([weight * point for weight, point, _ in standing], axis=0) / mass
    inertia = np.sum([spin + _steiner(weight, point - centre) for weight, point, spin in standing], axis=0)
    return {
        "mass": mass,
        "volume": volume,
        **{f"centre_{axis}": value for axis, value in zip("xyz", centre, strict=True)},
        **{f"inertia_{'xyz'[i]}{'xyz'[j]}": inertia[i, j] * 1e-6 for i, j in _PAIRS},
        "polar_inertia": (inertia + _steiner(mass, centre))[2, 2] * 1e-6,
    }


def bounding_box(bodies: Iterable[Body]) -> Box:
    """Return the bounding box of all bodies at their positions [mm], as tight as the kernel computes it."""
    faces = [
        face.wrapped.Moved(place.wrapped)  # the kernel's method: CadQuery's checks the types of its arguments
        for body in bodies
        for face in body.shape.Faces()
        for place in body.places
    ]
    loose = [Bnd_Box() for _ in faces]
    for face, around in zip(faces, loose, strict=True):
        BRepBndLib.Add_s(face, around, False)
    extents = [around.SquareExtent() for around in loose]
    whole, room = Bnd_Box(), Bnd_Box()
    # The tight box of a torus takes 10 ms, its loose box 10 µs: compute the tight box only where it can
    # matter.
    for n in sorted(range(len(faces)), key=extents.__getitem__, reverse=True):
        if room.IsVoid() or room.IsOut(loose[n].CornerMin()) or room.IsOut(loose[n].CornerMax()):
            BRepBndLib.AddOptimal_s(faces[n], close := Bnd_Box(), False, False)
            whole.Add(close)
            room = _widened(whole)
    low, high = ((c.X(), c.Y(), c.Z()) for c in (whole.CornerMin(), whole.CornerMax()))
    return Box(_rounded(low), _rounded(high))


def _rounded(corner: tuple[float, float, float]) -> tuple[float, float, float]:
    """Return a corner without the margin of 1e-7 that the kernel adds to the boxes of cut faces."""
    x, y, z = (round(value, 6) + 0.0 for value in corner)
    return x, y, z


def _stand(one: BodyMeasures, place: Location, density: float) -> Standing:
    """Return mass [kg], centre [mm] and inertia about the centre [kg·mm²] of a body at a position.

    The density is in kg/mm³.
    """
    turn, shift = rigid(place)
    return density * one.volume, turn @ one.centre + shift, density * turn @ one.inertia @ turn.T


def _steiner(mass: Number, arm: Numbers) -> Numbers:
    """Return the inertia that a mass at the end of an arm adds (parallel axis theorem)."""
    return np.asarray(mass * (arm @ arm * np.eye(3) - np.outer(arm, arm)))


def _widened(box: Bnd_Box) -> Bnd_Box:
    """Return a box enlarged by the kernel's tolerance, as the kernel enlarges its loose boxes."""
    room = Bnd_Box(box.CornerMin(), box.CornerMax())
    room.Enlarge(_PRECISION)
    return room
