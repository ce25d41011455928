"""Analytic: the slider-crank agrees with geometry, differences and quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad

from templates.physics.engine.slider_crank import (
    angle_of_travel,
    crank_angles,
    crank_motion,
    steps_in,
    travel_integral,
)

THETA = np.linspace(0.1, 12.4, 57)
STEP = 1e-4


def geometry(theta, n):
    """Angle of the rod, way of the piston from top dead centre over the crank radius; nothing cancels."""
    phi = np.arcsin(np.sin(theta) / n)
    return phi, 2 * np.sin(theta / 2) ** 2 + 2 * n * np.sin(phi / 2) ** 2


def differences(n, which):
    """First and second central differences of one part of the geometry."""
    before, here, after = (geometry(THETA + shift, n)[which] for shift in (-STEP, 0, STEP))
    return (after - before) / (2 * STEP), (after - 2 * here + before) / STEP**2


@pytest.mark.parametrize("n", [1.5, 3.2, 40.0])
def test_rod_and_piston_move_as_their_geometry_says(n):
    motion = crank_motion(THETA, np.asarray(n))
    phi, way = geometry(THETA, n)
    assert np.arctan(motion.tan_phi) == pytest.approx(phi, abs=1e-12)
    assert motion.q == pytest.approx(n * np.cos(phi))
    assert 2 * motion.travel == pytest.approx(way, abs=1e-12)
    (rod, rod_rate), (piston, piston_rate) = differences(n, 0), differences(n, 1)
    assert motion.rod_velocity == pytest.approx(rod, abs=1e-6)
    assert motion.rod_acceleration == pytest.approx(rod_rate, abs=1e-6)
    assert motion.lever == pytest.approx(piston, abs=1e-6)
    assert motion.acceleration == pytest.approx(-piston_rate, abs=1e-6)


@pytest.mark.parametrize("n", [1.5, 3.2])
def test_travel_is_integrated_and_inverted(n):
    for end in (0.4, 3.0, 9.0):
        exact = quad(lambda theta: geometry(theta, n)[1] / 2, 0, end, epsabs=1e-12, limit=200)[0]
        assert travel_integral(np.asarray(end), np.asarray(n)) == pytest.approx(exact, rel=1e-9)
    theta = np.linspace(0, np.pi, 21)
    travel = crank_motion(theta, np.asarray(n)).travel
    assert angle_of_travel(travel, np.asarray(n)) == pytest.approx(theta, abs=1e-7)


def test_dead_centres_and_right_angles_are_exact():
    motion = crank_motion(np.pi * np.arange(5), np.asarray(4.0))
    assert motion.sin.tolist() == motion.lever.tolist() == [0] * 5
    assert crank_motion(np.pi / 2 + np.pi * np.arange(4), np.asarray(4.0)).cos.tolist() == [0] * 4


@pytest.mark.parametrize("strokes", [2, 4])
def test_a_cycle_does_not_repeat_its_begin(strokes):
    step = np.asarray(np.pi / 6)
    angles = crank_angles(np.asarray(strokes), step)
    assert steps_in(np.asarray(strokes), step) == pytest.approx(6 * strokes)
    assert angles == pytest.approx(np.pi / 6 * np.arange(6 * strokes))
