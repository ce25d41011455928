"""Find the worst of several points and places: the worst verdict, then the value nearest to its limit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array, Mask
from templates.core.criteria.comparison import NOT_CHECKED, Comparison
from templates.core.criteria.criterion import Criterion


@dataclass(slots=True)  # a frozen instance would take four times as long to create
class Worst:
    """Both sides [SI] and their bands at the worst place; `index` is empty for a single value."""

    index: tuple[int, ...]
    code: int
    is_known: bool  # every error that contributes to the bands
    value: float
    limit: float
    low: float
    high: float
    limit_low: float
    limit_high: float

    @property
    def is_limit_exact(self) -> bool:
        """Return whether the limit has no error."""
        return self.limit_low == self.limit_high


def worst_of(criterion: Criterion, compared: Comparison) -> Worst:
    """Return the worst point and place of a comparison."""
    sides = (compared.value, compared.limit, *compared.value_bounds, *compared.limit_bounds)
    codes = compared.codes
    if isinstance(codes, int):
        return Worst((), codes, bool(compared.is_known), *map(float, sides))
    whole = [np.broadcast_to(side, codes.shape) for side in sides]
    clearance = _clearance(criterion, whole)
    if codes.min() != NOT_CHECKED:  # points judged by another comparison have no numbers to report
        clearance = np.where(_has_numbers(whole), clearance, np.finfo(float).max)
    clearance = np.where(codes == codes.min(), clearance, np.inf)
    index = np.unravel_index(int(np.argmin(clearance)), codes.shape)
    place = tuple(map(int, index))
    known = bool(np.broadcast_to(compared.is_known, codes.shape)[place])
    return Worst(place, int(codes[place]), known, *(float(side[place]) for side in whole))


def worst_of_rows(criterion: Criterion, compared: Comparison, count: int) -> tuple[Array, list[Array]]:
    """Return the verdict of each row, and both sides with their bands at its worst place.

    Parameters
    ----------
    compared
        A comparison whose first axis is the row, or one of single values for all `count` rows.

    Returns
    -------
    tuple
        Codes (count,); value, limit, low, high, lowest and highest limit [SI], each (count,); and a mask of
        the rows for which all contributing errors are known.
    """
    sides = (compared.value, compared.limit, *compared.value_bounds, *compared.limit_bounds)
    codes = np.asarray(compared.codes)
    shape = codes.shape or (1,)
    known = compared.is_known
    whole = [np.broadcast_to(side, shape).reshape(shape[0], -1) for side in (codes, *sides, known)]
    if whole[0].shape[1] > 1:
        worst = whole[0] == whole[0].min(axis=1, keepdims=True)
        clearance = np.where(worst, _clearance(criterion, whole[1:-1]), np.inf)
        place = np.argmin(clearance, axis=1, keepdims=True)
        whole = [np.take_along_axis(side, place, axis=1) for side in whole]
    rows = [np.broadcast_to(side[:, 0], (count,)) for side in whole]
    return rows[0], rows[1:]


def _clearance(criterion: Criterion, sides: list[Array]) -> Array:
    """Return the distance of the worst bound from the limit, positive on the safe side.

    The distance is relative if the limit is not zero. If the band is open, the value itself is used. A
    missing value gets a finite number, so that it differs from masked points.
    """
    value, limit, low, high, limit_low, limit_high = sides
    with np.errstate(all="ignore"):
        if criterion.sign == ">=":
            bound, nominal = low - limit_high, value - limit
        else:
            bound, nominal = limit_low - high, limit - value
        gap = np.where(np.isfinite(bound), bound, nominal)
        relative = np.where(limit != 0, gap / np.abs(limit), gap)
    return np.nan_to_num(relative)


def _has_numbers(sides: list[Array]) -> Mask:
    return ~(np.isnan(sides[0]) | np.isnan(sides[1]))
