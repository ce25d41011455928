"""Analytic: films by differences, by a finer mesh and by a search of every place, where errors hide."""

import numpy as np
import pytest

from templates.physics.cavities import transient_film
from templates.physics.cavities.transient_balance import balance, transient_mesh
from templates.physics.orbits.film_mobility import film_mobility
from templates.physics.orbits.short_mobility import mobility_Booker_1971, short_film_under_load


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
