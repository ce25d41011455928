"""The orbit by mobility agrees with a second integration, limits, symmetries and the order of the step.

Analytic: everything here follows from the equation of the orbit, solved in another way or transformed.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from seeds import seeded

from benchmarks.step_bound import random_duties
from templates.core.arrays import Array
from templates.physics.orbits import journal_orbit
from templates.physics.orbits.journal_orbit import CyclicLoad, Orbit, periodic_orbit
from templates.physics.orbits.mobility_law import MapLaw, MobilityLaw, ShortLaw
from templates.physics.orbits.mobility_map import mapped_mobility_along_load
from templates.physics.orbits.short_mobility import short_film_under_load
from tests.references.short_mobility import mobility_Booker_1965

FOUR_STROKE = 4 * np.pi
RATIO = np.float64(0.5)
Shares = float | list[float] | Array


def big_end(angle: Array) -> Array:
    """Inertia of first and second order and one firing, (2, N), of the order of 1; smooth."""
    x = -np.cos(angle) - 0.25 * np.cos(2 * angle) + 3 * np.exp(6 * (np.cos((angle - 6.6) / 2) - 1))
    return np.stack([x, -np.sin(angle)])


def angles(count: int, period: float = FOUR_STROKE) -> Array:
    return np.arange(count) * period / count


def duty(S: Shares, w: float = 0.5, count: int = 720) -> CyclicLoad:
    """The big end's load at one or several sizes."""
    angle, sizes = angles(count), np.atleast_1d(S)
    loads = big_end(angle)[:, None] * sizes[:, None]
    return CyclicLoad(angle, FOUR_STROKE, loads, np.full((sizes.size, count), w))


def turned(load: CyclicLoad, turn: Array) -> CyclicLoad:
    """The same load as seen from axes that stand at angles ahead, (N,)."""
    c, s = np.cos(turn), np.sin(turn)
    x, y = load.S
    return CyclicLoad(load.angle, load.period, np.stack([c * x + s * y, c * y - s * x]), load.w)


def gap(orbit: Orbit) -> Array:
    return np.asarray(1 - np.hypot(*orbit.eps))


def law(kind: type[ShortLaw] | type[MapLaw], cases: int = 1, ratio: float = RATIO) -> MobilityLaw:
    return kind(np.full(cases, ratio))


# Against a second integration


def booker_rate(angle: float, e: Array, S: float, w: float) -> Array:
    """The equation of the orbit of the short bearing, written in polar coordinates of the load."""
    x, y = big_end(np.array([angle]))[:, 0] * S
    size, direction = np.hypot(x, y), np.arctan2(y, x)
    xi, eta = (
        e[0] * np.cos(direction) + e[1] * np.sin(direction),
        e[1] * np.cos(direction) - e[0] * np.sin(direction),
    )
    along = size * (1 - xi) ** 2.5 / (np.pi * RATIO**2)
    ahead = -size * 4 * eta * (1 - xi) ** 1.5 / (np.pi * RATIO) ** 2
    return np.array([
        along * np.cos(direction) - ahead * np.sin(direction) - w * e[1],
        along * np.sin(direction) + ahead * np.cos(direction) + w * e[0],
    ])  # fmt: skip


@pytest.mark.parametrize(
    ("S", "w"),
    [
        (5.0, 0.0),
        (5.0, -0.5),
        *(pytest.param(S, 0.5, marks=pytest.mark.slow) for S in (0.5, 5.0, 50.0)),
    ],
)
@pytest.mark.sampled(1)
def test_short_orbit_meets_an_independent_integration(S: float, w: float) -> None:
    """Radau's method of fifth order, cycle after cycle until it repeats."""
    orbit = periodic_orbit(duty(S, w), law(ShortLaw))
    start, reported = np.zeros(2), angles(720)
    for _ in range(30):
        run = solve_ivp(
            booker_rate, (0, FOUR_STROKE), start, "Radau", reported, args=(S, w), rtol=1e-9, atol=1e-12
        )
        end = solve_ivp(
            booker_rate,
            (reported[-1], FOUR_STROKE),
            run.y[:, -1],
            "Radau",
            args=(S, w),
            rtol=1e-9,
            atol=1e-12,
        ).y[:, -1]
        if np.hypot(*(end - start)) < 1e-8:
            break
        start = end
    integrated = 1 - np.hypot(*run.y)
    assert gap(orbit)[0] == pytest.approx(integrated, rel=5e-3)
    error = abs(orbit.least_gap[0] / integrated.min() - 1)
    assert error < 3e-3
    assert error < 3 * orbit.step_error[0] + 1e-5


