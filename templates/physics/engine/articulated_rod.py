"""Articulated rods: a master rod carries the rods of other cylinders on pins in its big end.

Vectors in the plane of the mechanism are complex. In the axes of the master's cylinder the crankpin is at r
e^{iα}, the master rod is inclined by φ, and the pin of an articulated rod is at Q = r e^{iα} + ρ e^{i(γ−φ)}:
ρ is the articulation radius, γ its angle from the axis of the master rod, in the sense of rotation. Rotated
into the axes of its own cylinder, Q replaces the crankpin; the rest is a slider-crank. Primes are derivatives
by the crank angle.

The rod's force F on its pin exerts a moment on the master rod, which the wall of the master's cylinder must
balance: with N = −Im((Q−P)* F)/(l cos φ), where P is the crankpin, the load on the crankpin increases by F +
iN, and that on the wall by −N.

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
from templates.physics.engine.engine_layout import SAME, TURN, Layout, count_of
from templates.physics.engine.engine_sizes import each
from templates.physics.engine.harmonics import Phasor, piston_harmonics
from templates.physics.engine.offset_crank import OffsetCrank, RodMotion, pin_force

Numbers = NDArray[np.intp]
Vectors = NDArray[np.complex128]
_SAMPLES = 360  # per revolution
_NEWTON = 8  # Newton steps from a sample to the dead centre next to it
_NEAR = 1e-6  # tolerance of positions [m], and of radii relative to the radius
_CLEAR = 1e-6  # least relative excess of the rod's length over the distance of its pin from the axis


@dataclass(frozen=True)
class ArticulatedCrank(OffsetCrank):
    """The cranks of cylinders, (…, N); some of their rods are attached to the rod of another cylinder."""

    carrier: Numbers  # the cylinder whose rod carries this one, from 0; itself where it has a crankpin, (N,)
    arm: Vectors  # ρ e^{iγ} [m], 0 where it has a crankpin, (N,)
    turn: Array  # the bank angle less that of the carrier [rad], (N,)

    @cached_property
    def articulated(self) -> NDArray[np.bool_]:
        """Return a mask of the articulated rods, (N,)."""
        return np.asarray(self.carrier != np.arange(self.carrier.size))

    @cached_property
    def master(self) -> OffsetCrank:
        """Return the mechanisms of the carriers."""
        count = self.carrier.size
        full = (np.broadcast_to(one, (*one.shape[:-1], count)) for one in (self.r, self.l, self.e))
        return OffsetCrank(*(one[..., self.carrier] for one in full))

    @cached_property
    def top(self) -> Array:
        """Return the crank angle [rad] at which the piston is farthest from the crankshaft."""
        return self._dead_centre(highest=True)

    @cached_property
    def highest(self) -> Array:
        """Return the largest distance of the piston pin from the crankshaft along the axis [m]."""
        return self.at(self.top[..., None]).x[..., 0]

    @cached_property
    def lowest(self) -> Array:
        """Return the smallest distance of the piston pin from the crankshaft along the axis [m]."""
        return self.at(self._dead_centre(highest=False)[..., None]).x[..., 0]

    def at(self, alpha: Array) -> ArticulatedMotion:
        """Return the motion at crank angles [rad], (…, N, K)."""
        return ArticulatedMotion(self, alpha)

    def _dead_centre(self, *, highest: bool) -> Array:
        """Return the angle of a dead centre, by Newton's method from the best sample."""
        alpha = np.linspace(-np.pi, np.pi, _SAMPLES, endpoint=False) + np.zeros((self.carrier.size, 1))
        x = self.at(alpha).x
        best = np.argmax(x if highest else -x, axis=-1)
        place = -np.pi + best * (2 * np.pi / _SAMPLES)
        for _ in range(_NEWTON):
            motion = self.at(place[..., None])
            place = place - motion.x1[..., 0] / motion.x2[..., 0]
        return np.where(np.isfinite(place), place, 0.0)  # a rule reports rods that do not reach


