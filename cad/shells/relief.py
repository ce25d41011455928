"""Joint relief: near the joint the bore is a circle about a slightly offset axis, so it opens gradually.

The circle meets the joint at the bore's radius and the depth of the relief, and the bore at the relief's
height above the joint. Its axis lies on the plane of the joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, asin, atan2, cos, sin, sqrt

from cad.revolution import sheet_under_arc


@dataclass(frozen=True)
class Relief:
    """Sizes of a relief [mm]: radius of the bore, height above the joint, depth at the joint."""

    bore: float
    height: float
    depth: float

    @property
    def angle(self) -> float:
        """Return the angle from the joint to the end of the relief [rad]."""
        return asin(self.height / self.bore)

    @property
    def axis(self) -> float:
        """Return the distance of the relief's axis from that of the bore, towards the joint."""
        fall = self.height**2 / (self.bore + sqrt(self.bore**2 - self.height**2))  # sagitta of the bore's arc
        return self.depth * (2 * self.bore + self.depth) / (2 * (self.depth + fall))

    @property
    def radius(self) -> float:
        """Return the radius of the relief's circle."""
        return self.bore + self.depth - self.axis

    def arc(self) -> list[tuple[float, float]]:
        """Return the start, middle and end of the arc, as radius and angle [rad] from the joint."""
        foot = sqrt(self.bore**2 - self.height**2)
        half = atan2(self.height, foot - self.axis) / 2
        x, y = self.axis + self.radius * cos(half), self.radius * sin(half)
        return [(self.bore + self.depth, 0.0), (sqrt(x * x + y * y), atan2(y, x)), (self.bore, self.angle)]

    def area(self) -> float:
        """Return the area that the relief removes from the cross-section of the wall [mm²]."""
        circle, bore = (sheet_under_arc(r, self.height) / 2 for r in (self.radius, self.bore))
        return self.axis * self.height + circle - bore

    def angle_at(self, radius: float) -> float:
        """Return the angle [rad] about the bore, from the joint, at which the arc has a given radius."""
        c, rho = self.axis, self.radius
        cosine = ((radius - rho) * (radius + rho) + c * c) / (2 * radius * c)
        return acos(min(1.0, max(-1.0, cosine)))


def read_relief(bore: float, axis: float, radius: float) -> tuple[float, float]:
    """Return the height and depth [mm] of a relief, from the bore's radius and the relief's circle."""
    depth = axis + radius - bore
    fall = depth * (2 * bore + depth) / (2 * axis) - depth  # inverts `Relief.axis`
    return sqrt(fall * (2 * bore - fall)), depth
