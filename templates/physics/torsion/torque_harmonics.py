"""Harmonics of the torque of one cylinder, and the range of a curve that is a sum of harmonics.

A torque over one cycle is its mean plus Re Σ c e^{ihθ}, with orders h per revolution of the crank: whole
orders in two-stroke engines, half orders as well in four-stroke engines. The cylinder that fires at φ has the
harmonics of the first one, which fires at φ₁, times e^{−ih(φ−φ₁)}.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Integers
from templates.core.language.declare import units

Phasors = NDArray[np.complex128]
TURN = 2 * np.pi
MOST_ANGLES = 20_000
_EVEN = 1e-6  # tolerance as a fraction of a step
_NOISE = 1e-14  # relative to the largest harmonic; smaller ones are rounding error
_LOW = 0.02  # fraction of the sum of amplitudes; the curve rises less above a sample next to its peak
_BLOCK = 2_000_000  # most samples in memory at a time


@dataclass(frozen=True)
class Excitation:
    """Orders (H,), and harmonics of gas [N m] and inertia torque [N m s²], (…, H), of one cylinder."""

    orders: Array
    gas: Phasors
    inertia: Phasors

    def of_cylinders(self, speeds: Array, factors: Array, firing: Array) -> Phasors:
        """Return the harmonics of each cylinder [N m], (…, V, H, N), at speeds [rad/s], (…, V)."""
        behind = firing - firing[..., :1]
        phase = np.exp(-1j * self.orders[:, None] * behind[..., None, None, :])
        gas = self.gas[..., None, :, None] * np.asarray(factors)[..., None, None, :]
        inertia = self.inertia[..., None, :, None] * np.asarray(speeds)[..., :, None, None] ** 2
        return np.asarray((gas + inertia) * phase)


@dataclass(frozen=True)
class Cycle:
    """Equally spaced crank angles of one cycle: the first [rad], their number, and strokes 2 or 4."""

    first: float
    count: int
    strokes: int


def cycle_of(theta: Array) -> Cycle | None:
    """Return the cycle of crank angles [rad], (K,), without a last point that repeats the first.

    The result is None if the angles do not cover one cycle.
    """
    if np.ndim(theta) != 1 or not 8 <= theta.size <= MOST_ANGLES:
        return None
    step = float(theta[-1] - theta[0]) / (theta.size - 1)
    if step <= 0 or np.abs(np.diff(theta) - step).max() > _EVEN * step:
        return None
    for strokes in (2, 4):
        points = strokes / 2 * TURN / step
        count = round(points)
        if abs(points - count) < 1e-3 and count in (theta.size, theta.size - 1):
            return Cycle(float(theta[0]), count, strokes)
    return None


@units("rad", returns="1")
def is_one_cycle(theta: Array) -> bool:
    """Return whether crank angles [rad] ascend in equal steps over a cycle of one or two revolutions."""
    return cycle_of(theta) is not None


@units("rad", "N*m", returns="1")
def closes(theta: Array, T: Array) -> bool:
    """Return whether the last torque [N m], [..., angle], equals the first if its angle closes the cycle."""
    cycle = cycle_of(theta)
    if cycle is None or np.ndim(T) == 0 or np.shape(T)[-1] != cycle.count + 1:
        return True
    apart = np.abs(T[..., -1] - T[..., 0])
    return bool(np.all(~(apart > _EVEN * np.abs(T).max(axis=-1))))


@units("rad", "1", returns="1")
def resolves(theta: Array, highest: Array) -> bool:
    """Return whether the highest order is at least 1 and each of its periods has more than two points."""
    cycle = cycle_of(theta)
    return cycle is None or 1 <= _lines(cycle, highest) < cycle.count / 2


def _lines(cycle: Cycle, highest: Array) -> int:
    """Return the number of orders up to the highest."""
    return int(np.floor(float(highest) * cycle.strokes / 2 + 1e-9))


def excitation(theta: Array, gas: Array, inertia: Array, reference: Array, highest: Array) -> Excitation:
    """Return the harmonics of one cylinder; a torque that is not given counts as 0.

    `inertia` is the torque [N m] at the speed `reference` [rad/s]; it is proportional to the square of the
    speed.
    """
    cycle = cycle_of(theta)
    assert cycle is not None  # a rule refuses others
    orders = orders_of(theta, highest)
    squared = 1.0 if np.all(np.isnan(reference)) else np.asarray(reference)[..., None] ** 2
    return Excitation(
        orders, _harmonics(gas, cycle, orders), np.asarray(_harmonics(inertia, cycle, orders) / squared)
    )


def _harmonics(T: Array, cycle: Cycle, orders: Array) -> Phasors:
    if np.ndim(T) == 0:
        return np.zeros(orders.shape, complex)
    spectrum = np.fft.rfft(T[..., : cycle.count], axis=-1)[..., 1 : orders.size + 1] * (2 / cycle.count)
    size = np.abs(spectrum)
    noise = _NOISE * np.abs(T).max(axis=-1, keepdims=True)
    return np.asarray(np.where(size <= noise, 0, spectrum) * np.exp(-1j * orders * cycle.first))


def half_swing(amplitudes: Phasors) -> Array:
    """Return half the range of Re Σ c e^{ikx}, k = 1 … H, over the cycle, (…), from c (…, H).

    The curve is sampled at least sixteen times in each period of its highest order. Parabolas through the
    samples rank its peaks, and Newton's method then finds the largest and the smallest value.
    """
    lines = amplitudes.shape[-1]
    if lines == 1:
        return np.abs(amplitudes[..., 0])
    flat = amplitudes.reshape(-1, lines)
    samples = 1 << int(np.ceil(np.log2(max(64, 16 * lines))))
    rows = max(1, _BLOCK // samples)
    swings = np.empty(len(flat))
    for start in range(0, len(flat), rows):
        part = flat[start : start + rows]
        spectrum = np.zeros((len(part), samples // 2 + 1), complex)
        spectrum[:, 1 : lines + 1] = part * (samples / 2)
        curve = np.fft.irfft(spectrum, samples, axis=-1)
        highest = _extreme(part, curve)
        lowest = _extreme(-part, -curve)
        swings[start : start + rows] = (highest + lowest) / 2
    return swings.reshape(amplitudes.shape[:-1])


def _extreme(amplitudes: Phasors, curve: Array) -> Array:
    """Return the largest value of each curve, (R,), by two Newton steps from its highest sample."""
    step = TURN / curve.shape[-1]
    at = _tops(curve, _LOW * np.abs(amplitudes).sum(axis=-1))
    k = np.arange(1, amplitudes.shape[-1] + 1)
    x = at * step
    for _ in range(2):
        turned = amplitudes * np.exp(1j * k * x[:, None])
        slope, bend = -(turned.imag @ k), -(turned.real @ k**2)
        with np.errstate(divide="ignore", invalid="ignore"):
            way = np.where(bend < 0, -slope / bend, 0.0)
        x = x + np.clip(way, -step, step)
    return np.maximum(curve.max(axis=-1), (amplitudes * np.exp(1j * k * x[:, None])).real.sum(axis=-1))


def _tops(curve: Array, low: Array) -> Integers:
    """Return the index of the sample at the highest peak of each curve, (R,), estimated by parabolas.

    No peak is more than `low` above its sample.
    """
    largest = curve.max(axis=-1)
    is_high = curve >= (largest - low)[:, None]
    is_high[np.isnan(largest), 0] = True
    row, at = np.nonzero(is_high)
    here, before, after = curve[row, at], curve[row, at - 1], curve[row, (at + 1) % curve.shape[-1]]
    bend = 2 * here - before - after
    is_top = (here >= before) & (here >= after) & (bend > 0)
    top = here + np.where(is_top, (after - before) ** 2 / (8 * np.where(is_top, bend, 1.0)), 0.0)
    highest = np.maximum.reduceat(top, np.searchsorted(row, np.arange(len(curve))))
    chosen = np.flatnonzero(top >= highest[row])[::-1]
    tops = np.zeros(len(curve), dtype=np.int64)
    tops[row[chosen]] = at[chosen]
    return tops


@units("rad", "1", returns="1", latex=r"\frac{{2 j}}{{z}}\le {1}")
def orders_of(theta: Array, highest: Array) -> Array:
    """Return the orders up to the highest, (H,): whole ones for two strokes, also half ones for four."""
    cycle = cycle_of(theta)
    assert cycle is not None  # a rule refuses others
    return np.arange(1, _lines(cycle, highest) + 1) * 2 / cycle.strokes
