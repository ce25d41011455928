"""Measures a shaft of several throws: its rotating couple, and each throw cut out at mid-mains.

Mass moments are complex, x + i y. The unbalance of a throw is ∫ (x + i y) dm, its couple ∫ z (x + i y) dm
about z = 0: over ω² the force and the couple with which it shakes its bearings. Both are additive, as is the
polar inertia.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from cadquery import Shape, Solid, Vector

from cad.errors import GeometryError
from cad.inspect import bounding_box, measure
from cad.shaft import STEEL_DENSITY
from cad.step import Body, read_step


@dataclass(frozen=True)
class ThrowMeasures:
    """Of one throw: mass [kg], polar inertia [kg m²], unbalance [kg m], couple [kg m²] about z = 0."""

    mass: float
    polar_inertia: float
    unbalance: complex
    couple: complex


def rotating_couple(measures: Mapping[str, float]) -> complex:
    """∫ z (x + i y) dm [kg m²] about z = 0, from the measures of a build; inertia_xz is about the centre."""
    mass, z = measures["mass"], measures["centre_z"] * 1e-3
    x, y = measures["centre_x"] * 1e-3, measures["centre_y"] * 1e-3
    return complex(mass * z * x - measures["inertia_xz"], mass * z * y - measures["inertia_yz"])


def throws_measured(
    step: bytes, planes: Sequence[float], density: float = STEEL_DENSITY
) -> list[ThrowMeasures]:
    """The one solid of a STEP file cut across z at planes [mm], and each piece measured.

    The nose goes with the first piece, the flange with the last. density in kg/m³.

    Raises
    ------
    GeometryError
        `not_one_solid` if there are several bodies, or a plane cuts one piece into several;
        `volume` if the pieces are not together the whole.
    """
    bodies = read_step(step)
    if len(bodies) != 1:
        raise GeometryError("not_one_solid", f"a shaft must be one solid; the file has {len(bodies)}")
    pieces = cut(bodies[0], planes)
    measured = [_measured(piece, density * 1e-9) for piece in pieces]
    whole, total = measure(bodies[0]).volume * density * 1e-9, sum(one.mass for one in measured)
    if abs(total - whole) > 1e-9 * whole:
        raise GeometryError("volume", f"the throws weigh {total:.12g} kg, the shaft {whole:.12g} kg")
    return measured


def cut(body: Body, planes: Sequence[float]) -> list[Shape]:
    """The pieces of a body between planes across z [mm], in the order of z.

    Raises
    ------
    GeometryError
        `not_one_solid` if there is not one piece between two planes.
    """
    box = bounding_box([body])
    size = max(abs(value) for value in (*box.low[:2], *box.high[:2])) + 1
    levels = [box.low[2] - 1, *planes, box.high[2] + 1]
    pieces: list[Shape] = []
    for low, high in pairwise(levels):
        room = Solid.makeBox(2 * size, 2 * size, high - low, Vector(-size, -size, low))
        solids = body.shape.intersect(room).Solids() if planes else body.shape.Solids()
        if len(solids) != 1:
            where = f"between z = {low:g} and {high:g} mm"
            raise GeometryError("not_one_solid", f"{where} the shaft is {len(solids)} pieces, not one")
        pieces.append(solids[0])
    return pieces


def _measured(piece: Shape, density: float) -> ThrowMeasures:
    """Measures of a piece; density in kg/mm³."""
    one = measure(Body("piece", piece, (0.0, 0.0, 0.0), ()))
    mass, (x, y, z) = density * one.volume, one.centre * 1e-3
    inertia = np.asarray(one.inertia) * density * 1e-6
    return ThrowMeasures(
        mass=float(mass),
        polar_inertia=float(inertia[2, 2] + mass * (x**2 + y**2)),
        unbalance=complex(mass * x, mass * y),
        couple=complex(mass * z * x - inertia[0, 2], mass * z * y - inertia[1, 2]),
    )
