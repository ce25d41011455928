"""The fit eps = k1 So^k2 of the relative eccentricity, with the constants tabulated in the paper.

References
----------
Bhadke, Chaudhari, Sharma: Study of minimum oil film thickness, IJETR 3(5), 2015; for W/D = 32/85.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

_CASES = r"\begin{{cases}}%s & {0}<10\\ %s & 10\le {0}\le 100\\ %s & {0}>100\end{{cases}}"


@units("1", returns="1", latex=_CASES % (0.798, 0.897, 0.980))
def factor_k1(So: Array) -> Array:
    """Return the factor k1 of the fit at So [1]; outside 1 … 200 it is that of the nearest row."""
    return _row(So, 0.798, 0.897, 0.980)


@units("1", returns="1", latex=_CASES % (0.073, 0.022, 0.0028))
def exponent_k2(So: Array) -> Array:
    """Return the exponent k2 of the fit at So [1]; outside 1 … 200 it is that of the nearest row."""
    return _row(So, 0.073, 0.022, 0.0028)


def _row(So: Array, light: float, medium: float, heavy: float) -> Array:
    """Return the constant in the row for So (below 10, up to 100, above 100); a scalar for a scalar."""
    if isinstance(So, float):  # NumPy would take ten times as long
        return np.float64(light if So < 10 else medium if So <= 100 else heavy)
    return np.where(So < 10, light, np.where(So <= 100, medium, heavy))[()]
