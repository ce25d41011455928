"""Scatter of outputs and yields of criteria, from eight or more independent scramblings of a Sobol' sequence.

Standard errors are computed from the spread between scramblings, because points within one scrambling are not
independent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.tolerances.factors import Factor, scattered, sobol
from templates.core.arrays import Array
from templates.core.criteria.comparison import UNDECIDED, is_met

Codes = NDArray[np.int8]

SCRAMBLINGS = 8
AIM = 5e-4
"""Target for the standard error of a yield."""
QUANTILES = (0.00135, 0.5, 0.99865)
BINS = 40


@dataclass(frozen=True)
class Rows:
    """The results for rows of factors.

    Attributes
    ----------
    outputs
        Array of shape (rows, outputs) [SI]; NaN where a row is refused.
    codes
        For each criterion, the verdict of each row as an index into `VERDICTS`.
    margins
        For each criterion, the margin of the value itself in each row [SI]; NaN if unknown.
    """

    outputs: Array
    codes: Mapping[str, Codes]
    margins: Mapping[str, Array]


Judged = Callable[[Array], Rows]


@dataclass(frozen=True)
class Spread:
    """The scatter of one output [SI].

    Attributes
    ----------
    quantiles
        Quantiles by their share of the products.
    edges, counts
        A histogram of all rows that have a value.
    """

    mean: float
    deviation: float
    quantiles: Mapping[float, float]
    edges: Array
    counts: Sequence[int]


@dataclass(frozen=True)
class Yield:
    """The share of products that meet a criterion.

    Attributes
    ----------
    value, standard_error
        The share whose value itself meets the limit, and its standard error; a refused row does not meet it.
    with_model_error
        The share that certainly meets the limit and the share that may meet it, given the stated model error.
    """

    value: float
    standard_error: float
    with_model_error: tuple[float, float]


@dataclass(frozen=True)
class Scatter:
    """The scatter over all scramblings; None for an output or criterion without a value in any row."""

    spreads: Sequence[Spread | None]
    yields: Mapping[str, Yield | None]
    rows: int
    refused: int


def scatter(
    factors: Sequence[Factor], judged: Judged, points: int, seed: int, most: int | None = None
) -> Scatter:
    """Return the scatter of `points` rows in eight scramblings of the factors.

    With `most`, the number of scramblings is doubled until every yield has a standard error of `AIM`, or
    until there are so many rows. The spread of only eight scramblings is too uncertain for an earlier stop.
    """
    each = points // SCRAMBLINGS
    parts: list[Rows] = []
    count = SCRAMBLINGS
    while len(parts) < count:
        rows = scattered(factors, sobol(len(factors), each, (seed, 2, len(parts))))
        parts.append(judged(rows))
        if len(parts) == count and 2 * count * each <= (most or 0):
            count *= 1 if len(parts) > SCRAMBLINGS and _largest_error(parts) <= AIM else 2
    outputs = np.vstack([part.outputs for part in parts])
    refused = int(np.isnan(outputs).all(axis=1).sum()) if outputs.shape[1] else 0
    return Scatter(
        [_spread(outputs[:, column]) for column in range(outputs.shape[1])],
        {name: _yield(name, parts) for name in parts[0].codes},
        len(outputs),
        refused,
    )


def _largest_error(parts: Sequence[Rows]) -> float:
    yields = (_yield(name, parts) for name in parts[0].codes)
    return max((one.standard_error for one in yields if one is not None), default=0.0)


def _spread(values: Array) -> Spread | None:
    values = values[~np.isnan(values)]
    if not values.size:
        return None
    counts, edges = np.histogram(values, bins=BINS, range=_range(values))
    quantiles = np.quantile(values, QUANTILES, method="median_unbiased")
    by_share = dict(zip(QUANTILES, quantiles.tolist(), strict=True))
    return Spread(float(values.mean()), float(values.std()), by_share, edges, counts.tolist())


def _range(values: Array) -> tuple[float, float]:
    """Return the range of a histogram; for a single value, a small range around it."""
    low, high = float(values.min()), float(values.max())
    margin = 0.0 if np.nextafter(low, np.inf) < high and high - low > 1e-9 * abs(high) else 1e-6 * abs(low)
    return (low - margin, high + margin) if high + margin > low - margin else (low - 0.5, high + 0.5)


def _yield(name: str, parts: Sequence[Rows]) -> Yield | None:
    """Return the yield of a criterion; its standard error is at least that of one row."""
    margins = np.array([part.margins[name] for part in parts])
    codes = np.array([part.codes[name] for part in parts])
    if np.isnan(margins).all():
        return None
    with np.errstate(invalid="ignore"):
        each = (margins >= 0).mean(axis=1)
    error = max(float(each.std(ddof=1)) / np.sqrt(len(parts)), 1 / margins.size)
    surely, maybe = float(is_met(codes).mean()), float((codes == UNDECIDED).mean())
    return Yield(float(each.mean()), float(error), (surely, surely + maybe))
