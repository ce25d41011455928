"""Analytic: mass-conserving cavitation agrees with the pocketed slider's closed form and its balances."""

import numpy as np
import pytest
from grooved_lands import grooved_coefficients

from templates.physics.cavities.cavitating_dynamics import LinearFilm, linear_film
from templates.physics.cavities.cavitating_film import measured, solved_ring
from templates.physics.cavities.cavitating_network import Groove
from templates.physics.cavities.fed_film import Feed, fed_coefficients, fed_film
from templates.physics.films.film_dynamics import plain_coefficients
from templates.physics.films.reynolds import extrapolated_film
from tests.references.cavitating_slider import PocketedSlider, discrete_slider, film_Fowell_2007

SLIDER = PocketedSlider(1e-2, 1.05e-6, 1e-6, 2e-3, 5e-3, 1e-6, eta=1e-2, speed=1.0, ambient=1e5)
UNIT = SLIDER.eta * SLIDER.speed * SLIDER.length / SLIDER.outlet**2


def test_closed_form_of_the_pocketed_slider() -> None:
    """Fowell et al. 2007; numbers of the references' README."""
    film = film_Fowell_2007(SLIDER)
    assert film.flow == pytest.approx(5.229635e-7, rel=1e-6)
    assert film.reformation == pytest.approx(3.611263e-3, rel=1e-6)
    assert film.P_max == pytest.approx(9.80882e6, rel=1e-6)


@pytest.mark.parametrize("n", [100, 400, 1600])
def test_discrete_slider_meets_the_closed_form(n: int) -> None:
    film, x = discrete_slider(SLIDER, n), np.linspace(0, 1, n + 1)
    assert np.trapezoid(film.P, x) * UNIT * SLIDER.length == pytest.approx(35165.7, rel=1e-3)
    assert film.P.max() * UNIT == pytest.approx(film_Fowell_2007(SLIDER).P_max, rel=1e-3)
    assert x[film.void > 0].max() * SLIDER.length == pytest.approx(3.611263e-3, abs=1.01 * SLIDER.length / n)
    assert film.imbalance < 1e-8


@pytest.mark.parametrize(("eps", "ratio"), [(0.2, 1.0), (0.8, 0.5), (0.97, 1.0), (0.999, 0.3), (0.6, 4.0)])
def test_supplied_at_the_widest_gap_it_nears_the_swift_stieber_film(eps: float, ratio: float) -> None:
    """Both rupture alike; re-formation lies at the supply line, so the loads agree."""
    film, (static, _) = measured(solved_ring(eps, ratio, [Groove(np.pi, 0.0)])), extrapolated_film(eps, ratio)
    assert film.So == pytest.approx(static.So, rel=0.01)
    assert film.attitude == pytest.approx(static.attitude, abs=0.01)


@pytest.mark.parametrize("eps", [0.1, 0.6, 0.95])
def test_supply_equals_side_flow(eps: float) -> None:
    grooves = [Groove(-np.pi / 2, 0.3, 0.8, 0.5), Groove(np.pi / 2, 0.3, 0.8, 0.5)]
    film = measured(solved_ring(eps, 0.7, grooves, ambient=0.1))
    assert abs(film.imbalance) < 1e-8
    assert film.supply_flow > 0
    assert film.P.min() >= 0
    assert 0 <= film.void.min() <= film.void.max() < 1
    assert np.all(film.P * film.void < 1e-8 * film.P_max)


def test_refusals_name_the_argument() -> None:
    with pytest.raises(ValueError, match="grooves"):
        solved_ring(0.5, 0.5, [])
    with pytest.raises(ValueError, match="pressures"):
        solved_ring(0.5, 0.5, [Groove(0.0, 0.1, 1.0, -1.0)])
    with pytest.raises(ValueError, match="eps"):
        solved_ring(1.0, 0.5, [Groove(0.0, 0.1)])


