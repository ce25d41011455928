"""Outline of a crank web, seen along the shaft [mm]: its body, and a counterweight if there is one.

The body runs from half a width below the journal's axis to half a width above the pin's, with round or square
ends. The counterweight is a sector about the journal's axis, on the side away from the pin, as thick as the
web. Areas and moments are closed forms, which do not use the kernel.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, cos, dist, pi, remainder, sin, sqrt, tan

from cadquery import Edge, Vector, Wire
from cadquery.func import segment, wire

Point = tuple[float, float]
Run = tuple[Point, ...]  # two points: a line; three: an arc through the second

_NOTHING = 1e-9  # [mm]: shorter lines are left out, as where a flank meets a corner


@dataclass(frozen=True)
class Outline:
    """The outline of a web [mm]; a counterweight radius of 0 stands for no counterweight."""

    throw: float
    half_width: float
    rectangular: bool
    counterweight: float  # radius
    half_angle: float  # of the counterweight, from -x [rad]

    @property
    def tip(self) -> float:
        """Return the position of the end of the web beyond the pin."""
        return self.throw + self.half_width

    @property
    def area(self) -> float:
        """Return the area of the whole outline [mm²]."""
        h, R = self.half_width, self.throw
        body = 2 * h * (R + 2 * h) if self.rectangular else 2 * h * R + pi * h**2
        return body + self._sector

    def moment_beyond(self, start: float) -> float:
        """Return the first moment of the area beyond x = start, about the line x = start [mm³].

        The start must be above the journal axis.
        """
        h, R = self.half_width, self.throw
        if self.rectangular:
            return h * (self.tip - start) ** 2
        straight, u = max(R - start, 0.0), max(start - R, 0.0)
        chord = sqrt(h**2 - u**2)
        cap = h**2 * acos(u / h) - u * chord  # area of the round end beyond x = R + u
        return h * straight**2 + 2 / 3 * chord**3 + (R - start) * cap

    def wire(self, z: float) -> Wire:
        """Return the outline as a wire at a level of z."""
        return wire(*(edge(run, z) for run in self.runs()))

    def runs(self) -> list[Run]:
        """Return the lines and arcs, counter-clockwise, starting at the end beyond the pin.

        The lower side is the mirror image of the upper side.
        """
        first, upper, last = self._square() if self.rectangular else self._round()
        if self.counterweight > 0:
            flank, last = self._flank(upper[-1][-1])
            upper = [*upper, flank]
        upper = [run for run in upper if dist(run[0], run[-1]) > _NOTHING]
        lower = [tuple((x, -y) for x, y in reversed(run)) for run in reversed(upper)]
        return [first, *upper, last, *lower]

    def _round(self) -> tuple[Run, list[Run], Run]:
        """Return the upper side of a web with round ends: the end beyond the pin, the side, any other end."""
        h, R = self.half_width, self.throw
        first, last = ((R, -h), (self.tip, 0.0), (R, h)), ((0.0, h), (-h, 0.0), (0.0, -h))
        side: Run = ((R, h), (0.0, h))
        if self.counterweight == 0:
            return first, [side], last
        arc = tuple(
            _on_circle(h, angle) for angle in (pi / 2, (pi / 2 + self.half_angle) / 2, self.half_angle)
        )
        return first, [side, arc], last

    def _square(self) -> tuple[Run, list[Run], Run]:
        """Return the upper side of a rectangular web, in the order of `_round`."""
        h, a = self.half_width, self.half_angle
        first, last = ((self.tip, -h), (self.tip, h)), ((-h, h), (-h, -h))
        if self.counterweight > 0 and a > pi / 4:
            return first, [((self.tip, h), (-h / tan(a), h))], last
        side: Run = ((self.tip, h), (-h, h))
        return first, [side, ((-h, h), (-h, h * tan(a)))] if self.counterweight > 0 else [side], last

    def _flank(self, foot: Point) -> tuple[Run, Run]:
        """Return the flank of the counterweight at +y, from its foot outwards, and the rim."""
        rim = tuple(
            _on_circle(self.counterweight, angle) for angle in (self.half_angle, 0.0, -self.half_angle)
        )
        return (foot, rim[0]), rim

    @property
    def _sector(self) -> float:
        """Return the area that the counterweight adds to the body [mm²]."""
        h, a = self.half_width, self.half_angle
        if self.counterweight == 0:
            return 0.0
        if not self.rectangular:
            return a * (self.counterweight**2 - h**2)
        within = h**2 * (tan(a) if a <= pi / 4 else 2 - 1 / tan(a))
        return a * self.counterweight**2 - within


def edge(run: Run, z: float) -> Edge:
    """Return the edge of a line or an arc at a level of z."""
    return draw(run, lambda x, y: Vector(x, y, z))


def draw(run: Run, place: Callable[[float, float], Vector]) -> Edge:
    """Return the edge of a line or an arc; `place` converts its points to points in space."""
    points = [place(*point) for point in run]
    return segment(*points) if len(points) == 2 else Edge.makeThreePointArc(*points)


def _on_circle(radius: float, angle: float) -> Point:
    """Return the point at an angle from -x, towards +y."""
    return -radius * cos(angle), radius * sin(angle)


def reach(outline: Outline, direction: float) -> float:
    """Return the largest extent of a web in a direction [rad] from x, measured from the journal axis."""
    across = abs(sin(direction)) * outline.half_width
    along = cos(direction)
    if outline.rectangular:
        body = max(outline.tip * along, -outline.half_width * along) + across
    else:
        body = outline.half_width + max(outline.throw * along, 0.0)
    return max(body, _sector(outline, direction)) if outline.counterweight > 0 else body


def _sector(outline: Outline, direction: float) -> float:
    """Return the extent of the counterweight sector about -x: at its rim or the nearest end of the rim."""
    off = abs(remainder(direction - pi, 2 * pi)) - outline.half_angle
    return outline.counterweight * (cos(off) if off > 0 else 1.0)
