"""Meshes for the film of a journal bearing: graded to the thin film, to the ends, and for a short bearing.

phi is the angle from the narrowest gap, positive in the sense of rotation; H = 1 − eps cos(phi).
zeta = 2z/B runs from the middle of the bearing (0) to its end (1), because the film is symmetric.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.long_bearing import rupture_Swift_Stieber
from templates.physics.numerics.arrays import require

_MARGIN = 1.03
"""Extent of the mesh over that of the long bearing's film [-]; in a finite bearing rupture is earlier."""


@dataclass(frozen=True)
class Mesh:
    """Nodes and quadrature weights; every second node is a coarser mesh."""

    phi: Array
    """(n + 1,) angles of the nodes [rad]."""
    zeta: Array
    """(m + 1,) axial places of the nodes, 0 … 1."""
    weight_phi: Array
    """(n + 1,) fourth-order quadrature weights over phi [rad]."""
    weight_zeta: Array
    """(m + 1,) the same over zeta, for both halves together."""

    def coarser(self) -> "Mesh":
        """Return the mesh of every second node; its quadrature weights are invalid."""
        return Mesh(self.phi[::2], self.zeta[::2], self.weight_phi[::2], self.weight_zeta[::2])


def gap(phi: Array, eps: float) -> Array:
    """Return the film thickness H = h/c_radial, without cancellation where the film is thin [-]."""
    return (1 - eps) + swell(phi, eps)


def swell(phi: Array, eps: float) -> Array:
    """Return the film thickness above its least value, H − (1 − eps), to full relative accuracy."""
    return 2 * eps * np.sin(phi / 2) ** 2


def gregory(n: int) -> Array:
    """Return the weights of Gregory's fourth-order rule on n + 1 points at unit spacing, (n + 1,) [-].

    Raises
    ------
    ValueError
        If n is less than 6.

    References
    ----------
    A. Ralston and P. Rabinowitz, A First Course in Numerical Analysis, 1978, section 4.12.
    """
    require(np.asarray(n >= 6), "a mesh needs at least 6 intervals each way")
    end = np.array([3 / 8, 7 / 6, 23 / 24])
    return np.concatenate([end, np.ones(n - 5), end[::-1]])


def sommerfeld_angle(phi: Array, eps: float) -> Array:
    """Return Sommerfeld's angle from the narrowest gap, for phi in [−pi, pi] [rad]."""
    return 2 * np.arctan2(np.sin(phi / 2) * np.sqrt(1 + eps), np.cos(phi / 2) * np.sqrt(1 - eps))


def journal_mesh(eps: float, ratio: float, n: int, m: int) -> Mesh:
    """Return a mesh from the widest gap to just past the farthest angle at which the film can rupture.

    Parameters
    ----------
    eps
        Relative eccentricity, 0 … 1 − 1e-7 [-].
    ratio
        Width over diameter B/D [-].
    n
        Number of circumferential intervals.
    m
        Number of intervals over half the width.
    """
    end = np.tan(_MARGIN * (rupture_Swift_Stieber(eps) - np.pi) / 2)
    end = 2 * np.arctan(end * np.sqrt((1 - eps) / (1 + eps)))
    return _mesh(eps, ratio, n, m, end)


def halved(mesh: Mesh) -> Mesh:
    """Return the mesh of every second node, with its own quadrature weights.

    Raises
    ------
    ValueError
        If it has fewer than 6 intervals each way.
    """
    n, m = mesh.phi.size - 1, mesh.zeta.size - 1
    around, across = (2 * gregory(k // 2) / gregory(k)[::2] for k in (n, m))
    return Mesh(mesh.phi[::2], mesh.zeta[::2], around * mesh.weight_phi[::2], across * mesh.weight_zeta[::2])


def ring_mesh(eps: float, ratio: float, n: int, m: int) -> Mesh:
    """Return a mesh of the whole circle; its first and last nodes coincide."""
    return _mesh(eps, ratio, n, m, np.pi)


def _mesh(eps: float, ratio: float, n: int, m: int, end: float) -> Mesh:
    phi, slope = _graded_around(eps, ratio, n, end)
    zeta, axial_slope = graded_across(np.sqrt(1 - eps) / ratio, m)
    return Mesh(phi, zeta, gregory(n) * slope, 2 * gregory(m) * axial_slope)


def _graded_around(eps: float, ratio: float, n: int, end: float) -> tuple[Array, Array]:
    """Return nodes equally spaced in Sommerfeld's angle plus asinh(phi/w), and dphi of each interval.

    The first term resolves the thin film, the second every decade from it to the wide gap, where the side
    flow arises. w is the width of the thin film, or that of the rupture zone of a short bearing if it is
    smaller.
    """
    width = min(np.sqrt((1 - eps) / (1 + eps)), 3 * ratio)

    def place(phi: Array) -> Array:
        return sommerfeld_angle(phi, eps) + np.arcsinh(phi / width)

    def density(phi: Array) -> Array:
        return np.sqrt((1 - eps) * (1 + eps)) / gap(phi, eps) + 1 / np.hypot(phi, width)

    ends = place(np.array([-np.pi, end]))
    nodes = np.linspace(ends[0], ends[1], n + 1)
    phi = _inverse(place, density, nodes, _guesses(width, end))
    phi[[0, -1]] = -np.pi, end
    return phi, (ends[1] - ends[0]) / n / density(phi)


def _guesses(width: float, end: float) -> Array:
    """Return angles from −pi to the end, geometrically refined towards 0."""
    steps = np.geomspace(1e-3 * width, np.pi, 200)
    return np.concatenate([-steps[::-1], [0.0], steps[steps < end], [end]])


def _inverse(f: Callable[[Array], Array], slope: Callable[[Array], Array], y: Array, guesses: Array) -> Array:
    """Return the inverse of a smooth increasing function, from a table of guesses by Newton's method."""
    x = np.interp(y, f(guesses), guesses)
    for _ in range(4):
        x = x - (f(x) - y) / slope(x)
    return x


def graded_across(layer: float, m: int) -> tuple[Array, Array]:
    """Return axial nodes zeta [-], graded to an edge layer of given width, and dzeta of each interval.

    The width of the layer is the length of the thin film, relative to half the width of the bearing.
    """
    t = 1 - np.linspace(0, 1, m + 1)
    if layer >= 1:
        return 1 - t, np.full(m + 1, 1 / m)
    stretch = np.arcsinh(1 / layer)
    return 1 - layer * np.sinh(stretch * t), layer * stretch * np.cosh(stretch * t) / m
