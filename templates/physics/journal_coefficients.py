"""The eight linear coefficients of a journal film at every fidelity that has them, also without load.

K = k c psi²/(B D eta omega_h) and B = b c psi²/(B D eta): stiffness and damping over So, times So, so that
both stay finite as the load vanishes. Axes: x along the load, y ahead of x in the sense of rotation. c is
the radial clearance, psi = c/R.
"""

from collections.abc import Callable

import numpy as np

from templates.physics.arrays import Array
from templates.physics.film_dynamics import plain_coefficients
from templates.physics.film_map import mapped_coefficients, mapped_load
from templates.physics.short_bearing import load_Ocvirk_1952
from templates.physics.short_dynamics import coefficients_Holmes_1960

_CENTRED = 1e-6
"""Eccentricity at which a centred journal's coefficients are taken: their limit [-]."""


def coefficients_at(level: str, eps: Array, ratio: Array) -> tuple[Array, Array]:
    """Stiffness and damping, (..., 2, 2) each; NaN at points that are NaN and at levels without them [-].

    Args:
        level: as in `static_journal`.
        eps: relative eccentricity [-].
        ratio: width over diameter B/D [-].
    """
    eps, ratio = np.broadcast_arrays(np.asarray(eps, float), np.asarray(ratio, float))
    known = np.isfinite(eps) & np.isfinite(ratio) & (level in SOLVERS)
    K, B = np.full((2, *eps.shape, 2, 2), np.nan)
    if known.any():
        K[known], B[known] = SOLVERS[level](np.maximum(eps[known], _CENTRED), ratio[known])
    return K, B


def _short(eps: Array, ratio: Array) -> tuple[Array, Array]:
    return _times(load_Ocvirk_1952(eps, ratio), *coefficients_Holmes_1960(eps))


def _mapped(eps: Array, ratio: Array) -> tuple[Array, Array]:
    return _times(mapped_load(eps, ratio), *mapped_coefficients(eps, ratio))


def _solved(eps: Array, ratio: Array) -> tuple[Array, Array]:
    films = [plain_coefficients(float(e), float(b), 256, 32) for e, b in zip(eps, ratio, strict=True)]
    So, K, B = (np.array([getattr(film, name) for film in films]) for name in ("So", "K", "B"))
    return _times(So, K, B)


def _times(So: Array, K: Array, B: Array) -> tuple[Array, Array]:
    return So[..., None, None] * K, So[..., None, None] * B


SOLVERS: dict[str, Callable[[Array, Array], tuple[Array, Array]]] = {
    "short_bearing": _short,
    "map": _mapped,
    "reynolds": _solved,
}
