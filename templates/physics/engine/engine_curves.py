"""Curves of a whole engine over its cycle: torque, energy areas, shaking force and couple, roll moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.crankshaft.main_bearings import Vectors
from templates.physics.engine.offset_crank import RodMotion


@dataclass(frozen=True)
class Rotors:
    """Unbalances [kg m], complex as they stand at crank angle 0, (…, L), and their places [m], (L,).

    They turn `ratio` times as fast as the crank.
    """

    unbalance: Vectors
    place: Array
    ratio: Array | float = 1.0

    def forces(self, omega: Array, theta: Array) -> Vectors:
        """Return their forces [N], (…, L, K)."""
        size = self.unbalance * (np.asarray(omega)[..., None] * self.ratio) ** 2
        ratio = np.asarray(self.ratio + 0 * self.place)[:, None]
        return np.asarray(size[..., None] * np.exp(1j * ratio * theta))


def balancers(unbalance: Array, ratios: Array, phases: Array, places: Array) -> Rotors:
    """Return the balance shafts, none where none are given; phases [rad] at crank angle 0."""
    if np.ndim(unbalance) == 0:
        return Rotors(np.zeros(0, complex), np.zeros(0))
    return Rotors(unbalance * np.exp(1j * phases), places, ratios)


@units("kg*m", "1", "m", returns="1")
def balancers_are_whole(unbalance: Array, ratios: Array, places: Array) -> Truth:
    """Return whether the balance shafts have one list of each, or nothing is given."""
    lists = [np.ndim(one) for one in (unbalance, ratios, places)]
    return lists in ([0, 0, 0], [1, 1, 1])


@dataclass(frozen=True)
class Parts:
    """Forces of moving parts on the frame [N], (…, L, K), and their places [m], (L,), for Σ F and Σ z F."""

    pistons: Vectors
    cylinder_places: Array
    rotors: tuple[tuple[Vectors, Array], ...]

    def resultant(self) -> Vectors:
        """Return Σ F, (…, K)."""
        return self._sum(None)

    def couple(self, reference: Array) -> Vectors:
        """Return Σ (z − z₀) F, (…, K)."""
        return self._sum(reference)

    def _sum(self, reference: Array | None) -> Vectors:
        """Return the sum over all parts, each times its arm; zero where only rounding is left."""
        total, size = np.zeros((), complex), np.zeros(())
        for forces, places in ((self.pistons, self.cylinder_places), *self.rotors):
            arm = 1.0 if reference is None else (places - np.asarray(reference)[..., None])[..., None]
            total = total + (arm * forces).sum(axis=-2)
            size = size + np.abs(arm * forces).sum(axis=-2)
        least = 1e-12 * np.max(size, axis=-1, keepdims=True)
        x = np.where(np.abs(total.real) <= least, 0.0, total.real)
        return np.asarray(x + 1j * np.where(np.abs(total.imag) <= least, 0.0, total.imag))


def piston_shaking(reciprocating: Array, omega: Array, motion: RodMotion, bank: Array) -> Vectors:
    """Force of each reciprocating mass on the frame [N], −m x″ω² along its bank, complex, (…, N, K)."""
    along = -(reciprocating * omega**2)[..., None] * motion.x2
    return np.asarray(along * np.exp(1j * bank)[..., None])


@units(None, None, None, returns="N*m")
def roll_moment(wall: Array, gas: Array, motion: RodMotion) -> Array:
    """Return moment about the shaft that walls and heads put on the frame [N m]: Σ (x W − e (p − p₀) A)."""
    each = motion.x * wall - motion.crank.e[..., None] * gas
    return np.asarray(each.sum(axis=-2))


@units(None, None, None, returns="N*m")
def torque(pins: Vectors, motion: RodMotion, _theta: Array) -> Array:
    """Return torque of all rods on the crank [N m], from pin forces in the cylinders' own axes, (…, K)."""
    lever = motion.crank.r[..., None]
    return np.asarray((lever * (motion.cos * pins.imag - motion.sin * pins.real)).sum(axis=-2))


@units("rad", "N*m", returns="J")
def running_energy(theta: Array, T: Array) -> Array:
    """Integral of the torque less its mean from the first angle [J], (…, K), by the trapezoidal rule."""
    swing = T - T.mean(axis=-1, keepdims=True)
    step = theta[1] - theta[0]
    inner = (swing[..., 1:] + swing[..., :-1]) * (step / 2)
    energy = np.concatenate([np.zeros_like(swing[..., :1]), np.cumsum(inner, axis=-1)], axis=-1)
    least = 1e-12 * np.abs(energy).max(axis=-1, keepdims=True)
    return np.where(np.abs(energy) <= least, 0.0, energy)


@dataclass(frozen=True)
class Area:
    """An area between torque and mean torque: from and to [rad], energy [J], positive above the mean."""

    begin: float
    end: float
    energy: float


def areas_of(theta: Array, T: Array) -> list[Area]:
    """Return the areas of one torque curve, (K,), linear between its points and periodic; they sum to 0."""
    swing, step = T - T.mean(), float(theta[1] - theta[0])
    after = np.roll(swing, -1)
    crossing = np.flatnonzero((swing < 0) != (after < 0))
    if not crossing.size or np.abs(swing).max() <= 1e-12 * np.abs(T).max():
        return []
    share = swing[crossing] / (swing[crossing] - after[crossing])
    places = theta[crossing] + share * step
    areas = []
    for k, (i, s) in enumerate(zip(crossing, share, strict=True)):
        last = k + 1 == crossing.size
        j, t = (crossing[0] + T.size, share[0]) if last else (crossing[k + 1], share[k + 1])
        between = swing[np.arange(i + 1, j + 1) % T.size]
        ends = between[0] * (1 - s) / 2 + between[-1] * t / 2
        inner = (between[1:] + between[:-1]).sum() / 2
        end = places[0] + T.size * step if last else places[k + 1]
        areas.append(Area(float(places[k]), float(end), float((ends + inner) * step)))
    return areas


@units("rad", "N*m", returns="J")
def area_curve(theta: Array, T: Array) -> Array:
    """At each crank angle the whole area [J] in which it lies, (…, K); 0 where the torque does not vary."""
    flat = T.reshape(-1, T.shape[-1])
    curves = np.zeros_like(flat)
    span = T.shape[-1] * float(theta[1] - theta[0])
    for curve, one in zip(curves, flat, strict=True):
        for area in areas_of(theta, one):
            place = theta[0] + (theta - theta[0] - (area.begin - theta[0])) % span
            curve[place - theta[0] < area.end - area.begin] = area.energy
    return curves.reshape(T.shape)


@units("rad", "N*m", returns="1")
def areas_in_words(theta: Array, T: Array) -> str | Array:
    """Return every area: `+312.4 J from 12.3 to 104.1 deg; …`."""
    flat = T.reshape(-1, T.shape[-1])
    words = [
        "; ".join(
            f"{area.energy:+.5g} J from {np.degrees(area.begin):.2f} to {np.degrees(area.end):.2f} deg"
            for area in areas_of(theta, one)
        )
        for one in flat
    ]
    return words[0] if T.ndim == 1 else np.array(words, dtype=object).reshape(T.shape[:-1])


@units("J", returns="J")
def swing_of(energy: Array) -> Array:
    """Return the largest less smallest running energy [J]."""
    return np.asarray(np.ptp(energy, axis=-1))[()]
