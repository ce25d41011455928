"""The transient film conserves oil and agrees with the static limit."""

import numpy as np
import pytest

from templates.core.arrays import Array
from templates.physics.cavities.cavitating_film import measured, solved_ring
from templates.physics.cavities.cavitating_network import Groove
from templates.physics.cavities.transient_balance import Journal, balance, transient_mesh
from templates.physics.cavities.transient_film import State, stepped
from templates.physics.orbits.journal_orbit import CyclicLoad, periodic_orbit
from templates.physics.orbits.mobility_law import MapLaw
from templates.physics.orbits.transient_orbit import MarchSettings, transient_orbit

STEP = np.radians(4.0)


def full(journal: Journal, eps: Array) -> State:
    nothing = np.zeros((journal.phi.size, journal.zeta.size - 1))
    return State(eps, nothing, nothing, journal.gap(eps, journal.phi)[:, None] + nothing)


def marched(journal: Journal, eps: Array, loads: Array, w: float) -> list[State]:
    """States of first order in time, from a full film."""
    states = [full(journal, eps)]
    for load in loads:
        after = stepped(journal, states[-1], load, w, 1 / STEP, -states[-1].content / STEP)
        assert after is not None
        states.append(after)
    return states


@pytest.mark.parametrize(
    ("eps", "ratio"),
    [
        (0.8, 0.5),
        pytest.param(0.5, 0.5, marks=pytest.mark.slow),
        pytest.param(0.7, 1.0, marks=pytest.mark.slow),
    ],
)
def test_constant_load_settles_in_the_static_cavitating_film(eps: float, ratio: float) -> None:
    """That of oil_film 2 with oil fed along the widest gap, on a mesh four times as fine."""
    static = measured(solved_ring(eps, ratio, [Groove(np.pi, 0.0)]))
    loads = np.full((250, 2), [static.So, 0.0])
    settled = marched(transient_mesh(ratio, 96, 6), np.array([0.3, 0.3]), loads, 0.5)[-1].eps
    assert np.hypot(*settled) == pytest.approx(eps, rel=5e-3)
    assert np.arctan2(settled[1], settled[0]) == pytest.approx(static.attitude, abs=np.radians(1.0))


def test_every_step_bears_its_load_and_keeps_its_oil() -> None:
    """Force balance; and content gained is what is fed less what leaves, the fed row aside."""
    journal, turn = transient_mesh(0.5, 48, 4), np.arange(60) * STEP
    loads = np.stack([2 + np.cos(turn), np.sin(turn)], axis=-1)
    states = marched(journal, np.array([0.2, 0.0]), loads, 0.5)
    for before, after, load in zip(states, states[1:], loads, strict=False):
        assert journal.load(after.P) == pytest.approx(load, rel=1e-6)
        assert after.P.min() >= 0
        assert after.void.min() >= 0
        assert after.void.max() <= 1
        assert np.abs(after.P * after.void).max() < 1e-6 * after.P.max()
        flows = balance(journal, after.eps, 0.5, 1 / STEP)
        stored = 12 * before.content / STEP * (2 * np.pi / 48) * flows.width
        loss = flows.by_pressure(after.P) + flows.by_fill(1 - after.void) - stored
        feed = journal.gap(before.eps, journal.phi).argmax()
        assert np.abs(np.delete(loss, feed, axis=0)).max() < 1e-5 * np.abs(flows.carried).max()


def test_linear_solution_is_that_of_the_flows() -> None:
    rng = np.random.default_rng(2)
    for w in (0.5, -0.5):
        journal = transient_mesh(0.7, 20, 4)
        flows = balance(journal, np.array([0.5, 0.3]), w, 20.0)
        alpha, beta = rng.random((2, 20, 4)) + 0.5
        columns = rng.random((2, 20, 4))
        for k, column in zip(flows.solve(alpha, beta, columns, 7), columns, strict=True):
            back = flows.by_pressure(alpha * k) + flows.by_fill(beta * k)
            assert np.delete(back, 7, axis=0) == pytest.approx(np.delete(column, 7, axis=0), rel=1e-9)
            assert np.abs(k[7]).max() < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("w", [-0.5, pytest.param(0.5, marks=pytest.mark.slow)])
def test_orbit_repeats_near_that_by_mobility(w: float) -> None:
    """A load that swings about a mean: the same film, but for the history of its oil and a coarse mesh."""
    angle = np.arange(90) * np.radians(4.0)
    S = np.stack([2 + 1.5 * np.cos(angle), np.sin(angle)])[:, None]
    load = CyclicLoad(angle, 2 * np.pi, S, np.full((1, 90), w))
    by_mobility = periodic_orbit(load, MapLaw(np.array([0.5])))
    result = transient_orbit(load, 0.5, by_mobility.eps[:, 0, 0], MarchSettings(64, 4, STEP))
    assert result is not None
    assert 1 < result.cycles < 8
    gap = 1 - np.hypot(*result.eps)
    assert gap.min() == pytest.approx(by_mobility.least_gap[0], rel=0.1)
    assert result.P_max.min() > 0
    assert np.all(result.shear < np.pi / np.sqrt(gap * (2 - gap)) * 1.05)
    assert np.all(result.side_flow > 0)


@pytest.mark.slow
def test_mirrored_load_and_speed_give_the_mirrored_orbit() -> None:
    angle = np.arange(60) * np.radians(6.0)
    S = np.stack([2 + np.cos(angle), np.sin(angle)])[:, None]
    marching, mirror = MarchSettings(48, 4, np.radians(6.0)), np.array([1.0, -1.0])
    one = transient_orbit(
        CyclicLoad(angle, 2 * np.pi, S, np.full((1, 60), 0.5)), 0.5, np.array([0.5, 0.2]), marching
    )
    two = transient_orbit(
        CyclicLoad(angle, 2 * np.pi, S * mirror[:, None, None], np.full((1, 60), -0.5)),
        0.5, np.array([0.5, -0.2]), marching,
    )  # fmt: skip
    assert one is not None
    assert two is not None
    assert two.eps == pytest.approx(one.eps * mirror[:, None], abs=2e-3)


def test_load_that_no_film_bears_is_given_up() -> None:
    """A load that turns with the film leaves no wedge: the gap closes without end."""
    angle = np.arange(36) * np.radians(10.0)
    S = np.stack([np.full(36, 50.0), np.zeros(36)])[:, None]
    load = CyclicLoad(angle, 2 * np.pi, S, np.zeros((1, 36)))
    assert transient_orbit(load, 0.5, np.zeros(2), MarchSettings(48, 4, np.radians(10.0))) is None
