"""Unbalance of any engine by orders: the components that rotate with the crank and against it.

The force of order h on the frame is f e^{ihθ} + b e^{−ihθ}, complex, x + i y. With w the amplitude of the
piston force of a cylinder, f = ½ Σ w e^{i(β+h(ψ−β))} and b = ½ Σ w* e^{i(β−h(ψ−β))}; couples are the same
sums with each cylinder multiplied by its arm. The largest magnitude over a revolution is |f| + |b|, at hθ =
(arg b − arg f)/2, in the direction (arg f + arg b)/2; the smallest is ||f| − |b||.

References
----------
S. S. Rao, Singh: DYREMI, Int. J. of Engineering Education 1993/94, for orders 1 and 2 in line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.engine.engine_layout import Layout
from templates.physics.engine.offset_crank import OffsetCrank

Phasor = NDArray[np.complex128]
_VANISHES = 1e-12  # relative to the sum of all magnitudes; smaller values are rounding error
_SAMPLES = 360  # per revolution, for orders up to 90


@dataclass(frozen=True)
class Harmonics:
    """Phasors that rotate with the crank and against it, (…, H), at orders h, (H,)."""

    orders: Array
    forward: Phasor
    backward: Phasor

    @cached_property
    def largest_at(self) -> Array:
        """Return hθ [rad] from 0 to π at which the magnitude is largest.

        If the vector only rotates, it is the angle at which the vector points to x.
        """
        f, b = np.angle(self.forward), np.angle(self.backward)
        both = (self.forward != 0) & (self.backward != 0)
        at = np.where(both, (b - f) / 2, b - f)
        return np.where(np.pi - at % np.pi < 1e-12, 0.0, at % np.pi)

    @cached_property
    def there(self) -> Phasor:
        """Return the vector at the angle where its magnitude is largest."""
        turn = np.exp(1j * self.largest_at)
        return self.forward * turn + self.backward / turn


def _sum(weight: Phasor, angle: Array) -> Phasor:
    """Return the sum over the cylinders, (…, H); exactly 0 where it consists only of rounding error."""
    total = np.sum(weight * np.exp(1j * angle), axis=-2)
    vanishes = np.abs(total) <= _VANISHES * np.sum(np.abs(weight), axis=-2)
    return np.where(vanishes, 0, total)


def _with_axis(value: Array) -> Array:
    return np.asarray(value)[..., None]


def piston_harmonics(crank: OffsetCrank, orders: Array, exact: bool) -> Phasor:
    """Return the complex amplitudes c of −x″ [m] at integer orders, (…, N, H), with −x″ = Re Σ c e^{ihα}.

    They are the leading terms r (r/l)^(h−1) of textbooks for orders 1 and 2 of a centred crank; otherwise the
    Fourier coefficients of the exact motion.
    """
    whole = np.rint(np.atleast_1d(orders)).astype(int)
    alpha = np.linspace(0, 2 * np.pi, _SAMPLES, endpoint=False)
    spectrum = np.fft.rfft(-crank.at(alpha).x2, axis=-1) * (2 / _SAMPLES)
    amplitudes = spectrum[..., whole]
    centred = (crank.e == 0)[..., None]
    amplitudes = np.where(centred & (whole % 2 == 1) & (whole > 1), 0, amplitudes)
    if exact:
        return amplitudes
    leading = _with_axis(crank.r) * _with_axis(crank.r / crank.l) ** (whole - 1)
    return np.where(centred & (whole <= 2), leading, amplitudes)


def harmonics(layout: Layout, orders: Array, weight: Phasor, arm: Array | float = 1.0) -> Harmonics:
    """Return the unbalance at the orders from piston forces `weight`, (…, N, H), each times its arm."""
    h = np.atleast_1d(orders)
    bank, turn = _with_axis(layout.bank), _with_axis(layout.pin - layout.bank)
    half = weight / 2 * _with_axis(np.asarray(arm, dtype=float))
    forward = _sum(half, bank + h * turn)
    backward = _sum(np.conj(half), bank - h * turn)
    return Harmonics(h, forward, backward)


@units(None, returns="N")
def forward_force(parts: Harmonics) -> Array:
    """Return the magnitude of the force component that rotates with the crank [N]."""
    return np.abs(parts.forward)


@units(None, returns="N")
def backward_force(parts: Harmonics) -> Array:
    """Return the magnitude of the force component that rotates against the crank [N]."""
    return np.abs(parts.backward)


@units(None, returns="N*m")
def forward_couple(parts: Harmonics) -> Array:
    """Return the magnitude of the couple that rotates with the crank [N m]."""
    return np.abs(parts.forward)


@units(None, returns="N*m")
def backward_couple(parts: Harmonics) -> Array:
    """Return the magnitude of the couple that rotates against the crank [N m]."""
    return np.abs(parts.backward)


@units(None, returns="rad")
def largest_at(parts: Harmonics) -> Array:
    """Return the crank angle at which force or couple is largest [rad], from 0 to half its period."""
    return parts.largest_at / parts.orders


@units(None, returns="rad")
def largest_towards(parts: Harmonics) -> Array:
    """Return the direction of the largest force or couple [rad], from x in the sense of rotation, 0 to 2π."""
    angle = np.angle(parts.there) % (2 * np.pi)
    return np.where(2 * np.pi - angle < 1e-9, 0.0, angle)


@units(None, returns="N")
def force_size(phasor: Phasor) -> Array:
    """Return the magnitude of a force [N]."""
    return np.abs(phasor)[()]


@units(None, returns="N*m")
def couple_size(phasor: Phasor) -> Array:
    """Return the magnitude of a couple [N m]."""
    return np.abs(phasor)[()]


@units(None, returns="rad")
def direction(phasor: Phasor) -> Array:
    """Return the direction of a vector [rad], from 0 to 2π; 0 for a zero vector."""
    angle = np.angle(phasor) % (2 * np.pi)
    return np.where(2 * np.pi - angle < 1e-9, 0.0, angle)[()]


def rotating_sum(parts: Sequence[tuple[Phasor, Array]], omega: Array, reference: Array | None) -> Phasor:
    """Return force [N] and couple about a reference [N m] of unbalances [kg m], (…, L), at places [m], (L,).

    Both are exactly 0 where they consist only of rounding error.
    """
    total, size = np.zeros((), complex), np.zeros(())
    for unbalance, places in parts:
        arm = 1.0 if reference is None else places - np.asarray(reference)[..., None]
        total = total + np.sum(unbalance * arm, axis=-1)
        size = size + np.sum(np.abs(unbalance * arm), axis=-1)
    left = np.asarray(np.where(np.abs(total) <= _VANISHES * size, 0, total), dtype=complex)
    return np.asarray(left * np.asarray(omega) ** 2)
