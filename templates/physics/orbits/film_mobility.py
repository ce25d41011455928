"""The journal velocity under a load, by the full solution: pressure, film extent and velocity together.

The film and its boundary condition are those of `moving_film`; there the motion is given and the load
follows, here the load is given. For an assumed film extent the pressure is linear in the velocity, so the
load gives the velocity, and the pressure then determines the extent. The range of validity is that of
`moving_film`. The mesh is graded to the gap in the direction of the load, so that separating motion is
resolved as well as closing motion.
"""

from dataclasses import dataclass, replace

import numpy as np

from templates.core.arrays import Array, Mask
from templates.physics.films.banded_matrix import BandedMatrix, banded
from templates.physics.films.complementarity import finer
from templates.physics.films.film_equations import Equations, dual_widths, film_equations, midpoints, squeeze
from templates.physics.films.film_mesh import Mesh, gap, ring_mesh
from templates.physics.numerics.arrays import require, require_film

_COARSEST = 32, 8
_MOST_STEPS = 200


@dataclass(frozen=True)
class Motion:
    """The motion of a journal and its film under a unit load, F psi²/(B D eta) = 1."""

    velocity: Array
    """(2,) mobility M: d(eps)/dt along the line of centres and ahead of it [-]."""
    P_max: float
    """Largest pressure over the mean one, p_max B D/F [-]."""
    side_flow: float
    """Oil flow out of both ends over the displaced flow, Q/(B D v) [-]."""
    film: Mask
    """(n + 1, m + 1) nodes inside the film."""


@dataclass(frozen=True)
class _UnitVelocityFilm:
    """The discrete film for unit velocities along the line of centres and ahead of it."""

    mesh: Mesh
    equations: Equations
    """Flow balances without their source."""
    matrix: BandedMatrix
    sources: Array
    """(n + 1, 2) flow that each unit velocity brings to a node, per unit zeta."""
    brought: Array
    """(n + 1, m + 1, 2) the same over the nodes' cells."""
    may: Mask
    """(n + 1, m + 1) mask of nodes that may have pressure."""


def film_mobility(
    eps: float, ratio: float, load_direction: float, around: int = 128, across: int = 16
) -> Motion:
    """Return the motion of the journal.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D [-].
    load_direction
        Angle of the load on the journal from the narrowest gap, −pi … pi [rad].
    around
        Number of circumferential intervals, even.
    across
        Number of intervals over half the width.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    ArithmeticError
        If the film does not converge in 200 steps, which no film should need.
    """
    require_film(np.asarray(eps), np.asarray(ratio))
    require(np.asarray(abs(load_direction) <= np.pi), "load_direction must lie in [-pi, pi]")
    mesh = ring_mesh(max(eps * np.cos(load_direction), 0.0), ratio, around, across)
    return _nested(eps, ratio, load_direction, mesh)


def _nested(eps: float, ratio: float, load_direction: float, mesh: Mesh) -> Motion:
    """Return the solution, started from the next coarser mesh.

    On the coarsest mesh it starts from a film on the half that faces the load.
    """
    n, m = mesh.phi.size - 1, mesh.zeta.size - 1
    if min(n // _COARSEST[0], m // _COARSEST[1]) > 1 and n % 4 == m % 2 == 0:
        start = finer(_nested(eps, ratio, load_direction, mesh.coarser()).film)
        start[0] |= start[-2]
    else:
        start = np.repeat(np.cos(mesh.phi - load_direction)[:, None] > 0, m + 1, axis=1)
    return _settled(_squeezed(eps, ratio, mesh), load_direction, start)


def _squeezed(eps: float, ratio: float, mesh: Mesh) -> _UnitVelocityFilm:
    """Return the flow balances for unit velocities."""
    H, H_mid = gap(mesh.phi, eps), gap(midpoints(mesh.phi), eps)
    equations = replace(film_equations(mesh, ratio, H, H_mid, np.zeros_like(mesh.phi)), ring=True)
    matrix = banded(equations)
    sources = np.stack([squeeze(mesh, -np.cos(mesh.phi)), squeeze(mesh, -np.sin(mesh.phi))], axis=-1)
    brought = sources[:, None, :] * dual_widths(mesh.zeta)[:, None]
    brought[0] += brought[-1]
    may = np.zeros(matrix.shape, bool)
    may[matrix.order, :-1] = True
    return _UnitVelocityFilm(mesh, equations, matrix, sources, brought, may)


def _settled(system: _UnitVelocityFilm, load_direction: float, film: Mask) -> Motion:
    """Return the converged pair of velocity and film; the iteration computes each from the other in turn."""
    film = system.may & film
    load = np.array([np.cos(load_direction), np.sin(load_direction)])
    for _ in range(_MOST_STEPS):
        pressures = system.matrix.solve(film, system.brought)
        pressures[-1] = pressures[0]
        velocity = np.linalg.solve(_forces(system.mesh, pressures), load)
        P = pressures @ velocity
        excess = replace(system.equations, source=system.sources @ velocity).residual(P)
        noise = 1e-13 * np.abs(system.brought @ velocity).max()
        after = system.may & np.where(film, P > 0, excess < -noise)
        if np.array_equal(after, film):
            side = -excess[:-1, -1][film[:-1, -2]].sum() / (24 * np.hypot(*velocity))
            return Motion(velocity, _crest(P[:-1, 0]), float(side), film)
        film = after
    raise ArithmeticError("the film's extent did not converge")


def _forces(mesh: Mesh, pressures: Array) -> Array:
    """Return the force of each pressure along the line of centres and ahead of it, (2, velocities)."""
    line = np.einsum("nmk,m,n->nk", pressures, mesh.weight_zeta, mesh.weight_phi) / 4
    return np.asarray(np.stack([np.cos(mesh.phi), np.sin(mesh.phi)]) @ line)


def _crest(P: Array) -> float:
    """Return the largest pressure on the ring, from a parabola through the three nodes around it."""
    k = int(P.argmax())
    before, top, after = P[k - 1], P[k], P[(k + 1) % P.size]
    bend = 2 * top - before - after
    return float(top + (after - before) ** 2 / (8 * bend)) if bend > 0 else float(top)
