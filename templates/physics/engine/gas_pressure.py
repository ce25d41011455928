"""Results of every gas cycle, and the two simplest cycles: no gas, and pressure tabulated over crank angle.

Zero of the crank angle: in a four-stroke engine the intake stroke begins at 0° and combustion at 360°; in a
two-stroke engine combustion begins at 0°. Pressures are arrays over the angle (last axis) for each point.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.engine.slider_crank import Motion, travel_integral

_FINE = np.pi / 180  # the step of the grid of crank angles
_STEEP = 0.02  # fraction of the range of pressures between consecutive points of a table


class GasCycle(ABC):
    """The pressure in a cylinder over one cycle."""

    @abstractmethod
    def pressure(self, theta: Array, travel: Array) -> Array:
        """Return the pressure [Pa] at crank angles theta [rad]; `travel` there is a share of the stroke."""

    @abstractmethod
    def mean_effective(self) -> Array:
        """Return the work of the gas in a cycle per swept volume [Pa], exact for any output angles."""

    @abstractmethod
    def corners(self) -> Array:
        """Return crank angles [rad], (…, J), where the pressure jumps, has a sharp bend or is highest."""


@dataclass(frozen=True)
class NoGas(GasCycle):
    """A cycle without gas force: the crankcase pressure acts on both sides of the piston."""

    p_c: Array

    def pressure(self, theta: Array, travel: Array) -> Array:
        """Return the crankcase pressure."""
        return self.p_c[..., None] + 0 * travel

    def mean_effective(self) -> Array:
        """Return 0."""
        return 0 * self.p_c

    def corners(self) -> Array:
        """Return no angles."""
        return np.zeros(0)


@dataclass(frozen=True)
class TabulatedCycle(GasCycle):
    """Pressures p [Pa], (…, M), at angles [rad], (M,), periodic and piecewise linear; n = l/r, (…)."""

    angle: Array
    p: Array
    n: Array
    cycle: float

    def pressure(self, theta: Array, travel: Array) -> Array:
        """Return the pressure by linear interpolation."""
        angle, p = self.angle, self.p
        place = (theta - angle[0]) % self.cycle + angle[0]
        left = np.searchsorted(angle, place, side="right") - 1
        right = (left + 1) % angle.size
        width = np.diff(angle, append=angle[0] + self.cycle)
        share = (place - angle[left]) / width[left]
        return p[..., left] * (1 - share) + p[..., right] * share

    def mean_effective(self) -> Array:
        """Return the exact mean effective pressure of the piecewise linear table.

        Between two angles, ∫ p dV is the change of p V minus dp/dθ times the integral of V.
        """
        ends = np.append(self.angle, self.angle[0] + self.cycle)
        volumes = np.diff(travel_integral(ends, self.n[..., None]))
        slopes = np.diff(self.p, append=self.p[..., :1]) / np.diff(ends)
        return -np.sum(slopes * volumes, axis=-1)

    def corners(self) -> Array:
        """Return the angle of the highest pressure, and both ends of steep steps shorter than 1°."""
        width = np.diff(self.angle, append=self.angle[0] + self.cycle)
        rise = np.abs(np.diff(self.p, append=self.p[..., :1])).reshape(-1, self.angle.size)
        steep = (width < _FINE) & (rise > _STEEP * np.ptp(self.p, axis=-1).reshape(-1, 1)).any(axis=0)
        chosen = steep | np.roll(steep, 1)
        chosen[np.argmax(self.p, axis=-1)] = True
        return self.angle[chosen]


@on_paper("read from the gas cycle at each crank angle")
@units(None, None, returns="Pa")
def pressure_at(gas: GasCycle, motion: Motion) -> Array:
    """Return the pressure in the cylinder [Pa] at the angles of a motion, (…, K)."""
    return gas.pressure(motion.theta, motion.travel)


@units(None, returns="Pa")
def mean_effective(gas: GasCycle) -> Array:
    """Return the indicated mean effective pressure [Pa]: the work of a cycle per swept volume."""
    return np.asarray(gas.mean_effective())[()]


@units(None, None, returns="Pa")
def peak_pressure(name: str, p: Array) -> Array:
    """Return the largest pressure over the cycle [Pa]; NaN without gas."""
    return np.asarray(np.max(p, axis=-1))[()] if name != "none" else np.full(np.shape(p)[:-1], np.nan)[()]


def one_cycle(angle: Array, p: Array, cycle: float) -> tuple[Array, Array]:
    """Return angles [rad] and pressures [Pa] of a table, without a last point that repeats the first.

    The steps are equal if no angles are given.
    """
    if np.ndim(angle) == 0:
        angle = np.arange(p.shape[-1]) * (cycle / p.shape[-1])
    repeats = np.isclose(angle[-1] - angle[0], cycle, rtol=1e-9)
    return (angle[:-1], p[..., :-1]) if repeats else (angle, p)
