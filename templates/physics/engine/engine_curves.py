"""Curves of a whole engine over its cycle: torque, energy areas, shaking force and couple, roll moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.crankshaft.main_bearings import Vectors
from templates.physics.engine.offset_crank import RodMotion
from templates.physics.numerics.crank_grid import CrankGrid


@dataclass(frozen=True)
class Rotors:
    """Unbalances [kg m], complex at crank angle 0, (…, L), and their axial positions [m], (L,).

    They rotate `ratio` times as fast as the crank.
    """

    unbalance: Vectors
    place: Array
    ratio: Array | float = 1.0

    def forces(self, omega: Array, theta: Array) -> Vectors:
        """Return the forces of the rotors [N], (…, L, K)."""
        size = self.unbalance * (np.asarray(omega)[..., None] * self.ratio) ** 2
        ratio = np.asarray(self.ratio + 0 * self.place)[:, None]
        return np.asarray(size[..., None] * np.exp(1j * ratio * theta[..., None, :]))


def balancers(unbalance: Array, ratios: Array, phases: Array, places: Array) -> Rotors:
    """Return the balance shafts, or no rotors if none are given; phases [rad] at crank angle 0."""
    if np.ndim(unbalance) == 0:
        return Rotors(np.zeros(0, complex), np.zeros(0))
    return Rotors(unbalance * np.exp(1j * phases), places, ratios)


@units("kg*m", "1", "m", returns="1")
def balancers_are_whole(unbalance: Array, ratios: Array, places: Array) -> Truth:
    """Return whether the lists that describe balance shafts are all given, or none of them."""
    lists = [np.ndim(one) for one in (unbalance, ratios, places)]
    return lists in ([0, 0, 0], [1, 1, 1])


@dataclass(frozen=True)
class Parts:
    """Forces of moving parts on the frame [N], (…, L, K), and their positions [m], (L,): Σ F and Σ z F."""

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
        """Return the sum over all parts, each multiplied by its arm; mere rounding error is set to 0."""
        total, size = np.zeros((), complex), np.zeros(())
        for forces, places in ((self.pistons, self.cylinder_places), *self.rotors):
            arm = 1.0 if reference is None else (places - np.asarray(reference)[..., None])[..., None]
            total = total + (arm * forces).sum(axis=-2)
            size = size + np.abs(arm * forces).sum(axis=-2)
        least = 1e-12 * np.max(size, axis=-1, keepdims=True)
        x = np.where(np.abs(total.real) <= least, 0.0, total.real)
        return np.asarray(x + 1j * np.where(np.abs(total.imag) <= least, 0.0, total.imag))


def piston_shaking(reciprocating: Array, omega: Array, motion: RodMotion, bank: Array) -> Vectors:
    """Return the force of each reciprocating mass on the frame [N], −m x″ω² along its bank, (…, N, K)."""
    along = -(reciprocating * omega**2)[..., None] * motion.x2
    return np.asarray(along * np.exp(1j * bank)[..., None])


@units(None, None, None, None, returns="N*m")
def roll_moment(wall: Array, gas: Array, motion: RodMotion, grid: CrankGrid) -> Array:
    """Return the moment about the shaft of walls and heads on the frame [N m]: Σ (x W − e (p − p₀) A)."""
    each = motion.x * wall - motion.crank.e[..., None] * gas
    return grid.returned(np.asarray(each.sum(axis=-2)))


def torque(pins: Vectors, motion: RodMotion) -> Array:
    """Return the torque of all rods on the crank [N m], from pin forces in cylinder axes, (…, K)."""
    lever = motion.crank.r[..., None]
    return np.asarray((lever * (motion.cos * pins.imag - motion.sin * pins.real)).sum(axis=-2))


def running_energy(T: Array, grid: CrankGrid) -> Array:
    """Return the integral of torque minus its mean from the first angle [J], (…, K), at all grid angles."""
    energy = grid.running(T)
    least = 1e-12 * np.abs(energy).max(axis=-1, keepdims=True)
    return np.where(np.abs(energy) <= least, 0.0, energy)


@units(None, None, returns="N*m")
def torque_curve(T: Array, grid: CrankGrid) -> Array:
    """Return the torque [N m] at the returned angles."""
    return grid.returned(T)


@units(None, None, returns="J")
def energy_curve(energy: Array, grid: CrankGrid) -> Array:
    """Return the running energy [J] at the returned angles."""
    return grid.returned(energy)


@units(None, None, returns="Pa")
def pressure_curves(p: Array, grid: CrankGrid) -> Array:
    """Return the pressure in each cylinder [Pa] at the returned angles."""
    return grid.returned(p)


@dataclass(frozen=True)
class Area:
    """An area between torque and mean torque: start and end [rad], energy [J], positive above the mean."""

    begin: float
    end: float
    energy: float


def areas_of(theta: Array, swing: Array, cycle: float) -> list[Area]:
    """Return the areas of a periodic curve of zero mean at ascending angles, (K,); they sum to 0."""
    width, after = np.diff(theta, append=theta[0] + cycle), np.roll(swing, -1)
    crossing = np.flatnonzero((swing < 0) != (after < 0))
    if not crossing.size:
        return []
    before, beyond = swing[crossing], after[crossing]
    share = before / (before - beyond)
    places = theta[crossing] + share * width[crossing]
    parts = (swing + after) / 2 * width
    sums = np.cumsum(parts) - parts
    reached = sums[crossing] + before * share * width[crossing] / 2
    ends = np.append(places[1:], places[0] + cycle)
    energies = np.append(np.diff(reached), reached[0] + parts.sum() - reached[-1])
    return [Area(*map(float, one)) for one in zip(places, ends, energies, strict=True)]


def _areas(T: Array, grid: CrankGrid) -> list[list[Area]]:
    """Return the areas of each torque curve, (…, K), in order; empty if the torque is constant."""
    swing = grid.swing(T).reshape(-1, T.shape[-1])
    theta = np.broadcast_to(grid.ascending, T.shape).reshape(swing.shape)
    varies = np.abs(swing).max(axis=-1) > 1e-12 * np.abs(T).reshape(swing.shape).max(axis=-1)
    return [
        areas_of(angles, curve, grid.cycle) if moves else []
        for angles, curve, moves in zip(theta, swing, varies, strict=True)
    ]


@units("rad", None, None, returns="J")
def area_curve(theta: Array, T: Array, grid: CrankGrid) -> Array:
    """Return at each returned angle [rad] the whole area [J] that contains the angle, (…, K); else 0."""
    curves = np.zeros((max(1, T.size // T.shape[-1]), theta.size))
    for curve, areas in zip(curves, _areas(T, grid), strict=True):
        for area in areas:
            curve[(theta - area.begin) % grid.cycle < area.end - area.begin] = area.energy
    return curves.reshape(*T.shape[:-1], theta.size)


@units(None, None, returns="1")
def areas_in_words(T: Array, grid: CrankGrid) -> str | Array:
    """Return all areas as text: `+312.4 J from 12.3 to 104.1 deg; …`."""
    words = [
        "; ".join(
            f"{area.energy:+.5g} J from {np.degrees(area.begin):.2f} to {np.degrees(area.end):.2f} deg"
            for area in areas
        )
        for areas in _areas(T, grid)
    ]
    return words[0] if T.ndim == 1 else np.array(words, dtype=object).reshape(T.shape[:-1])


@units(None, returns="J")
def swing_of(energy: Array) -> Array:
    """Return the largest minus the smallest running energy [J]."""
    return np.asarray(np.ptp(energy, axis=-1))[()]
