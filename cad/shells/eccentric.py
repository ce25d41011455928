"""Eccentric bore of a half shell: a circle about a lower axis, so the wall is thinner towards the joints.

The circle touches that of the bore at the crown. Its axis lies on the plane of symmetry, beyond the shaft as
seen from the crown. The wall reduction at a height above the joint is the difference between the wall at the
crown and the wall, measured radially, where the bore has that height.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sqrt

import numpy as np
from scipy.integrate import quad

from templates.core.language.template import Array, units

Value = Array | float


@units("m", "m", "m", returns="m")
def offset_of(bore: Value, reduction: Value, height: Value) -> Array:
    """Return the offset of the axis of an eccentric bore.

    Parameters
    ----------
    bore
        Radius of the bore at the crown.
    reduction, height
        The wall reduction, and the height above the joint at which it is measured.
    """
    return reduction * (2 * bore + reduction) / (2 * np.maximum(bore - height, 0.05 * bore))


@units("m", "m", "m", returns="m")
def reduction_at(bore: Value, offset: Value, height: Value) -> Array:
    """Return the wall reduction at a height above the joint; the inverse of `offset_of`."""
    return np.sqrt(bore**2 + 2 * offset * (bore - height)) - bore


@dataclass(frozen=True)
class EccentricBore:
    """Sizes of an eccentric bore [mm]: radius at the crown and offset of the axis, 0 if concentric."""

    bore: float
    offset: float

    @property
    def joint(self) -> float:
        """Return the distance of the joint's edge from the axis of the shaft."""
        return sqrt(self.bore**2 + 2 * self.bore * self.offset)

    @property
    def drop(self) -> float:
        """Return how much thinner the wall is at the joint than at the crown."""
        return self.joint - self.bore

    def radius_at(self, angle: float) -> float:
        """Return the distance of the bore from the axis of the shaft, at an angle from the crown [rad]."""
        up = self.offset * cos(angle)
        return sqrt(up**2 + self.bore**2 + 2 * self.bore * self.offset) - up

    def sector(self, outside: float, turn: float) -> float:
        """Return the area [mm²] between the bore and a circle about the shaft, within a turn [rad]."""
        if self.offset == 0:
            return (outside**2 - self.bore**2) * turn / 2

        def slice_at(angle: float) -> float:
            return outside**2 - self.radius_at(angle) ** 2

        return float(quad(slice_at, 0.0, turn / 2, epsabs=0, epsrel=1e-12)[0])

    def chamfered(self, chamfer: float, outside: float) -> float:
        """Return the volume of a half ring within a radius that a 45° chamfer removes at one end [mm³].

        The chamfer is a cone about the shaft, of a given size at the crown.
        """
        tip = self.bore + chamfer
        end = min(tip, outside)

        def beyond(radius: float) -> float:
            return tip * radius**2 / 2 - radius**3 / 3

        def slice_at(angle: float) -> float:
            return beyond(end) - beyond(self.radius_at(angle))

        return float(2 * quad(slice_at, 0.0, pi / 2, epsabs=0, epsrel=1e-11)[0])
