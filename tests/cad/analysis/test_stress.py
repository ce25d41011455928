"""Literature: a shoulder fillet's stress concentration; what counts as converged."""

from math import pi, sqrt

import numpy as np
import pytest
from cadquery import Shape, Workplane

from cad.analysis.analyse import Asked, analyse
from cad.analysis.elastic import Load
from cad.analysis.solid import Solid, read_solid
from cad.analysis.stress import (
    CONVERGED,
    SMALL,
    Measure,
    Peak,
    Peaks,
    first_principal,
    greatest_stress,
    von_mises,
)
from cad.header import Header
from cad.model import STEEL_MATERIAL, Part, Shaft
from cad.step import write_step
from templates.physics.stress_concentration import shoulder_fillet_Pilkey_2008

WIDE, NARROW, FILLET = 60.0, 40.0, 4.0  # mm
SHOULDER, END = 60.0, 130.0


def shoulder(fillet: float) -> bytes:
    side = (
        Workplane("XZ").lineTo(WIDE / 2, 0).lineTo(WIDE / 2, SHOULDER).lineTo(NARROW / 2 + fillet, SHOULDER)
    )
    if fillet > 0:
        side = side.radiusArc((NARROW / 2, SHOULDER + fillet), fillet)
    shape = side.lineTo(NARROW / 2, END).lineTo(0, END).close().revolve(360, (0, 0, 0), (0, 1, 0)).val()
    assert isinstance(shape, Shape)
    return write_step((Part("shaft", shape, 1.0),), Header("shaft", 1, {}, "0" * 64))


def solid(fillet: float) -> Solid:
    return read_solid(shoulder(fillet), Shaft(0.0, END))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("load", "measure", "nominal"),
    [
        ("torsion", von_mises, sqrt(3) * 16 / (pi * NARROW**3)),  # pure shear: von Mises is √3 of it
        ("bending", first_principal, 32 / (pi * NARROW**3)),
    ],
)
def test_a_shoulder_fillet_concentrates_stress_as_peterson_says(
    load: Load, measure: Measure, nominal: float
) -> None:
    peaks = greatest_stress(solid(FILLET), STEEL_MATERIAL, load, "free_end", lambda step: None, measure)
    assert peaks.converged
    wanted = shoulder_fillet_Pilkey_2008(load, *np.array([WIDE, NARROW, FILLET]))
    assert peaks.steps[-1].value / nominal == pytest.approx(wanted, rel=0.05)


@pytest.mark.slow
def test_a_sharp_corner_has_no_greatest_stress() -> None:
    found = analyse(shoulder(0.0), Shaft(0.0, END), Asked(), ["maximum_stress"], lambda done, what: None)
    stress = found.outputs["maximum_stress"]
    assert stress["value"] is None
    assert "sharp inner corner" in stress["reason"]


def peaks(*values: float) -> Peaks:
    return Peaks(tuple(Peak(value, (0.0, 0.0, 0.0), 1, 1) for value in values))


@pytest.mark.parametrize(
    ("values", "converged"),
    [
        ((1.0,), False),
        ((1.0, 1.0), False),
        ((1.0, 1.3, 1.3), False),
        ((1.0, 1.3, 1.3, 1.3), True),
        ((1.0, 1.0, 1.0 + 2 * CONVERGED), False),
        ((1.0, 1.0 + 0.9 * SMALL, 1.0 + 0.9 * SMALL), True),
        ((1.0, 1.0 + 1.1 * SMALL, 1.0 + 1.1 * SMALL), False),
    ],
)
def test_one_small_change_is_no_convergence(values: tuple[float, ...], converged: bool) -> None:
    assert peaks(*values).converged == converged
