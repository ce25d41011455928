"""The stress in a shoulder fillet by finite elements, mesh by mesh, against Peterson's factors.

    python -m benchmarks.shoulder_fillet

Under torsion the von Mises stress is √3 times the shear stress; factors of bending are of the first principal
stress. Results in benchmarks/results/shoulder_fillet.json.
"""

import json
from math import pi, sqrt
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from cadquery import Shape, Workplane

from cad.analysis.kinds import Kind
from cad.analysis.solid import Solid, read_solid
from cad.analysis.stress import Measure, Peaks, first_principal, greatest_stress, von_mises
from cad.header import Header
from cad.model import Part
from cad.shaft import STEEL_MATERIAL, Shaft
from cad.step import write_step
from templates.physics.shafts.stress_concentration import shoulder_fillet_Pilkey_2008

RESULTS = Path("benchmarks/results/shoulder_fillet.json")
WIDE, NARROW, FILLET = 60.0, 40.0, 4.0  # mm
SHOULDER, END = 60.0, 130.0

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


def row(load: Kind) -> dict[str, Any]:
    """One load: factors mesh by mesh, and the published one."""
    start = perf_counter()
    stresses = peaks(load)
    ours = factors(load, stresses)
    return {
        "Peterson": peterson(load),
        "factors": ours,
        "degrees of freedom": [peak.degrees_of_freedom for peak in stresses.steps],
        "converged": stresses.converged,
        "against Peterson": ours[-1] / peterson(load) - 1,
        "seconds": perf_counter() - start,
    }


def main() -> None:
    """Measure, print and keep."""
    table = {load: row(load) for load in LOADS}
    RESULTS.write_text(json.dumps(table, indent=1) + "\n")
    print(json.dumps(table, indent=1))


if __name__ == "__main__":
    main()
