"""A split housing: a block above the joint and a cap below it, each with half of the bore.

The cap is a box, or has a crown between two shoulders, the seats of the bolts. The block is a box, or a
saddle as wide as the cap below a thinner bulkhead.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin, sqrt

from cadquery import Shape, Solid, Vector
from cadquery.func import cut, extrude, face, polyline
from cadquery.func import cylinder as round_bar
from scipy.integrate import quad


@dataclass(frozen=True)
class Housing:
    """Sizes of a housing [mm]; 0 omits bolt holes, drilling, shoulders, bulkhead or counterbores."""

    bore: float  # radius
    half_width: float  # along the shaft
    half_breadth: float  # across it
    block_height: float
    cap_height: float
    bolt: float = 0.0  # radius of the holes in the cap
    bolt_axis: float = 0.0  # its distance from the shaft
    bolt_depth: float = 0.0  # in the block
    drilling: float = 0.0  # radius
    thread: float = 0.0  # radius of the holes in the block, where it differs from those in the cap
    shoulder: float = 0.0  # depth below the crown
    half_crown: float = 0.0  # half the width of the crown
    half_bulkhead: float = 0.0  # half its thickness
    saddle: float = 0.0  # height of the saddle
    dowel: float = 0.0  # radius of the counterbores for dowels
    dowel_depth: float = 0.0  # of each counterbore

    @property
    def seat(self) -> float:
        """Return the distance of the bolts' seats from the joint."""
        return self.cap_height - self.shoulder

    def block(self) -> Shape:
        """Return the half at +y, with blind bolt holes and the drilling from the top to the bore."""
        body = self._bored(self._box(-self.half_breadth, self.half_breadth, 0.0, self.block_height))
        if self.half_bulkhead > 0:
            over = self.half_breadth + self.block_height
            for low, high in ((self.half_bulkhead, over), (-over, -self.half_bulkhead)):
                body = cut(body, self._box(-over, over, self.saddle, over + self.block_height, low, high))
        for axis in self._bolts():
            body = cut(body, self._hole(self.thread or self.bolt, axis, -self.bolt_depth, self.bolt_depth))
            body = self._counterbored(body, axis)
        if self.drilling > 0:
            body = cut(body, self._hole(self.drilling, 0.0, 0.0, 1.5 * self.block_height))
        return body

    def cap(self, gap: float = 0.0) -> Shape:
        """Return the half at -y with through holes for the bolts; a gap moves it away from the joint."""
        body = self._bored(self._box(-self.half_breadth, self.half_breadth, -self.cap_height, 0.0))
        if self.shoulder > 0:
            over = 2 * self.half_breadth
            for low, high in ((self.half_crown, over), (-over, -self.half_crown)):
                body = cut(body, self._box(low, high, -self.cap_height - self.shoulder, -self.seat))
        for axis in self._bolts():
            body = cut(body, self._hole(self.bolt, axis, -1.5 * self.cap_height, self.cap_height))
            body = self._counterbored(body, axis)
        return body.translate(Vector(0, -gap, 0)) if gap else body

    def _counterbored(self, body: Shape, axis: float) -> Shape:
        if self.dowel == 0:
            return body
        return cut(body, self._hole(self.dowel, axis, -self.dowel_depth, self.dowel_depth))

    def _bolts(self) -> tuple[float, ...]:
        return (-self.bolt_axis, self.bolt_axis) if self.bolt > 0 else ()

    def _box(
        self, left: float, right: float, low: float, high: float, front: float = 0.0, rear: float = 0.0
    ) -> Shape:
        """Return a box between coordinates of x, y and z; without those of z as wide as the housing."""
        b = self.half_width
        front, rear = (front, rear) if front or rear else (-b, b)
        corners = [(left, low), (right, low), (right, high), (left, high), (left, low)]
        return extrude(face(polyline(*(Vector(x, y, front) for x, y in corners))), (0, 0, rear - front))

    def _bored(self, body: Shape) -> Shape:
        b = self.half_width
        return cut(body, round_bar(2 * self.bore, 4 * b).translate(Vector(0, 0, -2 * b)))

    def _hole(self, radius: float, x: float, low: float, high: float) -> Solid:
        return Solid.makeCylinder(radius, high - low, Vector(x, low, 0), Vector(0, 1, 0))

    def block_volume(self) -> float:
        """Return the volume of the box minus half a bore, recesses, blind holes and the drilling [mm³]."""
        holes = self._holes(self.thread or self.bolt, self.bolt_depth)
        return self._half_volume(self.block_height) - self._recesses() - holes - self._drilled()

    def cap_volume(self) -> float:
        """Return the volume of the box minus half a bore, shoulders and the through holes [mm³]."""
        shoulders = 4 * self.half_width * self.shoulder * (self.half_breadth - self.half_crown)
        return self._half_volume(self.cap_height) - shoulders - self._holes(self.bolt, self.seat)

    def _holes(self, radius: float, depth: float) -> float:
        """Return the volume of the bolt holes of one half with their counterbores."""
        wider = max(self.dowel**2 - radius**2, 0.0) * self.dowel_depth
        return len(self._bolts()) * pi * (radius**2 * depth + wider)

    def _recesses(self) -> float:
        """Return the volume beside the bulkhead."""
        if self.half_bulkhead == 0:
            return 0.0
        across = 2 * self.half_breadth * (self.block_height - self.saddle)
        return across * 2 * (self.half_width - self.half_bulkhead)

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
