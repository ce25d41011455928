"""Slider-crank with an optional offset of the cylinder axis: motion, and the forces of rod and piston.

Vectors in the plane of the mechanism are complex, x + i y: x along the axis of the cylinder to its head, y in
the direction in which the crankpin first moves. The axis is offset by `e` towards y; an offset piston pin
adds to it. The crank angle alpha is measured from x, and the rod's angle phi has sin(phi) = (r sin(alpha) −
e)/l. Primes are derivatives by alpha.

References
----------
The formulas follow from geometry; an energy balance checks them: torque + dE/d(alpha) = 0 with E, the kinetic
energy of the rigid bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.numerics.crank_grid import CrankGrid

_ROUNDING = 2e-14
"""Sines and cosines below this are rounding errors at dead centres and right angles."""


@dataclass(frozen=True)
class OffsetCrank:
    """Crank radius, rod length and offset of the cylinder's axis [m], (…, N) or (…, 1)."""

    r: Array
    l: Array  # noqa: E741
    e: Array

    @cached_property
    def top(self) -> Array:
        """Return the crank angle [rad] at which the piston is farthest from the crankshaft."""
        return np.arcsin(self.e / (self.l + self.r))

    @cached_property
    def highest(self) -> Array:
        """Return the largest distance of the piston pin from the crankshaft along the axis [m]."""
        return np.sqrt((self.l + self.r - self.e) * (self.l + self.r + self.e))

    @cached_property
    def lowest(self) -> Array:
        """Return the smallest distance of the piston pin from the crankshaft along the axis [m]."""
        return np.sqrt((self.l - self.r - self.e) * (self.l - self.r + self.e))

    @cached_property
    def stroke(self) -> Array:
        """Return the distance between the two dead centres of the piston [m]."""
        return self.highest - self.lowest

    def at(self, alpha: Array) -> RodMotion:
        """Return the motion at crank angles [rad], (…, N, K)."""
        return RodMotion(self, alpha)

    def travel(self, alpha: Array) -> Array:
        """Return the travel of the piston from top dead centre per stroke, at angles (…, N, K)."""
        return (self.highest[..., None] - self.at(alpha).x) / self.stroke[..., None]


@dataclass(frozen=True)
class RodMotion:
    """Positions of rod and piston, and derivatives with respect to crank angle `alpha` [rad], (…, N, K)."""

    crank: OffsetCrank
    alpha: Array

    @cached_property
    def sin(self) -> Array:
        """Return the sine of the crank angle."""
        return _exact(np.sin(self.alpha))

    @cached_property
    def cos(self) -> Array:
        """Return the cosine of the crank angle."""
        return _exact(np.cos(self.alpha))

    @cached_property
    def _share(self) -> Array:
        return (self.crank.r / self.crank.l)[..., None]

    @cached_property
    def sin_phi(self) -> Array:
        """Return the sine of the rod's angle to the cylinder axis."""
        return self._share * self.sin - (self.crank.e / self.crank.l)[..., None]

    @cached_property
    def cos_phi(self) -> Array:
        """Return the cosine of the rod's angle."""
        return np.sqrt((1 - self.sin_phi) * (1 + self.sin_phi))

    @cached_property
    def tan_phi(self) -> Array:
        """Return the tangent of the rod's angle."""
        return self.sin_phi / self.cos_phi

    @cached_property
    def phi1(self) -> Array:
        """Return phi′ [1]; the rod rotates at −phi′ times the speed of the crank."""
        return self._share * self.cos / self.cos_phi

    @cached_property
    def phi2(self) -> Array:
        """Return phi″ [1]."""
        return -self._share * self.sin / self.cos_phi + self.tan_phi * self.phi1**2

    @cached_property
    def x(self) -> Array:
        """Return the distance of the piston pin from the crankshaft along the axis [m]."""
        return self.crank.r[..., None] * self.cos + self.crank.l[..., None] * self.cos_phi

    @cached_property
    def x1(self) -> Array:
        """Return x′ [m]."""
        return -self.crank.r[..., None] * (self.sin + self.cos * self.tan_phi)

    @cached_property
    def x2(self) -> Array:
        """Return x″ [m]."""
        swing = self.cos * self.phi1 / self.cos_phi**2
        return -self.crank.r[..., None] * (self.cos - self.sin * self.tan_phi + swing)