@pytest.mark.slow
def test_closed_form_is_off_by_a_few_per_cent_from_the_exact_half_film() -> None:
    """Booker's closed form beside the half film itself, inverted at every instant."""
    S = 3.0

    def rate(angle: float, e: Array) -> Array:
        x, y = big_end(np.array([angle]))[:, 0] * S
        eps, place = np.asarray(np.hypot(*e)), np.arctan2(e[1], e[0])
        chi = (np.arctan2(y, x) - place + np.pi) % (2 * np.pi) - np.pi
        along, ahead = mobility_Booker_1965(eps, np.asarray(RATIO), chi) * np.hypot(x, y)
        c, s = np.cos(place), np.sin(place)
        return np.array([along * c - ahead * s - e[1] / 2, along * s + ahead * c + e[0] / 2])

    orbit = periodic_orbit(duty(S), law(ShortLaw))
    start = orbit.eps[:, 0, 0]
    for _ in range(2):
        run = solve_ivp(
            rate, (0, FOUR_STROKE), start, "LSODA", angles(721, FOUR_STROKE * 721 / 720), rtol=1e-6
        )
        start = run.y[:, -1]
    exact = (1 - np.hypot(*run.y)).min()
    assert 0.003 < abs(orbit.least_gap[0] / exact - 1) < 0.06


@pytest.mark.parametrize("kind", [ShortLaw, MapLaw])
def test_slopes_are_those_of_the_mobility(kind: type[ShortLaw] | type[MapLaw]) -> None:
    rng = np.random.default_rng(3)
    r, a, step = rng.random((3, 60)) * 0.99, rng.random((3, 60)) * 2 * np.pi, 1e-6
    xi, eta, mobility = r * np.cos(a), r * np.sin(a), kind(np.array([0.1, 0.5, 2.0]))
    M, slopes = mobility(xi, eta)
    by_xi = (mobility(xi + step, eta)[0] - mobility(xi - step, eta)[0]) / (2 * step)
    by_eta = (mobility(xi, eta + step)[0] - mobility(xi, eta - step)[0]) / (2 * step)
    size = np.hypot(*M) / (1 - np.hypot(xi, eta))
    assert np.abs(slopes - np.stack([by_xi, by_eta], axis=1)).max() < 1e-4 * size.max()
    assert (np.abs(slopes - np.stack([by_xi, by_eta], axis=1)) / size).max() < 1e-3


def test_map_law_is_the_map() -> None:
    rng = np.random.default_rng(4)
    r, a, ratio = rng.random((3, 60)) * 0.999, rng.random((3, 60)) * 2 * np.pi, np.array([0.1, 0.5, 2.0])
    xi, eta = r * np.cos(a), r * np.sin(a)
    assert MapLaw(ratio)(xi, eta)[0] == pytest.approx(
        mapped_mobility_along_load(xi, eta, ratio[:, None]), rel=1e-9
    )


# The steps


