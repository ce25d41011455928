"""Analytic: films agree with differences, a finer mesh and an exhaustive search."""

import numpy as np
import pytest

from templates.physics.cavities import transient_film
from templates.physics.cavities.transient_balance import balance, transient_mesh
from templates.physics.journals.heat_balance import OperatingPoint
from templates.physics.orbits.cyclic_film import cycle_of
from templates.physics.orbits.film_mobility import film_mobility
from templates.physics.orbits.short_mobility import short_film_under_load
from templates.physics.pads.pad_mesh import grading
from templates.physics.pads.slider_film import finite_pad
from tests.references.short_mobility import mobility_Booker_1971


@pytest.mark.parametrize("eps", [(0.2, 0.1), (0.6, -0.5)])
def test_newtons_method_knows_how_the_flow_changes_with_the_place_of_the_journal(eps):
    """Against central differences a thousand times as wide, of flows with random pressure and void."""
    journal, place, motion = transient_mesh(0.5, 24, 4), np.array(eps), (0.5, 20.0)
    P, void = np.random.default_rng(3).random((2, 24, 4))
    stored, step = np.zeros_like(P), 1e-4

    def loss(at):
        return transient_film._loss(balance(journal, at, *motion), P, void, stored)

    slopes = transient_film._by_eps(journal, place, P, void, stored, loss(place), motion)
    for slope, axis in zip(slopes, np.eye(2), strict=True):
        secant = (loss(place + step * axis) - loss(place - step * axis)) / (2 * step)
        assert slope == pytest.approx(secant, abs=1e-4 * np.abs(secant).max())


@pytest.mark.parametrize(("eps", "ratio", "direction"), [(0.5, 2.0, 0.7), (0.0, 4.0, 0.0)])
def test_the_side_flow_of_a_moving_film_converges_with_the_mesh(eps, ratio, direction):
    """With the second order, so that a coarse mesh is within 0.3 % although the film ends within a cell."""
    coarse, fine = (film_mobility(eps, ratio, direction, 8 * n, n).side_flow for n in (8, 16))
    assert coarse == pytest.approx(fine, rel=3e-3)


@pytest.mark.parametrize("away", [3.03, 2.9, 1.7, 0.02])
@pytest.mark.parametrize("gap", [1e-6, 0.1])
def test_the_peak_of_a_short_film_is_the_largest_of_all_places(gap, away):
    """p goes with cos(phi − alpha)/H³ where that is positive, alpha the direction of the velocity."""
    eps, ratio = 1 - gap, 0.5
    velocity = mobility_Booker_1971(eps, ratio, away)
    phi = np.linspace(-np.pi, np.pi, 400_001)
    height = np.cos(phi - np.arctan2(velocity[1], velocity[0])) / (gap + 2 * eps * np.sin(phi / 2) ** 2) ** 3
    P_max, side_flow = short_film_under_load(eps * np.cos(away), -eps * np.sin(away), ratio)
    assert P_max == pytest.approx(6 * ratio**2 * np.hypot(*velocity) * height.max(), rel=1e-4)
    assert side_flow == 1


@pytest.mark.parametrize(("last", "covers"), [(1.0, True), (2.0, True), (2.5, False), (3.9, False)])
def test_a_cycle_may_end_two_steps_after_its_last_angle(last, covers):
    """Angles of 1° from −180° on, the last one so many degrees before the cycle is over."""
    count = 361 - int(last)
    angle = np.radians(np.append(np.arange(-180, -180 + count - 1), 180 - last))
    assert cycle_of(angle) == pytest.approx(2 * np.pi) if covers else np.isnan(cycle_of(angle))


@pytest.mark.parametrize(("a", "width"), [(1.0, np.nan), (2.0, np.nan), (np.nan, 1.0), (np.nan, 0.0)])
def test_a_pad_of_unknown_shape_bears_nothing_that_is_known(a, width):
    pad = finite_pad(np.array([a, 2.0]), np.array([width, 1.0]), 16, 8)
    for name in ("load", "P_max", "inlet_flow", "side_flow", "centre", "peak"):
        assert np.isnan(getattr(pad, name)).tolist() == [True, False]


def test_oil_too_thin_for_the_map_loses_the_power_of_the_thinnest_film_on_it():
    """Beyond the map the journal stays at its limit: power and flow depend on the load no more."""
    numbers = dict.fromkeys(("A", "B", "a", "b", "offset", "rho_ref", "T_ref"), np.nan)
    bearing = {"D": 0.05, "W": 0.025, "psi": 1e-3, "omega_m": 100.0, "omega_s": 100.0, "eta": 1e-4}
    air = {"heat_capacity": 1.8e6, "T_supply": 313.0, "T_ambient": 293.0, "kA": 10.0}
    given = {name: np.asarray(value) for name, value in {**numbers, **bearing, **air}.items()}
    power, flow = OperatingPoint(F=np.array([1e13, 2e13, 1e15]), **given).power_and_flow(np.asarray(320.0))
    assert power == pytest.approx(power[0], rel=1e-12)
    assert flow == pytest.approx(flow[0], rel=1e-12)
    assert power[0] > 0
    inside = OperatingPoint(F=np.array([1.0]), **given).power_and_flow(np.asarray(320.0))[0]
    assert inside < power[0]


@pytest.mark.parametrize("a", [1.5, 10.0, 200.0])
@pytest.mark.parametrize("width", [0.02, 0.1])
def test_the_ends_of_a_narrow_pad_are_as_fine_as_their_layers(a, width):
    """Pressure decays within b/pi of each end; from there on each decade of x gets its share of the nodes."""
    layer = width / np.pi
    along = np.log(a) / np.array([1 - 1 / a, a - 1])  # dx/ds at inlet and outlet, h falling as exp(−s ln a)
    graded = grading(np.array([a]), np.array([width]))
    assert graded.slope(np.array([0.0, 1.0]))[0] == pytest.approx(layer * np.arcsinh(along / layer), rel=1e-9)
    assert np.sinh(graded.stretch) / graded.stretch > 1
