"""Slider-crank: positions and motion of piston and rod, per unit of crank radius and crank speed.

The cylinder axis intersects the crankshaft axis. x points from the crankshaft to the cylinder head, y in the
direction in which the crankpin first moves; theta is measured from top dead centre, n = l/r, sin(phi) =
sin(theta)/n. The rod is at −phi from the x axis, so at top dead centre it swings against the crank.

With q = n cos(phi) = sqrt(n² − sin²(theta)), all formulas are exact for n > 1. At n = 1 the mechanism locks
at 90°.

References
----------
S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ellipeinc

from templates.core.arrays import Array
from templates.core.language.declare import units

_ROUNDING = 1e-14
"""Sines and cosines below this are rounding errors at dead centres and right angles."""


@dataclass(frozen=True)
class Motion:
    """A slider-crank at the angles theta [rad] (last axis), for ratios n = l/r [1] of shape (…, 1)."""

    theta: Array
    n: Array

    @cached_property
    def sin(self) -> Array:
        """Return the sine of the crank angle."""
        return _exact(np.sin(self.theta))

    @cached_property
    def cos(self) -> Array:
        """Return the cosine of the crank angle."""
        return _exact(np.cos(self.theta))

    @cached_property
    def q(self) -> Array:
        """Return the projection of the rod on the cylinder axis, divided by the crank radius: n cos(phi)."""
        return np.sqrt((self.n - 1) * (self.n + 1) + self.cos**2)

    @cached_property
    def tan_phi(self) -> Array:
        """Return the tangent of the rod's angle."""
        return self.sin / self.q

    @cached_property
    def travel(self) -> Array:
        """Return the travel of the piston from top dead centre, divided by the stroke."""
        return np.sin(self.theta / 2) ** 2 + self.sin**2 / (2 * (self.n + self.q))

    @cached_property
    def lever(self) -> Array:
        """Return the torque divided by the axial force and the crank radius.

        It equals −dx/dtheta of the piston divided by r.
        """
        return self.sin + self.cos * self.tan_phi

    @cached_property
    def acceleration(self) -> Array:
        """Return the acceleration of the piston over omega² r."""
        return piston_acceleration_Rao_Singh_1993(self.sin, self.cos, self.q, self.n)

    @cached_property
    def rod_velocity(self) -> Array:
        """Return the angular velocity of the rod over that of the crank, d(phi)/d(theta)."""
        return self.cos / self.q

    @cached_property
    def rod_acceleration(self) -> Array:
        """Return the angular acceleration of the rod over omega², d²(phi)/d(theta)²."""
        return -(self.n - 1) * (self.n + 1) * self.sin / self.q**3


def _exact(value: Array) -> Array:
    """Return values with rounding errors set to 0, so that they give no load at a dead centre."""
    return np.where(np.abs(value) < _ROUNDING, 0.0, value)


def piston_acceleration_Rao_Singh_1993(sin: Array, cos: Array, q: Array, n: Array) -> Array:
    """Return the acceleration of the piston over omega² r [1], positive towards the head; exact.

    a = −[cos θ + ((n² − 1) cos 2θ + cos⁴ θ) / (n³ (1 − sin² θ/n²)^1.5)], where n³ (…)^1.5 = q³.
    """
    double = (cos - sin) * (cos + sin)
    return -(cos + ((n - 1) * (n + 1) * double + cos**4) / q**3)


def crank_motion(theta: Array, n: Array) -> Motion:
    """Return the motion at crank angles theta [rad], (…, K), for each ratio n [1], (…)."""
    return Motion(np.asarray(theta, float), np.asarray(n, float)[..., None])


def travel_integral(theta: Array, n: Array) -> Array:
    """Return the integral of travel over stroke from crank angle 0 [rad]."""
    return ((1 + n) * theta - np.sin(theta) - n * ellipeinc(theta, 1 / n**2)) / 2


def angle_of_travel(travel: Array, n: Array) -> Array:
    """Return the crank angle in [0, π] [rad] at which the piston has covered a fraction of its stroke."""
    share = travel * (n - travel) / (1 + n - 2 * travel)
    return 2 * np.arcsin(np.sqrt(np.clip(share, 0, 1)))


@units("1", "rad", returns="rad")
def crank_angles(strokes: Array, step: Array) -> Array:
    """Return the angles of one cycle [rad] of 2 or 4 strokes, (K,); the last point is not repeated."""
    return np.arange(round(float(np.pi * strokes / step))) * step


@units("1", "rad", returns="1")
def steps_in(strokes: Array, step: Array) -> Array:
    """Return the number of grid steps in a cycle of 2 or 4 strokes."""
    return np.pi * strokes / step
