"""The converged static film of `reynolds`, precomputed over eccentricity and width.

Cubic splines over atanh(eps) and ln(B/D) represent each result of the film, as the logarithm of its ratio to
the short-bearing form or in terms of Sommerfeld's angle, so that the interpolated functions vary little.
`benchmarks/film_map.py` computes the map from Richardson-extrapolated solutions with the same boundary
condition, and measures its error. Range: eps 0 … 1 − 1e-7, B/D 0.01 … 100; values outside are refused.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_measures import Film
from templates.physics.films.film_mesh import sommerfeld_angle
from templates.physics.films.short_bearing import (
    attitude_Ocvirk_1952,
    load_Ocvirk_1952,
    peak_pressure_Ocvirk_1952,
)
from templates.physics.numerics.arrays import require, require_film
from templates.physics.numerics.uniform_spline import Axis, surface

NARROWEST, WIDEST = 0.01, 100.0
"""Width ratios B/D that the map covers [-]."""

_DATA = Path(__file__).with_name("film_map.npz")
_STIFFNESS_SCALE = np.array([[2, 1], [1, 0]])
_DAMPING_SCALE = np.array([[1, 0], [0, -1]])


@dataclass(frozen=True)
class FilmMap:
    """The map's data."""

    eccentricity: Axis
    """Nodes over atanh(eps)."""
    width: Axis
    """Nodes over ln(B/D)."""
    load: Array
    """Spline coefficients of the first value of `encode` alone."""
    static: Array
    """Spline coefficients of `encode`."""
    linear: Array
    """Spline coefficients of `encode_linear`."""
    error: Array
    """(cells over eps, cells over B/D, 8) largest error measured in each cell: see `map_error`."""


@cache
def film_map() -> FilmMap:
    """Return the map's data, which are read once."""
    with np.load(_DATA) as data:
        over_eps, over_width = (Axis(float(a), float(h), int(n)) for a, h, n in data["axes"])
        static, linear, error = (data[name].astype(float) for name in ("static", "linear", "error"))
    return FilmMap(over_eps, over_width, static[..., :1].copy(), static, linear, error)


def mapped_load(eps: Array, ratio: Array) -> Array:
    """Return the Sommerfeld number So = F psi²/(B D eta omega_h) [-].

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    return load_Ocvirk_1952(eps, ratio) * np.exp(_look_up(film_map().load, eps, ratio)[0])


def mapped_film(eps: Array, ratio: Array) -> dict[str, Array]:
    """Return all results of `film_measures.Film` except the imbalance, by name.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    eps, ratio = np.broadcast_arrays(np.asarray(eps, float), np.asarray(ratio, float))
    return decode(eps, ratio, _look_up(film_map().static, eps, ratio))


