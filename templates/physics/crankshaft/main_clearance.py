"""Main bearings with clearance: an elastic crankshaft touches elastic supports beyond a clearance.

A support reacts with R = k (|u| − c) along the displacement u of the shaft from the centre of its bore if |u|
exceeds the clearance c, otherwise with no force. The centre of the bore may be offset from the line of the
others.

By the force method of `crank_supports`, the reactions are R = R₀ + B x, with self-balanced sets B. The
displacements of the shaft d(R), of the supports R/k + c R/|R|, and the offsets o of the bores are compatible:
Bᵀ(d + R/k + c R/|R| − o) = 0. This is the minimum of a convex energy, which damped Newton steps find at all
crank angles at once. |R| is replaced by √(R² + ε²), with ε reduced to 1e-7 of the loads: a main without
contact then carries only a force of that order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.crankshaft.crank_frame import CrankFrame, CrankSections, Throw
from templates.physics.crankshaft.crank_supports import Flexibility, self_balancing
from templates.physics.crankshaft.main_bearings import ShaftLoads, Vectors, lever_shares
from templates.physics.crankshaft.shaft_loads import Places, fits, throw_places

_NONE = np.array(np.nan)
_SMOOTH = 10.0 ** -np.arange(1, 8)  # successive values of ε over the largest load
_STEPS = 40  # most Newton steps for each ε
_HALVINGS = 30
_SETTLED = 1e-9  # converged residual of compatibility, relative to the displacements
_LAW = 1e-8
_COLUMNS = 20_000  # most crank angles solved at once


@dataclass(frozen=True)
class Supports:
    """Stiffness [N/m], clearance [m] and offset of the bore [m], complex in the engine's axes, (n,)."""

    stiffness: Array
    clearance: Array
    offset: Vectors

    @property
    def have_play(self) -> bool:
        """Return whether any main has a clearance or an offset."""
        return bool(np.any(self.clearance > 0) or np.any(self.offset != 0))


def supports_of(mains: Array, stiffness: Array, clearance: Array, x: Array, y: Array) -> Supports:
    """Return the supports, one value for each main; rigid if no stiffness is given."""
    each = np.zeros(np.size(mains))
    middle: Vectors = np.asarray(x + 1j * y + each, dtype=complex)
    return Supports(np.where(np.isnan(stiffness), np.inf, stiffness) + each, clearance + each, middle)


def flexibilities(
    mains: Array, cylinders: Array, webs: Array, throw: Places, pins: Array, radius: Array,
    sections: CrankSections,
) -> list[Flexibility]:  # fmt: skip
    """Return the flexibility of the shaft at each point of pins [rad] and radii [m], (…, N).

    It is None if the sections of the shaft are not given.
    """
    if not np.ndim(mains) or np.isnan([vars(sections)[name] for name in vars(sections)]).any():
        return []
    if not np.isfinite(pins).all() or not fits(mains, cylinders, throw, sections):
        return []
    vectors = radius * np.exp(1j * pins)
    order, middles = np.argsort(cylinders, kind="stable"), throw_places(cylinders, throw)
    found = []
    for one in vectors.reshape(-1, vectors.shape[-1]):
        throws = [
            Throw(z, tuple((float(cylinders[j]), complex(one[j]), int(j)) for j in order if throw[j] == t))
            for t, z in enumerate(middles)
        ]
        found.append(CrankFrame(sections, mains, throws).flexibility(cylinders.size, webs))
    return found


@dataclass(frozen=True)
class SupportReactions:
    """Reactions of the mains [N], (…, n, K), and the relative residual of the support law, (…, K)."""

    forces: Vectors
    residual: Array


def with_play(
    mains: Array, loads: ShaftLoads, shafts: Sequence[Flexibility], supports: Supports, theta: Array
) -> SupportReactions:
    """Return the loads of mains with clearance; all points may share one shaft, or each has its own."""
    turn = np.exp(1j * theta)[..., None, :]
    shape = loads.forces.shape[:-2]
    points = loads.forces.reshape(-1, *loads.forces.shape[-2:])
    turned = points * np.conj(turn)
    offsets = supports.offset[:, None] * np.conj(turn)
    if len(shafts) == 1:
        play = _Play(mains, loads.places, shafts[0], supports)
        answer = play.reactions(np.concatenate([*turned], axis=-1), np.tile(offsets, points.shape[0]))
        split = np.moveaxis(answer.forces.reshape(mains.size, points.shape[0], theta.size), 1, 0)
        left = answer.residual.reshape(points.shape[0], theta.size)
    else:
        turned = np.broadcast_to(turned, (len(shafts), *turned.shape[1:]))
        each = [
            _Play(mains, loads.places, shaft, supports).reactions(one, offsets)
            for shaft, one in zip(shafts, turned, strict=True)
        ]
        split, left = np.array([one.forces for one in each]), np.array([one.residual for one in each])
        shape = shape if len(points) == len(shafts) else (len(shafts),)
    return SupportReactions(split.reshape(*shape, *split.shape[-2:]) * turn, left.reshape(*shape, theta.size))


