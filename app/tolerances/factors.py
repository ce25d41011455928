"""Toleranced values as random numbers: quasi-random rows, and rows that search the limits.

A *factor* is one toleranced value. Rows of factors are arrays of shape (rows, factors) in SI.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.special import ndtr, ndtri

from templates.core.arrays import Array
from templates.core.units.tolerance import Distribution

CUT = 3.0  # standard deviations at which a normal distribution is cut off at its limits
MOST_AT_THREE, MOST_AT_TWO = 6, 12  # most factors for a lattice with three values each, and with two


@dataclass(frozen=True)
class Factor:
    """A value between limits.

    Attributes
    ----------
    name
        Name of the value in its design.
    nominal, low, high
        The nominal value and the limits [SI].
    distribution
        The distribution between the limits.
    """

    name: str
    nominal: float
    low: float
    high: float
    distribution: Distribution = "normal"


def inverse(distribution: Distribution, share: Array) -> Array:
    """Return the quantile of a distribution as a position from −1 to 1 between the limits.

    `normal` has its limits at ±3 standard deviations, where it is cut off. `triangular` has its peak in the
    middle.
    """
    if distribution == "uniform":
        return 2 * share - 1
    if distribution == "triangular":
        rising: Array = np.sqrt(2 * np.minimum(share, 1 - share)) - 1
        return np.where(share < 0.5, rising, -rising)
    below = ndtr(-CUT)
    scaled: Array = np.clip(ndtri(below + share * (1 - 2 * below)) / CUT, -1, 1)
    return scaled


def placed(factors: Sequence[Factor], position: Array) -> Array:
    """Return the values [SI] at positions from −1 (lower limits) to 1 (upper limits)."""
    low, high = np.array([f.low for f in factors]), np.array([f.high for f in factors])
    between: Array = np.clip(0.5 * ((1 - position) * low + (1 + position) * high), low, high)
    return between


def scattered(factors: Sequence[Factor], shares: Array) -> Array:
    """Return the values [SI] for points of the unit cube, with the distributions of the factors."""
    columns = [inverse(f.distribution, shares[:, i]) for i, f in enumerate(factors)]
    return placed(factors, np.stack(columns, axis=1))


def sobol(dimensions: int, count: int, seed: Sequence[int]) -> Array:
    """Return a scrambled Sobol' sequence in the unit cube; the number of points is a power of two."""
    from scipy.stats import qmc  # this import takes as long as all others of a small command

    sequence = qmc.Sobol(dimensions, scramble=True, rng=np.random.default_rng(list(seed)))
    points: Array = sequence.random_base2(count.bit_length() - 1)
    return points


def lattice(count: int) -> Array:
    """Return positions on a lattice between the limits, as fine as the number of factors allows.

    The middle is always among them.
    """
    if count <= MOST_AT_THREE:
        return np.array(list(product((-1.0, 0.0, 1.0), repeat=count)))
    axes = np.vstack([np.zeros(count), np.eye(count), -np.eye(count)])
    if count > MOST_AT_TWO:
        return axes
    return np.vstack([axes, np.array(list(product((-1.0, 1.0), repeat=count)))])
