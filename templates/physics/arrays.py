"""The array type of the physics functions, and the refusal of values outside a formula's domain."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ECCENTRICITY_LIMIT = 1 - 1e-7
"""The largest relative eccentricity that any formula here accepts."""


def require(accepted: Mask, complaint: str) -> None:
    """Refuse unless every element is accepted; a NaN never is.

    Raises:
        ValueError: with the complaint, which names the argument and its limit.
    """
    if not np.all(accepted):
        raise ValueError(complaint)


def require_film(eps: Array, ratio: Array) -> None:
    """Refuse an eccentricity outside [0, 1 − 1e-7] or a width ratio that is not positive and finite.

    Raises:
        ValueError: naming the argument and its limit.
    """
    eps, ratio = np.asarray(eps), np.asarray(ratio)
    require((eps >= 0) & (eps <= ECCENTRICITY_LIMIT), "eps must lie in [0, 1 - 1e-7]")
    require((ratio > 0) & np.isfinite(ratio), "ratio B/D must be positive and finite")
