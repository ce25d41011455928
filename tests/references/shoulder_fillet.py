"""The stress in a shoulder fillet by finite elements, mesh by mesh, against Peterson's factors.

Under torsion the von Mises stress is √3 times the shear stress; factors of bending are of the first principal
stress.
"""

from math import pi, sqrt
from typing import Any

import ngsolve as ng
import numpy as np
from cadquery import Shape, Workplane

from cad.analysis.kinds import Kind
from cad.analysis.solid import Solid, read_solid
from cad.analysis.stress import Components, Measure, Peaks, greatest_stress, von_mises
from cad.header import Header
from cad.model import Part
from cad.shaft import STEEL_MATERIAL, Shaft
from cad.step import write_step
from templates.physics.shafts.stress_concentration import shoulder_fillet_Pilkey_2008

WIDE, NARROW, FILLET = 60.0, 40.0, 4.0  # mm
SHOULDER, END = 60.0, 130.0


def first_principal(components: Components) -> Any:
    """Return the largest principal stress, by Cardano's formula; factors of bending are of it."""
    xx, yy, zz, xy, yz, xz = components
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    radius = von_mises(components) * 2 / 3 + 1e-300  # an unloaded point has no direction
    determinant = a * b * c + 2 * xy * yz * xz - a * yz**2 - b * xz**2 - c * xy**2
    cosine = 4 * determinant / radius**3
    inside = ng.IfPos(cosine - 1, 1, ng.IfPos(-1 - cosine, -1, cosine))  # rounding may leave it outside
    return mean + radius * ng.cos(ng.acos(inside) / 3)


LOADS: dict[Kind, tuple[Measure, float]] = {
    "torsion": (von_mises, sqrt(3) * 16 / (pi * NARROW**3)),
    "bending": (first_principal, 32 / (pi * NARROW**3)),
}
"""The stress examined under each load, and its nominal value [MPa] under 1 N·mm."""


def shoulder(
    fillet: float, end: float = END, wide: float = WIDE, narrow: float = NARROW, at: float = SHOULDER
) -> bytes:
    """A stepped shaft as a STEP file; a fillet of 0 leaves the corner sharp."""
    side = Workplane("XZ").lineTo(wide / 2, 0).lineTo(wide / 2, at).lineTo(narrow / 2 + fillet, at)
    if fillet > 0:
        side = side.radiusArc((narrow / 2, at + fillet), fillet)
    shape = side.lineTo(narrow / 2, end).lineTo(0, end).close().revolve(360, (0, 0, 0), (0, 1, 0)).val()
    assert isinstance(shape, Shape)
    return write_step((Part("shaft", shape, 1.0),), Header("shaft", 1, {}, "0" * 64))


def solid() -> Solid:
    """The shaft with its fillet, held at the wide end."""
    return read_solid(shoulder(FILLET), Shaft(0.0, END))


def peaks(load: Kind) -> Peaks:
    """The greatest stress, mesh by mesh."""
    measure, _ = LOADS[load]
    return greatest_stress(solid(), STEEL_MATERIAL, load, "free_end", lambda step: None, measure)


def factors(load: Kind, stresses: Peaks) -> list[float]:
    """Stress concentration factors by mesh."""
    return [peak.value / LOADS[load][1] for peak in stresses.steps]


def peterson(load: Kind) -> float:
    """The published factor."""
    return float(shoulder_fillet_Pilkey_2008(load, *np.array([WIDE, NARROW, FILLET])))
