r"""The Reynolds equation of a film whose gap and viscosity depend on its own pressure, and its derivatives.

.. math::
    \partial_\phi\left(\frac{H^3}{\bar\eta}\partial_\phi P\right)
    + (D/B)^2\,\partial_\zeta\left(\frac{H^3}{\bar\eta}\partial_\zeta P\right) = 6\,\partial_\phi H,\quad
    H = 1 - \varepsilon\cos\phi + l\,P + \sum_n g_n\,(a_n\cos n\phi + b_n\sin n\phi)

l is the liner's compliance; a_n, b_n are the harmonics of the axial mean of the pressure, g_n the ring's
compliances. The viscosity increases with pressure after Roelands,

.. math:: \ln\bar\eta = L\,[(1 + s P)^Z - 1]

The finite-volume flow balances equal those of `film_equations` for a rigid bearing: the conductance between
two nodes uses the means of their deformations and pressures.

References
----------
C. J. A. Roelands: Dissertation, Delft 1966.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csc_array

from templates.core.arrays import Array, Mask
from templates.physics.elastic.compliance import HARMONICS
from templates.physics.films.film_equations import dual_widths, midpoints
from templates.physics.films.film_mesh import Mesh, swell


@dataclass(frozen=True)
class Softness:
    """Compliance of gap and oil for the pressure P = p psi²/(eta omega_h); lengths over radial clearance."""

    liner: float
    """Deformation of the liner per P, l [-]."""
    ring: Array
    """(HARMONICS + 1,) deformation of the ring per harmonic of P, g_n; 0 for n = 1 [-]."""
    size: float = 0.0
    """Roelands' ln(eta) + 9.67, L [-]."""
    scale: float = 0.0
    """Factor from P to Roelands' dimensionless pressure, s [-]."""
    power: float = 0.0
    """Roelands' exponent Z; 0 for constant viscosity [-]."""

    def times(self, share: float) -> "Softness":
        """Return the compliances multiplied by a factor."""
        return Softness(share * self.liner, share * self.ring, self.size, self.scale, share * self.power)

    def thickening(self, P: Array) -> tuple[Array, Array]:
        """Return the viscosity relative to that at ambient pressure, and its derivative with respect to P."""
        if self.power == 0 or self.scale == 0:
            return np.ones_like(P), np.zeros_like(P)
        base = 1 + self.scale * np.maximum(P, 0)
        with np.errstate(over="ignore"):
            eta = np.exp(self.size * (base**self.power - 1))
        return eta, eta * self.size * self.power * self.scale * base ** (self.power - 1)


@dataclass(frozen=True)
class Modes:
    """The ring's deformation as harmonics of the pressure on a mesh."""

    shapes: Array
    """(n + 1, M) cos and sin at the nodes."""
    taken: Array
    """(n + 1, M) weights that give the amplitudes from the axial mean pressure."""
    compliance: Array
    """(M,) deformation per amplitude."""


def modes(mesh: Mesh, ring: Array) -> Modes:
    """Return the harmonics 0, 2, 3, … of a ring on a mesh; empty for a rigid ring."""
    order = np.concatenate([[0], np.arange(2, HARMONICS + 1)]) if np.any(ring > 0) else np.zeros(0, int)
    cos, sin = np.cos(np.outer(mesh.phi, order)), np.sin(np.outer(mesh.phi, order[1:]))
    shapes = np.concatenate([cos, sin], axis=1)
    share = np.concatenate([np.where(order > 0, 1.0, 0.5), np.ones(order[1:].size)]) / np.pi
    compliance = np.concatenate([ring[order], ring[order[1:]]])
    return Modes(shapes, shapes * share * mesh.weight_phi[:, None], compliance)


