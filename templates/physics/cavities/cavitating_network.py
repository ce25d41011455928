"""Flow balances of a journal's cavitating film on a ring of nodes, and derivatives with respect to the gap.

Every coefficient is the product of a circumferential and an axial factor, as in `film_equations`; a change of
the gap changes only the circumferential factors.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from templates.core.arrays import Array, Mask
from templates.physics.cavities.cavitation import Network
from templates.physics.films.film_equations import dual_widths, midpoints
from templates.physics.films.film_mesh import gap, ring_mesh

Numbers = NDArray[np.intp]


@dataclass(frozen=True)
class Groove:
    """An axial groove or pocket, full at its own pressure; a width of 0 makes it a line."""

    centre: float
    """Angle from the narrowest gap in the sense of rotation [rad]."""
    width: float
    """Circumferential extent [rad]."""
    length: float = 1.0
    """Axial extent over the bearing's width, 0 … 1 [-]."""
    P: float = 0.0
    """Supply pressure above that of the cavity [-]."""


@dataclass(frozen=True)
class Ring:
    """The positions of the nodes: circumferential × axial, axial index fastest; phi ends where it starts."""

    eps: float
    """Relative eccentricity [-]."""
    ratio: float
    """Width over diameter B/D [-]."""
    phi: Array
    """(n + 1,) angles from the narrowest gap [rad]."""
    zeta: Array
    """(m + 1,) axial places, 0 (middle) … 1 (end)."""

    def closed(self, values: Array) -> Array:
        """Return the node values as a circumferential × axial array whose last row repeats the first."""
        rows = values.reshape(self.phi.size - 1, self.zeta.size, *values.shape[1:])
        return np.concatenate([rows, rows[:1]])

    def cells(self) -> Array:
        """Return the (N,) areas dphi dzeta of the cells around the nodes."""
        around = dual_widths(self.phi)
        return np.outer(np.append(around[0] + around[-1], around[1:-1]), dual_widths(self.zeta)).ravel()


def grooved_ring(eps: float, ratio: float, grooves: list[Groove], n: int, m: int) -> Ring:
    """Return a graded mesh in which the nodes nearest to the groove edges are moved onto them."""
    mesh = ring_mesh(eps, ratio, n, m)
    edges = [groove.centre + side * groove.width / 2 for groove in grooves for side in (-1, 1)]
    phi = _snapped(mesh.phi, _wrapped(np.array(edges)))
    return Ring(eps, ratio, phi, _snapped(mesh.zeta, np.array([groove.length for groove in grooves])))


def _wrapped(angle: Array) -> Array:
    """Return the angle wrapped into [−pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _snapped(nodes: Array, places: Array) -> Array:
    """Return the nodes after moving the inner node nearest to each place onto that place."""
    nodes = nodes.copy()
    for place in places[(places > nodes[0]) & (places < nodes[-1])]:
        nodes[1 + np.abs(nodes[1:-1] - place).argmin()] = place
    return nodes


def _inside(groove: Groove, phi: Array, zeta: Array) -> Mask:
    """Return a mask of the nodes in a groove; even a very narrow groove contains the node moved onto it."""
    around = np.abs(_wrapped(phi - groove.centre)) <= groove.width / 2 + 1e-9
    return around[:, None] & (zeta <= groove.length + 1e-9)


def fed_network(ring: Ring, grooves: list[Groove], ambient: float) -> tuple[Network, Mask]:
    """Return the flow balances, and a mask of the nodes (circumferential × axial) that grooves feed."""
    phi, middle = ring.phi, midpoints(ring.phi)
    H, H_mid = gap(phi, ring.eps), gap(middle, ring.eps)
    A, T = _flows(ring, H_mid**3, H**3, H_mid)
    P_fixed = np.full((phi.size - 1, ring.zeta.size), -1.0)
    fed = np.zeros(P_fixed.shape, bool)
    P_fixed[:, -1] = ambient
    for groove in grooves:
        inside = _inside(groove, phi[:-1], ring.zeta)
        P_fixed[inside] = groove.P
        fed |= inside
    return Network(A, T, (P_fixed >= 0).ravel(), P_fixed.ravel()), fed


def perturbed_flows(ring: Ring, change: Array, change_mid: Array) -> tuple[csc_array, csc_array]:
    """Return the derivatives of A and T for a change of the gap at (n + 1) and between (n) nodes."""
    H, H_mid = gap(ring.phi, ring.eps), gap(midpoints(ring.phi), ring.eps)
    return _flows(ring, 3 * H_mid**2 * change_mid, 3 * H**2 * change, change_mid)


def _flows(ring: Ring, cube_mid: Array, cube: Array, H_mid: Array) -> tuple[csc_array, csc_array]:
    """Return the outflow of the nodes by pressure and by shear, from H³ and H at and between nodes.

    Both matrices have the same sparsity pattern, so that their sums need no new pattern.
    """
    n, m, dual = ring.phi.size - 1, ring.zeta.size, dual_widths(ring.zeta)
    cell = cube * dual_widths(ring.phi) / ring.ratio**2
    cell[0] += cell[-1]
    around = ((cube_mid / np.diff(ring.phi))[:, None] * dual).ravel()
    across = (cell[:-1, None] / np.diff(ring.zeta)).ravel()
    shear = (6 * H_mid[:, None] * dual).ravel()
    pattern = _pattern(n, m)
    by_pressure = [around, around, -around, -around, across, across, -across, -across]
    return pattern.filled(pattern.pressure, by_pressure), pattern.filled(pattern.shear, [shear, -shear])


@dataclass(frozen=True)
class _Pattern:
    """The sparsity pattern of matrices on a ring of nodes, and the position of each entry in it."""

    row: NDArray[np.int32]
    """(places,) the row of each position."""
    starts: NDArray[np.int32]
    """(N + 1,) start of each column."""
    pressure: Numbers
    """(entries,) the position of each pressure entry: see `_flows`."""
    shear: Numbers
    """(entries,) the position of each shear entry."""

    def filled(self, places: Numbers, values: list[Array]) -> csc_array:
        """Return the sparse matrix with these entries; entries at the same position are added."""
        data = np.bincount(places, np.concatenate(values), self.row.size)
        count = self.starts.size - 1
        return csc_array((data, self.row, self.starts), shape=(count, count))


@lru_cache(maxsize=16)
def _pattern(n: int, m: int) -> _Pattern:
    """Return the sparsity pattern for n circumferential and m axial nodes."""
    node = np.arange(n * m).reshape(n, m)
    ahead = np.roll(node, -1, axis=0)
    pressure = [*_exchanged(node, ahead), *_exchanged(node[:, :-1], node[:, 1:])]
    at = [_places(entries, n * m) for entries in (pressure, [(node, node), (ahead, node)])]
    places = np.unique(at[0])  # the shear pattern is a subset of the pressure pattern
    column, row = np.divmod(places, n * m)
    starts = np.searchsorted(column, np.arange(n * m + 1)).astype(np.int32)
    return _Pattern(row.astype(np.int32), starts, *(np.searchsorted(places, one) for one in at))


def _exchanged(one: Numbers, other: Numbers) -> list[tuple[Numbers, Numbers]]:
    """Return the rows and columns of the flows between neighbouring nodes."""
    return [(one, one), (other, other), (one, other), (other, one)]


def _places(entries: list[tuple[Numbers, Numbers]], count: int) -> Numbers:
    """Return the column-major positions of entries in a square matrix."""
    return np.concatenate([(column * count + row).ravel() for row, column in entries])
