"""Data types for the duty of a journal bearing over a cycle, and for the results of its film.

Vectors are given in the frame of the load. A positive speed turns x to y. Pressure, loss and flow are
dimensionless: P = p psi²/(eta Omega), where psi is the diametral clearance divided by the diameter, and Omega
is the speed of the crank.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.numerics.arrays import largest_load as largest_load

FEWEST, MOST = 12, 3600
"""Smallest and largest number of angles in a cycle."""
NEARLY_HALF = 0.3
"""Accepted difference of a speed from half the crank's, relative to that [-]."""


@dataclass(frozen=True)
class Duty:
    """Loads and speeds of a bearing over a cycle, in SI; the axes before that of the cycle are points."""

    angle: Array
    """(N,) crank angles [rad]."""
    F_x: Array
    F_y: Array
    """Load on the journal along the axes of the frame, (..., N) [N]."""
    omega_J: Array
    omega_B: Array
    omega_F: Array
    """Speeds of journal, sleeve and frame, (..., N), (..., 1) or single values [rad/s]."""
    Omega: Array
    """Speed of the crank, (...) [rad/s]."""
    scale: Array
    """S over F, psi²/(B D eta Omega), (...) [1/N]."""
    ratio: Array
    """Width over diameter B/D, (...) [-]."""

    @property
    def points(self) -> tuple[int, ...]:
        """Return the shape of the points."""
        curves = (self.F_x, self.F_y, self.omega_J, self.omega_B, self.omega_F)
        values = (self.Omega, self.scale, self.ratio)
        return np.broadcast_shapes(*(np.shape(one)[:-1] for one in curves), *map(np.shape, values))


@dataclass(frozen=True)
class CycleFilm:
    """The results of the film over the cycle."""

    P: Array
    """Largest pressure over the bearing, (..., N)."""
    P_max: Array
    """The same over the cycle, (...)."""
    P_angle: Array
    """Crank angle of the largest pressure [rad]."""
    loss: Array
    """Power 2 psi/(eta Omega² B D²), mean over the cycle, (...)."""
    side_flow: Array
    """Oil flow out of both ends, Q/(B D c Omega), c the radial clearance, mean over the cycle, (...)."""
    feed_flow: Array
    """Additional flow from a groove driven by the supply pressure, same unit; 0 if `side_flow` includes it.
    """


def weights(angle: Array, period: float) -> Array:
    """Return the weights of the trapezoidal rule over a cycle, (N,), in the unit of the angles."""
    widths = np.diff(angle, append=angle[0] + period)
    return np.asarray((widths + np.roll(widths, 1)) / 2)


def cycle_of(angle: Array) -> float:
    """Return the cycle [rad] that crank angles [rad] cover once, 2 pi or 4 pi.

    The result is NaN if they cover neither or do not ascend. The last angle must not repeat the first, and
    its distance to the end of the cycle must be at most twice the largest other step.
    """
    if angle.ndim != 1 or not FEWEST <= angle.size <= MOST:
        return float("nan")
    steps = np.diff(angle)
    for period in (2 * np.pi, 4 * np.pi):
        last = period - (angle[-1] - angle[0])
        if (steps > 0).all() and 1e-9 < last <= 2 * steps.max() * (1 + 1e-9):
            return period
    return float("nan")


@units("rad", returns="rad", latex=r"\text{{the whole cycle that the angles cover}}")
def cycle_length(angle: Array) -> Array:
    """Return the result of `cycle_of` as a number for use in a formula."""
    return np.asarray(cycle_of(angle))[()]


@dataclass(frozen=True)
class LoadCourse:
    """Measures of how a load varies over the cycle; dimensionless, (...)."""

    peak: Array
    """Largest magnitude over mean magnitude."""
    steadiness: Array
    """Magnitude of the mean vector over the mean magnitude: 1 if the direction is constant."""
    at_half_speed: Array
    """Fraction of the cycle in which the load rotates at 0.2 to 0.8 of the crank's speed, about half of it:
    no film carries a load that does so permanently.
    """


def load_course(angle: Array, F_x: Array, F_y: Array) -> LoadCourse:
    """Return measures of how a load [N], (..., N), varies over crank angles (N,) [rad]."""
    period = cycle_of(angle)
    weight, size = weights(angle, period) / period, np.hypot(F_x, F_y)
    mean = size @ weight
    step = np.diff(angle, append=angle[0] + period)
    along = np.arctan2(F_y, F_x)
    turned = (np.roll(along, -1, axis=-1) - along + np.pi) % (2 * np.pi) - np.pi
    return LoadCourse(
        peak=size.max(axis=-1) / mean,
        steadiness=np.hypot(F_x @ weight, F_y @ weight) / mean,
        at_half_speed=(np.abs(turned / step - 0.5) < NEARLY_HALF) @ step / period,
    )


@units("rad/s", returns="rad/s", latex=r"\left|\overline{{{0}}}\right|")
def mean_speed(speed: Array) -> Array:
    """Return the magnitude of the mean of a speed over the cycle [rad/s]."""
    return np.abs(speed if np.ndim(speed) == 0 else np.mean(speed, axis=-1))
