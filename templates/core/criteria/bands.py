"""Compute the band that contains the true value, for a value or an expression with stated relative errors.

A stated error e means |v - t| ≤ e |t|: the true value t lies between v/(1 + e) and v/(1 - e). `CONVENTION`
states this in one sentence. Every table of measured errors repeats it, and the scripts that measure errors
use `relative_error`. Several errors may contribute to one band. If one of them is unknown, the band includes
only the known errors and is marked as unknown.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask, Truth
from templates.core.errors import FaultyText
from templates.core.units.relation import Relation
from templates.core.units.units import Value

CONVENTION = "|answer - truth| <= error * |truth|"
"""The reference of every stated error: for a curve its largest |truth|, for others what the table names under
`relative_to`, such as 90° for an angle.
"""

Bounds = tuple[Value, Value]
"""The smallest and the largest possible true value."""

Shift = tuple[Mapping[str, Value], Mapping[str, Value]]
"""The values of all names [SI], with an upstream value moved to either end of its band."""


@dataclass(slots=True)  # a frozen instance would take four times as long to create
class Estimate:
    """A named value [SI] with its error.

    Attributes
    ----------
    value
        A number, or an array with points on the first axes and places along a curve on the last; NaN where
        there is no value.
    error
        Relative error; 0 if exact, NaN where unknown. Its shape is that of the points.
    axes
        How many of the last axes of the value are places along a curve.
    scale
        The reference value of the error [SI], if this is not the value itself, such as 90° for an angle. The
        error of a curve is relative to its largest value.
    reasons
        For an array of points, why there is no value; None where there is one.
    """

    value: Value
    error: Value = 0.0
    axes: int = 0
    scale: Value | None = None
    reasons: NDArray[np.object_] | None = None

    @property
    def is_exact(self) -> bool:
        """Return whether the value has no error."""
        if isinstance(self.error, float):
            return self.error == 0
        return not self.error.any()

    @property
    def is_known(self) -> Truth:
        """Return a mask of the values with a known error."""
        if isinstance(self.error, float):
            return not math.isnan(self.error)
        known: Mask = ~np.isnan(spread(self.error, self.axes))
        return known

    @property
    def is_known_throughout(self) -> bool:
        """Return whether the error is known at every point."""
        if isinstance(self.error, float):
            return not math.isnan(self.error)
        return not np.isnan(self.error).any()

    def bounds(self) -> Bounds:
        """Return the band of the value; if its error is unknown, both bounds are the value itself."""
        if self.is_exact or self.is_known is False:
            return self.value, self.value
        error = spread(self.error, self.axes)
        if self.scale is None and not self.axes:
            low, high = band(self.value, error)
        else:
            low, high = band_relative_to(self.value, error, self._scale())
        if isinstance(low, float) and isinstance(high, float):
            return low, high
        known = self.is_known
        return np.where(known, low, self.value), np.where(known, high, self.value)

    def _scale(self) -> Value:
        if self.scale is not None:
            return self.scale
        places = tuple(range(-self.axes, 0))
        return np.max(np.abs(self.value), axis=places, keepdims=True)


def spread(value: Value, axes: int) -> Value:
    """Return values of points as an array that broadcasts along a curve."""
    return value[(..., *(None,) * axes)] if axes and isinstance(value, np.ndarray) else value


def relative_error(value: Value, truth: Value, scale: Value | None = None) -> Array:
    """Return the error of a value by `CONVENTION`; 0 where both agree, infinite where only the truth is 0.

    Parameters
    ----------
    value, truth
        Numbers, or arrays that broadcast together.
    scale
        The reference value of the error, if this is not the truth itself, such as 90° for an angle.
    """
    size = np.abs(truth) if scale is None else scale
    with np.errstate(all="ignore"):
        return np.asarray(np.where(value == truth, 0.0, np.abs(value - truth) / size))[()]


def band(value: Value, error: Value) -> Bounds:
    """Return the range of the true value, for values with a stated relative error.

    Parameters
    ----------
    value, error
        Numbers, or arrays that broadcast together; an error is not negative.

    Returns
    -------
    tuple
        The lower and the upper bound: v/(1 + e) and v/(1 - e), swapped where v is negative. For e ≥ 1 the
        bound away from zero is infinite, and for v = 0 both are infinite. NaN where v or e is NaN.
    """
    if isinstance(value, float) and isinstance(error, float):
        return _band_of_one(float(value), float(error))
    with np.errstate(all="ignore"):
        near = value / (1 + error)
        far = np.where(error < 1, value / (1 - error), np.copysign(np.inf, value))
        low, high = np.minimum(near, far), np.maximum(near, far)
    boundless = (np.asarray(value) == 0) & (error >= 1)
    unknown = np.isnan(value) | np.isnan(error)
    low = np.where(unknown, np.nan, np.where(boundless, -np.inf, low))
    return low, np.where(unknown, np.nan, np.where(boundless, np.inf, high))


def _band_of_one(value: float, error: float) -> tuple[float, float]:
    """Return the `band` of a single value, in a tenth of the time that `band` takes."""
    if math.isnan(value) or math.isnan(error):
        return math.nan, math.nan
    if error >= 1:
        if value == 0:
            return -math.inf, math.inf
        near = value / (1 + error)
        return (near, math.inf) if value > 0 else (-math.inf, near)
    near, far = value / (1 + error), value / (1 - error)
    return (near, far) if value >= 0 else (far, near)


def band_relative_to(value: Value, error: Value, scale: Value) -> Bounds:
    """Return the range of the true value, for an error relative to a scale such as 90°.

    The scale is computed from calculated values; the true scale may be larger by 1/(1 - e).
    """
    with np.errstate(all="ignore"):
        half = np.where(np.asarray(error) < 1, error * scale / (1 - error), np.inf)
        half = np.where(np.isnan(error), np.nan, half)[()]
        return value - half, value + half


def largest_true(size: Value, error: Value) -> Value:
    """Return the largest possible true magnitude of a calculated value with a relative error."""
    with np.errstate(all="ignore"):
        most = np.where(np.asarray(error) < 1, size / (1 - error), np.inf)
        return np.where(np.isnan(error), np.nan, most)[()]


def value_and_bounds(
    side: Relation, estimates: Mapping[str, Estimate], shifts: Sequence[Shift] = ()
) -> tuple[Value, Bounds, Truth]:
    """Return the value of one side of a comparison, its known band, and a mask of where the band is known.

    Each uncertain name is set to both ends of its band while the others stay unchanged, and the resulting
    changes are added. The changes of `shifts`, which come from upstream values, are added too.

    Raises
    ------
    FaultyText
        If arrays have different lengths; the code is `shape`.
    """
    name = side.only_name
    if name and not shifts:
        return estimates[name].value, estimates[name].bounds(), estimates[name].is_known
    values = {name: estimates[name].value for name in side.names}
    middle = side.value(values)
    low, high = estimates[name].bounds() if name else (middle, middle)
    known: Truth = True
    for used in side.names:
        known = known & estimates[used].is_known
    for shift in (*(() if name else _own_shifts(side, estimates, values)), *shifts):
        less, more, reached = _changes(side, middle, *shift)
        low, high, known = low + less, high + more, known & reached
    return middle, (low, high), known


def _own_shifts(
    side: Relation, estimates: Mapping[str, Estimate], values: Mapping[str, Value]
) -> Iterator[Shift]:
    """Yield the value of a side with each uncertain name at both ends of its band, others unchanged."""
    for name in sorted(side.names):
        if not estimates[name].is_exact:
            low, high = estimates[name].bounds()
            yield {**values, name: low}, {**values, name: high}


def _changes(
    side: Relation, middle: Value, low: Mapping[str, Value], high: Mapping[str, Value]
) -> tuple[Value, Value, Truth]:
    """Return the downward and upward change of a side, and a mask of the places with values at both ends."""
    with np.errstate(all="ignore"):
        one, other = (np.asarray(side.value(end)) - middle for end in (low, high))
        less, more = np.fmin(np.fmin(one, other), 0.0), np.fmax(np.fmax(one, other), 0.0)
    return less[()], more[()], ~(np.isnan(one) | np.isnan(other))


def relative_width(value: float, low: float, high: float) -> float | None:
    """Return the relative error that corresponds to a band; None if the band is open or unknown."""
    ends = [end for end in (low, high) if end != value]
    if not ends:
        return 0.0
    if not all(math.isfinite(end) and end != 0 for end in ends):
        return None
    return max(abs((end - value) / end) for end in ends)


def aligned(estimates: Mapping[str, Estimate], axes: int) -> Mapping[str, Estimate]:
    """Return the estimates with arrays that broadcast together.

    A value for each point also broadcasts along a curve.
    """
    if not axes:
        return estimates
    return {name: _aligned(estimate, axes) for name, estimate in estimates.items()}


def _aligned(estimate: Estimate, axes: int) -> Estimate:
    if estimate.axes == axes or not np.ndim(estimate.value):
        return estimate
    if estimate.axes:
        raise FaultyText("shape", "curves and tables over different axes cannot be compared")
    value, error = spread(estimate.value, axes), spread(estimate.error, axes)
    return replace(estimate, value=value, error=error)
