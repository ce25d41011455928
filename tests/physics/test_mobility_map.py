"""The mobility agrees with the short half film and the full solution under a load, and the map with both.

Literature: Butenschön 1976, pure squeeze. Analytic: quadrature, short bearing, equilibrium, symmetry.
"""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from seeds import seeded
from test_film_literature import table

from templates.core.arrays import Array
from templates.physics.orbits.film_mobility import film_mobility
from templates.physics.orbits.mobility_map import (
    LARGEST,
    NARROWEST,
    WIDEST,
    mapped_film_under_load,
    mapped_mobility,
    mapped_mobility_along_load,
    mobility_error,
)
from tests.references.moving_film import extrapolated_force, mobility, moving_force
from tests.references.short_mobility import (
    mobility_Booker_1965,
    mobility_Booker_1971,
    squeeze_force_Booker_1965,
)


def size(vector: Array) -> Array:
    """Length of vectors, (2, ...)."""
    return np.hypot(vector[0], vector[1])


def full(eps: float, ratio: float, load_direction: float, across: int = 10) -> Array:
    """Mobility of the full solution, extrapolated, from a mesh that is not the map's."""
    meshes = ((8 * n, n) for n in (across, 2 * across))
    coarse, fine = (film_mobility(eps, ratio, load_direction, *mesh).velocity for mesh in meshes)
    return np.asarray(fine + (fine - coarse) / 3)


def random_states(count: int, largest: float, narrow: float, wide: float, seed: int = 17) -> Array:
    """Eccentricity even in atanh, B/D, and direction even in asinh over the thin film's width, (count, 3)."""
    rng = np.random.default_rng(seed)
    eps = np.tanh(rng.uniform(0, np.arctanh(largest), count))
    thin = np.sqrt(1 - eps)
    chi = rng.choice([-1, 1], count) * thin * np.sinh(rng.random(count) * np.arcsinh(np.pi / thin))
    return np.stack([eps, np.exp(rng.uniform(np.log(narrow), np.log(wide), count)), chi], axis=-1)


# The short bearing


@pytest.mark.parametrize(("eps", "direction"), [(0, 1.0), (0.5, 0.3), (0.9, 2.0), (0.99, 3.0), (0.999, 1.5)])
def test_short_half_film_is_its_integral(eps: float, direction: float) -> None:
    def integrand(phi: float, part: object) -> float:
        assert callable(part)
        gap = 1 - eps + 2 * eps * np.sin(phi / 2) ** 2
        return float(2 * 0.25 * part(phi) * np.cos(phi - direction) / gap**3)

    low, high = direction - np.pi / 2, direction + np.pi / 2
    thin = [phi for phi in (-0.03, 0.0, 0.03) if low < phi < high] or None
    force = [
        quad(integrand, low, high, args=(part,), points=thin, limit=500, epsabs=0)[0]
        for part in (np.cos, np.sin)
    ]
    assert squeeze_force_Booker_1965(eps, 0.5, direction) == pytest.approx(force, rel=1e-8)


def test_short_mobility_inverts_its_force() -> None:
    rng = np.random.default_rng(18)
    eps, chi = rng.uniform(0, 0.999, 500), rng.uniform(-np.pi, np.pi, 500)
    M = mobility_Booker_1965(eps, 0.3, chi)
    force = squeeze_force_Booker_1965(eps, 0.3, np.abs(np.arctan2(M[1], M[0]))) * size(M)
    assert force[0] == pytest.approx(np.cos(chi), abs=1e-9)
    assert force[1] * np.sign(M[1]) == pytest.approx(np.sin(chi), abs=1e-9)


FITTED = [(0.2, 0.010), (0.5, 0.026), (0.8, 0.057), (0.9, 0.075), (0.99, 0.104), (1 - 1e-6, 0.116)]


@pytest.mark.parametrize(("eps", "error"), FITTED)
def test_closed_form_has_the_error_it_states(eps: float, error: float) -> None:
    chi = np.pi * np.linspace(0, 1, 2001) ** 3
    M = mobility_Booker_1965(eps, 1.0, chi)
    largest = (size(mobility_Booker_1971(eps, 1.0, chi) - M) / size(M)).max()
    assert 0.95 * error < largest < error


# The full solution under a load


@pytest.mark.parametrize("state", random_states(10, 0.99, 0.1, 2.0))
@pytest.mark.sampled(4)
def test_motion_under_a_load_is_that_whose_film_bears_it(state: Array) -> None:
    eps, ratio, chi = state.tolist()
    by_force = mobility(eps, ratio, chi, 256, 32)
    assert full(eps, ratio, chi) == pytest.approx(by_force, abs=2e-3 * float(size(by_force)))


# The map against other solutions


@pytest.mark.parametrize("state", random_states(20, 0.999, 0.1, 4.0))
def test_map_meets_the_full_solution(state: Array) -> None:
    truth = full(*state.tolist())
    assert size(mapped_mobility(*state) - truth) < 3e-3 * size(truth)


@pytest.mark.slow
def test_stored_error_bounds_the_error_at_new_points() -> None:
    """In at least 99 % of random points over the whole map, against meshes twice as fine as the map's."""
    states = random_states(300, LARGEST, NARROWEST, WIDEST, seeded(20))
    truth = np.array([full(*state.tolist(), 24) for state in states]).T
    eps, ratio, chi = states.T
    error = size(mapped_mobility(eps, ratio, chi) - truth) / size(truth)
    stored = mobility_error(eps * np.cos(chi), -eps * np.sin(chi), ratio)[:, 1]
    assert np.mean(error <= stored) >= 0.99


