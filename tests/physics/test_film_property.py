"""Property: random extremes of physics.md 5 give finite, ordered results, or are refused by name."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from seeds import examples

from templates.physics.films.film_dynamics import plain_coefficients
from templates.physics.films.film_fit import attitude_ISO_7902, load_ISO_7902
from templates.physics.films.film_measures import Film
from templates.physics.films.reynolds import static_film
from templates.physics.films.short_bearing import load_Ocvirk_1952
from templates.physics.numerics.eccentricity import eccentricity
from tests.references.long_bearing import load_Gumbel_1914, load_Sommerfeld_1904, load_Swift_Stieber
from tests.references.moving_film import moving_force

RATIOS = st.floats(np.log(0.01), np.log(100)).map(lambda y: float(np.exp(y)))
ECCENTRICITIES = st.one_of(
    st.floats(-9, 0).map(lambda k: 10.0**k * (1 - 1e-7)),
    st.floats(-7, 0).map(lambda k: 1 - 10.0**k),
    st.just(0.0),
)
MANY = settings(max_examples=examples(300), suppress_health_check=[HealthCheck.too_slow])
LOADS = [load_Ocvirk_1952, load_ISO_7902, load_Sommerfeld_1904, load_Gumbel_1914, load_Swift_Stieber]


def check(film: Film, eps: float) -> None:
    assert all(np.isfinite(value) for value in vars(film).values())
    assert (film.So > 0) == (eps > 0)
    assert 0 < film.attitude < np.pi / 2
    assert -np.pi < film.peak < 0 <= film.rupture < np.pi
    assert film.friction >= film.friction_bearing > 0
    assert film.imbalance < 1e-8


@MANY
@given(eps=ECCENTRICITIES, ratio=RATIOS)
def test_full_solution_is_finite_and_ordered(eps: float, ratio: float) -> None:
    check(static_film(eps, ratio, 64, 8), eps)


@MANY
@given(eps=ECCENTRICITIES, ratio=RATIOS, angle=st.floats(-np.pi, np.pi))
def test_moving_film_resists_its_motion(eps: float, ratio: float, angle: float) -> None:
    force = moving_force(eps, ratio, angle, 64, 8)
    assert np.all(np.isfinite(force))
    assert force @ [np.cos(angle), np.sin(angle)] > 0


@settings(max_examples=examples(100))
@given(eps=ECCENTRICITIES.filter(lambda eps: eps > 0), ratio=RATIOS)
def test_coefficients_are_finite_and_the_film_damps(eps: float, ratio: float) -> None:
    film = plain_coefficients(eps, ratio, 64, 8)
    assert np.all(np.isfinite(film.K))
    assert np.all(np.linalg.eigvalsh(film.B + film.B.T) > 0)


@pytest.mark.parametrize("ratio", [0.02, 0.3, 1.0, 10.0])
def test_full_solution_bears_more_the_more_eccentric(ratio: float) -> None:
    eps = np.concatenate([np.logspace(-9, -0.31, 25), 1 - np.logspace(-0.3, -7, 40)])
    films = [static_film(float(e), ratio, 64, 8) for e in eps]
    assert np.all(np.diff([film.So for film in films]) > 0)
    assert np.all(np.diff([film.attitude for film in films]) < 1e-6)


@pytest.mark.parametrize("load", LOADS, ids=lambda f: f.__name__)
def test_closed_forms_rise_and_invert_over_everything(load: object) -> None:
    assert callable(load)
    rng = np.random.default_rng(3)
    count = 400 if load is load_Swift_Stieber else 4000  # the one that integrates to a rupture of its own
    So = np.sort(10 ** rng.uniform(-8, 6, count))
    width = () if load.__code__.co_argcount == 1 else (0.5,)
    eps = eccentricity(load, So, *width)
    borne = np.isfinite(eps)
    assert np.all(So[~borne] > load(np.asarray(1 - 1e-7), *width) * (1 - 1e-6))
    assert np.all(np.diff(eps[borne]) > 0)
    assert load(eps[borne], *width) == pytest.approx(So[borne], rel=1e-7)
    assert eccentricity(load, np.asarray(0.0), *width) == 0


@pytest.mark.parametrize("eps", [-1e-9, 1.0, 1 - 1e-8, np.nan, np.inf])
def test_eccentricity_outside_its_range_is_refused(eps: float) -> None:
    for call in (load_Ocvirk_1952, static_film, plain_coefficients, lambda e, r: moving_force(e, r, 0.0)):
        with pytest.raises(ValueError, match="eps"):
            call(eps, 0.5)


@pytest.mark.parametrize("ratio", [0.0, -1.0, np.nan, np.inf])
def test_senseless_width_is_refused(ratio: float) -> None:
    for call in (load_Ocvirk_1952, static_film, plain_coefficients, load_ISO_7902, attitude_ISO_7902):
        with pytest.raises(ValueError, match="B/D"):
            call(0.5, ratio)


@pytest.mark.parametrize("ratio", [0.12, 1.01, 2.0])
def test_fit_refuses_widths_at_which_it_is_wrong(ratio: float) -> None:
    with pytest.raises(ValueError, match=r"\[1/8, 1\]"):
        load_ISO_7902(0.5, ratio)


@pytest.mark.parametrize("So", [-1.0, np.nan, np.inf])
def test_senseless_load_is_refused(So: float) -> None:
    with pytest.raises(ValueError, match="So"):
        eccentricity(load_Ocvirk_1952, np.asarray(So), 0.5)
