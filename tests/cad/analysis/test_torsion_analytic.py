"""Analytic: shafts of which stiffness and frequency are known; halves that must equal their wholes."""

from math import pi, sqrt

import pytest
from cadquery import Shape, Workplane

from cad.analysis.elastic import System, respond
from cad.analysis.levels import LEVELS
from cad.analysis.mesh import make_grid
from cad.analysis.modes import torsional_mode
from cad.analysis.solid import Solid, read_solid
from cad.header import Header
from cad.model import STEEL_MATERIAL, Part, Shaft
from cad.step import write_step

SHEAR = STEEL_MATERIAL.young / 2 / (1 + STEEL_MATERIAL.poisson)
FINE = LEVELS[-1]


def shaft_of(workplane: Workplane, length: float, mirrors: tuple[str, ...] = ("y", "x")) -> Solid:
    shape = workplane.val()
    assert isinstance(shape, Shape)
    step = write_step((Part("shaft", shape, 1.0),), Header("shaft", 1, {}, "0" * 64))
    return read_solid(step, Shaft(0.0, length), mirrors)


def test_a_circular_shaft_twists_and_vibrates_as_coulomb_says() -> None:
    """K = G I_p / l and f = sqrt(G / rho) / (4 l), exact for a circular section, held and free."""
    solid = shaft_of(Workplane().circle(25).extrude(200), 200)
    system = System(make_grid(solid, FINE.fineness), FINE.order, STEEL_MATERIAL, "torsion")
    response = respond(system, "free_end")
    stiffness = SHEAR * pi / 32 * 0.05**4 / 0.2
    assert 1e-3 / response.compliance == pytest.approx(stiffness, rel=5e-4)
    frequency = sqrt(SHEAR / STEEL_MATERIAL.density) / 0.8
    assert torsional_mode(response).frequency == pytest.approx(frequency, rel=5e-4)


def test_a_square_bar_has_saint_venants_torsion_constant() -> None:
    """0.140577 a⁴ (de Saint-Venant 1855), from two lengths: what the ends do cancels in the difference."""
    compliance = []
    for length in (100.0, 160.0):
        solid = shaft_of(Workplane().rect(40, 40).extrude(length), length)
        system = System(make_grid(solid, FINE.fineness), FINE.order, STEEL_MATERIAL, "torsion")
        compliance.append(respond(system, "free_end").compliance * 1e3)
    constant = 0.06 / (compliance[1] - compliance[0]) / SHEAR
    assert constant == pytest.approx(0.140577 * 0.04**4, rel=2e-3)


def test_half_of_a_shaft_tells_as_much_as_the_whole() -> None:
    block = Workplane().rect(40, 30).extrude(60)
    told = []
    for mirrors in (("y",), ()):
        solid = shaft_of(block, 60, mirrors)
        system = System(make_grid(solid, FINE.fineness), FINE.order, STEEL_MATERIAL, "torsion")
        told.append(respond(system, "guided_end").compliance)
    assert told[0] == pytest.approx(told[1], rel=5e-4)


def test_a_solid_that_does_not_mirror_itself_is_not_halved() -> None:
    block = Workplane().rect(40, 40).extrude(60)
    lopsided = block.cut(Workplane().center(15, 12).circle(3).extrude(60))
    assert shaft_of(block, 60).mirror == "y"
    assert shaft_of(lopsided, 60).mirror == ""
