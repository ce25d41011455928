"""Plane contours of lines and arcs [mm]: their area in closed form, and their face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi, sin

from cadquery import Edge, Shape, Vector
from cadquery.func import extrude, face, segment, wire

Point = tuple[float, float]
_NOTHING = 1e-9  # [mm]: shorter lines are left out


@dataclass(frozen=True)
class Line:
    """A straight line."""

    start: Point
    end: Point

    @property
    def swept(self) -> float:
        """Return twice the area [mm²] that the line sweeps about the origin; negative if clockwise."""
        (a, b), (c, d) = self.start, self.end
        return a * d - b * c

    def mirrored(self) -> Line:
        """Return the mirror image in x = 0, in the opposite direction."""
        return Line(_mirrored(self.end), _mirrored(self.start))

    def edge(self, z: float) -> Edge:
        """Return the edge at a level of z."""
        return segment(Vector(*self.start, z), Vector(*self.end, z))


@dataclass(frozen=True)
class Arc:
    """An arc of less than a full turn about a centre, from start to end."""

    start: Point
    end: Point
    centre: Point
    is_left: bool  # whether it turns to the left, counter-clockwise

    @property
    def turn(self) -> float:
        """Return the angle about the centre [rad], negative if clockwise."""
        (x, y), (a, b), (c, d) = self.centre, self.start, self.end
        turn = (atan2(d - y, c - x) - atan2(b - y, a - x)) % (2 * pi)
        return turn if self.is_left else turn - 2 * pi

    @property
    def radius(self) -> float:
        """Return the radius [mm]."""
        return hypot(self.start[0] - self.centre[0], self.start[1] - self.centre[1])

    @property
    def middle(self) -> Point:
        """Return the point halfway."""
        (x, y), (a, b) = self.centre, self.start
        angle = atan2(b - y, a - x) + self.turn / 2
        return x + self.radius * cos(angle), y + self.radius * sin(angle)

    @property
    def swept(self) -> float:
        """Return twice the area [mm²] that the arc sweeps about the origin; negative if clockwise."""
        (x, y), (a, b), (c, d) = self.centre, self.start, self.end
        return self.radius**2 * self.turn + x * (d - b) - y * (c - a)

    def mirrored(self) -> Arc:
        """Return the mirror image in x = 0, in the opposite direction."""
        return Arc(_mirrored(self.end), _mirrored(self.start), _mirrored(self.centre), self.is_left)

    def edge(self, z: float) -> Edge:
        """Return the edge at a level of z."""
        return Edge.makeThreePointArc(*(Vector(*point, z) for point in (self.start, self.middle, self.end)))


Run = Line | Arc


@dataclass(frozen=True)
class Contour:
    """A closed contour, counter-clockwise."""

    runs: Sequence[Run]

    @staticmethod
    def symmetric(right: Sequence[Run]) -> Contour:
        """Return the contour of the runs on the side +x and of their mirror images in x = 0.

        The first run starts on x = 0 and the last ends there; each becomes one run across x = 0.
        """
        first, *sides, last = right
        across = replace(first, start=_mirrored(first.end)), replace(last, end=_mirrored(last.start))
        return Contour([across[0], *sides, across[1], *(run.mirrored() for run in reversed(sides))])

    @property
    def area(self) -> float:
        """Return the area inside [mm²], by Green's theorem."""
        return sum(run.swept for run in self.runs) / 2

    def prism(self, low: float, high: float) -> Shape:
        """Return the solid between two levels of z."""
        edges = (run.edge(low) for run in self.runs if _length(run) > _NOTHING)
        return extrude(face(wire(*edges)), (0, 0, high - low))


def _length(run: Run) -> float:
    return hypot(run.end[0] - run.start[0], run.end[1] - run.start[1])


def _mirrored(point: Point) -> Point:
    return 0.0 - point[0], point[1]
