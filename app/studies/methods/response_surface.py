"""A polynomial response surface of the columns of a coarse level, for searches whose calls are slow.

A search calls its coarse level some hundred times with a few rows. If a call costs milliseconds whatever its
rows, one call with a thousand rows and a surface through them cost less. A surface counts only if it
reproduces rows that it has not seen; otherwise the search uses the level itself.

References
----------
Myers, Montgomery, Anderson-Cook 2016, Response Surface Methodology, 4th edition, section 10.6.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain, combinations_with_replacement
from math import comb

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from templates.core.arrays import Array, Integers, Mask

DEGREE = 10
"""Highest total degree of a surface."""
ROWS_PER_TERM = 4
"""Smallest number of rows for each coefficient."""
HELD_OUT = 8
"""Each row with a number divisible by this one checks the surface instead of defining it."""


@dataclass(frozen=True)
class ResponseSurface:
    """Columns as polynomials of total degree `degree` over the unit cube, of the logarithm where possible.

    Attributes
    ----------
    exponents
        The degree of each term in each variable, shape (T, d).
    coefficients
        Shape (T, c).
    signs
        1 or -1 for a column whose logarithm is fitted, by its sign; 0 for any other, shape (c,).
    error
        The largest deviation in the rows that were held out: relative for a logarithm, else relative to the
        range of the column.
    """

    exponents: Integers
    coefficients: Array
    signs: Array
    error: float = np.inf

    def __call__(self, unit: Array) -> Array:
        """Return the columns at points of the unit cube, shape (N, c)."""
        values = _terms(unit, self.exponents) @ self.coefficients
        with np.errstate(over="ignore"):
            return np.asarray(np.where(self.signs == 0, values, self.signs * np.exp(values)))


def fitted(unit: Array, columns: Array) -> ResponseSurface | None:
    """Return the surface through finite columns, shape (N, c), at points of the unit cube, shape (N, d).

    Return None if there are too few rows for a quadratic surface.
    """
    held: Mask = np.arange(len(unit)) % HELD_OUT == 0
    degree = _degree(unit.shape[1], int((~held).sum()))
    if degree < 2:
        return None
    exponents = _exponents(unit.shape[1], degree)
    signs = np.where((columns > 0).all(axis=0), 1.0, np.where((columns < 0).all(axis=0), -1.0, 0.0))
    with np.errstate(all="ignore"):
        values = np.where(signs == 0, columns, np.log(np.abs(columns)))
    solution = np.linalg.lstsq(_terms(unit[~held], exponents), values[~held], rcond=None)
    coefficients = np.asarray(solution[0], dtype=np.float64)
    apart = np.abs(_terms(unit[held], exponents) @ coefficients - values[held])
    width = np.where(signs == 0, np.ptp(values, axis=0), 1.0)
    error = float(np.max(apart / np.where(width > 0, width, 1.0), initial=0.0))
    return ResponseSurface(exponents, coefficients, signs, error)


def _degree(dimensions: int, rows: int) -> int:
    """Return the highest degree for which there are enough rows."""
    fitting = (n for n in range(DEGREE, 0, -1) if ROWS_PER_TERM * comb(n + dimensions, dimensions) <= rows)
    return next(fitting, 0)


def _exponents(dimensions: int, degree: int) -> Integers:
    """Return the exponents of all terms up to a total degree, shape (T, d)."""
    chosen = (combinations_with_replacement(range(dimensions), total) for total in range(degree + 1))
    return np.array([[one.count(n) for n in range(dimensions)] for one in chain.from_iterable(chosen)])


def _terms(unit: Array, exponents: Integers) -> Array:
    """Return the products of Chebyshev polynomials at each point, shape (N, T)."""
    whole = np.ones((len(unit), len(exponents)))
    for variable, exponent in enumerate(exponents.T):
        whole *= chebvander(2 * unit[:, variable] - 1, int(exponent.max()))[:, exponent]
    return whole