@dataclass(frozen=True)
class SoftFilm:
    """A pressure on a mesh with the gap that it produces, whether or not it balances the flow."""

    mesh: Mesh
    ratio: float
    softness: Softness
    modes: Modes
    eps: float
    P: Array
    """(n + 1, m + 1); 0 at the first and last ring and at the end zeta = 1."""

    @cached_property
    def deformation(self) -> Array:
        """Return the change of the gap due to pressure (n + 1, m + 1) [-]."""
        mean = self.P @ self.mesh.weight_zeta / 2
        ring = self.modes.shapes @ (self.modes.compliance * (mean @ self.modes.taken))
        return np.asarray(self.softness.liner * self.P + ring[:, None])

    @cached_property
    def H(self) -> Array:
        """Return the gap at the nodes (n + 1, m + 1) [-]."""
        return np.asarray((1 - self.eps) + swell(self.mesh.phi, self.eps)[:, None] + self.deformation)

    @cached_property
    def around(self) -> tuple[Array, Array, Array, Array]:
        """Return gap, viscosity, its slope and pressure slope between circumferential neighbours.

        All are (n, m + 1).
        """
        rise = np.diff(self.P, axis=0) / np.diff(self.mesh.phi)[:, None]
        rigid = (1 - self.eps) + swell(midpoints(self.mesh.phi), self.eps)
        return rigid[:, None] + midpoints(self.deformation), *self._oil(midpoints(self.P)), rise

    @cached_property
    def across(self) -> tuple[Array, Array, Array, Array]:
        """Return gap, viscosity, its slope and pressure slope between axial neighbours, (n + 1, m)."""
        rise = np.diff(self.P, axis=1) / np.diff(self.mesh.zeta)
        H, P = ((values[:, :-1] + values[:, 1:]) / 2 for values in (self.deformation, self.P))
        rigid = (1 - self.eps) + swell(self.mesh.phi, self.eps)
        return rigid[:, None] + H, *self._oil(P), rise

    def _oil(self, P: Array) -> tuple[Array, Array]:
        return self.softness.thickening(P)

    @cached_property
    def loss(self) -> Array:
        """Return the net outflow of each node (n + 1, m + 1)."""
        H, eta, _, rise = self.around
        width = dual_widths(self.mesh.zeta)
        onward = -(H**3) / eta * rise + 6 * (H - (1 - self.eps))
        H_side, eta_side, _, rise_side = self.across
        cells = dual_widths(self.mesh.phi)[:, None] / self.ratio**2
        outward = -(H_side**3) / eta_side * rise_side * cells
        return _gathered(onward * width, outward)

    def jacobian(self, film: Mask) -> tuple[csc_array, Array, Array]:
        """Return the derivatives of the loss in the film with respect to P, the ring's amplitudes and eps.

        Parameters
        ----------
        film
            (n + 1, m + 1) mask of the nodes of the film; at the others P stays 0.

        Returns
        -------
        The matrix over all nodes, and arrays (nodes, M) and (nodes,).
        """
        H, eta, bend, rise = self.around
        width = dual_widths(self.mesh.zeta)
        by_gap = (6 - 3 * H**2 / eta * rise) * width
        by_oil = H**3 / eta**2 * rise * bend * width
        conductance = H**3 / eta / np.diff(self.mesh.phi)[:, None] * width
        local = (by_gap * self.softness.liner + by_oil) / 2
        H_side, eta_side, bend_side, rise_side = self.across
        cells = dual_widths(self.mesh.phi)[:, None] / self.ratio**2
        by_gap_side = -3 * H_side**2 / eta_side * rise_side * cells
        by_oil_side = H_side**3 / eta_side**2 * rise_side * bend_side * cells
        conductance_side = H_side**3 / eta_side / np.diff(self.mesh.zeta) * cells
        local_side = (by_gap_side * self.softness.liner + by_oil_side) / 2
        matrix = _assembled(
            (conductance + local, local - conductance),
            (conductance_side + local_side, local_side - conductance_side),
            film,
        )
        shapes = self.modes.shapes
        mid = (shapes[:-1] + shapes[1:]) / 2
        inside = film[..., None]
        modal = inside * _gathered(by_gap[..., None] * mid[:, None], by_gap_side[..., None] * shapes[:, None])
        turn = -np.cos(midpoints(self.mesh.phi)), -np.cos(self.mesh.phi)
        swollen = _gathered(
            by_gap * turn[0][:, None] + 6 * width, by_gap_side * turn[1][:, None]
        )  # the loss omits the constant 1 − eps
        return matrix, modal.reshape(film.size, modal.shape[-1]), (film * swollen).ravel()

    @cached_property
    def amplitudes_of(self) -> Array:
        """Return the (M, nodes) deformations of the ring per nodal pressure."""
        taken = self.modes.taken * self.modes.compliance
        across = self.mesh.weight_zeta / 2
        return (taken.T[:, :, None] * across).reshape(taken.shape[1], self.P.size)

    @cached_property
    def force_of(self) -> Array:
        """Return the (2, nodes) force per nodal pressure towards and ahead of the narrowest gap, in So."""
        line = np.stack([np.cos(self.mesh.phi), np.sin(self.mesh.phi)]) * self.mesh.weight_phi / 4
        return (line[:, :, None] * self.mesh.weight_zeta).reshape(2, -1)

    @cached_property
    def force(self) -> Array:
        """Return the force of the present pressure, (2,)."""
        return np.asarray(self.force_of @ self.P.ravel())


def _gathered(onward: Array, outward: Array) -> Array:
    """Return the loss of each node from circumferential (n, m + 1, ...) and axial (n + 1, m, ...) flows."""
    loss = np.zeros((outward.shape[0], onward.shape[1], *onward.shape[2:]))
    loss[:-1] += onward
    loss[1:] -= onward
    loss[:, :-1] += outward
    loss[:, 1:] -= outward
    return loss


def _assembled(around: tuple[Array, Array], across: tuple[Array, Array], film: Mask) -> csc_array:
    """Return the matrix of the derivatives of each flow with respect to the pressures at its two ends.

    Outside the film it is the unit matrix.
    """
    number = np.arange(film.size).reshape(film.shape)
    ends = ((number[:-1], number[1:], *around), (number[:, :-1], number[:, 1:], *across))
    rows, columns, values = [], [], []
    for here, there, by_here, by_there in ends:
        for loser, sign in ((here, 1.0), (there, -1.0)):
            for node, slope in ((here, by_here), (there, by_there)):
                kept = film.ravel()[loser] & film.ravel()[node]
                rows.append(loser[kept])
                columns.append(node[kept])
                values.append(sign * slope[kept])
    outside = np.flatnonzero(~film)
    rows.append(outside)
    columns.append(outside)
    values.append(np.ones(outside.size))
    places = np.concatenate(rows), np.concatenate(columns)
    return coo_array((np.concatenate(values), places), shape=(film.size, film.size)).tocsc()
