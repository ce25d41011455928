"""Stub shaft: a plain cylinder that finite elements may twist, z along it."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

from cadquery.func import cylinder

from cad.model import STEEL, Box, CadModel, Part, mm
from cad.shaft import STEEL_MATERIAL, Shaft
from cad.surfaces import Seen, Z
from templates.core.template import Array, derived, formula, given


class StubShaft(CadModel):
    """Stub shaft, a plain cylinder."""

    example = {"diameter": "20 mm"}

    d: Array = given("mm", "diameter", ge=1, le=500)

    @derived("mm", "length", symbol="l", ge=1, le=2000)
    def l(self) -> Array:  # noqa: E743
        return 3 * self.d

    @formula("mm", "circumference")
    def U(self) -> Array:
        return pi * self.d

    def build(self) -> tuple[Part, ...]:
        """One cylinder."""
        d, length = mm(self.d), mm(self.l)
        return (Part("shaft", cylinder(d, length), pi / 4 * d**2 * length, STEEL),)

    def bounding_box(self) -> Box:
        """The cylinder's."""
        radius = mm(self.d) / 2
        return Box((-radius, -radius, 0), (radius, radius, mm(self.l)))

    def dimensions(self, seen: Mapping[str, Seen]) -> dict[str, float]:
        """From the cylinder and its ends."""
        (diameter,) = seen["shaft"].diameters(Z)
        return {"diameter": diameter, "length": seen["shaft"].length(Z)}

    def shaft(self) -> Shaft:
        """Held at z = 0, loaded at its other end."""
        return Shaft(0.0, mm(self.l), STEEL_MATERIAL)