@dataclass(frozen=True)
class ArticulatedMotion(RodMotion):
    """Positions of rods and pistons, and their derivatives with respect to the crank angle, (…, N, K)."""

    crank: ArticulatedCrank
    alpha: Array

    @cached_property
    def lead(self) -> RodMotion:
        """Return the motion of the carriers, in the axes of their own cylinders."""
        return self.crank.master.at(self.alpha + self.crank.turn[..., None])

    @cached_property
    def _back(self) -> Vectors:
        return np.exp(-1j * self.crank.turn)[..., None]

    @cached_property
    def _crankpin(self) -> Vectors:
        """Return the position of the crankpin in the axes of the carrier."""
        return np.asarray(self.lead.crank.r[..., None] * (self.lead.cos + 1j * self.lead.sin))

    @cached_property
    def _arm(self) -> Vectors:
        """Return the vector from the crankpin to the pin, in the axes of the carrier."""
        return self.crank.arm[..., None] * (self.lead.cos_phi - 1j * self.lead.sin_phi)

    @cached_property
    def lever(self) -> Vectors:
        """Return the vector from the crankpin to the pin [m], in the axes of the rod's own cylinder."""
        return self._arm * self._back

    @cached_property
    def pin(self) -> Vectors:
        """Return the position of the rod's pin [m], in the axes of its cylinder."""
        return (self._crankpin + self._arm) * self._back

    @cached_property
    def pin1(self) -> Vectors:
        """Return the first derivative of the pin's position [m]."""
        return 1j * (self._crankpin - self.lead.phi1 * self._arm) * self._back

    @cached_property
    def pin2(self) -> Vectors:
        """Return the second derivative of the pin's position [m]."""
        lead = self.lead
        return -(self._crankpin + (1j * lead.phi2 + lead.phi1**2) * self._arm) * self._back

    @cached_property
    def _rod(self) -> Array:
        return self.crank.l[..., None]

    @cached_property
    def sin_phi(self) -> Array:
        """Return the sine of the rod's angle to the cylinder axis."""
        return (self.pin.imag - self.crank.e[..., None]) / self._rod

    @cached_property
    def phi1(self) -> Array:
        """Return phi′ [1]; the rod rotates at −phi′ times the speed of the crank."""
        return np.asarray(self.pin1.imag / (self._rod * self.cos_phi))

    @cached_property
    def phi2(self) -> Array:
        """Return phi″ [1]."""
        return self.pin2.imag / (self._rod * self.cos_phi) + self.tan_phi * self.phi1**2

    @cached_property
    def x(self) -> Array:
        """Return the distance of the piston pin from the crankshaft along the axis [m]."""
        return np.asarray(self.pin.real + self._rod * self.cos_phi)

    @cached_property
    def x1(self) -> Array:
        """Return x′ [m]."""
        return np.asarray(self.pin1.real - self.pin1.imag * self.tan_phi)

    @cached_property
    def x2(self) -> Array:
        """Return x″ [m]."""
        return self.pin2.real - self._rod * self.cos_phi * (self.phi1**2 + self.tan_phi * self.phi2)


def carriers(masters: Array, count: int) -> Numbers:
    """Return the index of the cylinder that carries each rod.

    It is the cylinder itself if no master is named, or if the name is not a cylinder.
    """
    itself = np.arange(count)
    if np.shape(masters) != (count,):
        return itself
    named = np.rint(masters).astype(np.intp) - 1
    right = (named >= 0) & (named < count)
    return np.where(right, named, itself)


def with_articulated(
    crank: OffsetCrank, carrier: Numbers, radius: Array, angle: Array, bank: Array
) -> OffsetCrank:
    """Return the mechanisms with articulated rods; unchanged if there are none."""
    count = carrier.size
    articulated = carrier != np.arange(count)
    shapes = {np.shape(one) for one in (radius, angle, bank)}
    if not articulated.any() or not shapes <= {(), (1,), (count,)}:
        return crank  # rules report what is wrong
    vectors: Vectors = np.asarray(radius * np.exp(1j * np.asarray(angle)), dtype=complex)
    arm = np.where(articulated, vectors, 0j)
    if not np.isfinite(arm).all() or any(
        one.shape[-1] not in (1, count) for one in (crank.r, crank.l, crank.e)
    ):
        return crank
    banks = bank + np.zeros(count)
    r, l, e = (np.broadcast_to(one, (*one.shape[:-1], count)) for one in (crank.r, crank.l, crank.e))  # noqa: E741
    return ArticulatedCrank(r, l, e, carrier, arm, banks - banks[carrier])


def order_amplitudes(crank: OffsetCrank, orders: Array, exact: bool) -> Phasor:
    """Return the complex amplitudes of −x″ [m] at the orders, (…, N, H).

    Those of articulated rods are always exact.
    """
    if not isinstance(crank, ArticulatedCrank):
        return piston_harmonics(crank, orders, exact)
    plain = piston_harmonics(OffsetCrank(crank.r, crank.l, crank.e), orders, exact)
    whole = np.rint(np.atleast_1d(orders)).astype(int)
    alpha = np.linspace(0, 2 * np.pi, _SAMPLES, endpoint=False) + np.zeros((crank.carrier.size, 1))
    spectrum = np.fft.rfft(-crank.at(alpha).x2, axis=-1) * (2 / _SAMPLES)
    return np.where(crank.articulated[:, None], spectrum[..., whole], plain)