def test_step_is_of_second_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """The nodes are the load's own, and never made finer."""
    monkeypatch.setattr(journal_orbit, "LARGEST_STEP", np.pi)
    monkeypatch.setattr(journal_orbit, "ROUGHEST", np.inf)
    counts = np.array([360, 720, 1440, 11520])
    gaps = [gap(periodic_orbit(duty(2.0, count=count), law(MapLaw)))[0, :: count // 360] for count in counts]
    errors = [np.abs(coarse - gaps[-1]).max() for coarse in gaps[:-1]]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([2, 2], abs=0.25)


@pytest.mark.parametrize("S", [0.5, 5.0, 50.0, 500.0])
def test_step_error_is_reported(S: float, monkeypatch: pytest.MonkeyPatch) -> None:
    orbit = periodic_orbit(duty(S), law(MapLaw))
    monkeypatch.setattr(journal_orbit, "LARGEST_STEP", np.radians(0.125))
    fine = periodic_orbit(duty(S), law(MapLaw))
    assert abs(orbit.least_gap / fine.least_gap - 1) < 3 * orbit.step_error
    assert orbit.step_error < 2 * journal_orbit.ROUGHEST


def test_unequal_steps_tell_the_same() -> None:
    angle = np.sort(np.concatenate([angles(360), angles(2880)[700:1100]]))
    angle = angle[np.append(True, np.diff(angle) > 1e-9)]
    load = CyclicLoad(angle, FOUR_STROKE, 3 * big_end(angle)[:, None], np.full((1, angle.size), 0.5))
    equal = periodic_orbit(duty(3.0, count=2880), law(MapLaw))
    assert periodic_orbit(load, law(MapLaw)).least_gap == pytest.approx(equal.least_gap, rel=2e-3)


# Limits


def test_mean_speed_of_a_journal_in_a_fixed_sleeve_is_half_its_own() -> None:
    """A load that turns at half the speed leaves no wedge: there is no orbit; any other speed has one."""
    angle = angles(720)
    for turning, result in ((0.5, False), (0.45, True), (0.55, True), (1.0, True), (-0.5, True)):
        S = np.stack([np.cos(turning * angle), np.sin(turning * angle)])
        seen = turned(CyclicLoad(angle, FOUR_STROKE, S[:, None], np.full((1, 720), 0.5)), turning * angle)
        still = CyclicLoad(angle, FOUR_STROKE, seen.S, seen.w - turning)
        assert np.isfinite(periodic_orbit(still, law(MapLaw)).least_gap[0]) == result, turning
    half = CyclicLoad(angle, FOUR_STROKE, np.stack([np.cos(angle / 2), np.sin(angle / 2)])[:, None],
                      np.full((1, 720), 0.5))  # fmt: skip
    assert np.isnan(periodic_orbit(half, law(MapLaw)).least_gap[0])


def test_constant_load_settles_where_rotation_bears_it() -> None:
    """At rest M S balances the rotation: the same place from the orbit of a whole cycle."""
    load = CyclicLoad(angles(36), FOUR_STROKE, np.full((2, 1, 36), [[[2.0]], [[0.0]]]), np.full((1, 36), 0.5))
    orbit = periodic_orbit(load, law(MapLaw))
    assert np.ptp(orbit.eps, axis=-1) == pytest.approx(0, abs=1e-9)
    x, y = orbit.eps[:, 0, 0]
    along, ahead = 2 * mapped_mobility_along_load(x, y, np.asarray(RATIO))
    assert [along, ahead] == pytest.approx([y / 2, -x / 2], rel=1e-7)


def test_without_a_load_there_is_no_orbit() -> None:
    load = duty([0.0, 1.0])
    assert np.isnan(periodic_orbit(load, law(MapLaw, 2)).least_gap).tolist() == [True, False]


def test_pure_squeeze_swings_to_both_sides() -> None:
    """No rotation, a load that swings along x: the journal swings along x, alike in both halves."""
    angle = angles(360, 2 * np.pi)
    S = np.stack([10 * np.cos(angle), np.zeros(360)])[:, None]
    eps = periodic_orbit(CyclicLoad(angle, 2 * np.pi, S, np.zeros((1, 360))), law(MapLaw)).eps[:, 0]
    assert eps[0] == pytest.approx(-np.roll(eps[0], 180), abs=1e-6)
    assert np.abs(eps[1]).max() < 1e-9


# Symmetries


@pytest.mark.parametrize("kind", [ShortLaw, MapLaw])
def test_turning_axes_see_the_same_film(kind: type[ShortLaw] | type[MapLaw]) -> None:
    """Load and speed as seen from axes that turn with the crank; linear in between, hence not to rounding."""
    load = duty(3.0, count=1440)
    still = periodic_orbit(load, law(kind))
    seen = turned(load, load.angle)
    turning = periodic_orbit(CyclicLoad(seen.angle, seen.period, seen.S, seen.w - 1), law(kind))
    assert gap(turning) == pytest.approx(gap(still), rel=3e-3)
    assert turning.least_gap == pytest.approx(still.least_gap, rel=1e-3)


def test_fixed_axes_may_stand_at_any_angle() -> None:
    load = duty(3.0)
    tilted = periodic_orbit(turned(load, np.full(720, 1.0)), law(MapLaw))
    assert gap(tilted) == pytest.approx(gap(periodic_orbit(load, law(MapLaw))), rel=1e-7)


def test_mirrored_load_and_speed_give_the_mirrored_orbit() -> None:
    load = duty(3.0)
    mirror = np.array([1.0, -1.0])[:, None, None]
    mirrored = periodic_orbit(CyclicLoad(load.angle, load.period, load.S * mirror, -load.w), law(MapLaw))
    assert mirrored.eps == pytest.approx(periodic_orbit(load, law(MapLaw)).eps * mirror, abs=1e-10)


def test_cycle_may_begin_anywhere() -> None:
    load = duty(3.0)
    later = CyclicLoad(load.angle + 1.0, load.period, np.roll(load.S, 100, axis=-1), load.w)
    orbit, shifted = periodic_orbit(load, law(MapLaw)), periodic_orbit(later, law(MapLaw))
    assert np.roll(gap(shifted), -100, axis=-1) == pytest.approx(gap(orbit), rel=1e-6)


# Many cases


def test_one_case_and_many_agree() -> None:
    sizes = np.array([0.01, 1.0, np.nan, 30.0, 0.0, 3000.0])
    ratios = np.array([0.1, 0.5, 0.5, 0.5, 1.0, 2.0])
    many = periodic_orbit(duty(sizes), MapLaw(ratios))
    for k, (S, ratio) in enumerate(zip(sizes, ratios, strict=True)):
        alone = periodic_orbit(duty(S), law(MapLaw, ratio=ratio))
        assert many.eps[:, k] == pytest.approx(alone.eps[:, 0], rel=1e-9, abs=1e-12, nan_ok=True)


def check_random(count: int, seed: int) -> None:
    """Every orbit returned lies in its bearing, repeats, and obeys its equation; nearly all are found."""
    load, ratio = random_duties(np.random.default_rng(seed), count, 72)
    orbit = periodic_orbit(load, MapLaw(ratio))
    result = np.isfinite(orbit.least_gap)
    assert result.mean() > 0.97
    assert (orbit.least_gap[result] > 0).all()
    assert (orbit.least_gap[result] <= gap(orbit)[result].min(axis=-1) * (1 + 1e-9)).all()
    assert (orbit.step_error[result] < journal_orbit.UNKNOWN).all()
    assert np.isnan(orbit.eps[:, ~result]).all()
    assert np.isfinite(orbit.eps[:, result]).all()


def test_property_random_duties() -> None:
    check_random(60, 5)


@pytest.mark.slow
def test_property_many_random_duties() -> None:
    check_random(10_000, seeded(6))


# What the short film does


def test_short_film_under_load_has_its_steepest_pressure() -> None:
    """p_max by search over the half film that faces the motion."""
    rng = np.random.default_rng(8)
    r, a = rng.random(200) * 0.99, rng.random(200) * 2 * np.pi
    xi, eta = r * np.cos(a), r * np.sin(a)
    M = np.stack([(1 - xi) ** 2.5 / (np.pi * RATIO**2), -4 * eta * (1 - xi) ** 1.5 / (np.pi * RATIO) ** 2])
    phi = np.linspace(0, 2 * np.pi, 40_001)[:, None]
    H = 1 - xi * np.cos(phi) - eta * np.sin(phi)
    searched = 6 * RATIO**2 * ((M[0] * np.cos(phi) + M[1] * np.sin(phi)) / H**3).max(axis=0)
    P_max, side = short_film_under_load(xi, eta, np.asarray(RATIO))
    assert P_max == pytest.approx(searched, rel=1e-4)
    assert np.all(side == 1)


def test_a_load_that_vanishes_moves_the_journal_as_a_tiny_one_does() -> None:
    """Without a load no direction of it exists; the film carries the journal around where it is."""
    load = duty(4.0, w=0.5)
    pause = (load.angle > 2) & (load.angle < 4)
    idle, nearly = (np.where(pause, size, 1.0) * load.S for size in (0.0, 1e-12))
    orbit, limit = (
        periodic_orbit(CyclicLoad(load.angle, load.period, S, load.w), law(ShortLaw)) for S in (idle, nearly)
    )
    assert np.hypot(*orbit.eps[..., pause]).min() > 0.5
    assert orbit.eps == pytest.approx(limit.eps, abs=1e-9)
