"""Read the parameters of a crank back from the surfaces of the finished solid.

Each feature is recognised by its position, not by its expected size: planes across the shaft are the faces of
webs, cylinders about the shaft beyond the webs are journals and ends, another cylinder along it is the pin.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees

from cadquery import Vector

from cad.surfaces import PartSurfaces, Surface, X, Y, Z

_CLEAR = 1e-6  # [mm], and as the sine of an angle


@dataclass(frozen=True)
class Webs:
    """Where the faces of both webs lie along the shaft [mm], from front to rear."""

    faces: tuple[float, float, float, float]

    @staticmethod
    def of(seen: PartSurfaces) -> Webs:
        """Return the two planes across the shaft next to mid-pin, on either side."""
        levels = seen.levels(Z)
        front, rear = [z for z in levels if z < 0], [z for z in levels if z > 0]
        return Webs((front[-2], front[-1], rear[0], rear[1]))

    @property
    def thickness(self) -> float:
        """Return the thickness of a web [mm]."""
        outer, inner, other_inner, other_outer = self.faces
        return (inner - outer + other_outer - other_inner) / 2

    @property
    def apart(self) -> float:
        """Return the distance between the webs [mm]."""
        return self.faces[2] - self.faces[1]


def pin(seen: PartSurfaces, webs: Webs) -> dict[str, float]:
    """Return the pin diameter, bore and throw; the pin stands between the webs."""
    _, front, rear, _ = webs.faces
    beside = [c.turned(Z) for c in seen.cylinders if c.along(Z) and not c.about(Z)]
    pin_surface = next(c for c in beside if front - _CLEAR < c.reach[0] and c.reach[1] < rear + _CLEAR)
    bores = [c.diameter for c in beside if c.reach[0] < front - _CLEAR and rear + _CLEAR < c.reach[1]]
    throw = pin_surface.point.cross(Z).Length
    return {"pin_diameter": pin_surface.diameter, "pin_bore": max(bores, default=0.0), "throw": throw}


def stubs(seen: PartSurfaces, webs: Webs) -> tuple[list[Surface], list[Surface]]:
    """Return the cylinders about the shaft on the webs at the front and at the rear, from the web on."""
    behind = [c for c in seen.about(Z) if c.reach[0] > webs.faces[3] - _CLEAR]
    before = [c.turned(-Z) for c in seen.about(Z) if c.reach[1] < webs.faces[0] + _CLEAR]
    return sorted(before, key=_start), sorted(behind, key=_start)


def journal_bore(seen: PartSurfaces, webs: Webs) -> float:
    """Return the diameter of the cylinder about the shaft that continues through the web.

    Return 0 if there is none.
    """
    low, high = webs.faces[3] - _CLEAR, webs.faces[3] + _CLEAR
    through = (c.diameter for c in seen.about(Z) if c.reach[0] < low and high < c.reach[1])
    return max(through, default=0.0)


def counterweight(seen: PartSurfaces, webs: Webs) -> dict[str, float]:
    """Return its radius, and its angle [deg] if there is one: as thick as the web, and wider than it is."""
    _, _, inner, outer = webs.faces
    within = (c for c in seen.about(Z) if inner - _CLEAR < c.reach[0] and c.reach[1] < outer + _CLEAR)
    standing_out = [c.diameter for c in within if c.diameter > 1.01 * seen.length(Y)]
    if not standing_out:
        return {"counterweight_radius": 0.0}
    flank = next(p.direction for p in seen.planes if p.holds(Z))
    angle = 2 * degrees(atan2(abs(flank.x), abs(flank.y)))
    return {"counterweight_radius": max(standing_out) / 2, "counterweight_angle": angle}


def fillet(seen: PartSurfaces) -> float:
    """Return the radius of the fillets, all of which are alike; 0 if there are none.

    Raises
    ------
    LookupError
        If there are any, but not four that are alike.
    """
    radii = seen.tori
    if not radii:
        return 0.0
    if len(radii) != 4 or max(radii) - min(radii) > _CLEAR:
        raise LookupError(f"the four fillets must have one radius; the file has {radii}")
    return radii[0]


def drilling(seen: PartSurfaces) -> float:
    """Return the diameter of the cylinder that runs askew; 0 if there is none."""
    return max((c.diameter for c in seen.cylinders if not c.along(Z)), default=0.0)


def inclination(seen: PartSurfaces) -> float:
    """Return the angle [deg] of the planes that are inclined to the shaft; 0 if there are none."""
    slopes = (
        degrees(atan2(abs(p.direction.x), abs(p.direction.z))) for p in seen.planes if _askew(p.direction)
    )
    return max(slopes, default=0.0)


def _askew(normal: Vector) -> bool:
    return bool(min(abs(normal.dot(X)), abs(normal.dot(Z))) > _CLEAR)


def _start(cylinder: Surface) -> float:
    return cylinder.reach[0]
