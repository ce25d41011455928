"""Integral results of a static film from its pressure field: load, friction, flow, peak pressure.

Convention for friction: shear acts over the full circle, as in DIN 31652 and ISO 7902. The friction with
shear by streamers only, where the film has ruptured, is computed as well.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.complementarity import Rupture
from templates.physics.films.film_equations import Equations
from templates.physics.films.film_mesh import Mesh, sommerfeld_angle


@dataclass(frozen=True)
class Film:
    """The results of a static film; every value is dimensionless, angles are in rad."""

    So: float
    """Sommerfeld number F psi²/(B D eta omega_h)."""
    attitude: float
    """Angle from load to narrowest gap in the sense of rotation [rad]."""
    P_max: float
    """Largest pressure p psi²/(eta omega_h)."""
    peak: float
    """Angle of the largest pressure from the narrowest gap in the sense of rotation: negative [rad]."""
    rupture: float
    """Rupture angle at mid-width, from the narrowest gap; accurate to a mesh width [rad]."""
    friction: float
    """Friction on the journal F_f psi/(B D eta omega), shear over the full circle (DIN 31652)."""
    friction_bearing: float
    """Friction on the bearing, in the same convention."""
    friction_streamers: float
    """Friction on the journal if, beyond rupture, only streamers that fill H_rupture/H are sheared."""
    side_flow: float
    """Oil flow out of both ends, Q/(R³ psi omega_h)."""
    supply_flow: float
    """Oil that enters the film at the widest gap, Q/(R³ psi omega_h)."""
    imbalance: float
    """Residual of the discrete flow balance over the supply; only rounding error in a solution."""


@dataclass(frozen=True)
class Field:
    """A pressure field and the discrete film equations that it solves."""

    eps: float
    ratio: float
    mesh: Mesh
    equations: Equations
    rupture: Rupture


def force(mesh: Mesh, P: Array) -> tuple[float, float]:
    """Return So of a pressure along the line of centres (towards the narrowest gap) and ahead of it [-]."""
    line = P @ mesh.weight_zeta * mesh.weight_phi / 4
    return float(np.cos(mesh.phi) @ line), float(np.sin(mesh.phi) @ line)


def measure(field: Field) -> Film:
    """Return load, friction and flow by integrating the pressure."""
    along, ahead = force(field.mesh, field.rupture.P)
    peak, P_max = _peak(field.mesh.phi, field.rupture.P[:, 0])
    shear, pressure = np.pi / np.sqrt((1 - field.eps) * (1 + field.eps)), -field.eps * ahead / 2
    end = rupture_angle(field)
    supply, side, imbalance = _flows(field)
    return Film(
        So=float(np.hypot(along, ahead)),
        attitude=float(np.arctan2(-ahead, along)),
        P_max=P_max,
        peak=peak,
        rupture=float(end[0]),
        friction=float(shear + pressure),
        friction_bearing=float(shear - pressure),
        friction_streamers=float(_streamer_shear(field, end) + pressure),
        side_flow=side,
        supply_flow=supply,
        imbalance=imbalance,
    )


def rupture_angle(field: Field) -> Array:
    """Return the rupture angle of the film [rad], (m + 1,), from the last two pressures.

    The pressure decreases quadratically there.
    """
    phi, P = field.mesh.phi, np.sqrt(np.maximum(field.rupture.P[:, :-1], 0))
    last = np.maximum(P.shape[0] - 1 - (P[::-1] > 0).argmax(axis=0), 1)
    column = np.arange(P.shape[1])
    here, before = P[last, column], P[last - 1, column]
    drop = np.where(before > here, before - here, np.inf)
    beyond = np.minimum(here / drop, 1.0) * (phi[last] - phi[last - 1])
    end = np.where(P.any(axis=0), phi[last] + beyond, 0.0)
    return np.append(end, end[-1])


def _peak(phi: Array, P: Array) -> tuple[float, float]:
    """Return the position and value of the largest pressure, computed by a parabola through three nodes."""
    k = min(max(int(P.argmax()), 1), P.size - 2)
    before, after = phi[k - 1] - phi[k], phi[k + 1] - phi[k]
    slope_before, slope_after = (P[k - 1] - P[k]) / before, (P[k + 1] - P[k]) / after
    bend = (slope_after - slope_before) / (after - before)
    slope = slope_after - bend * after
    if bend >= 0:
        return float(phi[k]), float(P[k])
    return float(phi[k] - slope / (2 * bend)), float(P[k] - slope**2 / (4 * bend))


def _flows(field: Field) -> tuple[float, float, float]:
    """Return supply and side flow Q/(R³ psi omega_h) from flow balances, and the film's imbalance [-]."""
    excess = field.equations.residual(field.rupture.P)
    film = field.rupture.film
    carried = 6 * (1 - field.eps)
    supply = excess[0].sum() + carried
    side = -excess[1:-1, -1][film[1:-1, -2]].sum()
    scale = field.ratio / 6
    return float(scale * supply), float(scale * side), float(np.abs(excess[film].sum()) / supply)


def _streamer_shear(field: Field, end: Array) -> float:
    """Return the shear of the full film up to rupture and of streamers beyond it [-].

    The streamers fill the fraction H_rupture/H of the width.
    """
    eps, gamma = field.eps, sommerfeld_angle(end, field.eps)
    s = np.sqrt((1 - eps) * (1 + eps))
    H_end = s**2 / (1 + eps * np.cos(gamma))
    shear = (gamma + np.pi) / s + H_end * (np.pi - gamma - eps * np.sin(gamma)) / s**3
    return float(shear @ field.mesh.weight_zeta / 4)
