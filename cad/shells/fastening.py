"""Bolts and hollow dowels of a bearing cap: their shapes, and parameters with rules for a split bore."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from cadquery import Location, Shape, Solid, Vector
from cadquery.func import cut, extrude, face, fuse, polyline

from cad.model import BRIGHT_STEEL, STEEL, CadModel, Part, mm
from templates.core.language.template import Array, Truth, derived, formula, require


@dataclass(frozen=True)
class Bolt:
    """A bolt with a hexagon head [mm], along z from its seat at z = 0; threads are not drawn."""

    radius: float
    length: float  # from the seat to its end
    across_flats: float
    head_height: float

    def solid(self) -> Shape:
        """Return shank and head; two flats of the head are across x."""
        half, corner = self.across_flats / 2, self.across_flats / sqrt(3)
        right = [(half, corner / 2), (0.0, corner), (-half, corner / 2)]
        ring = [*right, *((-x, -y) for x, y in right), right[0]]
        foot = polyline(*(Vector(x, y, -self.head_height) for x, y in ring))
        shank = Solid.makeCylinder(self.radius, self.length, Vector(0, 0, 0), Vector(0, 0, 1))
        return fuse(extrude(face(foot), (0, 0, self.head_height)), shank)

    @property
    def volume(self) -> float:
        """Return the volume of the cylinder and the hexagon [mm³]."""
        head = sqrt(3) / 2 * self.across_flats**2 * self.head_height
        return pi * self.radius**2 * self.length + head


@dataclass(frozen=True)
class Dowel:
    """A hollow dowel [mm]: a tube along z from z = 0."""

    radius: float
    bore: float  # radius
    length: float

    def solid(self) -> Shape:
        """Return the tube."""
        up, below = Vector(0, 0, 1), Vector(0, 0, -self.length)
        bar = Solid.makeCylinder(self.radius, self.length, Vector(0, 0, 0), up)
        return cut(bar, Solid.makeCylinder(self.bore, 3 * self.length, below, up))

    @property
    def volume(self) -> float:
        """Return the volume of the tube [mm³]."""
        return pi * (self.radius**2 - self.bore**2) * self.length


def upright(x: float, y: float) -> Location:
    """Return the position of a part whose z axis stands along +y at x, its origin at y."""
    return Location(Vector(x, y, 0), Vector(1, 0, 0), -90)


class Fastening(CadModel):
    """Parameters of the bolts and dowels of a cap, which 0 omits."""

    D: Array  # bore of the housing
    A: Array  # breadth
    B: Array  # width
    d_b: Array  # bolt hole diameter
    a_b: Array  # bolt spacing
    l_b: Array  # bolt hole depth
    h_e: Array  # height of the seats

    @derived("mm", "bolt diameter", symbol="d_s", ge=0, le=500)
    def d_s(self) -> Array:
        """Return the default: no bolts."""
        return 0 * self.D

    @derived("mm", "bolt length", symbol="l_s", ge=0.1, le=10000)
    def l_s(self) -> Array:
        """Return the default: through the cap and three quarters of the hole in the block."""
        return self.h_e + 0.75 * self.l_b

    @derived("mm", "bolt head width", symbol="s_s", ge=0.05, le=1000)
    def s_s(self) -> Array:
        """Return the default width across flats: 1.5 bolt diameters, about ISO 4014."""
        return 1.5 * np.maximum(self.d_s, 0.05 * self.D)

    @derived("mm", "bolt head height", symbol="k_s", ge=0.01, le=1000)
    def k_s(self) -> Array:
        """Return the default: 0.65 bolt diameters, about ISO 4014."""
        return 0.65 * np.maximum(self.d_s, 0.05 * self.D)

    @derived("mm", "dowel diameter", symbol="d_p", ge=0, le=1000)
    def d_p(self) -> Array:
        """Return the default: no dowels."""
        return 0 * self.D

    @derived("mm", "dowel length", symbol="l_p", ge=0.02, le=2000)
    def l_p(self) -> Array:
        """Return the default: half in the block, half in the cap."""
        return 0.2 * self.D

    @formula("mm", "depth of the bolts in the block", name="bolt_engagement", symbol="l_e")
    def l_e(self) -> Array:
        """Length of a bolt in the block."""
        return self.l_s - self.h_e

    @formula("mm", "wall of the dowels", name="dowel_wall", symbol="w_p")
    def w_p(self) -> Array:
        """Thickness between bolt hole and surface of a dowel."""
        return (self.d_p - self.d_b) / 2

    @require("bolt_diameter", "bolt_hole_diameter", remedy="make the bolts thinner or their holes wider")
    def bolts_fit_holes(self) -> Truth:
        """The bolts are at most as thick as their holes in the cap, and at least half as thick."""
        return (self.d_s <= 0) | ((self.d_s <= self.d_b) & (self.d_s >= 0.5 * self.d_b))

    @require("bolt_diameter", "bolt_length", "bolt_hole_depth", "cap_height",
             remedy="take a length that ends in the block above the bottom of its hole")  # fmt: skip
    def bolts_end_in_block(self) -> Truth:
        """The bolts reach half their diameter into the block, and not to the bottom of their holes."""
        return (self.d_s <= 0) | ((self.l_e >= 0.5 * self.d_s) & (self.l_e <= 0.99 * self.l_b))

    @require("bolt_diameter", "bolt_head_width", "housing_width", "housing_breadth", "bolt_spacing",
             remedy="make the heads smaller or the cap larger")  # fmt: skip
    def heads_lie_on_cap(self) -> Truth:
        """The heads are 5 to 200 % wider than the bolts and their holes, and lie on the cap."""
        wide = (self.s_s >= 1.05 * self.d_b) & (self.s_s <= 3 * self.d_s)
        on: Truth = (2 / np.sqrt(3) * self.s_s <= self.B) & (self.a_b + self.s_s <= self.A)
        return (self.d_s <= 0) | (wide & on)

    @require("bolt_diameter", "bolt_head_height", remedy="take 0.05 to 3 bolt diameters")
    def heads_are_drawable(self) -> Truth:
        """The height of the heads is 0.05 to 3 bolt diameters."""
        return (self.d_s <= 0) | ((self.k_s >= 0.05 * self.d_s) & (self.k_s <= 3 * self.d_s))

    @require("dowel_diameter", "bolt_hole_diameter", remedy="make the dowels larger, or 0 for none")
    def dowels_have_walls(self) -> Truth:
        """Dowels stand about bolt holes and are at least 5 % larger."""
        return (self.d_p <= 0) | ((self.d_b > 0) & (self.d_p >= 1.05 * self.d_b))

    @require("dowel_diameter", "bolt_spacing", "housing_bore", "housing_breadth", "housing_width",
             remedy="make the dowels smaller, or 0 for none")  # fmt: skip
    def dowels_keep_within(self) -> Truth:
        """The dowels are clear of the bore by 1 % of its diameter, and lie within 98 % of the joint."""
        clear = (self.a_b - self.d_p >= 1.01 * self.D) & (self.a_b + self.d_p <= 0.98 * self.A)
        return (self.d_p <= 0) | (clear & (self.d_p <= 0.9 * self.B))

    @require("dowel_diameter", "dowel_length", "bolt_hole_depth", "cap_height",
             remedy="make the dowels shorter")  # fmt: skip
    def dowels_are_short(self) -> Truth:
        """Half of a dowel takes 1 to 90 % of the bolt hole in the block and of that in the cap."""
        least = np.minimum(self.l_b, self.h_e)
        return (self.d_p <= 0) | ((self.l_p / 2 <= 0.9 * least) & (self.l_p / 2 >= 0.01 * least))

    def fasteners(self) -> tuple[Part, ...]:
        """Return the dowels and bolts as parts, each at both positions."""
        x, parts = mm(self.a_b) / 2, list[Part]()
        if self.d_p > 0:
            dowel = Dowel(mm(self.d_p) / 2, mm(self.d_b) / 2, mm(self.l_p))
            places = upright(-x, -dowel.length / 2), upright(x, -dowel.length / 2)
            parts.append(Part("dowel", dowel.solid(), dowel.volume, BRIGHT_STEEL, places=places))
        if self.d_s > 0:
            bolt = Bolt(mm(self.d_s) / 2, mm(self.l_s), mm(self.s_s), mm(self.k_s))
            places = upright(-x, -mm(self.h_e)), upright(x, -mm(self.h_e))
            parts.append(Part("bolt", bolt.solid(), bolt.volume, STEEL, places=places))
        return tuple(parts)
