"""Analytic: mass-conserving cavitation against the pocketed slider's closed form, and its balances."""

import numpy as np
import pytest

from templates.physics.cavitating_film import Groove, cavitating_film
from templates.physics.cavitating_slider import PocketedSlider, discrete_slider, film_Fowell_2007
from templates.physics.film_dynamics import grooved_coefficients
from templates.physics.grooved_film import grooved_film
from templates.physics.reynolds import extrapolated_film

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
    film, (static, _) = cavitating_film(eps, ratio, [Groove(np.pi, 0.0)]), extrapolated_film(eps, ratio)
    assert film.So == pytest.approx(static.So, rel=0.01)
    assert film.attitude == pytest.approx(static.attitude, abs=0.01)


@pytest.mark.parametrize("eps", [0.1, 0.6, 0.95])
def test_supply_equals_side_flow(eps: float) -> None:
    grooves = [Groove(-np.pi / 2, 0.3, 0.8, 0.5), Groove(np.pi / 2, 0.3, 0.8, 0.5)]
    film = cavitating_film(eps, 0.7, grooves, ambient=0.1)
    assert abs(film.imbalance) < 1e-8
    assert film.supply_flow > 0
    assert film.P.min() >= 0
    assert 0 <= film.void.min() <= film.void.max() < 1
    assert np.all(film.P * film.void < 1e-8 * film.P_max)


def test_refusals_name_the_argument() -> None:
    with pytest.raises(ValueError, match="grooves"):
        cavitating_film(0.5, 0.5, [])
    with pytest.raises(ValueError, match="pressures"):
        cavitating_film(0.5, 0.5, [Groove(0.0, 0.1, 1.0, -1.0)])
    with pytest.raises(ValueError, match="eps"):
        cavitating_film(1.0, 0.5, [Groove(0.0, 0.1)])


@pytest.mark.parametrize("eps", [0.244, 0.655, 0.95])
def test_grooved_film_finds_the_attitude_of_the_ruptured_one(eps: float) -> None:
    """Two grooves at ambient pressure: nearly nothing re-forms outside them, so Swift and Stieber agree."""
    width = np.radians(20)
    film = grooved_film(eps, 0.5, [Groove(-np.pi / 2, width), Groove(np.pi / 2, width)])
    static = grooved_coefficients(eps, 0.5, [(-np.pi / 2, width), (np.pi / 2, width)])
    assert film.So == pytest.approx(static.So, rel=0.01)
    assert film.attitude == pytest.approx(static.attitude, abs=0.01)
