"""Orbits of supplied films agree with the static film, two short bearings, invariances and convergence."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.supplied_duties import GROOVES, random_duty
from templates.core.arrays import Array
from templates.core.progress import reporting
from templates.physics.cavities.cavitating_film import measured, solved_ring
from templates.physics.cavities.cavitating_network import Groove
from templates.physics.orbits.journal_orbit import CyclicLoad
from templates.physics.supplied.supplied_orbit import (
    COARSE,
    FINE,
    MeshSettings,
    SuppliedOrbit,
    Verdict,
    supplied_orbit,
)
from templates.physics.supplied.supply import Pocket, Supply

QUICK = (replace(COARSE, around=48), replace(COARSE, step=np.radians(3.0)))
ANGLE = np.arange(72) * np.pi / 36


def constant(
    S: float, ratio: float, supply: Supply, meshes: tuple[MeshSettings, ...] = QUICK
) -> SuppliedOrbit:
    """The orbit under a load at rest along x, the sleeve at rest too."""
    load = CyclicLoad(
        ANGLE, 2 * np.pi, np.array([S, 0.0])[:, None, None] * np.ones(72), np.full((1, 72), 0.5)
    )
    return supplied_orbit(load, np.ones(72), ratio, supply, meshes)


def swinging(turn: float = 0.0, frame: float = 0.0, mass: float = 2.5e-4) -> tuple[SuppliedOrbit, Array]:
    """The orbit under a load that swings, all turned by an angle, in a turning frame; at the load's angles.

    The orbit that is returned as e_x + i e_y is turned back, and seen from the frame at rest.
    """
    angle = np.arange(360) * np.pi / 180
    F = (4 + 3 * np.cos(angle) + 2j * np.sin(angle)) * np.exp(1j * (turn - frame * angle))
    load = CyclicLoad(angle, 2 * np.pi, np.stack([F.real, F.imag])[:, None], np.full((1, 360), 0.5 - frame))
    supply = Supply((Pocket(2.0 + turn, 0.2, 0.3), Pocket(-1.0 + turn, 0.2, 0.3, on_journal=True)), 0.3)
    orbit = supplied_orbit(load, np.ones(360), 0.4, supply, QUICK, mass)
    z = np.interp(angle, orbit.theta, orbit.eps[0] + 1j * orbit.eps[1], period=2 * np.pi)
    return orbit, z * np.exp(1j * (frame * angle - turn))


def static(eps: float, ratio: float, pocket: Pocket, pressure: float) -> tuple[float, float]:
    """Load and attitude of the static mass-conserving film, extrapolated; pocket from the narrowest gap."""
    groove = Groove(pocket.centre, 2 * pocket.half_angle, pocket.half_length, pressure)
    coarse, fine = (
        measured(solved_ring(eps, ratio, [groove], around=n, across=m)) for n, m in ((64, 8), (128, 16))
    )
    return 2 * fine.So - coarse.So, 2 * fine.attitude - coarse.attitude


CASES = [
    (0.85, 0.4, Pocket(2.5, np.radians(10), 0.5), 0.2),
    (0.8, 1.0, Pocket(np.pi, np.radians(10), 0.7), 0.05),
    pytest.param(0.6, 0.4, Pocket(np.pi, np.radians(10), 0.5), 0.2, marks=pytest.mark.slow),
]


@pytest.mark.sampled(1)
@pytest.mark.parametrize(("eps", "ratio", "pocket", "pressure"), CASES)
def test_constant_load_settles_in_the_static_film(
    eps: float, ratio: float, pocket: Pocket, pressure: float
) -> None:
    """Two discretisations: this one at its default mesh within 1 %, attitude within 0.5°."""
    So, attitude = static(eps, ratio, pocket, pressure)
    supply = Supply((replace(pocket, centre=pocket.centre + attitude),), pressure)
    orbit = constant(So, ratio, supply, (COARSE, FINE))
    assert orbit.verdict is Verdict.REPEATING
    assert orbit.gap == pytest.approx(1 - eps, rel=0.01)
    assert np.arctan2(*orbit.eps.mean(axis=1)[::-1]) == pytest.approx(attitude, abs=np.radians(0.5))
    assert abs(orbit.mass_balance) < 5e-3


def test_full_groove_makes_two_short_bearings() -> None:
    """Each bears half of what Ocvirk's closed form of the land's width gives; at eps 0.8 it holds to 1 %."""
    eps, ratio, edge = 0.8, 0.2, 0.25
    land = (1 - edge) * ratio / 2
    So = land**2 * eps * np.sqrt(np.pi**2 * (1 - eps**2) + 16 * eps**2) / (1 - eps**2) ** 2 / 2
    groove = Supply((Pocket(0.0, np.pi, edge),), 0.02)
    orbit = constant((1 - edge) * So, ratio, groove)
    assert orbit.gap == pytest.approx(1 - eps, rel=0.01)
    wider = Supply((Pocket(0.0, np.pi, 1 - (1 - edge) / 2),), 0.02)
    same = constant((1 - edge) * So / 2, 2 * ratio, wider)
    assert same.gap.mean() == pytest.approx(orbit.gap.mean(), rel=2e-3)


@pytest.mark.slow
def test_turned_as_a_whole_the_orbit_turns() -> None:
    """By whole cells it is the same to rounding, by part of one to the error of the mesh."""
    orbit, z = swinging()
    for turn, limit in ((np.radians(90.0), 1e-6), (np.radians(40.0), 0.02)):
        turned, seen = swinging(turn)
        assert turned.least_gap == pytest.approx(orbit.least_gap, rel=limit)
        assert np.abs(seen - z).max() < limit


@pytest.mark.slow
def test_the_frame_may_turn() -> None:
    orbit, z = swinging()
    for frame in (1.0, -1.0):
        turned, seen = swinging(frame=frame)
        assert turned.least_gap == pytest.approx(orbit.least_gap, rel=2e-3)
        assert np.abs(seen - z).max() < 2e-3


@pytest.mark.slow
def test_without_mass_the_orbit_is_nearly_the_same() -> None:
    heavy, light, none = (swinging(mass=mass)[0].least_gap for mass in (2.5e-3, 2.5e-4, 0.0))
    assert light == pytest.approx(none, rel=1e-3)
    assert abs(light - none) < abs(heavy - none)


def test_curves_are_of_one_cycle_and_the_oil_is_kept() -> None:
    orbit, _ = swinging()
    assert orbit.verdict is Verdict.REPEATING
    assert (np.diff(orbit.theta) > 0).all()
    assert orbit.theta[-1] == pytest.approx(2 * np.pi)
    assert orbit.gap == pytest.approx(1 - np.hypot(*orbit.eps))
    assert orbit.least_gap <= orbit.gap.min()
    assert abs(orbit.mass_balance) < 0.01
    assert ((orbit.void >= 0) & (orbit.void < 1)).all()
    assert (orbit.shear < np.pi / np.sqrt(orbit.gap * (2 - orbit.gap)) * 1.05).all()
    assert 0 < orbit.feed.mean() < 1
    assert orbit.under_load == 0


@pytest.mark.slow
def test_hole_under_the_load_starves() -> None:
    """The pin hole of a two-stroke big end, under the load for most of the cycle: its film thins at last."""
    duty = random_duty(17, 40)
    orbit = supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply)
    assert orbit.verdict is Verdict.STARVED
    assert orbit.under_load > 0.7
    assert orbit.reason.startswith("starved: the hole stays under the load, within 60° of it for ")
    assert len(orbit.cycles) == 1
    assert sum(orbit.cycles) <= COARSE.most


def test_a_pocket_in_the_load_line_settles_where_the_static_film_bears_the_load() -> None:
    """A pocket from -30° to -10° of the load: two discretisations, load within 2 %, attitude within 0.2°."""
    pocket = Pocket(np.radians(-20.0), np.radians(10.0), 0.85)
    orbit = constant(1.0, 0.4, Supply((pocket,), 0.2), (COARSE, FINE))
    assert orbit.verdict is Verdict.REPEATING
    assert orbit.under_load == 1
    attitude = np.arctan2(*orbit.eps[::-1, -1])
    fed = replace(pocket, centre=pocket.centre - attitude)
    So, same = static(float(np.hypot(*orbit.eps[:, -1])), 0.4, fed, 0.2)
    assert So == pytest.approx(1.0, rel=0.02)
    assert same == pytest.approx(attitude, abs=np.radians(0.2))


def test_a_journal_that_floats_on_its_supply_is_not_called_starved() -> None:
    orbit = constant(0.0107, 0.2, Supply((Pocket(0.0, np.pi, 0.25),), 0.2), QUICK[:1])
    assert orbit.verdict is not Verdict.STARVED


@pytest.mark.slow
def test_a_load_that_no_film_bears_has_no_least_gap() -> None:
    orbit = constant(1e6, 0.4, Supply((Pocket(np.pi, 0.2, 0.3),), 0.2))
    assert orbit.verdict is Verdict.UNSETTLED
    assert np.isnan(orbit.least_gap)
    assert orbit.reason.startswith("no orbit repeats")


def test_progress_rises_and_a_reporter_may_cancel() -> None:
    said: list[float] = []
    supply = Supply((Pocket(np.pi, 0.2, 0.3),), 0.2)
    with reporting(lambda fraction, _: said.append(fraction)):
        constant(3.0, 0.4, supply)
    assert len(said) > 10
    assert (np.diff(said) >= 0).all()
    assert 0 <= said[0] < said[-1] < 1

    def cancel(fraction: float, _: str) -> None:
        if fraction > 0:
            raise InterruptedError

    with reporting(cancel), pytest.raises(InterruptedError):
        constant(3.0, 0.4, supply)


def test_a_hole_that_does_not_come_back_is_refused() -> None:
    load = CyclicLoad(ANGLE, 2 * np.pi, np.ones((2, 1, 72)), np.full((1, 72), 0.5))
    hole = Supply((Pocket(0.0, 0.1, 0.3, on_journal=True),), 0.2)
    with pytest.raises(ValueError, match="18° away from its initial position"):
        supplied_orbit(load, np.full(72, 1.1), 0.4, hole, QUICK)


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 16])
def test_converges_in_mesh_and_step(number: int) -> None:
    """The change of the least gap from mesh to mesh falls, and the default is within 2 % of the finest."""
    duty = random_duty(7, number)
    ladder = [MeshSettings(int(96 * k), int(6 * k), np.radians(2 / k), 12) for k in (1, 4 / 3, 2, 8 / 3)]
    gaps = np.array([
        supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply, (COARSE, mesh)).least_gap
        for mesh in ladder
    ])  # fmt: skip
    assert abs(gaps[3] - gaps[2]) < abs(gaps[2] - gaps[0])
    assert gaps[1] == pytest.approx(gaps[3], rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(12))
def test_random_duties_repeat_wander_or_starve(number: int) -> None:
    duty = random_duty(29, number)
    orbit = supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply)
    assert orbit.verdict is not Verdict.UNSETTLED
    if orbit.verdict is Verdict.WANDERING:
        assert orbit.repeat_error <= 0.03
    if duty.fed_by in GROOVES:
        assert orbit.verdict is Verdict.REPEATING
    if orbit.verdict is Verdict.REPEATING:
        assert orbit.repeat_error < 1e-3
        assert abs(orbit.mass_balance) < 0.05


@pytest.mark.slow
def test_extrapolated_the_static_film_is_met_to_two_parts_in_a_thousand() -> None:
    eps, ratio, pocket, pressure = 0.8, 1.0, Pocket(np.pi, np.radians(10), 0.7), 0.05
    groove = Groove(pocket.centre, 2 * pocket.half_angle, pocket.half_length, pressure)
    films = [
        measured(solved_ring(eps, ratio, [groove], around=n, across=m)) for n, m in ((128, 16), (256, 32))
    ]
    So, attitude = (2 * getattr(films[1], name) - getattr(films[0], name) for name in ("So", "attitude"))
    supply = Supply((replace(pocket, centre=pocket.centre + attitude),), pressure)
    coarse, fine = (
        constant(So, ratio, supply, (COARSE, MeshSettings(96 * k, 6 * k, np.radians(2 / k), 12))).gap.mean()
        for k in (1, 2)
    )
    assert 2 * fine - coarse == pytest.approx(1 - eps, rel=2e-3)
