"""A connecting rod: its big end is a split housing, its shank a bar with a pocket on each side."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from cadquery import Shape, Solid, Vector
from cadquery.func import cut, fuse

from cad.revolution import sheet_under_arc
from cad.shells.housing import Housing


@dataclass(frozen=True)
class Rod:
    """Sizes of a rod [mm]: the shank runs along +y, from the shoulder of the big end to the small end."""

    big_end: Housing
    distance: float  # of the two axes
    bore: float  # radius of the small end's bore
    outside: float  # radius of the small end
    half_width: float  # of the small end, along the pin
    shank_width: float  # across the pin
    thickness: float  # of the shank, along the pin
    pocket_width: float = 0.0
    web: float = 0.0  # thickness between the pockets

    @property
    def shoulder(self) -> float:
        """Return the distance from the axis of the big end to the start of the shank."""
        return self.big_end.block_height

    @property
    def pocket(self) -> tuple[float, float]:
        """Return the ends of a pocket, which is as far from the ends of the shank as from its sides."""
        edge = (self.shank_width - self.pocket_width) / 2
        return self.shoulder + edge, self.distance - self.outside - edge

    def body(self) -> Shape:
        """Return the upper half of the big end, the shank and the small end as one solid."""
        end, full = Vector(0, self.distance, -self.half_width), 2 * self.half_width
        shank = self._bar(self.shank_width, self.shoulder, self.distance, 0.0, self.thickness)
        if self.pocket_width > 0:
            depth = (self.thickness - self.web) / 2
            for side in (1, -1):
                middle = side * (self.web / 2 + depth)  # the tool is twice as deep as the pocket
                shank = cut(shank, self._bar(self.pocket_width, *self.pocket, middle, 2 * depth))
        eye = Solid.makeCylinder(self.outside, full, end, Vector(0, 0, 1))
        whole = fuse(fuse(shank, eye), self.big_end.block())
        below = end - Vector(0, 0, self.half_width)
        return cut(whole, Solid.makeCylinder(self.bore, 2 * full, below, Vector(0, 0, 1)))

    def volume(self) -> float:
        """Compute the volume of the body [mm³]: the shank ends where the small end's circle begins."""
        half = self.shank_width / 2
        sheet = self.shank_width * (self.distance - self.shoulder) - sheet_under_arc(self.outside, half)
        eye = pi * (self.outside**2 - self.bore**2) * 2 * self.half_width
        return self.big_end.block_volume() + sheet * self.thickness - self._pockets() + eye

    def _pockets(self) -> float:
        if self.pocket_width <= 0:
            return 0.0
        low, high = self.pocket
        return self.pocket_width * (high - low) * (self.thickness - self.web)

    def _bar(self, width: float, low: float, high: float, z: float, thickness: float) -> Shape:
        corner = Vector(-width / 2, low, z - thickness / 2)
        return Solid.makeBox(width, high - low, thickness, corner)
