"""Static journal bearing with mass-conserving cavities, grooves and supply pressure.

Boundary condition: the ambient pressure at the ends, the supply pressure in the grooves, which are
full; elsewhere the film ruptures and re-forms as mass conservation demands (`cavitation`).
Pressures are above that of the cavity, P = p psi²/(eta omega_h). First order at the re-formation:
128 × 16 intervals err by about 0.1 % in So and 3 % in side flow; the flow from pockets that end inside
the width converges more slowly, 10 % and more. The film turns in the positive sense.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, diags_array, eye_array, kron

from templates.physics.arrays import Array, Mask, require, require_film
from templates.physics.cavitation import Cavitation, Network, cavitation
from templates.physics.film_equations import dual_widths, midpoints
from templates.physics.film_mesh import gap, ring_mesh

_COARSEST = 16, 6


@dataclass(frozen=True)
class Groove:
    """An axial groove or pocket, full at its pressure; a width of 0 makes a line."""

    centre: float
    """From the narrowest gap in the sense of rotation [rad]."""
    width: float
    """Extent around [rad]."""
    length: float = 1.0
    """Extent across over the bearing's width, 0 … 1 [-]."""
    P: float = 0.0
    """Supply pressure above that of the cavity [-]."""


@dataclass(frozen=True)
class CavitatingFilm:
    """A solved film; values dimensionless as in `film_measures.Film`."""

    So: float
    """Sommerfeld number F psi²/(B D eta omega_h)."""
    attitude: float
    """Angle from load to narrowest gap in the sense of rotation [rad]."""
    P_max: float
    """Largest pressure above that of the cavity."""
    friction: float
    """Friction on the journal F_f psi/(B D eta omega), shear by the oil there is."""
    side_flow: float
    """Oil that leaves at both ends, less what enters, Q/(R³ psi omega_h)."""
    supply_flow: float
    """Oil that the grooves feed, Q/(R³ psi omega_h)."""
    imbalance: float
    """Supply less side flow, over the flow that the journal carries round."""
    phi: Array
    """(n + 1,) angles of the nodes from the narrowest gap; the last is the first [rad]."""
    zeta: Array
    """(m + 1,) axial places of the nodes, 0 (middle) … 1 (end)."""
    P: Array
    """(n + 1, m + 1) pressure above that of the cavity."""
    void: Array
    """(n + 1, m + 1) share of the gap without oil."""


def cavitating_film(
    eps: float, ratio: float, grooves: list[Groove], ambient: float = 0.0, around: int = 128, across: int = 16
) -> CavitatingFilm:
    """Solve the static film with cavities.

    Args:
        eps: relative eccentricity, 0 … 1 − 1e-7 [-].
        ratio: width over diameter B/D [-].
        grooves: where oil is fed.
        ambient: pressure at the ends above that of the cavity, 0 or more [-].
        around: intervals around.
        across: intervals across half the width.

    Raises:
        ValueError: if an argument lies outside its range.
    """
    require_film(np.asarray(eps), np.asarray(ratio))
    require(np.asarray(len(grooves) > 0), "grooves: at least one must feed the film")
    pressures = np.array([ambient, *(groove.P for groove in grooves)])
    require((pressures >= 0) & np.isfinite(pressures), "pressures must be 0 or more above that of the cavity")
    start = None
    for shift in (3, 2, 1, 0):
        n, m = max(around >> shift, _COARSEST[0]), max(across >> shift, _COARSEST[1])
        phi, zeta = _nodes(eps, ratio, grooves, n, m)
        network, fed = _network(eps, ratio, phi, zeta, grooves, ambient)
        solution = cavitation(network, None if start is None else _interpolated(*start, phi, zeta))
        start = solution, phi, zeta
    return _measure(eps, ratio, phi, zeta, network, solution, fed)


def _nodes(eps: float, ratio: float, grooves: list[Groove], n: int, m: int) -> tuple[Array, Array]:
    """A graded mesh whose nearest nodes are moved to the edges of the grooves."""
    mesh = ring_mesh(eps, ratio, n, m)
    edges = [groove.centre + side * groove.width / 2 for groove in grooves for side in (-1, 1)]
    return _snapped(mesh.phi, _wrapped(np.array(edges))), _snapped(
        mesh.zeta, np.array([g.length for g in grooves])
    )


