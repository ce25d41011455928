"""Compare two sides with their bands, and give a verdict at every point and every place of a curve.

The values themselves decide the verdict, unless a known band contains the limit. The verdict also states
whether every error is known: `met` with an unknown error is not confirmed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Mask, Truth
from templates.core.criteria.bands import Bounds, Estimate, Shift, aligned, spread, value_and_bounds
from templates.core.criteria.criterion import Criterion, Sign
from templates.core.errors import FaultyText
from templates.core.units.relation import Relation
from templates.core.units.units import Value

Verdict = Literal["not_met", "undecided", "not_checked", "met"]

WORST_FIRST: tuple[Verdict, ...] = ("not_met", "undecided", "not_checked", "met")
NOT_MET, UNDECIDED, NOT_CHECKED, MET_ERROR_UNKNOWN, MET = range(5)
VERDICTS: tuple[Verdict, ...] = (*WORST_FIRST, "met")
"""The verdict of each code."""
Codes = int | NDArray[np.int8]
"""Verdicts as indices in `VERDICTS`: the smallest is the worst. Met with an unknown error has its own code.
"""


def is_met(codes: NDArray[Any]) -> Mask:
    """Return a mask of the verdicts that are met, whether their errors are known or not."""
    mask: Mask = np.isin(codes, (MET_ERROR_UNKNOWN, MET))
    return mask


@dataclass(slots=True)  # a frozen instance would take four times as long to create
class Comparison:
    """Both sides of a criterion [SI] with their bands, and the verdict at every point and place.

    Attributes
    ----------
    is_known
        Where every error that contributes to the bands is known; the bands contain only the known errors.
    """

    value: Value
    limit: Value
    value_bounds: Bounds
    limit_bounds: Bounds
    is_known: Truth
    codes: Codes
    axes: int

    def filled(self, rows: Codes) -> Comparison:
        """Return a copy with the given verdicts at the points where a side has no value.

        Verdicts of a curve do not change.
        """
        if self.axes:
            return self
        codes = np.where(np.equal(self.codes, NOT_CHECKED), rows, self.codes).astype(np.int8)
        return replace(self, codes=codes if codes.ndim else int(codes))

    def rows(self) -> Codes:
        """Return the verdict at every point; for a curve, the worst verdict of its places."""
        if not self.axes or isinstance(self.codes, int):
            return self.codes
        worst = self.codes.min(axis=tuple(range(-self.axes, 0)))
        return worst if worst.ndim else int(worst)


def compare(
    criterion: Criterion,
    estimates: Mapping[str, Estimate],
    shifts: Sequence[Shift] = (),
    *,
    is_known: Truth = True,
) -> Comparison:
    """Compare the sides of a criterion, all of whose names have estimates; places with NaN are not checked.

    `shifts` are the values of all names after an upstream value was moved to either end of its band;
    `is_known` states where all upstream errors are known.

    Raises
    ------
    FaultyText
        If arrays have different lengths; the code is `shape`.
    """
    axes = max(estimates[name].axes for name in criterion.names) if criterion.names else 0
    fitted = aligned(estimates, axes)
    moved = [(_spread(low, estimates, axes), _spread(high, estimates, axes)) for low, high in shifts]
    value, value_bounds, is_value_known = value_and_bounds(criterion.value, fitted, moved)
    limit, limit_bounds, is_limit_known = value_and_bounds(criterion.limit, fitted, moved)
    try:
        known = is_known & is_value_known & is_limit_known
        codes = verdicts(criterion.sign, value, limit, value_bounds, limit_bounds, known)
    except ValueError:
        message = f"{criterion.require!r} compares arrays of different lengths"
        raise FaultyText("shape", message) from None
    return Comparison(value, limit, value_bounds, limit_bounds, known, codes, axes)


def _spread(values: Mapping[str, Value], estimates: Mapping[str, Estimate], axes: int) -> Mapping[str, Value]:
    """Return the shifted values; a value for each point becomes an array that broadcasts along a curve."""
    return {name: v if estimates[name].axes else spread(v, axes) for name, v in values.items()}


def side_of(side: Relation, estimates: Mapping[str, Estimate]) -> Value:
    """Return the value of a side [SI]."""
    if name := side.only_name:
        return estimates[name].value
    return side.value({name: estimates[name].value for name in side.names})


def verdicts(
    sign: Sign,
    value: Value,
    limit: Value,
    value_bounds: Bounds,
    limit_bounds: Bounds,
    is_known: Truth = True,
) -> Codes:
    """Return the verdicts for two sides with their bands; equality meets the criterion.

    The bands include the known errors; `is_known` states where all errors are known.
    """
    safe, bad = _opposed(sign, value_bounds, limit_bounds)
    ends = value, limit, *safe, *bad
    if isinstance(is_known, (bool, np.bool_)) and not [end for end in ends if not isinstance(end, float)]:
        if value != value or limit != limit:
            return NOT_CHECKED
        met = MET if is_known else MET_ERROR_UNKNOWN
        return met if safe[0] >= safe[1] else NOT_MET if bad[0] < bad[1] else UNDECIDED
    with np.errstate(invalid="ignore"):
        is_met = np.greater_equal(*safe)
        decided = [np.isnan(value) | np.isnan(limit), is_met & is_known, is_met, np.less(*bad)]
    cases = [NOT_CHECKED, MET, MET_ERROR_UNKNOWN, NOT_MET]
    codes = np.select(np.broadcast_arrays(*decided), cases, UNDECIDED)
    return codes.astype(np.int8) if codes.ndim else int(codes)


def _opposed(sign: Sign, value: Bounds, limit: Bounds) -> tuple[Bounds, Bounds]:
    """Return two pairs (a, b) of bounds.

    The criterion is met if a ≥ b in the first pair, and not met if a < b in the second.
    """
    if sign == ">=":
        return (value[0], limit[1]), (value[1], limit[0])
    return (limit[0], value[1]), (limit[1], value[0])
