"""Single-zone combustion with Wiebe's burnt fraction: pressure over a four-stroke cycle, adiabatic walls.

With a constant ratio of specific heats the first law can be integrated: p V^γ = p₁V₁^γ + (γ − 1) ∫ V^(γ−1) dQ
from inlet closing. The pressure therefore needs only a quadrature, not the solution of a differential
equation. Angles are measured from the start of the intake stroke; the cylinder fires at 360°.

References
----------
I. I. Wiebe: Brennverlauf und Kreisprozeß von Verbrennungsmotoren, VEB Verlag Technik 1970.
Heywood: Internal Combustion Engine Fundamentals, 1988, 9.2 and 9.6, for the law and its usual constants.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.engine.slider_crank import Motion

FIRING = 2 * np.pi
_PANELS = 240  # number of panels for combustion and for each part of the work
_DEGREES, _CLOSER, _AROUND = (
    720,
    5,
    41,
)  # number of angles of the first peak search; further searches; their number of angles
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


def _column(value: Array) -> Array:
    return np.asarray(value, dtype=float)[..., None]


@dataclass(frozen=True)
class HeatRelease:
    """Wiebe's law: heat [J], start and duration [rad], efficiency constant and shape [1], for each point."""

    heat: Array
    start: Array
    duration: Array
    a: Array
    m: Array

    def share(self, theta: Array) -> Array:
        """Return the burnt fraction [1] at crank angles [rad], (…, K)."""
        y = np.clip((theta - _column(self.start)) / _column(self.duration), 0, 1)
        return -np.expm1(-_column(self.a) * y ** (_column(self.m) + 1))


@dataclass(frozen=True)
class ClosedCylinder:
    """A cylinder with closed valves: rod over crank radius, volumes [m³], pressure [Pa], angles [rad].

    `gamma` is the ratio of specific heats [1].
    """

    n: Array
    swept: Array
    dead: Array
    pressure_closed: Array
    closes: Array
    opens: Array
    gamma: Array
    burning: HeatRelease

    def volume(self, theta: Array) -> Array:
        """Return the volume [m³] at crank angles [rad], (…, K)."""
        return _column(self.dead) + _column(self.swept) * Motion(theta, _column(self.n)).travel

    @cached_property
    def initial(self) -> Array:
        """Return p₁V₁^γ divided by (dead volume)^γ [Pa], (…, 1)."""
        ratio = self.volume(_column(self.closes)) / _column(self.dead)
        return _column(self.pressure_closed) * ratio ** _column(self.gamma)

    @cached_property
    def gained(self) -> Array:
        """Return ∫ (V/V_c)^(γ−1) dx at the ends of combustion panels in √y, (…, panels + 1), by Gauss."""
        ends = np.linspace(0, 1, _PANELS + 1)
        u = (ends[:-1, None] + ends[1:, None]) / 2 + _NODES / (2 * _PANELS)
        density = self._density(u.ravel())
        parts = (density.reshape(*density.shape[:-1], *u.shape) * _WEIGHTS).sum(axis=-1) / (2 * _PANELS)
        return np.concatenate([0 * parts[..., :1], np.cumsum(parts, axis=-1)], axis=-1)

    def _density(self, u: Array) -> Array:
        """Return (V/V_c)^(γ−1) dx/du at u = √y, the root of the fraction of the duration, (…, K)."""
        b, y = self.burning, u * u
        theta = _column(b.start) + _column(b.duration) * y
        compressed = (self.volume(theta) / _column(self.dead)) ** (_column(self.gamma) - 1)
        m, a = _column(b.m), _column(b.a)
        return compressed * 2 * a * (m + 1) * u ** (2 * m + 1) * np.exp(-a * y ** (m + 1))

    def pressure(self, theta: Array) -> Array:
        """Return the pressure [Pa] at crank angles [rad] with closed valves, (…, K)."""
        b = self.burning
        u = np.sqrt(np.clip((theta - _column(b.start)) / _column(b.duration), 0, 1))
        panel = np.minimum(np.nan_to_num(u * _PANELS).astype(np.intp), _PANELS - 1)
        shape = np.broadcast_shapes(self.gained.shape[:-1], panel.shape[:-1])
        panel = np.broadcast_to(panel, (*shape, panel.shape[-1]))
        gained = np.broadcast_to(self.gained, (*shape, _PANELS + 1))
        ends = [np.take_along_axis(gained, panel + k, axis=-1) for k in (0, 1)]
        slopes = [self._density((panel + k) / _PANELS) / _PANELS for k in (0, 1)]
        gamma = _column(self.gamma)
        added = (gamma - 1) * _column(b.heat) / _column(self.dead)
        state = self.initial + added * _hermite(u * _PANELS - panel, ends, slopes)
        return state * (self.volume(theta) / _column(self.dead)) ** -gamma

    def work(self) -> Array:
        """Return ∫ p dV from closing to opening [J], by Gauss before, during and after combustion."""
        b = self.burning
        marks = [self.closes, b.start, b.start + b.duration, self.opens]
        s = ((np.arange(_PANELS)[:, None] + (1 + _NODES) / 2) / _PANELS).ravel()
        weights = np.tile(_WEIGHTS / 2, _PANELS) / _PANELS
        total = 0.0 * self.initial[..., 0]
        for begin, end in pairwise(marks):
            theta = _column(begin) + _column(end - begin) * s
            slope = _column(self.swept) * Motion(theta, _column(self.n)).lever / 2
            total = total + np.sum(self.pressure(theta) * slope * weights, axis=-1) * (end - begin)
        return total


