"""Roots of many equations at once, each inside its bracket.

New versions use `root_between`, which calls SciPy. Released versions use `bracketed_root` with the same
method, because their results are frozen to the last digits.

References
----------
T. R. Chandrupatla, Adv. Eng. Software 28, 1997, p. 145;
P. O. J. Scherer, Computational Physics, 2010, section 6.1.7.3.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize.elementwise import find_root

from templates.core.arrays import Array

_STEPS = 200


def root_between(f: Callable[..., Array], low: Array, high: Array, *parameters: Array) -> Array:
    """Return x in [low, high] with f(x, *parameters) = 0, elementwise, by SciPy's `find_root`.

    Parameters
    ----------
    f
        An elementwise function of arrays. It is called only for elements that are not solved yet, so values
        that differ between elements must be passed as parameters, not by a closure.
    low, high
        The brackets; f has opposite signs at their ends.
    parameters
        Further arguments of f, arrays that broadcast with the brackets.

    Returns
    -------
    x; NaN where the bracket contains no change of sign or f is not finite.
    """
    result = find_root(f, (np.asarray(low, float), np.asarray(high, float)), args=parameters)
    return np.where(result.success, result.x, np.nan)[()]


def bracketed_root(f: Callable[[Array], Array], low: Array, high: Array, tolerance: float = 4e-16) -> Array:
    """Return x in [low, high] with f(x) = 0, elementwise, by inverse quadratic interpolation or bisection.

    Parameters
    ----------
    f
        An elementwise function of an array with the shape of low.
    low, high
        The brackets; f has opposite signs at their ends.
    tolerance
        Relative accuracy of x.

    Returns
    -------
    x; NaN where the bracket contains no change of sign.
    """
    a, b = np.array(high, float), np.array(low, float)
    fa, fb = f(a), f(b)
    held = np.sign(fa) * np.sign(fb) <= 0
    t = np.full(a.shape, 0.5)
    for _ in range(_STEPS):
        x = a + t * (b - a)
        fx = f(x)
        same = np.sign(fx) == np.sign(fa)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        best = np.where(np.abs(fb) < np.abs(fa), b, a)
        width = np.abs(b - a)
        floor = (2 * tolerance * np.abs(best) + np.finfo(float).tiny) / np.maximum(
            width, np.finfo(float).tiny
        )
        if np.all((floor > 0.5) | (fa == 0) | (fb == 0) | ~held):
            break
        t = np.clip(_interpolation(a, b, c, fa, fb, fc), np.minimum(floor, 0.5), np.maximum(1 - floor, 0.5))
    return np.where(held, best, np.nan)


def _interpolation(a: Array, b: Array, c: Array, fa: Array, fb: Array, fc: Array) -> Array:
    """Return the fraction from a to b at which the inverse parabola vanishes, or 1/2 if unreliable."""
    with np.errstate(all="ignore"):
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        trusted = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
        t = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return np.where(trusted & np.isfinite(t), t, 0.5)
