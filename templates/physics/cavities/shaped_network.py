"""Flow balances of a film with a given gap on a ring of nodes, and derivatives with respect to the gap.

This is like `cavitating_network`, but the gap may also vary axially. A tilted journal needs the whole width,
a bore with lobes or a bell mouth only half of it. Angles are measured from the load.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array, eye_array, kron, vstack

from templates.core.arrays import Array, Mask
from templates.physics.cavities.cavitation import Network
from templates.physics.films.film_equations import dual_widths, midpoints
from templates.physics.films.film_mesh import ring_mesh
from templates.physics.films.film_shape import Bore, Lie, directions, gap, narrowest
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT

FULL_TURN = 2 * np.pi


@dataclass(frozen=True)
class Pocket:
    """An axial groove over the whole width, full at its own pressure; a width of 0 makes it a line."""

    centre: float
    """Angle from the load in the sense of rotation [rad]."""
    width: float
    """Circumferential extent [rad]."""
    P: float
    """Supply pressure above that of the cavity [-]."""


@dataclass(frozen=True)
class Nodes:
    """The positions of the nodes: circumferential × axial, axial index fastest; phi ends where it starts."""

    ratio: float
    """Width over diameter B/D [-]."""
    phi: Array
    """(n + 1,) angles from the load; the last is the first and a full turn [rad]."""
    zeta: Array
    """(m + 1,) axial places, from 0 (middle) or −1 to 1 (ends)."""

    @property
    def shape(self) -> tuple[int, int]:
        """Return the number of circumferential and axial nodes."""
        return self.phi.size - 1, self.zeta.size

    @property
    def is_half(self) -> bool:
        """Return whether the nodes cover only half the width; the other half is its mirror image."""
        return bool(self.zeta[0] == 0)

    @cached_property
    def around(self) -> Array:
        """Return the (n,) circumferential widths of the cells around the nodes [rad]."""
        widths = dual_widths(self.phi)
        return np.append(widths[0] + widths[-1], widths[1:-1])

    @cached_property
    def across(self) -> Array:
        """Return the (m + 1,) axial lengths of the cells [-]."""
        return dual_widths(self.zeta)

    @cached_property
    def weight(self) -> Array:
        """Return the (n, m + 1) cell areas over four, doubled if they represent both halves."""
        return np.outer(self.around, self.across) / (2 if self.is_half else 4)

    @cached_property
    def steps(self) -> tuple[csr_array, csr_array]:
        """Return the circumferential and axial difference matrices between neighbours, (edges, nodes)."""
        n, m = self.shape
        turn = csr_array((np.ones(n), (np.arange(n), np.arange(1, n + 1) % n)), shape=(n, n)) - eye_array(n)
        axial = eye_array(m - 1, m, k=1) - eye_array(m - 1, m)
        return csr_array(kron(turn, eye_array(m))), csr_array(kron(eye_array(n), axial))


@dataclass(frozen=True)
class Gaps:
    """A gap, or its change, at the positions where the balances need it."""

    nodes: Array
    """(n, m + 1) at the nodes."""
    around: Array
    """(n, m + 1) midway between circumferential neighbours."""
    across: Array
    """(n, m) midway between axial neighbours."""


def shaped_nodes(bore: Bore, lie: Lie, ratio: float, pockets: list[Pocket], n: int, m: int) -> Nodes:
    """Return a mesh graded to the thin film, with nodes at pocket edges, lobe joints and bell mouths.

    It is the mesh of a plain bearing with the same least film and the radius of the lobe.
    """
    least, place = narrowest(bore, lie)
    radius = 1 + (bore.excess if bore.is_lobed else 0.0)
    eps = float(np.clip(1 - least / radius, 0.0, ECCENTRICITY_LIMIT))
    mesh = ring_mesh(eps, ratio, n, m)
    edges = [pocket.centre + side * pocket.width / 2 for pocket in pockets for side in (-1, 1)]
    places = (np.array([*edges, *bore.joints()]) - place + np.pi) % FULL_TURN - np.pi
    zeta = _moved_to(mesh.zeta, np.array([1 - bore.mouth_length] if bore.mouth > 0 else []))
    zeta[0] = 0.0
    whole = np.concatenate([-zeta[:0:-1], zeta]) if lie.is_tilted else zeta
    return Nodes(ratio, place + _moved_to(mesh.phi, places), whole)


def _moved_to(nodes: Array, places: Array) -> Array:
    """Return the nodes after moving the inner node nearest to each place onto it; no node is moved twice."""
    nodes, held = nodes.copy(), np.zeros(nodes.size, bool)
    for place in np.unique(places[(places > nodes[0]) & (places < nodes[-1])]):
        k = 1 + int(np.abs(nodes[1:-1] - place).argmin())
        if not held[k]:
            nodes[k], held[k] = place, True
    return nodes


def gaps(nodes: Nodes, bore: Bore, lie: Lie) -> Gaps:
    """Return the gap at the positions where the flow balances need it.

    The gap may jump where lobes meet: at such a node the balances use the mean of 1/H over the half cells on
    both sides.
    """
    phi, zeta = nodes.phi[:-1], nodes.zeta
    ahead = np.diff(nodes.phi)[:, None]
    behind = np.roll(ahead, 1, axis=0)
    sides = behind / gap(bore, lie, phi, zeta, -1) + ahead / gap(bore, lie, phi, zeta)
    return Gaps(
        (behind + ahead) / sides if bore.is_lobed else gap(bore, lie, phi, zeta),
        gap(bore, lie, midpoints(nodes.phi), zeta),
        gap(bore, lie, phi, midpoints(zeta)),
    )


def displaced(nodes: Nodes) -> tuple[Gaps, Gaps]:
    """Return how the gap changes with the journal's displacement along and ahead of the load."""
    n, m = nodes.shape
    at_nodes, between = directions(nodes.phi[:-1]), directions(midpoints(nodes.phi))

    def change(k: int) -> Gaps:
        across = np.broadcast_to(-at_nodes[k][:, None], (n, m))
        return Gaps(across, np.broadcast_to(-between[k][:, None], (n, m)), across[:, :-1])

    return change(0), change(1)


