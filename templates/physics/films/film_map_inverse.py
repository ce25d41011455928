"""Relative eccentricity from load by the film map, for any number of points at once.

The load rises with eps, so the loads at the map's nodes bracket eps within one cell. Inside the cell the
spline is a cubic, and a bracketed search converges to rounding error.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_map import FilmMap, film_map, require_mapped
from templates.physics.films.short_bearing import load_Ocvirk_1952
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT, require
from templates.physics.numerics.roots import bracketed_root
from templates.physics.numerics.uniform_spline import line

_BLOCK = 4096
_LOWEST = 1e-20


def mapped_eccentricity(So: Array, ratio: Array) -> Array:
    """Return the relative eccentricity eps that carries So: the inverse of `film_map.mapped_load` [-].

    Parameters
    ----------
    So
        Sommerfeld number F psi²/(B D eta omega_h), 0 or more [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].

    Returns
    -------
    eps; 0 where So is 0, NaN where So is more than the film carries at eps 1 − 1e-7.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    So, ratio = np.broadcast_arrays(np.asarray(So, float), np.asarray(ratio, float))
    require(np.isfinite(So) & (So >= 0), "So must be 0 or more and finite")
    require_mapped(np.zeros(()), ratio)
    eps = np.zeros(So.size)
    for start in range(0, So.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        eps[part] = _block(film_map(), So.ravel()[part], ratio.ravel()[part])
    return eps.reshape(So.shape)


def _block(data: FilmMap, So: Array, ratio: Array) -> Array:
    """Return the eccentricities of a block of points: find the cell, then the root in it."""
    wanted = np.log(np.where(So > 0, So, 1.0) / ratio**2)
    coefficients = line(data.load[..., 0], data.width, np.log(ratio))
    inner = data.eccentricity.places()[1:-1]
    at_nodes = (coefficients[:, 1:-3] + 4 * coefficients[:, 2:-2] + coefficients[:, 3:-1]) / 6
    at_nodes += np.log(load_Ocvirk_1952(np.tanh(inner), np.ones(())))
    cell = (at_nodes <= wanted[:, None]).sum(axis=1)
    four = np.take_along_axis(coefficients, cell[:, None] + np.arange(4), axis=1)

    def excess(logarithm: Array) -> Array:
        x = np.exp(logarithm)
        _, weights = data.eccentricity.weights(x, cell)
        short = load_Ocvirk_1952(_eccentricity(x), np.ones(()))
        return np.asarray(np.einsum("ij,ij->i", weights, four) + np.log(short) - wanted)

    low, high = cell * data.eccentricity.step, (cell + 1) * data.eccentricity.step
    root = bracketed_root(excess, np.log(np.maximum(low, _LOWEST)), np.log(high))
    return np.where(So > 0, _eccentricity(np.exp(root)), 0.0)


def _eccentricity(x: Array) -> Array:
    """Return eps from the map's coordinate, limited so that rounding cannot exceed the bound."""
    return np.minimum(np.tanh(x), ECCENTRICITY_LIMIT)