class _Play:
    """Reactions of one shaft in rotating axes; rows alternate between real and imaginary parts."""

    def __init__(self, mains: Array, places: Array, shaft: Flexibility, supports: Supports) -> None:
        plane = np.eye(2)
        self.start = -np.kron(lever_shares(mains, places), plane)
        self.basis = np.kron(self_balancing(mains), plane)
        self.shaft, self.supports = shaft, supports
        self.give = shaft.mains + np.diag(np.repeat(1 / supports.stiffness, 2))
        self.clearance = supports.clearance[:, None]

    def reactions(self, forces: Vectors, offsets: Vectors) -> SupportReactions:
        """Return reactions [N], (n, K), to loads, (L, K), with the bore centres at offsets [m], (n, K)."""
        parts = [
            self._some(forces[:, at : at + _COLUMNS], offsets[:, at : at + _COLUMNS])
            for at in range(0, forces.shape[-1], _COLUMNS)
        ]
        together = np.concatenate([part.forces for part in parts], axis=-1)
        return SupportReactions(together, np.concatenate([part.residual for part in parts]))

    def _some(self, forces: Vectors, offsets: Vectors) -> SupportReactions:
        rows, bores = _rows(forces), _rows(offsets)
        first = self.start @ rows
        free = self.give @ first + self.shaft.loads @ rows - bores
        B, stiff = self.basis, self.basis.T @ self.give @ self.basis
        x = np.zeros((B.shape[1], rows.shape[-1]))
        if B.shape[1]:
            x -= np.linalg.solve(stiff, B.T @ free)
        size = np.maximum(np.abs(rows).max(axis=0), 1e-30)
        for share in _SMOOTH:
            x = self._settled(x, first, B.T @ free, stiff, share * size)
        slope, _ = self._slope(x, first, B.T @ free, stiff, _SMOOTH[-1] * size)
        moved = np.abs(free).max(axis=0) + np.max(self.clearance)
        left = np.abs(slope).max(axis=0, initial=0.0) / moved
        pairs = (first + B @ x).reshape(-1, 2, rows.shape[-1])
        return SupportReactions(pairs[:, 0] + 1j * pairs[:, 1], left)

    def _settled(self, x: Array, first: Array, free: Array, stiff: Array, small: Array) -> Array:
        """Return the solution of Newton's method started at x; the energy damps the steps at each angle."""
        if not x.size:
            return x
        for _ in range(_STEPS):
            slope, bend = self._slope(x, first, free, stiff, small)
            gap = np.abs(slope).max(axis=0)
            moves = gap > _SETTLED * (np.abs(free).max(axis=0) + self.clearance.max())
            if not moves.any():
                break
            step = np.asarray(-np.linalg.solve(bend, slope.T[..., None])[..., 0].T, dtype=float)
            length = self._damped(x, step, slope, lambda tried: (
                self._energy(tried, first, free, stiff, small),
                self._slope(tried, first, free, stiff, small)[0],
            ))  # fmt: skip
            x = np.where(moves, x + length * step, x)  # the result at one angle must not depend on the others
        return x

    def _damped(
        self, x: Array, step: Array, slope: Array, look: Callable[[Array], tuple[Array, Array]]
    ) -> Array:
        """Return the length of each step at which the energy, or near the solution its gradient, decreases.

        Near the solution, differences of energy are dominated by rounding error.
        """
        energy, _ = look(x)
        falls, steep = (slope * step).sum(axis=0), np.abs(slope).max(axis=0)
        length = np.ones(x.shape[-1])
        for _ in range(_HALVINGS):
            there, slope_there = look(x + length * step)
            worse = (there > energy + 1e-4 * length * falls) & (np.abs(slope_there).max(axis=0) > steep / 2)
            if not worse.any():
                break
            length = np.where(worse, length / 2, length)
        return length

    def _energy(self, x: Array, first: Array, free: Array, stiff: Array, small: Array) -> Array:
        sizes = _sizes(first + self.basis @ x, small)
        return np.asarray(
            (x * (stiff @ x)).sum(axis=0) / 2 + (x * free).sum(axis=0) + (self.clearance * sizes).sum(axis=0)
        )

    def _slope(self, x: Array, first: Array, free: Array, stiff: Array, small: Array) -> tuple[Array, Array]:
        """Return the gradient, (m, K), and Hessian, (K, m, m), of the energy by x."""
        R = first + self.basis @ x
        sizes = _sizes(R, small)
        pairs = R.reshape(-1, 2, R.shape[-1])
        along = pairs / sizes[:, None]
        push = (self.clearance[:, None] * along).reshape(R.shape)
        curved = (self.clearance / sizes)[:, None, None] * (
            np.eye(2)[None, :, :, None] - along[:, :, None] * along[:, None, :]
        )
        bases = self.basis.reshape(-1, 2, self.basis.shape[-1])
        bend = stiff + np.einsum("nam,nabk,nbl->kml", bases, curved, bases, optimize=True)
        return stiff @ x + free + self.basis.T @ push, bend


def _rows(vectors: Vectors) -> Array:
    """Return complex rows, (n, K), as alternating real and imaginary rows, (2 n, K)."""
    return np.stack([vectors.real, vectors.imag], axis=1).reshape(-1, vectors.shape[-1])


def _sizes(R: Array, small: Array) -> Array:
    pairs = R.reshape(-1, 2, R.shape[-1])
    return np.sqrt((pairs**2).sum(axis=1) + small**2)


@units("m", "m", "m", "m", returns="1")
def play_of_each_main(clearance: Array, x: Array, y: Array, mains: Array) -> Truth:
    """Return whether clearances and offsets are single numbers, or lists with one value for each main."""
    given = (clearance, x, y)
    return all(np.ndim(one) == 0 or np.ndim(mains) == 0 or np.shape(one) == np.shape(mains) for one in given)


@units(None, None, returns="1")
def law_residual(forces: Vectors, supported: SupportReactions | None) -> Array:
    """Return the relative residual of the support law; 0 below 1e-8, NaN without mains."""
    if not np.ndim(forces):
        return _NONE
    if supported is None:
        return np.zeros(forces.shape[:-2])[()]
    left = supported.residual.max(axis=-1)
    return np.where(left < _LAW, 0.0, left)[()]