def mapped_coefficients(eps: Array, ratio: Array) -> tuple[Array, Array]:
    """Return stiffness k c/W and damping b c omega_h/W, (..., 2, 2) each, of `film_dynamics`.

    Parameters
    ----------
    eps
        Relative eccentricity, above 0 to 1 − 1e-7 [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    eps, ratio = np.broadcast_arrays(np.asarray(eps, float), np.asarray(ratio, float))
    require(eps > 0, "eps must be above 0: without load, coefficients over load do not exist")
    attitude = np.asarray(mapped_film(eps, ratio)["attitude"])
    cos, sin = np.cos(attitude), np.sin(attitude)
    turn = np.stack([np.stack([cos, -sin], axis=-1), np.stack([sin, cos], axis=-1)], axis=-2)
    values = np.moveaxis(_look_up(film_map().linear, eps, ratio), 0, -1).reshape(*eps.shape, 2, 2, 2)
    thin = np.sqrt((1 - eps) / (1 + eps))[..., None, None]
    K = values[..., 0, :, :] / (eps[..., None, None] * thin**_STIFFNESS_SCALE)
    B = values[..., 1, :, :] / (eps[..., None, None] * thin**_DAMPING_SCALE)
    return turn @ K @ turn.swapaxes(-1, -2), turn @ B @ turn.swapaxes(-1, -2)


def map_error(eps: Array, ratio: Array) -> Array:
    """Return the largest measured difference [-] near a point between the map and new, finer solutions.

    Returns
    -------
    (..., 8): errors of ln So, ln tan(attitude/2), ln P_max, ln tan(gamma/2) of the peak, ln side flow,
    ln supply flow, ln shear with streamers, tan(gamma/2) of the rupture; gamma is Sommerfeld's angle.
    """
    data = film_map()
    cells = np.array(data.error.shape[:2])
    x, y = _place(np.asarray(eps, float), np.asarray(ratio, float))
    row = (x - data.eccentricity.first) / (data.eccentricity.step * (data.eccentricity.nodes - 1))
    column = (y - data.width.first) / (data.width.step * (data.width.nodes - 1))
    cell = np.stack([row, column], axis=-1) * cells
    index = np.clip(cell.astype(int), 0, cells - 1)
    return np.asarray(data.error[index[..., 0], index[..., 1]])


def encode(eps: float, ratio: float, film: Film) -> Array:
    """Return the values, (8,), by which the map interpolates a film at eps > 0 smoothly."""
    s = np.sqrt((1 - eps) * (1 + eps))
    peak, rupture = np.tan(sommerfeld_angle(np.array([film.peak, film.rupture]), eps) / 2)
    shear = film.friction_streamers - (film.friction - film.friction_bearing) / 2
    return np.array([
        np.log(film.So / load_Ocvirk_1952(np.asarray(eps), np.asarray(ratio))),
        np.log(np.tan(film.attitude / 2) / np.tan(attitude_Ocvirk_1952(np.asarray(eps)) / 2)),
        np.log(film.P_max / peak_pressure_Ocvirk_1952(np.asarray(eps), np.asarray(ratio))),
        np.log(-peak),
        np.log(film.side_flow / (2 * ratio * eps)),
        np.log(film.supply_flow / (ratio * (1 + eps))),
        np.log(shear * s / np.pi),
        rupture,
    ])  # fmt: skip


def decode(eps: Array, ratio: Array, values: Array) -> dict[str, Array]:
    """Return the film's results by name from the values of `encode`, (8, ...); half is tan(attitude/2)."""
    s2 = (1 - eps) * (1 + eps)
    s, thin = np.sqrt(s2), np.sqrt((1 - eps) / (1 + eps))
    load, half, P_max, peak, side, supply, streamers = np.exp(values[:7])
    So = load_Ocvirk_1952(eps, ratio) * load
    half = half * np.pi * s / (4 * eps + np.sqrt(16 * eps**2 + np.pi**2 * s2))
    shear, pressure = np.pi / s, eps * So * half / (1 + half**2)
    return {
        "So": So,
        "attitude": 2 * np.arctan(half),
        "P_max": peak_pressure_Ocvirk_1952(eps, ratio) * P_max,
        "peak": -2 * np.arctan(thin * peak),
        "rupture": 2 * np.arctan(thin * values[7]),
        "friction": shear + pressure,
        "friction_bearing": shear - pressure,
        "friction_streamers": shear * streamers + pressure,
        "side_flow": 2 * ratio * eps * side,
        "supply_flow": ratio * (1 + eps) * supply,
    }


def encode_linear(eps: float, forces: Array) -> Array:
    """Return smooth values, (8,), for stiffness and damping in axes of the line of centres."""
    thin = np.sqrt((1 - eps) / (1 + eps))
    scale = eps / float(np.hypot(*forces[:, 0]))
    K, B = forces[:, 1:3] * scale * thin**_STIFFNESS_SCALE, forces[:, 3:5] * scale * thin**_DAMPING_SCALE
    return np.concatenate([K.ravel(), B.ravel()])


def require_mapped(eps: Array, ratio: Array) -> None:
    """Raise an error for a point outside the map.

    Raises
    ------
    ValueError
        If an argument is outside its range; the message names it and its limit.
    """
    require_film(eps, ratio)
    ratio = np.asarray(ratio)
    require((ratio >= NARROWEST) & (ratio <= WIDEST), "ratio B/D must lie in [0.01, 100] for the film map")


def _place(eps: Array, ratio: Array) -> tuple[Array, Array]:
    """Return the coordinates of the map."""
    return np.arctanh(eps), np.log(ratio)


def _look_up(coefficients: Array, eps: Array, ratio: Array) -> Array:
    """Return the interpolated functions at points of any shape, (functions, ...)."""
    require_mapped(eps, ratio)
    x, y = np.broadcast_arrays(*_place(eps, ratio))
    data = film_map()
    values = surface(coefficients, data.eccentricity, data.width, x.ravel(), y.ravel())
    return values.reshape(coefficients.shape[-1], *x.shape)
