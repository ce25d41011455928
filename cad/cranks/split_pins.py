"""Split pins of a throw: two pins at an angle, and the middle web between them [mm]."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, pi, sin

from cadquery import Shape, Solid, Vector
from cadquery.func import wire

from cad.cranks.outline import Run, edge


@dataclass(frozen=True)
class SplitPins:
    """Two split pins: the rear pin is at an angle [rad] from the front pin, and the middle web joins them.

    The outline of the middle web is two half circles about the pins, joined by two lines.
    """

    angle: float
    thickness: float  # of the middle web
    half_width: float  # of the middle web

    def apart(self, throw: float) -> float:
        """Return the distance between the axes of the two pins."""
        return 2 * throw * abs(sin(self.angle / 2))

    def volume(self, throw: float) -> float:
        """Return the volume of the middle web [mm³]."""
        return (pi * self.half_width**2 + 2 * self.half_width * self.apart(throw)) * self.thickness

    def web(self, front: float, low: float, throw: float) -> Shape:
        """Return the middle web between a pin at an angle [rad] and the next one, begun at a level of z."""
        rear = front + self.angle
        x, y = (throw / 2 * (f(front) + f(rear)) for f in (cos, sin))
        along = atan2(sin(rear) - sin(front), cos(rear) - cos(front))
        reach, h = self.apart(throw) / 2, self.half_width
        ends: list[Run] = [
            ((reach, -h), (reach + h, 0.0), (reach, h)),
            ((reach, h), (-reach, h)),
            ((-reach, h), (-reach - h, 0.0), (-reach, -h)),
            ((-reach, -h), (reach, -h)),
        ]
        plate = Solid.extrudeLinear(wire(*(edge(run, 0.0) for run in ends)), [], Vector(0, 0, self.thickness))
        turned = plate.rotate(Vector(0, 0, 0), Vector(0, 0, 1), degrees(along))
        return turned.translate(Vector(x, y, low))
