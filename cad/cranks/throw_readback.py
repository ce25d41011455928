"""Read the parameters of a crank back from the surfaces of the finished solid.

Each feature is recognised by its position, not by its expected size: planes across the shaft are the faces of
webs, coaxial cylinders beyond the webs are journals and ends, and another cylinder parallel to the shaft is
the pin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, degrees

from cadquery import Vector

from cad.surfaces import PartSurfaces, Place, Size, Surface, X, Y, Z, faces_of

_CLEAR = 1e-6  # [mm], also used as the sine of an angle


@dataclass(frozen=True)
class ThrowReadback:
    """A throw: its pins, and the positions of its web faces [mm], from front to rear.

    An undivided pin counts once; split pins count as two, with a middle web between them.
    """

    pins: tuple[Surface, ...]
    faces: tuple[float, ...]

    @property
    def angles(self) -> tuple[float, float]:
        """Return the angles of the pins next to the front and rear web, from x towards y [rad]."""
        first, last = (atan2(pin.point.y, pin.point.x) for pin in (self.pins[0], self.pins[-1]))
        return first, last

    @property
    def pin_spans(self) -> list[tuple[float, float]]:
        """Return the start and end of the pins, including their fillets."""
        return [(self.faces[at], self.faces[at + 1]) for at in range(1, len(self.faces) - 1, 2)]

    @property
    def webs(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the start and end of the webs, without the middle web."""
        return self.faces[:2], self.faces[-2:]


@dataclass(frozen=True)
class Webs:
    """Positions of the faces of both webs along the shaft [mm], from front to rear."""

    faces: tuple[float, float, float, float]

    @staticmethod
    def of(seen: PartSurfaces) -> Webs:
        """Return the two planes across the shaft next to mid-pin, on either side."""
        levels = seen.levels(Z)
        front, rear = [z for z in levels if z < 0], [z for z in levels if z > 0]
        return Webs((front[-2], front[-1], rear[0], rear[1]))

    def thickness(self, seen: PartSurfaces) -> float:
        """Return the thickness of the webs [mm]."""
        outer, inner, other_inner, other_outer = self.faces
        webs = seen.apart(Z, outer, inner), seen.apart(Z, other_inner, other_outer)
        return Size.repeated(webs, "webs")

    def apart(self, seen: PartSurfaces) -> float:
        """Return the distance between the two webs [mm]."""
        return seen.apart(Z, self.faces[1], self.faces[2])


def pin(seen: PartSurfaces, webs: Webs) -> dict[str, float]:
    """Return the pin diameter, the pin bore and the throw, from the cylinders between the webs."""
    _, front, rear, _ = webs.faces
    beside = [c.turned(Z) for c in seen.cylinders if c.along(Z) and not c.about(Z)]
    within = [c for c in beside if front - _CLEAR < c.reach[0] and c.reach[1] < rear + _CLEAR]
    bores = [c for c in beside if c.reach[0] < front - _CLEAR and rear + _CLEAR < c.reach[1]]
    if not within:
        raise LookupError("the file has no pin between the webs")
    journals = [cylinder for stub in stubs(seen, webs) for cylinder in stub[:1]]
    return {
        "pin_diameter": Size.diameter(within),
        "pin_bore": Size.diameter(bores) if bores else 0.0,
        "throw": Size.distance(within[0].point.cross(Z).Length, journals, within),
    }


def stubs(seen: PartSurfaces, webs: Webs) -> tuple[list[Surface], list[Surface]]:
    """Return the coaxial cylinders at the front and at the rear, starting at the web."""
    behind = [c for c in seen.about(Z) if c.reach[0] > webs.faces[3] - _CLEAR]
    before = [c.turned(-Z) for c in seen.about(Z) if c.reach[1] < webs.faces[0] + _CLEAR]
    return sorted(before, key=_start), sorted(behind, key=_start)


def journal_bore(seen: PartSurfaces, webs: Webs) -> float:
    """Return the diameter of the coaxial cylinder that continues through the web.

    The result is 0 if there is none.
    """
    low, high = webs.faces[3] - _CLEAR, webs.faces[3] + _CLEAR
    through = [c for c in seen.about(Z) if c.reach[0] < low and high < c.reach[1]]
    return Size.diameter(through) if through else 0.0


def counterweight(seen: PartSurfaces, webs: Webs) -> dict[str, float]:
    """Return the radius of the counterweight, and its angle [deg] if there is one."""
    width = seen.length(Y)
    spans = webs.faces[:2], webs.faces[2:]
    within = [c for c in seen.about(Z) if any(_lies_within(c, span) for span in spans)]
    rims = [c for c in within if c.diameter > 1.01 * width]
    if not rims:
        return {"counterweight_radius": 0.0}
    flanks = [p for p in seen.planes if p.holds(Z)]
    flank = flanks[0].direction
    angle = 2 * degrees(atan2(abs(flank.x), abs(flank.y)))
    sides = [p for p in flanks if p.along(flank)], [p for p in flanks if not p.along(flank)]
    between = Size(angle, "angle", Place(faces_of(sides[0]), faces_of(sides[1])))
    return {"counterweight_radius": Size.radius(rims), "counterweight_angle": between}


def fillet(seen: PartSurfaces) -> float:
    """Return the common radius of the fillets; 0 if there are none.

    Raises
    ------
    LookupError
        If there are fillets, but not four equal ones.
    """
    if seen.tori and len(seen.tori) != 4:
        raise LookupError(f"a throw must have four fillets; the file has {len(seen.tori)}")
    return Size.radius(seen.tori) if seen.tori else 0.0


def drilling(seen: PartSurfaces) -> float:
    """Return the diameter of the oblique cylinder; 0 if there is none."""
    askew = [c for c in seen.cylinders if not c.along(Z)]
    return Size.diameter(askew) if askew else 0.0


def inclination(seen: PartSurfaces) -> float:
    """Return the angle [deg] of the planes inclined to the shaft; 0 if there are none."""
    leaning = [p for p in seen.planes if _askew(p.direction)]
    if not leaning:
        return 0.0
    slopes = (degrees(atan2(abs(p.direction.x), abs(p.direction.z))) for p in leaning)
    return Size(max(slopes), "angle", Place(faces_of(leaning)))


def _lies_within(cylinder: Surface, span: Sequence[float]) -> bool:
    low, high = span
    return low - _CLEAR < cylinder.reach[0] and cylinder.reach[1] < high + _CLEAR


def _askew(normal: Vector) -> bool:
    return bool(min(abs(normal.dot(X)), abs(normal.dot(Z))) > _CLEAR)


def _start(cylinder: Surface) -> float:
    return cylinder.reach[0]
