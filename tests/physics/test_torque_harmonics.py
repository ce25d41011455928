"""Harmonics of a torque and the swing of their sum agree with closed forms and dense sampling."""

import numpy as np
import pytest

from templates.physics.torsion.torque_harmonics import cycle_of, excitation, half_swing

NONE = np.float64(np.nan)


@pytest.mark.parametrize("lines", [1, 2, 5, 24, 60])
@pytest.mark.sampled(1)
def test_second_method_swing_against_dense_sampling(lines):
    rng = np.random.default_rng(lines)
    amplitudes = rng.normal(size=(40, lines)) + 1j * rng.normal(size=(40, lines))
    x = np.linspace(0, 2 * np.pi, 200 * lines + 1)
    curves = (amplitudes[:, :, None] * np.exp(1j * np.arange(1, lines + 1)[:, None] * x)).real.sum(axis=1)
    dense = np.ptp(curves, axis=1) / 2
    swing = half_swing(amplitudes)
    assert np.all(swing >= dense * (1 - 1e-12))
    assert swing == pytest.approx(dense, rel=3e-4)


def test_analytic_swing_of_two_orders():
    """cos x + a cos 2x with a < 1/4 has its extremes at 0 and pi: half their difference is 1."""
    assert half_swing(np.array([[1.0, 0.2]], complex))[0] == pytest.approx(1, rel=1e-12)
    assert half_swing(np.array([[1.0, 1.0]], complex))[0] == pytest.approx((2 + 1.125) / 2, rel=1e-9)


@pytest.mark.parametrize(("turns", "strokes"), [(1, 2), (2, 4)])
def test_analytic_harmonics_of_a_cycle(turns, strokes):
    theta = np.arange(0, 360 * turns, 5.0)
    order = 0.5 if strokes == 4 else 3.0
    T = 7 + 4 * np.cos(order * np.radians(theta) + 0.3)
    lines = excitation(np.radians(theta), T, NONE, NONE, np.float64(6))
    assert lines.orders[:2] == pytest.approx([2 / strokes, 4 / strokes])
    at = np.argmin(np.abs(lines.orders - order))
    assert lines.gas[at] == pytest.approx(4 * np.exp(0.3j), rel=1e-12)
    assert np.all(np.abs(np.delete(lines.gas, at)) < 1e-12)
    assert np.all(lines.inertia == 0)


@pytest.mark.parametrize("theta", [
    np.arange(0, 700, 10.0), np.arange(0, 360, 60.0), np.arange(720, 0, -10.0), np.full(72, 3.0),
    np.append(np.arange(0, 710, 10.0), 715.0),
])  # fmt: skip
def test_property_what_is_no_cycle(theta):
    assert cycle_of(np.radians(theta)) is None


@pytest.mark.parametrize("count", [72, 73])
def test_property_a_repeated_last_point_is_not_counted(count):
    cycle = cycle_of(np.radians(10.0 * np.arange(count)))
    assert (cycle.count, cycle.strokes) == (72, 4)