def _exact(value: Array) -> Array:
    """Return values with rounding errors set to 0, so that they give no load at a dead centre."""
    return np.where(np.abs(value) < _ROUNDING, 0.0, value)


@dataclass(frozen=True)
class RodMasses:
    """A rod as two masses at its pins [kg], and the excess of their moment of inertia [kg m²], (…, N)."""

    at_crank: Array
    at_piston: Array
    excess: Array


@units("m", "m", "m", returns="m", latex=r"\frac{{{0}}}{{2}}\sqrt{{1-\frac{{4 {2}^2}}{{4 {1}^2-{0}^2}}}}")
def radius_of_stroke(stroke: Array, rod: Array, offset: Array) -> Array:
    """Return the crank radius [m] that gives a stroke if the axis is at `offset` from the crankshaft."""
    return stroke / 2 * np.sqrt(1 - 4 * offset**2 / (4 * rod**2 - stroke**2))


@units("m", "m", "m", "m", returns="1")
def turns_through(stroke: Array, radius: Array, rod: Array, offset: Array) -> Truth:
    """Return whether the mechanism can make a full revolution.

    The rod must be longer than crank radius plus offset.
    """
    by_stroke = np.where(np.isnan(stroke), 2 * radius, stroke) / 2
    reach = np.where(np.isnan(radius), by_stroke, radius)
    return _at_all_cylinders(rod > 1.000001 * (reach + np.abs(offset)))


def _at_all_cylinders(holds: NDArray[np.bool_]) -> Truth:
    whole = np.all(np.atleast_1d(holds), axis=-1)
    return bool(whole) if whole.ndim == 0 else whole


def rod_masses(mass: Array, centre: Array, inertia: Array, rod: Array) -> RodMasses:
    """Return the rod as two masses; `centre` is measured from the big end [m].

    If the rod's inertia is unknown, the excess of the moment of inertia of the two masses is 0.
    """
    excess = mass * centre * (rod - centre) - inertia
    return RodMasses(
        mass * (rod - centre) / rod, mass * centre / rod, np.where(np.isnan(excess), 0.0, excess)
    )


def axial_force(reciprocating: Array, omega: Array, motion: RodMotion, gas: Array) -> Array:
    """Return K = m x″ω² + gas [N], the crank's force that drives the mass against the gas, (…, N, K)."""
    return (reciprocating * omega**2)[..., None] * motion.x2 + gas


def wall_force(axial: Array, excess: Array, omega: Array, motion: RodMotion) -> Array:
    """Return the force of the piston on the wall along y [N]; the rigid rod contributes −ΔI φ̈/(l cos φ)."""
    arm = motion.crank.l[..., None] * motion.cos_phi
    return -axial * motion.tan_phi - (excess * omega**2)[..., None] * motion.phi2 / arm


def pin_force(
    at_crank: Array, omega: Array, motion: RodMotion, axial: Array, wall: Array
) -> NDArray[np.complex128]:
    """Return the complex force of the rod on the crankpin in the cylinder's axes [N], (…, N, K)."""
    turning = (at_crank * omega**2 * motion.crank.r)[..., None]
    return (turning * motion.cos - axial) + 1j * (turning * motion.sin - wall)


@units("rad/s", None, None, returns="rad/s")
def rod_speed(omega: Array, motion: RodMotion, grid: CrankGrid) -> Array:
    """Return the angular speed of each rod [rad/s] at the returned angles, (…, N, K)."""
    return -np.asarray(omega)[..., None, None] * grid.returned(motion.phi1)
