"""The main sizes of a throw, and the positions of its pin and fillets.

This module does not import the geometry kernel: the finite-element code loads its own kernel, and one process
must not load both.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from templates.core.arrays import Array, Integers

_MARGIN = 0.1  # relative to its radius: the search for a fillet extends this far beyond its ends
_SECTORS = 24


@dataclass(frozen=True)
class Ring:
    """The region of a fillet at a web: between two radii about an axis and two levels of z [mm]."""

    axis: float  # x of the axis
    inner: float
    outer: float
    low: float
    high: float

    def holds(self, points: Array) -> Array:
        """Return whether points [n, 3] lie in the region."""
        away = np.hypot(points[:, 0] - self.axis, points[:, 1])
        inside = (away >= self.inner) & (away <= self.outer)
        return np.asarray(inside & (points[:, 2] >= self.low) & (points[:, 2] <= self.high))

    def sectors(self, points: Array) -> Integers:
        """Return the numbers of the sectors around the axis in which points [n, 3] lie."""
        angle = np.arctan2(points[:, 1], points[:, 0] - self.axis) % (2 * pi)
        return np.asarray(np.minimum(angle * _SECTORS / (2 * pi), _SECTORS - 1).astype(int))


@dataclass(frozen=True)
class Crank:
    """The sizes of a throw that determine the positions of its pin and fillets [mm]; z = 0 is mid-pin."""

    throw: float
    pin_radius: float
    pin_length: float
    journal_radius: float
    web_thickness: float
    fillet: float

    @property
    def plain(self) -> float:
        """Return the length of the cylindrical part of the pin between its fillets."""
        return self.pin_length - 2 * self.fillet

    def rings(self) -> tuple[Ring, ...]:
        """Return the regions of the four fillets: of pin and journal, at the lower and upper web."""
        margin = _MARGIN * self.fillet
        half, outer = self.pin_length / 2, self.pin_length / 2 + self.web_thickness
        spans = ((self.throw, self.pin_radius, half - self.fillet), (0.0, self.journal_radius, outer))
        rings = []
        for axis, radius, near in spans:
            reach = (radius - margin, radius + self.fillet + margin)
            low, high = near - margin, near + self.fillet + margin
            rings += [Ring(axis, *reach, -high, -low), Ring(axis, *reach, low, high)]
        return tuple(rings)
