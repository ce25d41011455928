"""Analytic: limits, observed order of convergence, balance of flow, symmetry, derivatives."""

import numpy as np
import pytest

from templates.physics.films.complementarity import rupture
from templates.physics.films.film_dynamics import plain_coefficients
from templates.physics.films.film_measures import force
from templates.physics.films.long_bearing import rupture_Swift_Stieber
from templates.physics.films.reynolds import extrapolated_film, journal_equations, static_field, static_film
from templates.physics.films.short_bearing import (
    attitude_Ocvirk_1952,
    load_Ocvirk_1952,
    peak_angle_Ocvirk_1952,
    peak_pressure_Ocvirk_1952,
    side_flow_Ocvirk_1952,
)
from templates.physics.journals.whirl import threshold_mass, whirl_ratio_squared
from templates.physics.numerics.eccentricity import eccentricity
from tests.references.long_bearing import force_Swift_Stieber, load_Swift_Stieber, pressure_Swift_Stieber
from tests.references.moving_film import mobility, moving_force


@pytest.mark.parametrize(("eps", "ratio"), [(0.1, 1.0), (0.5, 0.25), (0.8, 1.0), (0.95, 0.5), (0.99, 2.0)])
@pytest.mark.sampled(2)
def test_observed_order(eps: float, ratio: float) -> None:
    """Of load vector and mean pressure error, in which errors cannot cancel, over three halvings."""
    levels = (1, 2, 4, 8, 16)
    fields = [static_field(eps, ratio, 32 * k, 8 * k) for k in levels]
    pressures, loads = [f.rupture.P for f in fields], [complex(*force(f.mesh, f.rupture.P)) for f in fields]
    load = loads[-1] + (loads[-1] - loads[-2]) / 3
    limit = pressures[-1].copy()
    limit[::2, ::2] += (limit[::2, ::2] - pressures[-2]) / 3
    field_errors = [
        np.abs(P - limit[:: 16 // k, :: 16 // k]).mean() for P, k in zip(pressures, levels, strict=True)
    ]
    load_errors = [abs(value - load) for value in loads]
    assert np.log2(field_errors[0] / field_errors[3]) / 3 >= 1.8
    assert np.log2(load_errors[0] / load_errors[3]) / 3 >= 1.8


@pytest.mark.parametrize(("eps", "low", "high"), [(0.1, 0.0, 0.002), (0.5, 0.0, 0.006), (0.8, 0.004, 0.012),
                                                  (0.9, 0.012, 0.022), (0.99, 0.16, 0.20)])  # fmt: skip
def test_short_bearing_limit(eps: float, low: float, high: float) -> None:
    """Physics.md 1.2: Ocvirk is high by 0.1–0.8 % at B/D 0.05 up to eps 0.8, 1.8 % at 0.9, 18 % at 0.99."""
    film, _ = extrapolated_film(eps, 0.05)
    assert low < load_Ocvirk_1952(eps, 0.05) / film.So - 1 < high


def test_very_short_bearing_meets_every_ocvirk_form() -> None:
    film, _ = extrapolated_film(0.6, 0.01)
    assert film.So == pytest.approx(load_Ocvirk_1952(0.6, 0.01), rel=1e-3)
    assert film.attitude == pytest.approx(attitude_Ocvirk_1952(0.6), abs=1e-3)
    assert film.P_max == pytest.approx(peak_pressure_Ocvirk_1952(0.6, 0.01), rel=1e-3)
    assert film.peak + np.pi == pytest.approx(peak_angle_Ocvirk_1952(0.6), abs=1e-3)
    assert film.side_flow == pytest.approx(side_flow_Ocvirk_1952(0.6, 0.01), rel=1e-3)


@pytest.mark.parametrize("eps", [0.1, 0.5, 0.9])
def test_long_bearing_is_approached_as_stated(eps: float) -> None:
    """Physics.md 1.2: as 1 − 0.93 D/B; at B/D 20 within what the next term leaves."""
    film, _ = extrapolated_film(eps, 20.0)
    assert film.So / load_Swift_Stieber(eps) == pytest.approx(1 - 0.93 / 20, abs=0.03)
    as_wide_as_where_it_ruptures = 2 * np.pi - rupture_Swift_Stieber(eps)
    assert film.P_max == pytest.approx(pressure_Swift_Stieber(eps, as_wide_as_where_it_ruptures), rel=1e-3)


def test_long_bearing_converges_in_width() -> None:
    """What is missing to the one-dimensional load halves with D/B."""
    limit = load_Swift_Stieber(0.5)
    missing = [1 - extrapolated_film(0.5, ratio)[0].So / limit for ratio in (20.0, 40.0, 80.0)]
    assert missing[0] / missing[1] == pytest.approx(2, rel=0.05)
    assert missing[1] / missing[2] == pytest.approx(2, rel=0.05)


def test_closed_form_of_the_long_bearing_integrates_its_pressure() -> None:
    film, _ = extrapolated_film(0.7, 100.0, 256, 16)
    along, across = force_Swift_Stieber(0.7)
    assert film.So == pytest.approx(np.hypot(along, across), rel=0.012)


@pytest.mark.parametrize(
    ("eps", "ratio"), [(1e-9, 1.0), (0.5, 0.02), (0.9, 10.0), (1 - 1e-6, 0.5), (1 - 1e-7, 100.0)]
)
def test_flow_balances(eps: float, ratio: float) -> None:
    """The discrete film loses nothing; what enters and does not leave at the ends is carried on."""
    film = static_film(eps, ratio)
    assert film.imbalance < 1e-10
    assert 0 < film.side_flow < film.supply_flow


def test_torques_on_journal_and_bearing_differ_by_the_load_couple() -> None:
    film = static_film(0.7, 0.8)
    assert film.friction - film.friction_bearing == pytest.approx(
        0.7 * film.So * np.sin(film.attitude), rel=1e-12
    )


def test_mirrored_motion_gives_the_mirrored_force() -> None:
    forward, backward = moving_force(0.6, 0.7, 1.1, 64, 8), moving_force(0.6, 0.7, -1.1, 64, 8)
    assert forward == pytest.approx(backward * [1, -1], rel=1e-10)


def test_centred_journal_yields_equally_in_every_direction() -> None:
    sizes = [np.hypot(*moving_force(0.0, 0.5, angle, 128, 8)) for angle in (0.0, 0.7, np.pi / 2, 3.0)]
    assert sizes == pytest.approx([sizes[0]] * 4, rel=1e-3)


def test_stiffness_along_the_line_of_centres_is_the_slope_of_the_load_vector() -> None:
    """Against differences of static films; displacement ahead turns the film but for its supply line."""
    eps, ratio, step = 0.6, 0.8, 1e-4
    film = plain_coefficients(eps, ratio, 128, 16)
    near, far = static_film(eps - step, ratio, 128, 16), static_film(eps + step, ratio, 128, 16)
    slope = (far.So * np.exp(-1j * far.attitude) - near.So * np.exp(-1j * near.attitude)) / (
        2 * step * film.So
    )
    beta = film.attitude
    to_load = np.array([[np.cos(beta), -np.sin(beta)], [np.sin(beta), np.cos(beta)]])
    along = to_load.T @ film.K @ to_load @ [1.0, 0.0]
    assert along == pytest.approx([slope.real, slope.imag], rel=2e-3)


def test_damping_is_symmetric_and_whirl_has_its_limits() -> None:
    """Reciprocity of the squeeze film; at small load a journal whirls at half speed."""
    light = plain_coefficients(1e-3, 0.5)
    assert light.B[0, 1] == pytest.approx(light.B[1, 0], rel=1e-3, abs=1e-3 * light.B[0, 0])
    assert np.sqrt(whirl_ratio_squared(light.K, light.B)) == pytest.approx(0.5, abs=0.02)
    heavy = plain_coefficients(0.9, 0.5)
    assert threshold_mass(heavy.K, heavy.B) == np.inf


def test_eccentricity_inverts_closed_forms_at_both_ends() -> None:
    So = np.logspace(-8, 6, 57)
    for ratio in (0.05, 0.5):
        eps = eccentricity(load_Ocvirk_1952, So, ratio)
        assert load_Ocvirk_1952(eps, ratio) == pytest.approx(So, rel=1e-8)
        assert np.all(np.diff(eps) > 0)


def test_pressure_is_a_complementary_solution() -> None:
    """P ≥ 0, A P − b ≥ 0 outside the film and 0 inside, to rounding."""
    field = static_field(0.9, 0.5)
    excess, film = field.equations.residual(field.rupture.P), field.rupture.film
    scale = np.abs(excess).max()
    assert field.rupture.P.min() == 0
    assert np.abs(excess[film]).max() < 1e-11 * scale
    assert excess[1:-1, :-1].min() > -1e-11 * scale


@pytest.mark.parametrize(("eps", "ratio"), [(1e-6, 0.02), (0.6, 0.5), (0.9, 20.0), (0.99995, 1.0)])
def test_a_film_does_not_depend_on_where_the_solver_starts(eps: float, ratio: float) -> None:
    """A start from the coarser film, and one from nothing but the nodes to which motion brings oil."""
    field = static_field(eps, ratio, 96, 16)
    alone = rupture(journal_equations(eps, ratio, field.mesh))
    assert (field.rupture.film == alone.film).all()
    np.testing.assert_allclose(field.rupture.P, alone.P, rtol=0, atol=1e-12 * alone.P.max())


@pytest.mark.parametrize(
    ("eps", "angle"), [(0.0, 1.0), (0.5, 0.4), (0.5, -2.0), (0.9, 2.8), (0.95, 0.0), (0.95, np.pi)]
)
def test_mobility_is_the_motion_whose_film_bears_the_load(eps: float, angle: float) -> None:
    M = mobility(eps, 0.5, angle, 64, 8)
    force = moving_force(eps, 0.5, float(np.arctan2(M[1], M[0])), 64, 8) * np.hypot(*M)
    assert force == pytest.approx([np.cos(angle), np.sin(angle)], abs=1e-6)


@pytest.mark.parametrize("eps", [0.1, 0.5])
def test_short_bearing_mobility_along_the_line_of_centres(eps: float) -> None:
    """Booker 1965: closing, M = (1 − eps)^2.5 / (pi (L/D)²), itself a fit by some per cent."""
    short = (1 - eps) ** 2.5 / (np.pi * 0.02**2)
    assert mobility(eps, 0.02, 0.0)[0] == pytest.approx(short, rel=0.06)
