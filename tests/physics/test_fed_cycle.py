"""Films with the supply of an engine: motion of sleeve and journal, holes under the load, level supplied.

Analytic: closed angles and shares; the static film of oil_film 2 with the same groove.
"""

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.oil_film.oil_film_v2 import OilFilm
from templates.physics.orbits.cyclic_film import Duty
from templates.physics.orbits.grooved_mobility import Groove
from templates.physics.orbits.journal_orbit import CyclicLoad
from templates.physics.orbits.rotation import turning
from templates.physics.supplied.supplied_march import Duty as FilmDuty
from templates.physics.supplied.supplied_mesh import supplied_mesh
from templates.physics.supplied.supplied_orbit import under_load
from templates.physics.supplied.supply import Pocket, Supply
from templates.physics.supplied.supply_geometry import SupplyGeometry, feed_under_load

D, PSI, ETA, OMEGA, RATIO = 0.1, 1e-3, 0.02, 300.0, 0.5
COUNT = 24
ANGLE = np.arange(COUNT) * 2 * np.pi / COUNT
SCALE = ETA * OMEGA * D * D * RATIO / PSI**2
PIN = {"pin_hole_length": "5 mm", "supply_pressure": "3 bar"}


def si(value, unit):
    return {"value": np.asarray(value, dtype=float).tolist(), "unit": unit}


def inputs(x, y, **changes):
    x, y = (np.broadcast_to(np.asarray(v, dtype=float), (COUNT,)) for v in (x, y))
    return {
        "crank_angle": si(np.degrees(ANGLE), "deg"),
        "load_x": si(x * SCALE, "N"),
        "load_y": si(y * SCALE, "N"),
        "speed": si(OMEGA, "rad/s"),
        "bearing_diameter": si(D, "m"),
        "bearing_width": si(D * RATIO, "m"),
        "diametral_clearance": si(D * PSI, "m"),
        "dynamic_viscosity": si(ETA, "Pa*s"),
        **changes,
    }


def marched(raw, **keywords):
    return evaluate(OilFilmCycle, raw, level="supplied", **keywords)


def test_analytic_rod_swings_by_the_angle_of_the_crank_triangle():
    for start in (0.0, -1.0, 7.0):
        angle = start + np.radians(np.arange(0, 720, 2.0))
        speed = -np.cos(angle) / np.sqrt(16 - np.sin(angle) ** 2)
        rod = turning(angle, 4 * np.pi, speed[None])
        assert rod.turns == 0
        assert rod.at(angle, rod.swing)[0] == pytest.approx(-np.arcsin(np.sin(angle) / 4), abs=2e-4)


def test_analytic_even_turning_is_whole_turns_or_none():
    angle = np.radians(np.arange(0, 720, 10.0))
    motion = turning(angle, 4 * np.pi, np.array([[1.0], [-1.0], [0.5], [0.3]]) * np.ones(angle.size))
    assert motion.turns[:3].tolist() == [2, -2, 1]
    assert np.isnan(motion.turns[3])
    assert motion.at(angle, motion.swing)[0] == pytest.approx(angle)


def test_analytic_share_of_the_sector_about_the_load():
    quarter = np.pi / 2
    groove = Groove(np.array([0.2]), np.array([0.0]), np.array([np.pi]))
    direction = np.array([[quarter, 0.0, np.pi, -quarter, np.pi / 4, 2 * np.pi + np.pi / 8, -np.pi / 8]])
    assert groove.covers(direction)[0] == pytest.approx([1, 0.5, 0.5, 0, 1, 0.75, 0.25])
    everywhere = Groove(np.array([0.2]), np.array([1.0]), np.array([2 * np.pi]))
    assert everywhere.covers(direction) == pytest.approx(1)
    none = Groove(np.array([0.0]), np.array([1.0]), np.array([2 * np.pi]))
    assert none.covers(direction) == pytest.approx(0)


def test_analytic_a_hole_in_a_pin_at_half_speed_stays_under_a_load_that_turns_with_it():
    """The pin turns once in a cycle of two turns of the crank. At the crank's own speed it lies within 60° of
    the load for a third of that cycle."""
    angle, none = np.radians(np.arange(0, 720, 5.0)), np.array(np.nan)
    hole = SupplyGeometry(np.array(D), np.array(D * RATIO), *[none] * 6, *map(np.array, (5e-3, 5e-3, 0.0)))
    load = np.cos(angle / 2), np.sin(angle / 2)
    for speed, share in ((OMEGA / 2, 1.0), (OMEGA, 1 / 3)):
        speeds = map(np.array, (speed, 0.0, 0.0, OMEGA))
        duty = Duty(angle, *load, *speeds, np.array(SCALE), np.array(RATIO))
        assert feed_under_load(duty, hole) == pytest.approx(share, abs=2 / 144)


