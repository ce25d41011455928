"""Analytic: convergence of an orbit, on an artificial film whose every cycle is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from templates.physics.cavities.transient_balance import transient_mesh
from templates.physics.cavities.transient_film import State
from templates.physics.orbits import transient_orbit
from templates.physics.orbits.journal_orbit import CyclicLoad
from templates.physics.orbits.transient_orbit import (
    MOST_CYCLES,
    REPEATS,
    MarchSettings,
    along_march,
    sampled_orbit,
)

ANGLE = np.radians(np.arange(-170.0, 190.0, 30.0))
LOAD = CyclicLoad(ANGLE, 2 * np.pi, np.ones((2, 1, 12)), np.full((1, 12), 0.5))
MARCHING = MarchSettings(around=8, across=2, step=np.radians(30.0))
SMALLEST_GAP = 0.02
CIRCLE = ((np.cos, np.sin), (lambda angle: -np.sin(angle), np.cos))  # a place on it, the direction ahead


def run_in(monkeypatch, decay):
    """An orbit whose distance from its last one, half the clearance at first, decays from cycle to cycle.

    The film is full and bears what its place makes up; its gap is smallest at the fourth node.
    """
    steps = []

    def following(journal, states, S, w, step):
        steps.append(step)
        cycle, k = divmod(len(steps) - 1, 12)
        thickness = SMALLEST_GAP + 0.01 * abs(k - 3) + 0.5 * decay ** (cycle + 1)
        nothing = np.zeros_like(states[-1].P)
        return State(np.array([1 - thickness, 0.0]), nothing + 1, nothing, nothing + 1)

    monkeypatch.setattr(transient_orbit, "_next", following)
    return transient_orbit.transient_orbit(LOAD, 0.5, np.zeros(2), MARCHING), steps


@pytest.mark.parametrize("decay", [0.02, 0.1, 0.2])
def test_an_orbit_repeats_once_two_cycles_differ_by_a_share_of_the_gap(monkeypatch, decay):
    orbit, steps = run_in(monkeypatch, decay)
    cycles = np.arange(2, MOST_CYCLES + 1)
    change = 0.5 * (decay ** (cycles - 1) - decay**cycles)
    repeats = change < REPEATS * (SMALLEST_GAP + 0.5 * decay**cycles)
    assert orbit.cycles == cycles[repeats][0]
    assert len(steps) == 12 * orbit.cycles
    assert steps == pytest.approx([np.radians(30)] * len(steps))
    assert 1 - np.hypot(*orbit.eps).max() == pytest.approx(SMALLEST_GAP + 0.5 * decay**orbit.cycles)


def test_an_orbit_that_does_not_repeat_is_given_up(monkeypatch):
    orbit, steps = run_in(monkeypatch, 0.9)
    assert orbit is None
    assert len(steps) == 12 * MOST_CYCLES


def test_the_smallest_gap_of_a_marched_orbit_is_where_its_node_is_in_the_cycle_of_the_load(monkeypatch):
    orbit, _ = run_in(monkeypatch, 0.02)
    sampled = sampled_orbit(orbit, LOAD)
    assert sampled.least_gap[0] == pytest.approx(1 - np.hypot(*orbit.eps).max())
    assert sampled.least_angle[0] == pytest.approx(np.radians(-170 + 4 * 30))
    assert ANGLE[0] <= sampled.least_angle[0] < ANGLE[0] + 2 * np.pi
    assert sampled.eps[:, 0] == pytest.approx(np.roll(orbit.eps, 1, axis=1))


@pytest.mark.parametrize("ratio", [0.3, 1.0])
@pytest.mark.parametrize("eps", [(0.0, 0.0), (0.3, -0.4)])
def test_shear_and_side_flow_of_a_full_film_of_even_pressure(ratio, eps):
    """Shear as of Sommerfeld's film; 1 + 3 ε²/2 times the flow of a centred journal out of both ends."""
    journal = transient_mesh(ratio, 128, 4)
    even = np.ones((128, 4))
    state = State(np.array(eps), 3 * even, 0 * even, even)
    orbit = transient_orbit._measured(journal, np.zeros(1), [state], 1)
    e2, edge = eps[0] ** 2 + eps[1] ** 2, np.diff(journal.zeta)[-1]
    assert orbit.shear == pytest.approx(np.pi / np.sqrt(1 - e2))
    assert orbit.side_flow == pytest.approx(3 / edge * 2 * np.pi * (1 + 1.5 * e2) / (24 * ratio**2))
    assert orbit.P_max == 3


@pytest.mark.parametrize("turns", [1, 2])
def test_analytic_work_of_a_force_along_a_circle(turns):
    """A force of 1 along the path of a journal on a circle of radius 0.4: power 0.4 a radian and turn."""
    angle = np.radians(np.arange(360.0))
    circle, ahead = (np.stack([f(turns * angle), g(turns * angle)]) for f, g in CIRCLE)
    nothing = np.zeros(360)
    orbit = SimpleNamespace(eps=0.4 * circle, place=angle, P_max=nothing, side_flow=nothing, shear=nothing)
    load = CyclicLoad(angle, 2 * np.pi, ahead[:, None], np.zeros((1, 360)))
    work = along_march(orbit, load, orbit.eps[:, None])[3]
    assert work == pytest.approx(np.full((1, 360), 0.4 * turns), rel=1e-3)
