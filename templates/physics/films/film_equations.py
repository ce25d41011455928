r"""The Reynolds equation in finite volumes on a product mesh: one flow balance per node.

.. math::
    \partial_\phi(H^3\partial_\phi P) + (D/B)^2\,\partial_\zeta(H^3\partial_\zeta P)
    = 6\,\partial_\phi H + 12\,\partial_\tau H

In discrete form A P = b: A is a symmetric M-matrix, b is the flow that rotation and squeeze bring to a node.
All coefficients are products of a circumferential and an axial factor, so a perturbation of the gap gives
equations of the same form.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_mesh import Mesh


def dual_widths(nodes: Array) -> Array:
    """Return the lengths of the cells around the nodes (n + 1,), with half cells at the ends."""
    half = np.diff(nodes) / 2
    return np.concatenate([half, [0.0]]) + np.concatenate([[0.0], half])


@dataclass(frozen=True)
class Equations:
    """Coefficients of the flow balances at (n + 1) × (m + 1) nodes."""

    around: Array
    """(n,) conductance H³/dphi between circumferential neighbours, per unit zeta."""
    across: Array
    """(n + 1,) axial conductance (D/B)² H³ dphi, times dzeta."""
    source: Array
    """(n + 1,) flow that rotation and squeeze bring to a node, per unit zeta."""
    zeta: Array
    """(m + 1,) axial places of the nodes."""
    ring: bool = False
    """Whether the last node coincides with the first; otherwise P = 0 at both."""

    @cached_property
    def conductance_around(self) -> Array:
        """Return the flow between circumferential neighbours per unit of pressure, (n, m + 1)."""
        return np.asarray(self.around[:, None] * dual_widths(self.zeta))

    @cached_property
    def conductance_across(self) -> Array:
        """Return the flow between axial neighbours per unit of pressure, (n + 1, m)."""
        return np.asarray(self.across[:, None] / np.diff(self.zeta))

    @cached_property
    def brought(self) -> Array:
        """Return the flow that rotation and squeeze bring to the nodes, (n + 1, m + 1)."""
        return np.asarray(self.source[:, None] * dual_widths(self.zeta))

    def residual(self, P: Array) -> Array:
        """Return A P − b: the outflow of a node by pressure minus its inflow by motion, (n + 1, m + 1)."""
        flow = P[1:] - P[:-1]
        flow *= self.conductance_around
        axial = P[:, 1:] - P[:, :-1]
        axial *= self.conductance_across
        excess = -self.brought
        excess[:-1] -= flow
        excess[1:] += flow
        excess[:, :-1] -= axial
        excess[:, 1:] += axial
        return self._closed(excess)

    def diagonal(self) -> Array:
        """Return the diagonal of A, (n + 1, m + 1)."""
        total = np.zeros((self.across.size, self.zeta.size))
        total[:-1] += self.conductance_around
        total[1:] += self.conductance_around
        total[:, :-1] += self.conductance_across
        total[:, 1:] += self.conductance_across
        return self._closed(total)

    def _closed(self, balance: Array) -> Array:
        """Return the nodal balances; on a ring, the first node includes the balances of the last."""
        if self.ring:
            balance[0] += balance[-1]
            balance[-1] = 0
        return balance


def film_equations(mesh: Mesh, ratio: float, H: Array, H_mid: Array, source: Array) -> Equations:
    """Return the flow balances for a gap that is given at the nodes and midway between them.

    Parameters
    ----------
    mesh
        The nodes.
    ratio
        Width over diameter B/D [-].
    H
        (n + 1,) gap at the nodes [-].
    H_mid
        (n,) gap midway between the nodes [-].
    source
        (n + 1,) flow that motion brings to the nodes; see `rotation` and `squeeze`.
    """
    return Equations(
        around=H_mid**3 / np.diff(mesh.phi),
        across=H**3 * dual_widths(mesh.phi) / ratio**2,
        source=source,
        zeta=mesh.zeta,
    )


def perturbed_equations(
    mesh: Mesh, ratio: float, H: Array, H_mid: Array, change: Array, change_mid: Array
) -> Equations:
    """Return the derivative of `film_equations` in the direction of a change of the gap."""
    return Equations(
        around=3 * H_mid**2 * change_mid / np.diff(mesh.phi),
        across=3 * H**2 * change * dual_widths(mesh.phi) / ratio**2,
        source=rotation(change_mid),
        zeta=mesh.zeta,
    )


def rotation(H_mid: Array) -> Array:
    """Return the oil that shear flow brings to each node, −6 dH over its cell [-].

    A constant in H_mid cancels. At the ends of the mesh the value is the flow out of or into the mesh.
    """
    flow = 6 * H_mid
    return np.concatenate([[0.0], flow]) - np.concatenate([flow, [0.0]])


def squeeze(mesh: Mesh, H_rate: Array) -> Array:
    """Return the oil that a decreasing gap brings to each node, −12 dH/d(omega_h t) over its cell [-]."""
    return -12 * H_rate * dual_widths(mesh.phi)


def midpoints(nodes: Array) -> Array:
    """Return the positions midway between the nodes, in the unit of the nodes."""
    return (nodes[:-1] + nodes[1:]) / 2