@pytest.mark.parametrize("centre", np.radians([-170.0, -50.0, 0.0, 100.0, 350.0]))
def test_analytic_a_load_that_turns_once_lies_over_a_hole_for_a_third_of_the_cycle(centre):
    load = CyclicLoad(
        ANGLE, 2 * np.pi, np.stack([np.cos(ANGLE), np.sin(ANGLE)])[:, None], np.zeros((1, COUNT))
    )
    supply = Supply((Pocket(float(centre), 0.1, 0.3),), 0.3)
    assert under_load(FilmDuty(load, np.zeros(COUNT), supply, 0.0)) == pytest.approx(1 / 3, abs=2 / 720)


@pytest.mark.parametrize("around", range(32, 400, 2))
def test_property_rows_of_a_mesh_are_numbered_once(around):
    """π comes out a rounding too large at half of 94 nodes."""
    order = supplied_mesh(0.5, around, 4).order
    assert sorted(order) == list(range(around))
    apart = np.abs(order - np.roll(order, 1))
    assert apart.max() <= 2


@pytest.mark.slow  # test_supplied_orbit.py has the same of other grooves in the quick lane
def test_analytic_constant_load_is_the_static_film_with_the_same_groove():
    """oil_film 2 counts the angle of a groove from the load; here the load points along x."""
    groove = {"groove_width": "10 mm", "groove_start": "90 deg", "groove_extent": "180 deg"}
    fed = marched(inputs(3.0, 0.0, **groove, supply_pressure="3 bar"))
    film = {name: answer.value for name, answer in fed.outputs.items()}
    assert film["verdict"] == "repeating"
    assert np.ptp(film["film_thickness"]) < 2e-3 * film["minimum_film_thickness"]
    plain = {
        "radial_load": si(3.0 * SCALE, "N"), "speed": si(OMEGA, "rad/s"), "bearing_diameter": si(D, "m"),
        "bearing_width": si(D * RATIO, "m"), "diametral_clearance": si(D * PSI, "m"),
        "dynamic_viscosity": si(ETA, "Pa*s"),
    }  # fmt: skip
    static = evaluate(OilFilm, plain, level="map").outputs
    assert film["minimum_film_thickness"] == pytest.approx(static["minimum_film_thickness"].value, rel=0.05)
    assert film["power_loss"] == pytest.approx(static["power_loss"].value, rel=0.4)
    assert film["supply_flow"] == pytest.approx(film["side_flow"], rel=2e-3)


@pytest.mark.slow
def test_property_hole_that_stays_under_the_load_starves_and_is_refused_by_that_name():
    """What does not need the film is answered; of several points the others are."""
    turning_load = inputs(4 * np.cos(ANGLE), 4 * np.sin(ANGLE), **PIN)
    with pytest.raises(InvalidInputs, match=r"hole stays under the load.*move the groove") as info:
        marched(turning_load)
    assert [fault.code for fault in info.value.faults] == ["starved"]
    answers = marched(turning_load, outputs=["verdict", "feed_under_load", "cycles_run"]).outputs
    assert answers["verdict"].value == "starved"
    assert answers["feed_under_load"].value == pytest.approx(1)
    assert answers["cycles_run"].value > 1


@pytest.mark.slow
def test_property_oil_of_the_cycle_balances():
    x = 2 + 3 * np.exp(6 * (np.cos(ANGLE - 0.4) - 1)) + 0.5 * np.cos(2 * ANGLE)
    answers = marched(inputs(x, np.sin(ANGLE), **PIN)).outputs
    assert answers["verdict"].value in ("repeating", "wandering")
    assert 5e-3 < answers["numerical_error"].value < 0.06  # mesh and step are in it
    assert abs(answers["mass_balance"].value) < 1e-4
    assert answers["supply_flow"].value == pytest.approx(answers["side_flow"].value, rel=5e-3)
    assert answers["minimum_film_thickness"].value <= answers["film_thickness"].value.min() * (1 + 1e-9)
