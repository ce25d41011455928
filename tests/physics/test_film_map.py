"""Property and analytic: the film map agrees with fresh full solutions on another mesh."""

import numpy as np
import pytest
from seeds import seeded

from templates.physics.films.film_dynamics import plain_coefficients
from templates.physics.films.film_map import map_error, mapped_coefficients, mapped_film, mapped_load
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.films.reynolds import extrapolated_film
from templates.physics.films.short_bearing import load_Ocvirk_1952


def compare(eps: float, ratio: float) -> tuple[float, float]:
    """Relative error of So and error of the attitude in degrees, against a mesh that is not the map's."""
    film, _ = extrapolated_film(eps, ratio, 192, 24)
    mapped = mapped_film(eps, ratio)
    return abs(mapped["So"] / film.So - 1), abs(np.degrees(mapped["attitude"] - film.attitude))


def central_points(count: int, seed: int = 11) -> list[tuple[float, float]]:
    """Random eps 0.01 … 0.999, even in atanh, and B/D 0.1 … 4, even in the logarithm."""
    rng = np.random.default_rng(seed)
    eps = np.tanh(rng.uniform(np.arctanh(0.01), np.arctanh(0.999), count))
    return list(zip(eps, np.exp(rng.uniform(np.log(0.1), np.log(4), count)), strict=True))


@pytest.mark.parametrize(("eps", "ratio"), central_points(30))
def test_map_meets_the_converged_solution(eps: float, ratio: float) -> None:
    load, angle = compare(eps, ratio)
    assert load < 1e-3
    assert angle < 0.05


@pytest.mark.slow
def test_map_meets_the_converged_solution_at_many_points() -> None:
    errors = np.array([compare(eps, ratio) for eps, ratio in central_points(500, seeded(12))])
    assert errors[:, 0].max() < 1e-3
    assert errors[:, 1].max() < 0.05


@pytest.mark.slow
def test_stored_error_bounds_the_error_at_new_points() -> None:
    """In at least 99 % of random points over the whole map."""
    rng = np.random.default_rng(seeded(13))
    eps = np.tanh(rng.uniform(0, np.arctanh(1 - 1e-7), 300))
    ratio = np.exp(rng.uniform(np.log(0.01), np.log(100), 300))
    errors = np.array([compare(e, b)[0] for e, b in zip(eps, ratio, strict=True)])
    assert np.mean(errors <= map_error(eps, ratio)[:, 0] + 2e-5) >= 0.99


@pytest.mark.parametrize(("eps", "ratio"), [(0.2, 0.3), (0.7, 1.0), (0.95, 0.5), (0.995, 2.0)])
def test_every_output_agrees(eps: float, ratio: float) -> None:
    film, _ = extrapolated_film(eps, ratio, 192, 24)
    mapped = mapped_film(eps, ratio)
    for name, value in mapped.items():
        assert value == pytest.approx(getattr(film, name), rel=0.05 if name == "rupture" else 1e-3), name


@pytest.mark.parametrize(("eps", "ratio"), [(0.05, 0.5), (0.5, 1.0), (0.9, 0.4), (0.99, 1.5)])
def test_coefficients_agree(eps: float, ratio: float) -> None:
    film = plain_coefficients(eps, ratio, 512, 32)
    K, B = mapped_coefficients(eps, ratio)
    assert pytest.approx(film.K, rel=0.03, abs=0.01) == K
    assert pytest.approx(film.B, rel=0.03, abs=0.01) == B


@pytest.mark.parametrize("ratio", np.geomspace(0.01, 100, 25))
def test_map_is_monotone_and_finite(ratio: float) -> None:
    eps = np.concatenate(
        [[0.0], np.logspace(-9, -1, 500), np.linspace(0.1, 0.9, 2000)[1:], 1 - np.logspace(-1, -7, 3000)[1:]]
    )
    film = mapped_film(eps, ratio)
    assert all(np.all(np.isfinite(values)) for values in film.values())
    assert np.all(np.diff(film["So"]) > 0)
    assert np.all(np.diff(film["P_max"]) > 0)
    assert np.all(np.diff(film["friction"]) >= -4 * np.spacing(film["friction"][1:]))
    assert np.all(film["attitude"] > 0)


def test_inverse_is_exact_monotone_and_complete() -> None:
    rng = np.random.default_rng(14)
    So, ratio = 10 ** rng.uniform(-8, 6, 20_000), np.exp(rng.uniform(np.log(0.01), np.log(100), 20_000))
    eps = mapped_eccentricity(So, ratio)
    borne = np.isfinite(eps)
    assert np.all(So[~borne] > mapped_load(np.full((~borne).sum(), 1 - 1e-7), ratio[~borne]) * (1 - 1e-9))
    assert mapped_load(eps[borne], ratio[borne]) == pytest.approx(So[borne], rel=1e-7)
    rising = mapped_eccentricity(np.logspace(-8, 6, 20_000), 0.5)
    assert np.all(np.diff(rising[np.isfinite(rising)]) > 0)
    assert mapped_eccentricity(0.0, 0.5) == 0


def test_centred_journal_has_the_limits_of_the_light_load() -> None:
    still, light = mapped_film(0.0, 0.5), mapped_film(1e-7, 0.5)
    assert still["So"] == 0
    assert still["attitude"] == pytest.approx(light["attitude"], rel=1e-5)
    assert light["So"] == pytest.approx(
        load_Ocvirk_1952(1e-7, 0.5) * mapped_load(1e-4, 0.5) / load_Ocvirk_1952(1e-4, 0.5), rel=1e-4
    )


OUTSIDE = [
    (1.0, 0.5, "eps"),
    (-0.1, 0.5, "eps"),
    (np.nan, 0.5, "eps"),
    (0.5, 0.009, "B/D"),
    (0.5, 101.0, "B/D"),
]


@pytest.mark.parametrize(("eps", "ratio", "name"), OUTSIDE)
def test_points_outside_are_refused_by_name(eps: float, ratio: float, name: str) -> None:
    with pytest.raises(ValueError, match=name):
        mapped_film(eps, ratio)
