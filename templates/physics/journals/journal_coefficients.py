"""The eight linear coefficients of a journal film at every fidelity that has them, also without load.

K = k c psi²/(B D eta omega_h) and B = b c psi²/(B D eta) are the usual stiffness and damping multiplied by
So, so that both stay finite as the load vanishes. Axes: x along the load, y ahead of x in the sense of
rotation. c is the radial clearance, psi = c/R.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.cavities.fed_film import Feed, fed_coefficients
from templates.physics.films.film_dynamics import plain_coefficients
from templates.physics.films.film_map import mapped_coefficients, mapped_load
from templates.physics.films.short_bearing import load_Ocvirk_1952
from templates.physics.films.short_dynamics import coefficients_Holmes_1960

_CENTRED = 1e-6
"""Eccentricity used for the limit of the coefficients of a centred journal [-]."""


@dataclass(frozen=True)
class Linear:
    """The individual coefficients, dimensionless as above; M_c is the largest stable mass."""

    K_xx: Array
    K_xy: Array
    K_yx: Array
    K_yy: Array
    B_xx: Array
    B_xy: Array
    B_yx: Array
    B_yy: Array
    M_c: Array
    """M omega² c psi²/(B D eta omega_h), with M the rotor mass per film; infinite if every mass is stable."""


def coefficients_at(
    level: str,
    eps: Array,
    ratio: Array,
    attitude: Array | float = 0.0,
    pressure: Array | float = 0.0,
    grooves: tuple[tuple[float, float], ...] = (),
) -> tuple[Array, Array]:
    """Return stiffness and damping, (..., 2, 2) each; NaN at points without a film and at level fit [-].

    Parameters
    ----------
    level
        As in `static_journal`.
    eps
        Relative eccentricity [-].
    ratio
        Width over diameter B/D [-].
    attitude
        Angle from the load to the narrowest gap, by which mass_conserving positions grooves [rad].
    pressure
        Supply pressure above ambient, used by mass_conserving [-].
    grooves
        (angle from the load, width) of each groove, used by mass_conserving [rad].
    """
    points = np.broadcast_arrays(*(np.asarray(a, float) for a in (eps, ratio, attitude, pressure)))
    valid = np.isfinite(points).all(axis=0) & (level in SOLVERS)
    K, B = np.full((2, *valid.shape, 2, 2), np.nan)
    if valid.any():
        eps, ratio, attitude, pressure = (point[valid] for point in points)
        feeds = [Feed(p, grooves) for p in pressure]
        K[valid], B[valid] = SOLVERS[level](np.maximum(eps, _CENTRED), ratio, attitude, feeds)
    return K, B


def _short(eps: Array, ratio: Array, *_: object) -> tuple[Array, Array]:
    return _times(load_Ocvirk_1952(eps, ratio), *coefficients_Holmes_1960(eps))


def _mapped(eps: Array, ratio: Array, *_: object) -> tuple[Array, Array]:
    return _times(mapped_load(eps, ratio), *mapped_coefficients(eps, ratio))


def _solved(eps: Array, ratio: Array, *_: object) -> tuple[Array, Array]:
    films = [plain_coefficients(float(e), float(b), 256, 32) for e, b in zip(eps, ratio, strict=True)]
    So, K, B = (np.array([getattr(film, name) for film in films]) for name in ("So", "K", "B"))
    return _times(So, K, B)


def _conserving(eps: Array, ratio: Array, attitude: Array, feeds: list[Feed]) -> tuple[Array, Array]:
    films = [fed_coefficients(*point) for point in zip(eps, ratio, attitude, feeds, strict=True)]
    K, B = np.array(films).swapaxes(0, 1)
    return K, B


def _times(So: Array, K: Array, B: Array) -> tuple[Array, Array]:
    return So[..., None, None] * K, So[..., None, None] * B


SOLVERS: dict[str, Callable[[Array, Array, Array, list[Feed]], tuple[Array, Array]]] = {
    "short_bearing": _short,
    "map": _mapped,
    "reynolds": _solved,
    "mass_conserving": _conserving,
}