def walls_with_articulated(walls: Array, motion: RodMotion, rods: Vectors) -> Array:
    """Return the force of each piston on its wall [N], including the reaction to articulated rods."""
    if not isinstance(motion, ArticulatedMotion):
        return walls
    held = (np.conj(motion.lever) * rods).imag / (motion.lead.crank.l[..., None] * motion.lead.cos_phi)
    total = walls + np.zeros(np.shape(held))
    for rod in np.flatnonzero(motion.crank.articulated):
        total[..., motion.crank.carrier[rod], :] += held[..., rod, :]
    return total


def link_force(at_crank: Array, omega: Array, motion: RodMotion, axial: Array, wall: Array) -> Vectors:
    """Return the complex force of each rod on its pin, in the axes of its cylinder [N], (…, N, K)."""
    if not isinstance(motion, ArticulatedMotion):
        return pin_force(at_crank, omega, motion, axial, wall)
    return np.asarray(-(at_crank * omega**2)[..., None] * motion.pin2 - axial - 1j * wall)


def off_the_circle(at_crank: Array, omega: Array, motion: RodMotion, bank: Array) -> Vectors:
    """Return the force on the frame [N] of masses at articulated pins, beyond that at the crankpin."""
    if not isinstance(motion, ArticulatedMotion):
        return np.zeros(1, dtype=complex)
    circle = motion.crank.r[..., None] * (motion.cos + 1j * motion.sin)
    force = -(at_crank * omega**2)[..., None] * (motion.pin2 + circle)
    return np.asarray(force * np.exp(1j * bank)[..., None])


def on_big_ends(pins: Vectors, motion: RodMotion) -> Vectors:
    """Return the big-end loads [N].

    A master rod loads the crankpin with the loads of all rods that it carries; other rods load their own
    pins.
    """
    if not isinstance(motion, ArticulatedMotion):
        return pins
    total = pins.copy()
    for rod in np.flatnonzero(motion.crank.articulated):
        total[..., motion.crank.carrier[rod], :] += pins[..., rod, :]
    return total


@units("1", "1", "rad", "rad", returns="1")
def masters_are_named(masters: Array, order: Array, pins: Array, firing: Array) -> Truth:
    """Return whether masters, if given, are named for each cylinder, and no master has a master itself."""
    if not np.ndim(masters):
        return True
    count = count_of(order, pins, firing)
    if np.shape(masters) != (count,) or np.any(masters > count):
        return False
    carrier = carriers(masters, count)
    named = np.rint(masters).astype(np.intp) > 0
    alone = carrier != np.arange(count)
    return bool(np.array_equal(named, alone)) and not named[carrier[named]].any()


@units("1", "m", returns="1")
def arms_are_given(masters: Array, radius: Array) -> Truth:
    """Return whether each articulated rod has a radius above 0."""
    if not np.ndim(masters):
        return True
    given = np.ndim(radius) <= 1 and np.shape(radius) in ((), np.shape(masters))
    return given and bool(np.all((masters < 1) | (radius > 0)))


@units(None, None, "m", returns="1")
def rods_share_a_pin(crank: OffsetCrank, layout: Layout, places: Array) -> Truth:
    """Return whether articulated rods have the throw, pin, position and crank radius of their master."""
    if not isinstance(crank, ArticulatedCrank):
        return True
    carrier, places = crank.carrier, each(places)
    if layout.throw.size != carrier.size or places.size != carrier.size:
        return True  # another rule reports it
    if not np.isfinite(layout.pin).all():
        return True
    apart = (layout.pin - layout.pin[..., carrier] + TURN / 2) % TURN - TURN / 2
    radii = np.abs(crank.r / crank.r[..., carrier] - 1)
    return bool(
        np.array_equal(layout.throw, layout.throw[carrier])
        and np.all(np.abs(apart) <= SAME)
        and np.all(np.abs(places - places[carrier]) <= _NEAR)
        and np.all(radii <= _NEAR)
    )


@units(None, returns="1")
def articulated_rods_reach(crank: OffsetCrank) -> Truth:
    """Return whether articulated rods are longer than the largest distance of their pins from the axis."""
    if not isinstance(crank, ArticulatedCrank):
        return True
    if not (np.isfinite(crank.arm).all() and np.isfinite(crank.r).all()):
        return True  # another rule reports it
    alpha = np.linspace(0, 2 * np.pi, 2 * _SAMPLES, endpoint=False) + np.zeros((crank.carrier.size, 1))
    with np.errstate(invalid="ignore"):
        leaning = np.abs(crank.at(alpha).sin_phi).max(axis=-1)
    holds = np.all(leaning < 1 - _CLEAR, axis=-1)
    return bool(holds) if np.ndim(holds) == 0 else holds
