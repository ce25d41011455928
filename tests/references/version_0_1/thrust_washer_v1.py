"""Thrust washer: a flat ring, z along the shaft, its back on z = 0."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

import numpy as np
from cadquery.func import cut, cylinder

from cad.model import BRONZE, Box, CadModel, Part, mm
from cad.surfaces import Seen, Z
from templates.core.template import Array, Truth, derived, formula, given, require


class ThrustWasher(CadModel):
    """Thrust washer, a flat ring."""

    example = {"inner_diameter": "20 mm"}

    d: Array = given("mm", "inner diameter", ge=1, le=1000, also=("bearing diameter", "bore"))

    @derived("mm", "outer diameter", symbol="D", ge=1, le=5000)
    def D(self) -> Array:
        return 1.6 * self.d

    @derived("mm", "thickness", symbol="t", ge=0.01, le=500)
    def t(self) -> Array:
        return 0.08 * self.d

    @formula("mm**2", "face area", symbol="A")
    def A(self) -> Array:
        return np.pi / 4 * (self.D**2 - self.d**2)

    @require("outer_diameter", "inner_diameter", remedy="make the outer diameter larger")
    def has_a_face(self) -> Truth:
        """The outer diameter is at least 2 % larger than the inner one."""
        return self.D >= 1.02 * self.d

    def build(self) -> tuple[Part, ...]:
        """One ring; its volume is a closed form that knows nothing of the kernel."""
        d, D, t = mm(self.d), mm(self.D), mm(self.t)
        ring = cut(cylinder(D, t), cylinder(d, t))
        return (Part("washer", ring, pi / 4 * (D**2 - d**2) * t, BRONZE),)

    def bounding_box(self) -> Box:
        """As wide as the outer diameter, as high as it is thick."""
        radius = mm(self.D) / 2
        return Box((-radius, -radius, 0), (radius, radius, mm(self.t)))

    def dimensions(self, seen: Mapping[str, Seen]) -> dict[str, float]:
        """All three, from the cylinders about the shaft and the planes across it."""
        inner, outer = seen["washer"].diameters(Z)
        return {"inner_diameter": inner, "outer_diameter": outer, "thickness": seen["washer"].length(Z)}