@pytest.mark.parametrize("row", table("squeeze_film_butenschoen_1976.csv"), ids=str)
def test_butenschoen_1976_squeeze(row: dict[str, float]) -> None:
    """As the full solution in test_film_literature: the printed values are low by up to 0.75 %."""
    eps, chi = abs(row["eps"]), 0.0 if row["eps"] >= 0 else np.pi
    along, ahead = mapped_mobility(eps, row["width_ratio"], chi)
    assert 1 / abs(along) == pytest.approx(row["So_V"], rel=0.0075 + 0.5e-4 / row["So_V"])
    assert abs(ahead) < 1e-12 * abs(along)


@pytest.mark.parametrize("eps", [0.0, 0.2, 0.4, 0.6, 0.7, 0.8])
def test_narrow_bearing_meets_the_short_half_film_in_every_direction(eps: float) -> None:
    chi = np.linspace(-np.pi, np.pi, 721)
    short = mobility_Booker_1965(eps, 0.05, chi)
    assert (size(mapped_mobility(eps, 0.05, chi) - short) / size(short)).max() < 0.01


@pytest.mark.parametrize(("eps", "ratio"), [(0.1, 0.5), (0.5, 0.05), (0.5, 1.0), (0.8, 0.3), (0.95, 0.5)])
def test_constant_load_settles_at_the_static_eccentricity(eps: float, ratio: float) -> None:
    """Rotation at omega_h is a motion with −eps/2 across, so that film bears So: that of `moving_film`."""
    So = eps / 2 * float(size(extrapolated_force(eps, ratio, -np.pi / 2)[0]))

    def rate(_: float, e: Array) -> Array:
        turning = np.array([-e[1], e[0]]) / 2
        return np.asarray(So * mapped_mobility_along_load(e[0], e[1], ratio) + turning)

    orbit = solve_ivp(rate, (0, 400), [0.0, 0.0], method="LSODA", rtol=1e-8, atol=1e-10)
    settled = orbit.y[:, -1]
    assert size(rate(0, settled)) < 1e-5
    assert size(settled) == pytest.approx(eps, rel=1e-3)
    along, ahead = moving_force(eps, ratio, -np.pi / 2)
    assert np.arctan2(settled[1], settled[0]) == pytest.approx(np.arctan2(-ahead, along), abs=2e-3)


# The map's properties


def test_map_is_mirrored_in_direction() -> None:
    eps, ratio, chi = random_states(1000, LARGEST, NARROWEST, WIDEST).T
    mirrored = mapped_mobility(eps, ratio, -chi) * np.array([[1], [-1]])
    assert mapped_mobility(eps, ratio, chi) == pytest.approx(mirrored, rel=1e-12)


@pytest.mark.parametrize("ratio", [NARROWEST, 0.1, 0.5, 1.0, 3.0, WIDEST])
def test_load_is_never_resisted_backwards(ratio: float) -> None:
    """Finite everywhere, and the load always does work: M along it is positive."""
    rng = np.random.default_rng(19)
    near = 10 ** rng.uniform(-6, 0, 20_000)
    eps = np.concatenate([rng.uniform(0, LARGEST, 20_000), 1 - near, [0.0, LARGEST, LARGEST]])
    chi = np.concatenate([rng.uniform(-np.pi, np.pi, 40_000), [1.0, 0.0, np.pi]])
    chi[:30_000:3] *= np.sqrt(1 - eps[:30_000:3])
    M = mapped_mobility(eps, ratio, chi)
    assert np.all(np.isfinite(M))
    assert np.all(M[0] * np.cos(chi) + M[1] * np.sin(chi) > 0)
    P_max, side = mapped_film_under_load(eps * np.cos(chi), -eps * np.sin(chi), ratio)
    assert np.all(P_max > 1)
    assert np.all((side > 0) & (side < 1.01))


def test_centred_journal_moves_along_the_load() -> None:
    chi = np.linspace(-np.pi, np.pi, 37)
    M = mapped_mobility(0.0, 0.5, chi)
    assert np.arctan2(M[1], M[0])[1:-1] == pytest.approx(chi[1:-1], abs=1e-12)
    assert np.ptp(size(M)) < 1e-12
    step = mapped_mobility(1e-9, 0.5, chi) - M
    assert size(step).max() < 1e-7


def test_one_width_and_many_agree() -> None:
    eps, _, chi = random_states(100, LARGEST, 0.1, 1.0).T
    many = mapped_mobility(eps, np.full(100, 0.37), chi)
    assert mapped_mobility(eps, 0.37, chi) == pytest.approx(many, rel=1e-10)
    assert mapped_mobility(eps.reshape(4, 25), np.array([0.37]), chi.reshape(4, 25)).shape == (2, 4, 25)


OUTSIDE = [
    (1.0, 0.5, 0.0, "eps"),
    (-0.1, 0.5, 0.0, "eps"),
    (np.nan, 0.5, 0.0, "eps"),
    (0.5, 0.019, 0.0, "B/D"),
    (0.5, 10.1, 0.0, "B/D"),
    (0.5, 0.5, 3.2, "load_direction"),
]


@pytest.mark.parametrize(("eps", "ratio", "chi", "name"), OUTSIDE)
def test_points_outside_are_refused_by_name(eps: float, ratio: float, chi: float, name: str) -> None:
    with pytest.raises(ValueError, match=name):
        mapped_mobility(eps, ratio, chi)
