"""Static journal bearing with mass-conserving cavities, grooves and supply pressure.

Boundary conditions: ambient pressure at the ends, supply pressure in the grooves, which are full. Elsewhere
the film ruptures and re-forms as mass conservation requires (`cavitation`). Pressures are relative to the
cavity pressure, P = p psi²/(eta omega_h). The method is first-order accurate at re-formation: with 128 × 16
intervals the errors are about 0.1 % in So and 3 % in side flow. The flow from pockets that end inside the
width converges more slowly, with errors of 10 % and more. The journal rotates in the positive sense.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask
from templates.physics.cavities.cavitating_network import Groove, Ring, fed_network, grooved_ring
from templates.physics.cavities.cavitation import Cavitation, Network, cavitation
from templates.physics.films.film_equations import dual_widths
from templates.physics.films.film_mesh import gap
from templates.physics.numerics.arrays import require, require_film

_COARSEST = 16, 6


@dataclass(frozen=True)
class RingSolution:
    """A solved film with the values at its nodes."""

    ring: Ring
    """The positions of the nodes."""
    network: Network
    """The flow balances of the nodes."""
    solution: Cavitation
    """Pressure and void."""
    fed: Mask
    """(n, m + 1) nodes fed by grooves."""


@dataclass(frozen=True)
class CavitatingFilm:
    """The results of a solved film, dimensionless as in `film_measures.Film`."""

    So: float
    """Sommerfeld number F psi²/(B D eta omega_h)."""
    attitude: float
    """Angle from load to narrowest gap in the sense of rotation [rad]."""
    P_max: float
    """Largest pressure above that of the cavity."""
    friction: float
    """Friction on the journal F_f psi/(B D eta omega), with shear of the existing oil only."""
    side_flow: float
    """Net oil flow out of both ends, Q/(R³ psi omega_h)."""
    supply_flow: float
    """Oil that the grooves feed, Q/(R³ psi omega_h)."""
    imbalance: float
    """Supply minus side flow, over the flow that the journal transports."""
    phi: Array
    """(n + 1,) angles of the nodes from the narrowest gap; the last is the first [rad]."""
    zeta: Array
    """(m + 1,) axial places of the nodes, 0 (middle) … 1 (end)."""
    P: Array
    """(n + 1, m + 1) pressure above that of the cavity."""
    void: Array
    """(n + 1, m + 1) fraction of the gap without oil."""


def solved_ring(
    eps: float,
    ratio: float,
    grooves: list[Groove],
    ambient: float = 0.0,
    around: int = 128,
    across: int = 16,
    near: RingSolution | None = None,
) -> RingSolution:
    """Solve the static film with cavities, starting from a nearby film or from coarser meshes.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D [-].
    grooves
        The grooves that feed oil.
    ambient
        Pressure at the ends above that of the cavity, 0 or more [-].
    around
        Number of intervals in the circumferential direction.
    across
        Number of intervals over half the width.
    near
        A solved film at almost the same position, used as the initial guess in place of coarser meshes.

    Raises
    ------
    ValueError
        If an argument lies outside its range.
    """
    require_film(np.asarray(eps), np.asarray(ratio))
    require(np.asarray(len(grooves) > 0), "grooves: at least one must feed the film")
    pressures = np.array([ambient, *(groove.P for groove in grooves)])
    require((pressures >= 0) & np.isfinite(pressures), "pressures must be 0 or more above that of the cavity")
    meshes = [(max(around >> k, _COARSEST[0]), max(across >> k, _COARSEST[1])) for k in (3, 2, 1, 0)]
    solved = near
    for n, m in dict.fromkeys(meshes if near is None else meshes[-1:]):
        ring = grooved_ring(eps, ratio, grooves, n, m)
        network, fed = fed_network(ring, grooves, ambient)
        solution = cavitation(network, None if solved is None else _interpolated(solved, ring))
        solved = RingSolution(ring, network, solution, fed)
    assert solved is not None
    return solved


def _interpolated(solved: RingSolution, finer: Ring) -> tuple[Array, Array]:
    """Interpolate pressure and void linearly in each direction to the nodes of a finer mesh."""
    ring = solved.ring
    around, across = _between(ring.phi, finer.phi[:-1]), _between(ring.zeta, finer.zeta)

    def carried(values: Array) -> Array:
        (row, share), (column, part) = around, across
        rows = ring.closed(values)
        rows = rows[row] + share[:, None] * (rows[row + 1] - rows[row])
        return (rows[:, column] + part * (rows[:, column + 1] - rows[:, column])).ravel()

    return carried(solved.solution.P), carried(solved.solution.void)


def _between(nodes: Array, places: Array) -> tuple[NDArray[np.intp], Array]:
    """Return the index of the node before each place, and the fraction of the interval up to that place."""
    before = np.clip(np.searchsorted(nodes, places, side="right") - 1, 0, nodes.size - 2)
    return before, np.clip((places - nodes[before]) / np.diff(nodes)[before], 0.0, 1.0)


def force(ring: Ring, P: Array) -> Array:
    """Return the force of a nodal pressure along and ahead of the line of centres, in So, (2,) [-]."""
    weight = dual_widths(ring.phi)
    axes = np.array([np.cos(ring.phi), np.sin(ring.phi)]) * weight
    return axes @ ring.closed(P) @ dual_widths(ring.zeta) / 2


def measured(solved: RingSolution) -> CavitatingFilm:
    """Return the results of a solved film by integrating load, friction and flow."""
    ring, solution, fed = solved.ring, solved.solution, solved.fed
    P, void = ring.closed(solution.P), ring.closed(solution.void)
    along, ahead = force(ring, solution.P)
    shear = dual_widths(ring.phi) / gap(ring.phi, ring.eps) @ (1 - void) @ dual_widths(ring.zeta) / 2
    loss = solved.network.loss(solution.P, solution.void).reshape(fed.shape)
    supply, side = loss[fed].sum(), -loss[:, -1][~fed[:, -1]].sum()
    return CavitatingFilm(
        So=float(np.hypot(along, ahead)),
        attitude=float(np.arctan2(-ahead, along)),
        P_max=float(P.max()),
        friction=float(shear - ring.eps * ahead / 2),
        side_flow=float(ring.ratio / 6 * side),
        supply_flow=float(ring.ratio / 6 * supply),
        imbalance=float((supply - side) / 6),
        phi=ring.phi,
        zeta=ring.zeta,
        P=P,
        void=void,
    )
