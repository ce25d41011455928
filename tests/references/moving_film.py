"""The film of a moving journal: rotation and squeeze solved together, over the direction of motion.

Rotation at omega_h is a motion of the journal's centre with −eps omega_h/2 across the line of centres, as
the film sees it; so one direction angle describes every state of motion at an eccentricity.
Boundary condition: P = 0 at the ends only; the film is free to lie anywhere on the circle and
ruptures, and forms, where P = dP/dn = 0. Without a supply line, rotation alone has another
attitude than the static film of `reynolds` at small eps and wide bearings.

References
----------
J. F. Booker, Trans. ASME J. Basic Eng. 87, 1965, p. 537; K. Butenschön, Diss. Karlsruhe 1976.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from templates.core.arrays import Array
from templates.physics.films.complementarity import Rupture, finer, rupture
from templates.physics.films.film_equations import film_equations, midpoints, squeeze
from templates.physics.films.film_measures import force
from templates.physics.films.film_mesh import Mesh, gap, ring_mesh
from templates.physics.numerics.arrays import require, require_film

_COARSEST = 16, 4


def moving_force(eps: float, ratio: float, direction: float, around: int = 128, across: int = 16) -> Array:
    """Load borne by a film between a journal whose centre moves and a still bearing.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D [-].
    direction
        Angle of the velocity from the narrowest gap; 0 closing, pi separating [rad].
    around
        Intervals around, even.
    across
        Intervals across half the width.

    Returns
    -------
    (2,) F psi²/(B D eta v/c) along the line of centres (towards the narrowest gap) and ahead of it,
    with v the speed of the centre and c the radial clearance.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    mesh, solution = moving_film(eps, ratio, direction, around, across)
    return np.array(force(mesh, solution.P))


def extrapolated_force(
    eps: float, ratio: float, direction: float, around: int = 128, across: int = 16
) -> tuple[Array, Array]:
    """`moving_force` extrapolated by Richardson from twice as many intervals, and the change that made."""
    coarse = moving_force(eps, ratio, direction, around, across)
    fine = moving_force(eps, ratio, direction, 2 * around, 2 * across)
    return fine + (fine - coarse) / 3, (fine - coarse) / 3


def mobility(eps: float, ratio: float, load_direction: float, around: int = 128, across: int = 16) -> Array:
    """Velocity that a load gives the journal in a film that does not turn: Booker's mobility, without a map.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D [-].
    load_direction
        Angle of the load on the journal from the narrowest gap, −pi … pi [rad].
    around
        Intervals around, even.
    across
        Intervals across half the width.

    Returns
    -------
    (2,) M along the line of centres and ahead of it: d(eps)/dt = M F psi²/(B D eta).

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    require(np.asarray(abs(load_direction) <= np.pi), "load_direction must lie in [-pi, pi]")

    def excess(direction: float) -> float:
        along, ahead = moving_force(eps, ratio, direction, around, across)
        return float(np.arctan2(abs(ahead), along) - abs(load_direction))

    inside = 0 < abs(load_direction) < np.pi
    direction = brentq(excess, 0.0, np.pi, xtol=1e-15) if inside else abs(load_direction)
    size = np.hypot(*moving_force(eps, ratio, direction, around, across))
    return np.array([np.cos(direction), np.sign(load_direction) * np.sin(direction)]) / size


def moving_film(eps: float, ratio: float, direction: float, around: int, across: int) -> tuple[Mesh, Rupture]:
    """Solve for the pressure on the whole circle, from a coarse mesh to the one asked for."""
    require_film(np.asarray(eps), np.asarray(ratio))
    mesh = ring_mesh(eps, ratio, around, across)
    return mesh, _nested(eps, ratio, direction, mesh)


def _nested(eps: float, ratio: float, direction: float, mesh: Mesh) -> Rupture:
    """Solve with the start taken from the next coarser mesh, as long as there is one."""
    n, m = mesh.phi.size - 1, mesh.zeta.size - 1
    start = None
    if min(n // _COARSEST[0], m // _COARSEST[1]) > 1 and n % 4 == m % 2 == 0:
        start = finer(_nested(eps, ratio, direction, mesh.coarser()).film)
        start[0] |= start[-2]
    source = squeeze(mesh, -np.cos(mesh.phi - direction))
    H, H_mid = gap(mesh.phi, eps), gap(midpoints(mesh.phi), eps)
    return rupture(replace(film_equations(mesh, ratio, H, H_mid, source), ring=True), start)
