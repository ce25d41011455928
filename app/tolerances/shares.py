"""Shares of each toleranced value in the variance of each output: Sobol' indices.

Eight scrambled Sobol' sequences of twice as many dimensions give pairs of independent samples A and B, and
for each factor a sample AB that has this factor from B. First-order shares are estimated after Saltelli 2010
(table 2, b), which is exact for a factor without effect, and after Jansen 1999, which is exact for a factor
that causes the whole variance. Total shares are estimated after Jansen, and as the remainder that the other
factors leave. The estimate with the smaller standard error is used. All estimates use the eight sequences
together; their standard errors come from a jackknife that leaves out one sequence at a time.

References
----------
Saltelli et al.: Variance based sensitivity analysis of model output, Comput. Phys. Commun. 181 (2010).
Jansen: Analysis of variance designs for model output, Comput. Phys. Commun. 117 (1999).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.tolerances.factors import Factor, scattered, sobol
from app.tolerances.scatter import SCRAMBLINGS
from app.tolerances.worst import Outputs
from templates.core.arrays import Array

NEGLIGIBLE = 1e-10  # a smaller standard deviation, relative to the output, is rounding and no scatter


@dataclass(frozen=True)
class Share:
    """The share of a factor in an output's variance, alone (`first`) and with interactions (`total`)."""

    first: float
    total: float
    first_error: float
    total_error: float


@dataclass(frozen=True)
class Parts:
    """The shares of all factors in one output, and the sum of the first-order shares with its error."""

    shares: Sequence[Share]
    sum: float
    sum_error: float


@dataclass(frozen=True)
class Shares:
    """The parts of each output; None for an output without scatter, or refused in any row."""

    outputs: Sequence[Parts | None]
    rows: int


def shares(factors: Sequence[Factor], outputs: Outputs, base: int, seed: int) -> Shares:
    """Return all shares, estimated from `base` · (factors + 2) rows; `base` is eight times a power of two."""
    each = base // SCRAMBLINGS
    samples = [_samples(factors, outputs, each, (seed, 3, number)) for number in range(SCRAMBLINGS)]
    stacked = np.stack(samples)  # scramblings, samples (A, B, AB...), rows, outputs
    by_output = [_of_output(stacked[..., column]) for column in range(stacked.shape[-1])]
    return Shares(by_output, base * (len(factors) + 2))


def _samples(factors: Sequence[Factor], outputs: Outputs, count: int, seed: Sequence[int]) -> Array:
    """Return the outputs for A, B and one AB for each factor, of shape (samples, rows, outputs)."""
    number = len(factors)
    points = sobol(2 * number, count, seed)
    first, second = scattered(factors, points[:, :number]), scattered(factors, points[:, number:])
    mixed = [np.where(np.arange(number) == factor, second, first) for factor in range(number)]
    values = outputs(np.vstack([first, second, *mixed]))
    return values.reshape(number + 2, count, -1)


def _of_output(values: Array) -> Parts | None:
    """Return the shares of one output, from values of shape (scramblings, samples, rows)."""
    if np.isnan(values).any() or values.std() <= NEGLIGIBLE * np.abs(values).max():
        return None
    whole = _indices(values)
    without = np.stack([_indices(np.delete(values, number, axis=0)) for number in range(SCRAMBLINGS)])
    errors = _jackknife(without)
    taken = np.argmin(errors, axis=1)[:, np.newaxis]  # index of the better estimator
    values_taken, errors_taken, without_taken = (
        np.take_along_axis(each, taken.reshape(shape), -2).squeeze(-2)
        for each, shape in ((whole, taken.shape), (errors, taken.shape), (without, (1, *taken.shape)))
    )
    each = [Share(*map(float, row)) for row in zip(*values_taken, *errors_taken, strict=True)]
    sum_error = _jackknife(without_taken[:, 0].sum(axis=-1))
    return Parts(each, float(values_taken[0].sum()), float(sum_error))


def _jackknife(without: Array) -> Array:
    """Return the standard error of an estimate, from estimates that each omit one scrambling (first axis)."""
    spread = ((without - without.mean(axis=0)) ** 2).sum(axis=0)
    error: Array = np.sqrt((SCRAMBLINGS - 1) / SCRAMBLINGS * spread)
    return error


def _indices(values: Array) -> Array:
    """Return first-order and total shares, each by two estimators, of shape (2, 2, factors)."""
    centred = values - values[:, :2].mean()
    a, b, mixed = centred[:, :1], centred[:, 1:2], centred[:, 2:]

    def mean(products: Array) -> Array:
        average: Array = products.mean(axis=(0, 2)) / centred[:, :2].var()
        return average

    first = mean(b * (mixed - a)), 1 - mean((b - mixed) ** 2) / 2
    total = mean((mixed - a) ** 2) / 2, 1 - mean(a * (mixed - b))
    return np.array([first, total])
