"""Meshes for the films of plane pads, many at once, refined towards the thin film and all edges.

x = 0 (inlet) … 1 (outlet) along the pad, H = a − (a − 1) x; zeta = 2z/b = 0 (middle) … 1 (side). The nodes
are equally spaced in t, 0 … 1, which maps smoothly to x, so that differences and Richardson's extrapolation
keep their order. From t to s, tanh concentrates the nodes in the two end layers, which are as thick as the
pad is wide; from s to x, :math:`H = a^{1-s}` gives every decade of the film the same number of nodes.

References
----------
M. Vinokur, J. Comput. Phys. 50, 1983, p. 215, for the stretching with two given slopes.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array

_FLATTEST = 1e-9
"""Smallest ln(a) in the map; below it the film is uniform to rounding."""
_NEWTON_STEPS = 12


@dataclass(frozen=True)
class NodeMap:
    """The map between t and x for pads (..., 1)."""

    logarithm: Array
    """L = ln a [-]."""
    skew: Array
    """Vinokur's A, the square root of the ratio of the end slopes [-]."""
    stretch: Array
    """Vinokur's Delta, 0 for no stretching [-]."""

    def place(self, t: Array) -> Array:
        """Return x at t [-]."""
        u = 0.5 * (1 + np.tanh(self.stretch * (t - 0.5)) / np.tanh(self.stretch / 2))
        s = u / (self.skew + (1 - self.skew) * u)
        return np.expm1(-s * self.logarithm) / np.expm1(-self.logarithm)

    def slope(self, t: Array) -> Array:
        """Return dx/dt at t [-]."""
        half = np.tanh(self.stretch / 2)
        u = 0.5 * (1 + np.tanh(self.stretch * (t - 0.5)) / half)
        du = 0.5 * self.stretch / (np.cosh(self.stretch * (t - 0.5)) ** 2 * half)
        s, ds = u / (self.skew + (1 - self.skew) * u), self.skew / (self.skew + (1 - self.skew) * u) ** 2
        return -self.logarithm * np.exp(-s * self.logarithm) / np.expm1(-self.logarithm) * ds * du

    def coordinate(self, x: Array) -> Array:
        """Return t at x, the inverse of `place` [-]."""
        s = -np.log1p(x * np.expm1(-self.logarithm)) / self.logarithm
        u = s * self.skew / (1 - s * (1 - self.skew))
        return np.clip(0.5 + np.arctanh((2 * u - 1) * np.tanh(self.stretch / 2)) / self.stretch, 0, 1)


def grading(a: Array, width: Array) -> NodeMap:
    """Return the map for pads of film ratio a ≥ 1 and width b/l.

    Parameters
    ----------
    a
        Film ratio h_i/h_o [-].
    width
        b/l [-].
    """
    logarithm = np.maximum(np.log(a), _FLATTEST)
    outlet = _layer_slope(width / np.pi * np.expm1(logarithm) / logarithm)
    inlet = _layer_slope(width / np.pi * -np.expm1(-logarithm) / logarithm)
    stretch = _stretch(-np.log(outlet * inlet) / 2)
    return NodeMap(logarithm[..., None], np.sqrt(outlet / inlet)[..., None], stretch[..., None])


def _layer_slope(layer: Array) -> Array:
    """Return the slope at the end of a map with equal numbers of nodes per decade down to the layer [-]."""
    return layer * np.arcsinh(1 / layer)


def _stretch(logarithm: Array) -> Array:
    """Return delta from its logarithm ln(sinh(delta)/delta), which is convex, by Newton's method [-]."""
    delta = 1e-3 + np.sqrt(6 * np.maximum(logarithm, 0))
    for _ in range(_NEWTON_STEPS):
        excess = delta + np.log(-np.expm1(-2 * delta) / (2 * delta)) - logarithm
        delta = np.maximum(delta - excess / (1 / np.tanh(delta) - 1 / delta), 1e-3)
    return delta


def across(a: Array, width: Array, m: int) -> Array:
    """Return nodes from the middle to the side, graded to an edge layer as thick as the pad is long [-].

    Parameters
    ----------
    a
        Film ratio h_i/h_o; the thin outlet film of a steep pad makes the layer thinner [-].
    width
        b/l [-].
    m
        Number of intervals.
    """
    layer = (1 / (width * np.sqrt(a)))[..., None]
    return 1 - layer * np.sinh(np.arcsinh(1 / layer) * (1 - np.arange(m + 1) / m))
