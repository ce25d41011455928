"""The fit of DIN 31652-2 / ISO 7902-2 to the converged film of 1976: load and attitude, 1/8 ≤ B/D ≤ 1.

Within its range the error of So is 2.4 % (median) and 6.8 % (largest); the error of the attitude is 0.7° and
2.4°. Outside its range it is badly wrong (+221 % at B/D 1.5, tenfold at 2), so values there are refused.
Boundary condition: P = 0 at the ends and at the widest gap, Swift–Stieber rupture.

References
----------
DIN 31652-2:1983; ISO 7902-2:1998, clause 4; K. Butenschön, Diss. Karlsruhe 1976.
"""

import numpy as np
from numpy.polynomial.polynomial import polyval

from templates.core.arrays import Array
from templates.physics.films.short_bearing import load_Ocvirk_1952
from templates.physics.numerics.arrays import require, require_film

NARROWEST, WIDEST = 0.125, 1.0
"""Width ratios B/D that the fit covers [-]."""

_A1 = (1.1642, -1.9456, 7.1161, -10.1073, 5.0141)
_A2 = (-1.000026, -0.023634, -0.4215, -0.038817, -0.090551)
_ANGLE = np.array([(1.152624, -0.105465), (-2.5905, 0.798745), (8.73393, -2.3291),
                   (-13.3414, 3.424337), (6.6294, -1.591732)])  # fmt: skip


def _require_width(eps: Array, ratio: Array) -> None:
    """Raise an error for a width ratio outside the range of the fit."""
    require_film(eps, ratio)
    ratio = np.asarray(ratio)
    require((ratio >= NARROWEST) & (ratio <= WIDEST), "ratio B/D must lie in [1/8, 1] for the ISO 7902 fit")


def load_ISO_7902(eps: Array, ratio: Array) -> Array:
    r"""Return the Sommerfeld number So = F psi²/(B D eta omega) by the standard's fit [-].

    .. math:: So = So_{Ocvirk}(\epsilon, b) \cdot a_1(b) \frac{\epsilon - 1}{a_2(b) + \epsilon}

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter b = B/D, 1/8 … 1 [-].

    Raises
    ------
    ValueError
        If an argument lies outside its range.

    Examples
    --------
    >>> round(float(load_ISO_7902(0.5, 0.5)), 3)
    0.315

    References
    ----------
    ISO 7902-2:1998.
    """
    _require_width(eps, ratio)
    return load_Ocvirk_1952(eps, ratio) * polyval(ratio, _A1) * (eps - 1) / (polyval(ratio, _A2) + eps)


def attitude_ISO_7902(eps: Array, ratio: Array) -> Array:
    r"""Return the angle between load and narrowest gap by the standard's fit [rad].

    .. math:: \beta = \arctan\frac{\pi\sqrt{1-\epsilon^2}}{2\epsilon}
        \sum_{k=0}^4 (c_{k0} + c_{k1} b)\,\epsilon^k

    One public copy prints 0.104565 for 0.105465.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter b = B/D, 1/8 … 1 [-].

    Raises
    ------
    ValueError
        If an argument lies outside its range.

    References
    ----------
    ISO 7902-2:1998.
    """
    _require_width(eps, ratio)
    factor = polyval(eps, [constant + slope * ratio for constant, slope in _ANGLE], tensor=False)
    return np.asarray(np.arctan2(np.pi * np.sqrt((1 - eps) * (1 + eps)), 2 * eps) * factor)
