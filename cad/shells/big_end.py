"""The big end of a rod: a half with the shank and a cap, each round with bosses for the bolts.

Each half is a circle about the crankpin, as high as its shoulder, between two flat sides. Rectangular bosses,
with rounded corners, join the sides up to their seats. A half whose bosses are as high as its shoulder is a
box; without bosses the circle runs into the sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

from cadquery import Shape, Solid, Vector
from cadquery.func import cut

from cad.contour import Arc, Contour, Line, Run

_SAME = 1e-9  # [mm]


@dataclass(frozen=True)
class EndHalf:
    """One half of a big end [mm], above the joint y = 0."""

    bore: float  # radius
    half_breadth: float
    height: float  # of the shoulder, the radius of the circle
    seat: float  # height of the bosses; 0 for none
    corner: float  # radius at the bosses, 0 for sharp ones

    @property
    def is_square(self) -> bool:
        """Return whether the bosses are as high as the shoulder."""
        return self.seat >= self.height - _SAME

    @property
    def edge(self) -> float:
        """Return how far from the middle the circle begins: at the seat, or at the side."""
        return sqrt(self.height**2 - self.seat**2) if self.seat > 0 else self.half_breadth

    def contour(self) -> Contour:
        """Return the section across the pin, with half of the bore."""
        a, r = self.half_breadth, self.bore
        bore = Arc((0.0, r), (r, 0.0), (0.0, 0.0), is_left=False)
        return Contour.symmetric([bore, Line((r, 0.0), (a, 0.0)), *self._outside()])

    def _outside(self) -> list[Run]:
        """Return the runs from the joint to the top."""
        a, h, c = self.half_breadth, self.seat, self.corner
        if h == 0:
            foot = (a, sqrt(self.height**2 - a**2))
            return [Line((a, 0.0), foot), self._round(foot)]
        edge = (0.0 if self.is_square else self.edge, self.height if self.is_square else h)
        top = edge[1]
        side: list[Run] = [Line((a, 0.0), (a, top - c))]
        if c > 0:
            side.append(Arc((a, top - c), (a - c, top), (a - c, top - c), is_left=True))
        side.append(Line((a - c, top), edge))
        return side if self.is_square else [*side, self._round(edge)]

    def _round(self, start: tuple[float, float]) -> Arc:
        return Arc(start, (0.0, self.height), (0.0, 0.0), is_left=True)


@dataclass(frozen=True)
class BigEnd:
    """Sizes of a big end [mm]; a bolt radius of 0 omits the bolt holes."""

    rod: EndHalf
    cap: EndHalf
    half_width: float  # along the pin
    bolt: float = 0.0  # radius
    bolt_axis: float = 0.0  # its distance from the pin
    bolt_depth: float = 0.0  # in the half with the shank

    @property
    def bore(self) -> float:
        """Return the radius of the bore."""
        return self.rod.bore

    def drilled(self, body: Shape) -> Shape:
        """Return the half with the shank after drilling its blind bolt holes."""
        for axis in self._bolts():
            body = cut(body, self._hole(axis, -self.bolt_depth, self.bolt_depth))
        return body

    def cap_body(self) -> Shape:
        """Return the cap, at -y, with through holes for the bolts."""
        body = self.cap.contour().prism(-self.half_width, self.half_width).mirror("XZ")
        for axis in self._bolts():
            body = cut(body, self._hole(axis, -1.5 * self.cap.height, self.cap.height))
        return body

    def _bolts(self) -> tuple[float, ...]:
        return (-self.bolt_axis, self.bolt_axis) if self.bolt > 0 else ()

    def _hole(self, x: float, low: float, high: float) -> Solid:
        return Solid.makeCylinder(self.bolt, high - low, Vector(x, low, 0), Vector(0, 1, 0))

    def volume(self) -> float:
        """Return the volume of the half with the shank, minus blind holes [mm³]."""
        return self._prism(self.rod) - self._holes(self.bolt_depth)

    def cap_volume(self) -> float:
        """Return the volume of the cap, minus the through holes to its seats [mm³]."""
        return self._prism(self.cap) - self._holes(min(self.cap.seat, self.cap.height))

    def _prism(self, half: EndHalf) -> float:
        return half.contour().area * 2 * self.half_width

    def _holes(self, depth: float) -> float:
        return len(self._bolts()) * pi * self.bolt**2 * depth
