"""Static plain journal bearing: the Reynolds equation in two dimensions with free film rupture.

Assumptions: isothermal, incompressible, laminar flow; a rigid, aligned bearing; a full circle without
grooves. Boundary condition: P = 0 at the ends and along a supply line at the widest gap; the film ruptures
where P = dP/dn = 0 (Swift, Stieber). A film without a supply line, periodic around the circle, would have
different attitudes at small eps.

Everything is dimensionless: P = p psi²/(eta omega_h), So = F psi²/(B D eta omega_h). Second-order finite
volumes: with 128 × 16 intervals the error of So is about 0.05 % up to eps 0.999 (0.1 % at 1 − 1e-6);
Richardson's extrapolation from these and twice as many intervals reduces it to some 1e-5.

References
----------
H. W. Swift, Proc. Inst. Civ. Eng. 233, 1932, p. 267; W. Stieber, Das Schwimmlager, VDI 1933;
DIN 31652-1; ISO 7902-1.
"""

from dataclasses import fields, replace

import numpy as np

from templates.core.arrays import Mask
from templates.physics.films.complementarity import finer, rupture
from templates.physics.films.film_equations import Equations, film_equations, midpoints, rotation
from templates.physics.films.film_measures import Field, Film, measure, rupture_angle
from templates.physics.films.film_mesh import Mesh, gap, halved, journal_mesh, swell
from templates.physics.numerics.arrays import require_film

_COARSEST = 16, 4
_CLOSE = 0.9999
"""Eccentricity above which rounding and initial guess decide single nodes, with an effect of 1e-7 of the load
[-].
"""
_CENTRED = 1e-9
"""Eccentricity used for the limits of attitude and angles of a centred journal."""


def static_film(eps: float, ratio: float, around: int = 128, across: int = 16) -> Film:
    """Return the solved static film.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D, 0.01 … 100 [-].
    around
        Number of circumferential intervals; 16 times a power of 2 is fastest.
    across
        Number of intervals over half the width; 4 times a power of 2 is fastest.

    Raises
    ------
    ValueError
        If an argument lies outside its range.

    Examples
    --------
    >>> film = static_film(0.8, 1.0)
    >>> round(film.So, 3), round(float(np.degrees(film.attitude)), 2)
    (3.572, 36.22)
    """
    if eps == 0:
        direction = static_film(_CENTRED, ratio, around, across)
        return replace(direction, So=0.0, P_max=0.0, side_flow=0.0)
    return measure(static_field(eps, ratio, around, across))


def extrapolated_film(eps: float, ratio: float, around: int = 128, across: int = 16) -> tuple[Film, Film]:
    """Return the film by Richardson extrapolation from the given mesh and one twice as fine.

    Returns
    -------
    The film extrapolated with order 2, and its difference from the finer solution: an estimate of that
    solution's error.
    """
    if eps == 0:
        coarse, fine = (static_film(eps, ratio, k * around, k * across) for k in (1, 2))
    else:
        require_film(np.asarray(eps), np.asarray(ratio))
        mesh = journal_mesh(eps, ratio, 2 * around, 2 * across)
        first = _nested(eps, ratio, halved(mesh))
        coarse, fine = measure(first), measure(_nested(eps, ratio, mesh, first))
    values = [(getattr(coarse, f.name), getattr(fine, f.name)) for f in fields(Film)]
    return Film(*(f + (f - c) / 3 for c, f in values)), Film(*((f - c) / 3 for c, f in values))


def static_field(eps: float, ratio: float, around: int = 128, across: int = 16) -> Field:
    """Return the pressure field; the arguments are those of `static_film`, with eps above 0."""
    require_film(np.asarray(eps), np.asarray(ratio))
    return _nested(eps, ratio, journal_mesh(eps, ratio, around, across))


def _nested(eps: float, ratio: float, mesh: Mesh, coarser: Field | None = None) -> Field:
    """Return the solution, started recursively from the next coarser mesh, down to the coarsest."""
    n, m = mesh.phi.size - 1, mesh.zeta.size - 1
    if coarser is None and min(n // _COARSEST[0], m // _COARSEST[1]) > 1 and n % 2 == m % 2 == 0:
        coarser = _nested(eps, ratio, mesh.coarser())
    equations = journal_equations(eps, ratio, mesh)
    start = None if coarser is None else _start(coarser, mesh)
    return Field(eps, ratio, mesh, equations, rupture(equations, start))


def _start(coarser: Field, mesh: Mesh) -> Mask:
    """Return a mask of the nodes of a finer mesh that lie inside a film, (n + 1, m + 1)."""
    if coarser.eps > _CLOSE:
        return finer(coarser.rupture.film)
    end = rupture_angle(coarser)
    end[-1] += end[-2] - end[-3]  # at the edge of the bearing, extrapolated from the neighbouring nodes
    return np.asarray(mesh.phi[:, None] < np.interp(mesh.zeta, coarser.mesh.zeta, end))


def journal_equations(eps: float, ratio: float, mesh: Mesh) -> Equations:
    """Return the flow balances of a journal that rotates without squeeze motion."""
    middle = midpoints(mesh.phi)
    source = rotation(swell(middle, eps))
    return film_equations(mesh, ratio, gap(mesh.phi, eps), gap(middle, eps), source)
