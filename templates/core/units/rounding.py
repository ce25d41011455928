"""Rounding of a relation's value to a multiple of a step: `= 0.31 * bore rounded up to 0.5 mm`.

The multiples count from zero of the unit in which the step is typed, so 5 degC means 80 °C, 85 °C and so on.
A value that differs from a multiple by less than `NOISE` is that multiple: floating-point noise and the
rest of an iteration do not move a size by a whole step.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Literal

import numpy as np

from templates.core.arrays import Array
from templates.core.errors import FaultyText
from templates.core.units.conformity import misfit
from templates.core.units.nodes import Kind, Operation, kind_of
from templates.core.units.units import Unit, Value, unit

Direction = Literal["nearest", "up", "down"]

NOISE = 1e-9
"""Largest distance from a multiple that counts as none, relative to the value, or to the step if larger."""
MOST_NOISE = 1e-3  # largest such distance in steps
_EXACT = 2**53  # whole numbers up to this are exact floats


@dataclass(frozen=True)
class Rounding:
    """A rule: the step as typed, such as `0.5 mm`, and the direction; `nearest` rounds a half away from zero.

    Attributes
    ----------
    text
        The step as typed.
    step
        The magnitude of the step, exactly as typed.
    scale
        The unit of the step.
    """

    text: str
    step: Fraction
    scale: Unit
    direction: Direction

    @classmethod
    def read(cls, text: str, direction: Direction) -> Rounding:
        """Return the rule for a step as typed.

        Raises
        ------
        FaultyText
            If the unit is unknown (code `unknown_unit`), or the step is not above 0 (code `out_of_range`).
        """
        number, _, name = text.partition(" ")
        step = Fraction(number)
        if not 0 < float(step) < np.inf:
            raise FaultyText("out_of_range", f"the step of a rounding must be above 0, not {text}")
        return cls(text, step, unit(name or "1"), direction)

    @property
    def words(self) -> str:
        """Return the rule as a user writes it: `rounded up to 0.5 mm`."""
        return f"rounded {'' if self.direction == 'nearest' else f'{self.direction} '}to {self.text}"

    @cached_property
    def operation(self) -> Operation:
        """Return the rule as the operation that a relation applies last."""
        return Operation("rounded", self.of, _kept, 1)

    def misfit(self, kind: Kind, shown: str) -> str:
        """Return why the step does not fit the rounded value, and a remedy; empty if it fits.

        The text continues a sentence about the value and its unit `shown`: `, but it is rounded to 0.5 N`.
        """
        if misfit(kind, self.scale, "") is None and misfit(kind_of(self.scale.text), unit(shown), "") is None:
            return ""
        right = "without a unit" if shown == "1" else f"in {shown}, such as 0.5 {shown}"
        return f", but it is {self.words}; give the step {right}"

    def of(self, si: Value) -> Value:
        """Return the chosen value [SI] for a calculated one; NaN stays NaN."""
        if isinstance(si, np.ndarray):
            return self._chosen(si)
        return float(self._chosen(np.asarray(si, dtype=float)))

    def _chosen(self, si: Array) -> Array:
        value = np.asarray(self.scale.from_si(si), dtype=float)
        with np.errstate(all="ignore"):
            count = _COUNTS[self.direction](value / float(self.step))
            chosen = self._multiple(count)
            is_counted = np.abs(count) < _EXACT
        return np.asarray(np.where(is_counted, self.scale.to_si(chosen), si), dtype=float)

    def _multiple(self, count: Array) -> Array:
        """Return a multiple of the step as the float nearest to its decimal: 3 times 0.1 is 0.3."""
        over, under = self.step.numerator, self.step.denominator
        return count * over / under if max(over, under) < _EXACT else count * float(self.step)


def _kept(_: Operation, kinds: list[Kind], __: tuple[object, ...]) -> Kind:
    """Return the kind of the rounded value."""
    return kinds[0]


def _nearest(count: Array) -> Array:
    """Return the nearest whole numbers; a half, up to noise, goes away from zero."""
    return np.copysign(np.floor(np.abs(count) + 0.5 + _noise(count)), count) + 0.0


def _up(count: Array) -> Array:
    return np.ceil(count - _noise(count)) + 0.0


def _down(count: Array) -> Array:
    return np.floor(count + _noise(count)) + 0.0


def _noise(count: Array) -> Array:
    return np.minimum(NOISE * np.maximum(np.abs(count), 1.0), MOST_NOISE)


_COUNTS = {"nearest": _nearest, "up": _up, "down": _down}
