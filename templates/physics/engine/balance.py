"""Balance of a crankshaft with any number of equal cylinders: residual forces and couples.

When the first cylinder to fire is at top dead centre, the crank of a cylinder is at −(firing interval) · (its
position in the firing order, from 0) plus the angle of its bank. Phasors are complex: x real, y imaginary, in
units of mass times omega² r. The force of a piston along the axis of its bank is the sum of a phasor that
rotates with the crank and one that rotates against it. For in-line cylinders the two are equal, and the sum
stays in the plane of the cylinders. A V engine differs only by its bank angles.

References
----------
S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94. Erratum: the paper drops r in the residual
force m_rec omega² r cos(2 theta)/n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units

Phasor = NDArray[np.complex128]
_VANISHES = 1e-12  # relative to the sum of all magnitudes; smaller values are rounding error


@dataclass(frozen=True)
class Pair:
    """A phasor that rotates with the crank, and one that rotates against it."""

    forward: Phasor
    backward: Phasor

    @property
    def amplitude(self) -> Array:
        """Return the largest magnitude over the cycle: the semi-major axis of an ellipse."""
        return np.asarray(np.abs(self.forward) + np.abs(self.backward), dtype=float)

    def at(self, angle: Array) -> Phasor:
        """Return the sum of both phasors, (…, K), at a crank angle `angle` [rad] times the order."""
        turn = np.exp(1j * angle)
        return self.forward[..., None] * turn + self.backward[..., None] / turn


@dataclass(frozen=True)
class Arrangement:
    """In-line or banked cylinders: crank and bank angle [rad], distance from reference plane [m].

    All have the shape (…, N).
    """

    turn: Array
    bank: Array
    arm: Array

    def rotating(self, arm: Array | float = 1.0) -> Phasor:
        """Return the sum of the crank directions, each multiplied by its arm."""
        return _sum(arm, self.bank + self.turn)

    def reciprocating(self, order: int, arm: Array | float = 1.0) -> Pair:
        """Return the phasors of one order of the pistons, each multiplied by its arm."""
        return Pair(
            _sum(np.asarray(arm) / 2, self.bank + order * self.turn),
            _sum(np.asarray(arm) / 2, self.bank - order * self.turn),
        )


def _sum(weight: Array | float, angle: Array) -> Phasor:
    """Return the sum of weighted directions; exactly 0 where it consists only of rounding error."""
    weight = np.broadcast_to(weight, np.shape(weight * angle))
    total = np.sum(weight * np.exp(1j * angle), axis=-1)
    vanishes = np.abs(total) <= _VANISHES * np.sum(np.abs(weight), axis=-1)
    return np.where(vanishes, 0, total)


def crank_turns(order: Array, interval: Array | float) -> Array:
    """Return the crank angle [rad] of each cylinder, (…, N), from firing order and firing interval [rad]."""
    place = np.argsort(np.atleast_1d(order), axis=-1).astype(float)
    return np.asarray(-interval * place)


def arrangement(strokes: Array, order: Array, bank: Array, places: Array, reference: Array) -> Arrangement:
    """Return the cylinders that fire in `order`, at equal intervals, at axial positions `places` [m]."""
    order, places = np.atleast_1d(order), np.atleast_1d(places)
    turn = crank_turns(order, np.pi * strokes / order.shape[-1])
    return Arrangement(turn, np.atleast_1d(bank) + 0 * turn, places - np.asarray(reference)[..., None])


@units("m", returns="m", latex=r"\frac{{\min {0}+\max {0}}}{{2}}")
def mid_plane(places: Array) -> Array:
    """Return the plane midway between the outermost cylinders [m]."""
    places = np.atleast_1d(places)
    ends = np.min(places, axis=-1), np.max(places, axis=-1)
    return np.asarray((ends[0] + ends[1]) / 2)[()]


@units("1", "1", returns="1")
def is_firing_order(order: Array, count: Array) -> Truth:
    """Return whether every cylinder from 1 to `count` fires once."""
    order = np.atleast_1d(order)
    if order.shape[-1] != count:
        return False
    return np.all(np.sort(order, axis=-1) == np.arange(1, order.shape[-1] + 1), axis=-1)


@units(None, "1", returns="1")
def is_one_each(value: Array, count: Array) -> Truth:
    """Return whether there is a value for each cylinder."""
    return bool(np.atleast_1d(value).shape[-1] == count)


@units("kg", "rad/s", "m", None, returns="N")
def rotating_force(m_rot: Array, omega: Array, r: Array, row: Arrangement) -> Array:
    """Return the magnitude of the force of the rotating masses [N]."""
    return np.abs(m_rot * omega**2 * r) * np.abs(row.rotating())


@units("kg", "rad/s", "m", None, returns="N*m")
def rotating_couple(m_rot: Array, omega: Array, r: Array, row: Arrangement) -> Array:
    """Return the magnitude of the couple of the rotating masses about the reference plane [N m]."""
    return np.abs(m_rot * omega**2 * r) * np.abs(row.rotating(row.arm))


@units("kg", "rad/s", "m", "1", None, None, returns="N")
def reciprocating_force(m: Array, omega: Array, r: Array, n: Array, order: int, row: Arrangement) -> Array:
    """Return the amplitude of the primary (1) or secondary (2) force [N]: m ω² r [/n] times phasors."""
    return m * omega**2 * r / n ** (order - 1) * row.reciprocating(order).amplitude


@units("kg", "rad/s", "m", "1", None, None, returns="N*m")
def reciprocating_couple(m: Array, omega: Array, r: Array, n: Array, order: int, row: Arrangement) -> Array:
    """Return the amplitude of the primary (1) or secondary (2) couple about the reference plane [N m]."""
    return m * omega**2 * r / n ** (order - 1) * row.reciprocating(order, row.arm).amplitude


@units("kg", "kg", "rad/s", "m", "1", None, "rad", returns="N")
def residual_force_x(
    m_rot: Array, m_rec: Array, omega: Array, r: Array, n: Array, row: Arrangement, theta: Array
) -> Array:
    """Return the force of all cylinders on the frame along x [N], (…, K), up to the second harmonic."""
    return _residual(m_rot, m_rec, omega, r, n, row, theta).real


@units("kg", "kg", "rad/s", "m", "1", None, "rad", returns="N")
def residual_force_y(
    m_rot: Array, m_rec: Array, omega: Array, r: Array, n: Array, row: Arrangement, theta: Array
) -> Array:
    """Return the force of all cylinders on the frame along y [N], (…, K), up to the second harmonic."""
    return _residual(m_rot, m_rec, omega, r, n, row, theta).imag


def _residual(
    m_rot: Array, m_rec: Array, omega: Array, r: Array, n: Array, row: Arrangement, theta: Array
) -> Phasor:
    parts = (
        (m_rot, row.rotating()[..., None] * np.exp(1j * theta)),
        (m_rec, row.reciprocating(1).at(theta)),
        (m_rec / n, row.reciprocating(2).at(2 * theta)),
    )
    return np.asarray(sum(np.asarray(m * omega**2 * r)[..., None] * phasor for m, phasor in parts))


@dataclass(frozen=True)
class TwoPlanes:
    """Phasors of the balancing masses in two planes, for cranks of unit mass at unit radius."""

    flywheel: Phasor
    damper: Phasor


def two_planes(row: Arrangement, reference: Array, x_f: Array, x_d: Array) -> TwoPlanes:
    """Return the masses in the planes at x_f and x_d [m] that balance the rotating forces and couples."""
    place = row.arm + np.asarray(reference)[..., None]
    x_f, x_d = np.asarray(x_f), np.asarray(x_d)
    flywheel = row.rotating(place - x_d[..., None]) / (x_d - x_f)
    damper = row.rotating(place - x_f[..., None]) / (x_f - x_d)
    return TwoPlanes(flywheel, damper)


@units("kg", None, returns="rad", latex=r"\operatorname{{arg}}\left({1}\right)")
def balance_angle(m_rot: Array, phasor: Phasor) -> Array:
    """Return the angle of a balancing mass [rad], from 0 to 2π; NaN if the mass is 0."""
    angle = np.angle(m_rot * phasor) % (2 * np.pi)
    return np.where(np.abs(m_rot * phasor) > 0, angle, np.nan)[()]
