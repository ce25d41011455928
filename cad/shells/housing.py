"""A split housing: a block above the joint and a cap below it, each a box with half of the bore."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin, sqrt

from cadquery import Shape, Solid, Vector
from cadquery.func import cut, extrude, face, polyline
from cadquery.func import cylinder as round_bar
from scipy.integrate import quad


@dataclass(frozen=True)
class Housing:
    """Sizes of a housing [mm]; a radius of 0 omits a bolt hole or the drilling."""

    bore: float  # radius
    half_width: float  # along the shaft
    half_breadth: float  # across it
    block_height: float
    cap_height: float
    bolt: float = 0.0  # radius
    bolt_axis: float = 0.0  # its distance from the shaft
    bolt_depth: float = 0.0  # in the block
    drilling: float = 0.0  # radius

    def block(self) -> Shape:
        """Return the half at +y, with blind bolt holes and the drilling from the top to the bore."""
        body = self._half(1, self.block_height)
        for axis in self._bolts():
            body = cut(body, self._hole(self.bolt, axis, -self.bolt_depth, self.bolt_depth))
        if self.drilling > 0:
            body = cut(body, self._hole(self.drilling, 0.0, 0.0, 1.5 * self.block_height))
        return body

    def cap(self, gap: float = 0.0) -> Shape:
        """Return the half at -y with through holes for the bolts; a gap shifts it away from the joint."""
        body = self._half(-1, self.cap_height)
        for axis in self._bolts():
            body = cut(body, self._hole(self.bolt, axis, -1.5 * self.cap_height, self.cap_height))
        return body.translate(Vector(0, -gap, 0)) if gap else body

    def _bolts(self) -> tuple[float, ...]:
        return (-self.bolt_axis, self.bolt_axis) if self.bolt > 0 else ()

    def _half(self, side: int, height: float) -> Shape:
        a, b = self.half_breadth, self.half_width
        corners = [(-a, 0.0), (a, 0.0), (a, side * height), (-a, side * height), (-a, 0.0)]
        box = extrude(face(polyline(*(Vector(x, y, -b) for x, y in corners))), (0, 0, 2 * b))
        return cut(box, round_bar(2 * self.bore, 4 * b).translate(Vector(0, 0, -2 * b)))

    def _hole(self, radius: float, x: float, low: float, high: float) -> Solid:
        return Solid.makeCylinder(radius, high - low, Vector(x, low, 0), Vector(0, 1, 0))

    def block_volume(self) -> float:
        """Return the volume of the box minus half a bore, blind holes and the drilling [mm³]."""
        bolts = len(self._bolts()) * pi * self.bolt**2 * self.bolt_depth
        return self._half_volume(self.block_height) - bolts - self._drilled()

    def cap_volume(self) -> float:
        """Return the volume of the box minus half a bore and the through holes [mm³]."""
        return self._half_volume(self.cap_height) - len(self._bolts()) * pi * self.bolt**2 * self.cap_height

    def _half_volume(self, height: float) -> float:
        return 2 * self.half_width * (2 * self.half_breadth * height - pi * self.bore**2 / 2)

    def _drilled(self) -> float:
        """Return the volume of the drilling: the cylinder up to the top, minus its part inside the bore."""
        a, R = self.drilling, self.bore
        if a == 0:
            return 0.0

        def chord(t: float) -> float:
            return 2 * (a * cos(t)) ** 2 * sqrt(R * R - (a * sin(t)) ** 2)

        within = 2 * quad(chord, 0.0, pi / 2, epsabs=0, epsrel=1e-11)[0]
        return pi * a * a * self.block_height - within