def pressed(nodes: Nodes, H: Gaps) -> csc_array:
    """Return the outflow of the nodes due to pressure, per unit of pressure."""
    return _conducted(nodes, H.around**3, H.across**3)


def sheared(nodes: Nodes, H: Gaps) -> csc_array:
    """Return the outflow of the nodes due to shear, per fill of the upstream node."""
    n, m = nodes.shape
    flow = diags_array((6 * H.around * nodes.across).ravel())
    return csc_array(-nodes.steps[0].T @ flow @ eye_array(n * m))


def perturbed(nodes: Nodes, H: Gaps, change: Gaps) -> tuple[csc_array, csc_array]:
    """Return the derivatives of both matrices in the direction of a change of the gap."""
    A = _conducted(nodes, 3 * H.around**2 * change.around, 3 * H.across**2 * change.across)
    return A, sheared(nodes, change)


def _conducted(nodes: Nodes, around: Array, across: Array) -> csc_array:
    """Return the matrix of conductances between neighbours, from H³ or from its change."""
    turn, axial = nodes.steps
    by_turn = around * nodes.across / np.diff(nodes.phi)[:, None]
    by_axis = across * nodes.around[:, None] / np.diff(nodes.zeta) / nodes.ratio**2
    step = vstack([turn, axial])
    conductance = np.concatenate([by_turn.ravel(), by_axis.ravel()])
    return csc_array(step.T @ diags_array(conductance) @ step)


def fed(nodes: Nodes, pockets: list[Pocket]) -> tuple[Array, Mask]:
    """Return the fixed pressures P [-] (−1 where free) and a mask of the nodes that pockets feed, (n, m + 1).

    The ends are at ambient pressure.
    """
    P = np.full(nodes.shape, -1.0)
    P[:, -1] = 0.0
    if not nodes.is_half:
        P[:, 0] = 0.0
    inside = np.zeros(nodes.shape, bool)
    for pocket in pockets:
        away = np.abs((nodes.phi[:-1] - pocket.centre + np.pi) % FULL_TURN - np.pi)
        P[away <= pocket.width / 2 + 1e-9] = pocket.P
        inside[away <= pocket.width / 2 + 1e-9] = True
    return P, inside


def network(nodes: Nodes, H: Gaps, P_fixed: Array) -> Network:
    """Return the flow balances."""
    return Network(pressed(nodes, H), sheared(nodes, H), (P_fixed >= 0).ravel(), P_fixed.ravel())
