"""A second method: shafts of revolution in their half plane, bending as the first harmonic."""

from math import pi, sqrt

import pytest

from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.kinds import BOUNDARIES, LOADS, Boundary, Kind
from cad.shaft import STEEL_MATERIAL, Shaft
from tests.references.half_plane import HalfPlane, bending, factor, torsion
from tests.references.shoulder_fillet import END, FILLET, shoulder

LENGTH, RADIUS = 200.0, 20.0  # [mm], of a cylinder
YOUNG = STEEL_MATERIAL.young * 1e-6  # MPa
SHEAR = YOUNG / (2 * (1 + STEEL_MATERIAL.poisson))
CYLINDER = HalfPlane(wide=RADIUS, narrow=RADIUS, end=LENGTH)


def test_a_cylinder_in_torsion_is_exact_in_the_half_plane() -> None:
    """Coulomb: G J/L; the greatest shear stress is T R/J."""
    polar = pi * RADIUS**4 / 2
    solved = torsion(CYLINDER)
    assert solved.stiffness == pytest.approx(1e-3 * SHEAR * polar / LENGTH, rel=1e-8)
    assert solved.stress == pytest.approx(sqrt(3) * RADIUS / polar, rel=1e-6)


def test_a_cylinder_bends_in_the_half_plane_as_a_beam() -> None:
    """E I/L; the clamp, which lets nothing contract, makes it stiffer by a share of radius over length."""
    moment = pi * RADIUS**4 / 4
    solved = bending(CYLINDER, "free_end")
    assert 0 < solved.stiffness / (1e-3 * YOUNG * moment / LENGTH) - 1 < 0.1 * RADIUS / LENGTH
    assert solved.stress == pytest.approx(RADIUS / moment, rel=1e-4)


def test_a_guided_cylinder_is_four_times_as_stiff_as_a_slender_beam() -> None:
    """A beam held at one end and supported at the other: 4 E I/L; shear takes off with (R/L)²."""
    slender = HalfPlane(wide=5.0, narrow=5.0, end=LENGTH)
    beam = 1e-3 * YOUNG * pi * 5.0**4 / 4 / LENGTH
    assert bending(slender, "guided_end").stiffness == pytest.approx(4 * beam, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("load", LOADS)
def test_stiffnesses_of_the_solid_are_those_of_the_half_plane(load: Kind, boundary: Boundary) -> None:
    plane = torsion(HalfPlane()) if load == "torsion" else bending(HalfPlane(), boundary)
    asked = AnalysisRequest(load, boundary)
    outputs = analyse(
        shoulder(FILLET), Shaft(0.0, END), asked, ["stiffness"], lambda done, what: None
    ).outputs
    solid = outputs["stiffness"]
    assert abs(solid["value"] / plane.stiffness - 1) <= solid["error"] <= 0.01


@pytest.mark.slow
@pytest.mark.parametrize("load", LOADS)
def test_stress_at_the_fillet_of_the_solid_is_that_of_the_half_plane(load: Kind) -> None:
    compared = factor(load)
    assert abs(compared["difference"]) <= compared["estimated error"] <= 0.015
