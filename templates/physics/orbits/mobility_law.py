"""Mobility with its derivatives, for the orbits of many journals at once, as Newton's method needs it.

In Booker's frame, xi is along the load on the journal and eta ahead of it. Points are (cases, places), and
every case has its own width. There are two laws: Booker's closed form, and the map of the finite bearing.

References
----------
J. F. Booker, Trans. ASME J. Basic Eng. 87, 1965, p. 537; J. Lubr. Technol. 93, 1971, p. 168.
"""

from typing import Protocol

import numpy as np

from templates.core.arrays import Array, Mask
from templates.physics.numerics.spline_slopes import at_thirds, surfaces_with_slopes
from templates.physics.orbits.mobility_map import coordinates, mobility_map


class MobilityLaw(Protocol):
    """A mobility M(xi, eta) of some cases."""

    def __call__(self, xi: Array, eta: Array) -> tuple[Array, Array]:
        """Return M, (2, C, K), and its derivatives with respect to xi and eta, (2, 2, C, K) [-]."""

    def of(self, cases: Mask) -> "MobilityLaw":
        """Return the same law for a subset of the cases."""


class ShortLaw:
    """Booker's closed form for the half film of the short bearing (1971); valid for every eps below 1."""

    def __init__(self, ratio: Array) -> None:
        """Store the widths B/D of the cases, (C,) [-]."""
        self.ratio = ratio

    def of(self, cases: Mask) -> "ShortLaw":
        """Return the same law for a subset of the cases."""
        return ShortLaw(self.ratio[cases])

    def __call__(self, xi: Array, eta: Array) -> tuple[Array, Array]:
        """Return M and its derivatives; see `short_mobility`."""
        area, h = self.ratio[:, None] ** 2, 1 - xi
        root = np.sqrt(h)
        along, across = h * h * root / (np.pi * area), 4 * h * root / (np.pi**2 * area)
        M = np.stack([along, -across * eta])
        slopes = np.array([[-2.5 * along / h, np.zeros_like(xi)], [1.5 * across * eta / h, -across]])
        return M, slopes


class MapLaw:
    """The finite bearing's mobility from `mobility_map`, within the range of that map."""

    def __init__(self, ratio: Array) -> None:
        """Store the widths B/D of the cases, (C,), each within the map [-]."""
        self.ratio = ratio
        widths, self.width = np.unique(ratio, return_inverse=True)
        self.surfaces = at_thirds(mobility_map().motion, mobility_map().axes[2], np.log(widths))

    def of(self, cases: Mask) -> "MapLaw":
        """Return the same law for a subset of the cases."""
        return MapLaw(self.ratio[cases])

    def __call__(self, xi: Array, eta: Array) -> tuple[Array, Array]:
        """Return M and its derivatives, through the coordinates and the encoded values of the map."""
        x, v = coordinates(xi, eta)
        width = np.repeat(self.width, xi.shape[1])
        axes = mobility_map().axes
        values = surfaces_with_slopes(self.surfaces, width, axes[0], axes[1], x.ravel(), v.ravel())
        (p, q), by_x, by_v = values.reshape(3, 2, *xi.shape)
        h, chord = 1 - xi, np.sqrt(np.maximum((1 - xi) * (1 + xi), 1e-30))
        x_xi, v_xi, v_eta = -(1 + 1 / h), v * xi / chord**2, np.sign(eta) / chord
        (p_xi, q_xi), (p_eta, q_eta) = by_x * x_xi + by_v * v_xi, by_v * v_eta
        along = h * h * np.sqrt(h) / (np.pi * self.ratio[:, None] ** 2) * np.exp(p)
        lean = -q * eta / h
        along_xi, along_eta = along * (p_xi - 2.5 / h), along * p_eta
        ahead_xi = along_xi * lean - along * (q_xi + q / h) * eta / h
        ahead_eta = along_eta * lean - along * (q_eta * eta + q) / h
        return np.stack([along, along * lean]), np.array([[along_xi, along_eta], [ahead_xi, ahead_eta]])