def _wrapped(angle: Array) -> Array:
    """The same angle in [−pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _snapped(nodes: Array, places: Array) -> Array:
    """Move the inner node nearest to each place there."""
    nodes = nodes.copy()
    for place in places[(places > nodes[0]) & (places < nodes[-1])]:
        nodes[1 + np.abs(nodes[1:-1] - place).argmin()] = place
    return nodes


def _inside(groove: Groove, phi: Array, zeta: Array) -> Mask:
    """Nodes of a groove; a groove narrower than the mesh still has the node that was moved to it."""
    around = np.abs(_wrapped(phi - groove.centre)) <= groove.width / 2 + 1e-9
    return around[:, None] & (zeta <= groove.length + 1e-9)


def _network(
    eps: float, ratio: float, phi: Array, zeta: Array, grooves: list[Groove], ambient: float
) -> tuple[Network, Mask]:
    """Balances of flow on the ring of nodes, and which of them are fed by grooves."""
    n, dual = phi.size - 1, dual_widths(zeta)
    upwind = eye_array(n)
    step = csc_array((np.ones(n), (np.arange(n), np.arange(1, n + 1) % n)), shape=(n, n)) - upwind
    H_mid, width = gap(midpoints(phi), eps), dual_widths(phi)
    axial = eye_array(zeta.size - 1, zeta.size, k=1) - eye_array(zeta.size - 1, zeta.size)
    conductance = gap(phi, eps) ** 3 * width / ratio**2
    conductance[0] += conductance[-1]
    around = kron(step.T @ diags_array(H_mid**3 / np.diff(phi)) @ step, diags_array(dual))
    across = kron(diags_array(conductance[:-1]), axial.T @ diags_array(1 / np.diff(zeta)) @ axial)
    shear = kron(-step.T @ diags_array(6 * H_mid) @ upwind, diags_array(dual))
    P_fixed, fed = np.full((n, zeta.size), -1.0), np.zeros((n, zeta.size), bool)
    P_fixed[:, -1] = ambient
    for groove in grooves:
        inside = _inside(groove, phi[:-1], zeta)
        P_fixed[inside] = groove.P
        fed |= inside
    network = Network(csc_array(around + across), csc_array(shear), (P_fixed >= 0).ravel(), P_fixed.ravel())
    return network, fed


def _interpolated(
    solution: Cavitation, phi: Array, zeta: Array, finer_phi: Array, finer_zeta: Array
) -> tuple[Array, Array]:
    """Carry pressure and void to the nodes of a finer mesh, linearly along each direction."""

    def carried(values: Array) -> Array:
        ring = _closed(values, zeta.size)
        rows = np.stack([np.interp(finer_phi[:-1], phi, column) for column in ring.T], axis=1)
        return np.stack([np.interp(finer_zeta, zeta, row) for row in rows]).ravel()

    return carried(solution.P), carried(solution.void)


def _closed(values: Array, columns: int) -> Array:
    """Node values as an array around × across whose last row repeats the first."""
    rows = values.reshape(-1, columns)
    return np.concatenate([rows, rows[:1]])


def _measure(
    eps: float, ratio: float, phi: Array, zeta: Array, network: Network, solution: Cavitation, fed: Mask
) -> CavitatingFilm:
    """Integrate load, friction and flow."""
    P, void = _closed(solution.P, zeta.size), _closed(solution.void, zeta.size)
    weight, dual = dual_widths(phi), dual_widths(zeta)
    along, ahead = (np.array([np.cos(phi), np.sin(phi)]) * weight) @ P @ dual / 2
    shear = weight / gap(phi, eps) @ (1 - void) @ dual / 2
    loss = network.loss(solution.P, solution.void).reshape(fed.shape)
    supply, side = loss[fed].sum(), -loss[:, -1][~fed[:, -1]].sum()
    return CavitatingFilm(
        So=float(np.hypot(along, ahead)),
        attitude=float(np.arctan2(-ahead, along)),
        P_max=float(P.max()),
        friction=float(shear - eps * ahead / 2),
        side_flow=float(ratio / 6 * side),
        supply_flow=float(ratio / 6 * supply),
        imbalance=float((supply - side) / 6),
        phi=phi,
        zeta=zeta,
        P=P,
        void=void,
    )
