"""The array type of the physics functions, and domain checks of values, points and curves."""

import numpy as np

from templates.core.arrays import Array, Mask
from templates.core.language.declare import units

ECCENTRICITY_LIMIT = 1 - 1e-7
"""The largest relative eccentricity that any formula here accepts."""


def require(accepted: Mask, complaint: str) -> None:
    """Raise an error unless every element is accepted; NaN is never accepted.

    Raises
    ------
    ValueError
        If an element is not accepted; the message is the given complaint, which names the argument and its
        limit.
    """
    if not np.all(accepted):
        raise ValueError(complaint)


def require_film(eps: Array, ratio: Array) -> None:
    """Raise an error for an eccentricity or a width ratio outside its range.

    The eccentricity must be in [0, 1 − 1e-7], the width ratio positive and finite.

    Raises
    ------
    ValueError
        If an argument is outside its range; the message names it and its limit.
    """
    eps, ratio = np.asarray(eps), np.asarray(ratio)
    require((eps >= 0) & (eps <= ECCENTRICITY_LIMIT), "eps must lie in [0, 1 - 1e-7]")
    require((ratio > 0) & np.isfinite(ratio), "ratio B/D must be positive and finite")


def spread(scale: Array, profile: Array) -> Array:
    """Return a profile for every point, (..., places): the scale of each point times its profile."""
    return scale[..., None] * profile


@units("N", "N", returns="N", latex=r"\max\sqrt{{{0}^2+{1}^2}}")
def largest_load(x: Array, y: Array) -> Array:
    """Return the largest magnitude of a load over the cycle [N]."""
    return np.asarray(np.sqrt((x * x + y * y).max(axis=-1)))[()]