@pytest.mark.parametrize("eps", [0.244, 0.655, 0.95])
def test_fed_film_finds_the_place_of_the_ruptured_one(eps: float) -> None:
    """Two grooves at ambient pressure: nearly nothing re-forms outside them, so Swift and Stieber agree."""
    grooves = ((-np.pi / 2, np.radians(20)), (np.pi / 2, np.radians(20)))
    static = grooved_coefficients(eps, 0.5, list(grooves))
    film = fed_film(static.So, 0.5, Feed(0.0, grooves))
    assert film is not None
    assert 1 - film.eps == pytest.approx(1 - eps, rel=0.005)
    assert film.attitude == pytest.approx(static.attitude, abs=0.005)


LATE = Feed(0.3, ((-1.2, 0.4), (2.9, 0.0)))


def borne(y: np.ndarray, feed: Feed) -> LinearFilm:
    """The film of a journal at y, in units of the radial clearance, along and ahead of the load."""
    attitude = float(np.arctan2(y[1], y[0]))
    solved = solved_ring(float(np.hypot(*y)), 0.7, feed.placed(attitude), 0.0, 256, 16)
    return linear_film(solved).turned(attitude)


@pytest.mark.parametrize("eps", [0.3, 0.7, 0.9])
@pytest.mark.sampled(1)
def test_stiffness_is_the_slope_of_the_force_where_the_film_re_forms(eps: float) -> None:
    """By a displacement that moves the front over many nodes: less would see the steps of the mesh."""
    place, step = eps * np.array([np.cos(0.7), np.sin(0.7)]), 0.02 * (1 - eps)
    film = borne(place, LATE)
    for k, axis in enumerate(np.eye(2)):
        slope = (borne(place + step * axis, LATE).force - borne(place - step * axis, LATE).force) / (2 * step)
        assert film.K[:, k] == pytest.approx(slope, abs=0.05 * np.abs(film.K).max())


@pytest.mark.parametrize("eps", [0.01, 0.5, 0.95, 0.999])
def test_coefficients_near_those_of_the_ruptured_film(eps: float) -> None:
    """Fed at the widest gap both films rupture alike."""
    K, B = fed_coefficients(eps, 0.5, 0.0, Feed())
    ruptured = plain_coefficients(eps, 0.5, 256, 32)
    for result, expected in ((K, ruptured.So * ruptured.K), (B, ruptured.So * ruptured.B)):
        assert result == pytest.approx(expected, abs=0.015 * np.abs(expected).max())


def drawn_feeds(seed: int, count: int) -> list[tuple[float, float, Feed]]:
    """Loads, widths and feeds over the range of physics.md, section 5, odd grooves among them."""
    rng = np.random.default_rng(seed)
    points = []
    for _ in range(count):
        So = 10 ** rng.uniform(-8, 6) * (rng.random() > 0.05)
        P = 0.0 if rng.random() < 0.4 else 10 ** rng.uniform(-4, 3)
        widths = [rng.choice([0.0, 10 ** rng.uniform(-3, 0.3)]) for _ in range(rng.integers(0, 5))]
        grooves = tuple((float(rng.uniform(-2 * np.pi, 4 * np.pi)), float(width)) for width in widths)
        points.append((float(So), float(10 ** rng.uniform(-2, 2)), Feed(float(P), grooves)))
    return points


@pytest.mark.slow
def test_fed_films_bear_their_load_on_a_finer_mesh() -> None:
    """At random feeds, odd ones among them: how far the journal is from where a finer mesh would have it.

    Over the film left, or the eccentricity; one in ten has grooves finer than the mesh, or little stiffness.
    """
    distances = []
    for So, ratio, feed in drawn_feeds(3, 150):
        film = fed_film(So, ratio, feed) if feed.grooves and So > 1e-3 else None
        if film is None or film.eps < 1e-3:
            continue
        linear = linear_film(solved_ring(film.eps, ratio, feed.placed(film.attitude), 0.0, 256, 32))
        load = So * np.array([np.cos(film.attitude), -np.sin(film.attitude)])
        along, ahead = np.abs(np.linalg.solve(linear.K, linear.force - load))
        distances.append(max(along / min(film.eps, 1 - film.eps), ahead / film.eps))
    assert len(distances) > 50
    assert np.median(distances) < 0.004
    assert np.quantile(distances, 0.85) < 0.04