def _hermite(t: Array, ends: list[Array], slopes: list[Array]) -> Array:
    """Return the cubic Hermite interpolation between two values with their slopes, at t from 0 to 1."""
    rest = 1 - t
    value = ends[0] * (1 + 2 * t) * rest**2 + ends[1] * (3 - 2 * t) * t**2
    return value + slopes[0] * t * rest**2 - slopes[1] * rest * t**2


def closed_cylinder(
    n: Array, swept: Array, epsilon: Array, p_1: Array, closes: Array, opens: Array, gamma: Array,
    burning: HeatRelease,
) -> ClosedCylinder:  # fmt: skip
    """Return the cylinder with its compression ratio."""
    return ClosedCylinder(n, swept, swept / (epsilon - 1), p_1, closes, opens, gamma, burning)


@on_paper("by quadrature of the first law with closed valves; constant in suction and exhaust")
@units(None, "rad", "Pa", "Pa", returns="Pa")
def cycle_pressure(cylinder: ClosedCylinder, theta: Array, p_s: Array, p_e: Array) -> Array:
    """Return the pressure over the whole cycle [Pa], (…, K).

    After exhaust opening the pressure is linear up to 540°.
    """
    closes, opens = _column(cylinder.closes), _column(cylinder.opens)
    inside = np.clip(theta, closes, opens)
    closed = cylinder.pressure(inside)
    bottom = np.maximum(3 * np.pi, opens)
    share = np.clip((theta - opens) / np.where(bottom > opens, bottom - opens, 1.0), 0, 1)
    share = np.where(theta >= bottom, 1.0, share)
    after = closed + (_column(p_e) - closed) * share
    return np.where(theta < closes, _column(p_s), np.where(theta <= opens, closed, after))


@units(None, "rad", returns="1")
def burnt_share(cylinder: ClosedCylinder, theta: Array) -> Array:
    """Return the burnt fraction over the cycle [1], (…, K); it returns to 0 at the next intake stroke."""
    return cylinder.burning.share(theta)


@on_paper("by quadrature over the closed part of the cycle")
@units(None, returns="J")
def closed_work(cylinder: ClosedCylinder) -> Array:
    """Return the work of the gas with closed valves [J]."""
    return np.asarray(cylinder.work())[()]


@units(None, returns="J")
def released_heat(cylinder: ClosedCylinder) -> Array:
    """Return the heat released up to the end of combustion [J]."""
    b = cylinder.burning
    return b.heat * -np.expm1(-b.a)


@units(None, returns="J")
def energy_change(cylinder: ClosedCylinder) -> Array:
    """Return internal energy at exhaust opening minus that at inlet closing [J]: (p₂V₂ − p₁V₁)/(γ − 1)."""
    energy = [
        cylinder.pressure(_column(at)) * cylinder.volume(_column(at))
        for at in (cylinder.closes, cylinder.opens)
    ]
    return ((energy[1] - energy[0])[..., 0] / (cylinder.gamma - 1))[()]


@dataclass(frozen=True)
class Peak:
    """The largest pressure of a cycle [Pa] and its crank angle [rad]."""

    pressure: Array
    angle: Array


def highest(cylinder: ClosedCylinder, p_s: Array, p_e: Array) -> Peak:
    """Return the largest pressure of the cycle, independent of the angles at which the curve is returned.

    It is searched at each degree and at the ends of combustion, then on ever finer grids around the best
    angle.
    """
    b = cylinder.burning
    shape = np.broadcast_shapes(*map(np.shape, (b.start, b.duration, cylinder.closes, p_s, p_e, b.heat)))
    whole = np.broadcast_to(np.linspace(0, 2 * FIRING, _DEGREES, endpoint=False), (*shape, _DEGREES))
    ends = [np.broadcast_to(_column(at), (*shape, 1)) for at in (b.start, b.start + b.duration)]
    theta, reach = np.concatenate([whole, *ends], axis=-1), 2 * FIRING / _DEGREES
    best, p = theta[..., :1], np.empty(0)
    for _ in range(_CLOSER):
        p = cycle_pressure(cylinder, theta, p_s, p_e)
        theta = np.broadcast_to(theta, p.shape)
        best = np.take_along_axis(theta, np.nan_to_num(p).argmax(axis=-1)[..., None], axis=-1)
        theta = np.clip(best + reach * np.linspace(-1, 1, _AROUND), 0, 2 * FIRING)
        reach *= 2 / (_AROUND - 1)
    return Peak(np.asarray(p.max(axis=-1))[()], best[..., 0][()])


@on_paper("the largest pressure of the cycle")
@units(None, returns="Pa")
def peak(highest: Peak) -> Array:
    """Return the largest pressure [Pa]."""
    return highest.pressure


@on_paper("where the pressure is largest")
@units(None, returns="rad")
def peak_angle(highest: Peak) -> Array:
    """Return the crank angle of the largest pressure [rad]."""
    return highest.angle


@units("1", returns="rad")
def four_stroke_angles(steps: Array) -> Array:
    """Return the angles of a cycle of 720° [rad], (K,), without the end point."""
    return np.linspace(0, 4 * np.pi, round(float(steps)), endpoint=False)


@units("J", "J", "J", "J", returns="1", latex=r"\frac{{{0}-{1}-{2}}}{{{0}+{3}}}")
def unbalanced_share(heat: Array, work: Array, change: Array, scale: Array) -> Array:
    """Return (heat − work − change of internal energy)/(heat + energy of the charge) [1].

    Values below 1e-9 are returned as 0.
    """
    share = (heat - work - change) / (heat + scale)
    return np.where(np.abs(share) < 1e-9, 0.0, share)[()]
