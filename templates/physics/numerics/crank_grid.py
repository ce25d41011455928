"""Crank angles at which an engine is calculated: a uniform grid of at most 1°, with both sides of each jump.

The user's step selects which of these angles are returned. Maxima and integrals use all angles, so that they
do not depend on that step. At a pressure jump, such as an ideal combustion or a late exhaust opening, one
angle lies just before the jump and one at it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array

T = TypeVar("T", bound=np.generic)

FINEST = np.pi / 180
"""The largest step of the internal grid [rad]."""
COARSE = 5.000001 * np.pi / 180
"""The largest step [rad] at which returned curves show their peaks: 5° plus rounding."""
_BEFORE = 1e-7  # distance of an angle before a jump [rad]


@dataclass(frozen=True)
class CrankGrid:
    """Angles of one cycle [rad], (…, K): `uniform` equal steps first, then those next to jumps."""

    theta: Array
    uniform: int
    every: int
    cycle: float

    def returned(self, values: NDArray[T]) -> NDArray[T]:
        """Return the values at the requested angles, (…, K), from the values at all angles."""
        return values[..., : self.uniform : self.every] if np.ndim(values) else values

    @cached_property
    def order(self) -> NDArray[np.intp]:
        """Return the indices that sort the angles in ascending order, (…, K)."""
        return np.argsort(self.theta, axis=-1, kind="stable")

    @cached_property
    def ascending(self) -> Array:
        """Return the angles in ascending order [rad], (…, K)."""
        return np.take_along_axis(self.theta, self.order, axis=-1)

    @cached_property
    def widths(self) -> Array:
        """Return the intervals between ascending angles [rad], up to the start of the next cycle, (…, K)."""
        first = self.ascending[..., :1] + self.cycle
        return np.diff(self.ascending, axis=-1, append=first)

    def sorted(self, values: Array) -> Array:
        """Return values at all angles, sorted by angle, (…, K)."""
        order = np.broadcast_to(self.order, (*values.shape[:-1], self.order.shape[-1]))
        return np.take_along_axis(values, order, axis=-1)

    def swing(self, values: Array) -> Array:
        """Return values, sorted by angle, minus their mean over the cycle by the trapezoidal rule, (…, K)."""
        ascending = self.sorted(values)
        return ascending - self._parts(ascending).sum(axis=-1, keepdims=True) / self.cycle

    def running(self, values: Array) -> Array:
        """Return the integral of values minus their mean from the first angle on, (…, K), in grid order.

        The mean is computed by the same rule on the same grid, so that the integral is 0 over a whole cycle.
        """
        parts = self._parts(self.swing(values))
        sums = np.concatenate([np.zeros_like(parts[..., :1]), np.cumsum(parts, axis=-1)[..., :-1]], axis=-1)
        found = np.empty_like(sums)
        np.put_along_axis(found, np.broadcast_to(self.order, sums.shape), sums, axis=-1)
        return found

    def _parts(self, ascending: Array) -> Array:
        """Return the integral over each interval, (…, K)."""
        return (ascending + np.roll(ascending, -1, axis=-1)) / 2 * self.widths


def angles_in(strokes: Array, step: Array) -> float:
    """Return the number of equal grid steps for a returned step [rad]."""
    return float(np.pi * strokes / np.minimum(step, FINEST))


def crank_grid(strokes: Array, step: Array, jumps: Array) -> CrankGrid:
    """Return the grid of a cycle for a returned step [rad] and jumps at the angles [rad], (…, J)."""
    cycle = float(np.pi * strokes)
    returned = round(cycle / float(step))
    every = max(1, int(np.ceil(float(step) / FINEST - 1e-9)))
    uniform = np.arange(returned * every) * (cycle / (returned * every))
    near = np.concatenate([jumps - _BEFORE, jumps], axis=-1) % cycle
    base = np.broadcast_to(uniform, (*near.shape[:-1], uniform.size))
    return CrankGrid(np.concatenate([base, near], axis=-1), uniform.size, every, cycle)
