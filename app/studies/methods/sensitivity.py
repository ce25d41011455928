"""Influence of each varied value: slopes at a point, Morris' screening, Sobol' indices.

References
----------
Morris 1991, Technometrics 33, 161; Campolongo, Cariboni and Saltelli 2007, Environ. Model. Softw. 22, 1509.
Saltelli et al. 2010, Comput. Phys. Commun. 181, 259. The estimators are SALib's.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.designs.slopes import Local, Slopes, slopes_at
from app.studies.methods.extras import extra
from app.studies.methods.space import Space
from templates.core.arrays import Array
from templates.core.errors import Fault, InvalidInputs

CONFIDENCE = 0.95
"""Confidence level of the intervals around indices and effects, by bootstrap."""


def slopes(points: Local, output: str, y: Array) -> Slopes:
    """Return the slopes of an output at a point from its values [SI] at the rows of `points`.

    Raises
    ------
    InvalidInputs
        If a row has no value; the code is `refused_rows`.
    """
    _complete(output, y, len(y))
    return slopes_at(points, y)


@dataclass(frozen=True)
class MorrisPoints:
    """Rows of Morris' screening: trajectories of d + 1 rows each, on a lattice of `levels`."""

    space: Space
    trajectories: int
    seed: int
    levels: int = 4

    @property
    def count(self) -> int:
        """Return the number of rows."""
        return self.trajectories * (len(self.space) + 1)

    @cached_property
    def unit(self) -> Array:
        """Return all rows as points of the unit cube."""
        sample = extra("SALib.sample.morris").sample
        problem, random = _problem(self.space), np.random.default_rng(self.seed)
        return np.asarray(sample(problem, self.trajectories, num_levels=self.levels, seed=random))

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, excluding `last`."""
        return self.space.at(self.unit[first:last])


@dataclass(frozen=True)
class Effects:
    """The change of an output [SI] as a variable crosses its whole range, shape (d,).

    Attributes
    ----------
    mean, mean_absolute, spread
        µ, µ* and σ: direction, importance, and variation of the effect over the box.
    confidence
        Half the width of the 95 % interval of µ*.
    """

    mean: Array
    mean_absolute: Array
    spread: Array
    confidence: Array


def effects(points: MorrisPoints, output: str, y: Array) -> Effects:
    """Return the elementary effects of an output from its values [SI] at the rows of `points`.

    Raises
    ------
    InvalidInputs
        If a row has no value; the code is `refused_rows`.
    """
    _complete(output, y, points.count)
    analyse = extra("SALib.analyze.morris").analyze
    by_name = analyse(
        _problem(points.space),
        points.unit,
        np.asarray(y, dtype=np.float64),
        conf_level=CONFIDENCE,
        num_levels=points.levels,
        seed=np.random.default_rng(points.seed),
    )
    return Effects(*(_plain(by_name[name]) for name in ("mu", "mu_star", "sigma", "mu_star_conf")))


@dataclass(frozen=True)
class SobolPoints:
    """Rows for Sobol' indices: `base` points of the scrambled sequence, d + 2 rows for each (Saltelli).

    Raises
    ------
    InvalidInputs
        If `base` is not a power of two; the code is `points`.
    """

    space: Space
    base: int
    seed: int

    def __post_init__(self) -> None:
        if self.base < 2 or self.base & (self.base - 1):
            low = 2 ** max(1, min(self.base, 10**6).bit_length() - 1)
            detail = f"{self.base} is not a power of two; write {low} or {2 * low}"
            raise InvalidInputs([Fault("points", "points", detail)])

    @property
    def count(self) -> int:
        """Return the number of rows."""
        return self.base * (len(self.space) + 2)

    @cached_property
    def unit(self) -> Array:
        """Return all rows as points of the unit cube."""
        sample = extra("SALib.sample.sobol").sample
        problem, random = _problem(self.space), np.random.default_rng(self.seed)
        return np.asarray(sample(problem, self.base, calc_second_order=False, seed=random))

    def rows(self, first: int, last: int) -> Array:
        """Return rows `first` to `last`, excluding `last`."""
        return self.space.at(self.unit[first:last])


@dataclass(frozen=True)
class Indices:
    """Shares of the variance of an output, shape (d,), each with half the width of its 95 % interval.

    `first` is the share that disappears if the variable is fixed; `total` the share that remains if all other
    variables are fixed.
    """

    first: Array
    first_confidence: Array
    total: Array
    total_confidence: Array


def indices(points: SobolPoints, output: str, y: Array) -> Indices:
    """Return the Sobol' indices of an output from its values [SI] at the rows of `points`.

    Raises
    ------
    InvalidInputs
        If a row has no value, because a single one would make every index NaN; the code is `refused_rows`.
        If the output does not vary; the code is `constant`.
    """
    _complete(output, y, points.count)
    if np.ptp(y) <= np.finfo(float).eps * np.abs(y).max():
        detail = f"{output} is {float(y[0]):.6g} [SI] in all rows, so no variable has a share of its variance"
        raise InvalidInputs([Fault(output, "constant", detail)])
    analyse = extra("SALib.analyze.sobol").analyze
    random = np.random.default_rng(points.seed)  # SALib treats a seed of 0 as no seed
    by_name = analyse(
        _problem(points.space),
        np.asarray(y, dtype=np.float64),
        calc_second_order=False,
        conf_level=CONFIDENCE,
        seed=random,
    )
    return Indices(*(_plain(by_name[name]) for name in ("S1", "S1_conf", "ST", "ST_conf")))


def _problem(space: Space) -> dict[str, object]:
    """Return the unit cube as a problem of SALib."""
    return {"num_vars": len(space), "names": space.names, "bounds": [[0.0, 1.0]] * len(space)}


def _plain(values: object) -> Array:
    return np.ma.filled(np.ma.asarray(values, dtype=np.float64), np.nan)


def _complete(output: str, y: Array, count: int) -> None:
    """Raise InvalidInputs if the number of values is wrong, or a row has no value."""
    if len(y) != count:
        raise ValueError(f"{output}: {len(y)} values for {count} rows")
    if missing := int(np.count_nonzero(~np.isfinite(y))):
        share = f"{missing} of {count} rows ({missing / count:.1%}) have no value of {output}"
        remedy = "narrow the bounds so that every row can be calculated"
        raise InvalidInputs(
            [Fault(output, "refused_rows", f"{share}, but sensitivities need a value in every row; {remedy}")]
        )
