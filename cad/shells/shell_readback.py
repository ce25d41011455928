"""Read the sizes of a half shell back from the surfaces of its back and its lining."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import asin, degrees, hypot, pi

from cad.revolution import nearest
from cad.shells.eccentric import reduction_at
from cad.shells.half_shell import HalfShell
from cad.shells.relief import read_relief
from cad.surfaces import PartSurfaces, Place, Size, Surface, Y, Z, faces_of

_SAME = 1e-6  # [mm]


@dataclass(frozen=True)
class ShellReadback:
    """Surfaces of back and lining of one shell, and its expected sizes.

    Candidates are chosen by the nearest size.

    Without a lining the surfaces of the back replace those of the lining.
    """

    back: PartSurfaces
    lining: PartSurfaces
    wanted: HalfShell

    def sizes(self, *, with_oil: bool, side: int) -> dict[str, float]:
        """Return every parameter by name.

        `side` is 1 for an upper shell, -1 for a lower one, 0 for a full bush.
        """
        joint = self.back.levels(Y)[0 if side > 0 else -1] if side else 0.0
        return {
            "inner_diameter": self.bore_diameter,
            "wall_reduction": self.reduction,
            "wall": self.wall,
            "width": self.back.length(Z),
            "lining_thickness": self.lining_wall,
            "crush_height": self._crush(side, joint),
            **self.chamfers(),
            **self.relief(),
            **self.tang(),
            **self.flange(),
            **(self.groove() if with_oil else {}),
        }

    def _crush(self, side: int, joint: float) -> float:
        """Return the distance of the joint from the axis of the shaft [mm]; 0 for a full bush."""
        if side == 0:
            return 0.0
        about = self.outside_ring if self.wanted.offset > 0 else self.bore_ring
        return Size.distance(-side * joint + 0.0, about, self.back.planes_at(Y, joint))

    @property
    def bore_ring(self) -> list[Surface]:
        """Return the faces of the bore."""
        if self.wanted.offset == 0:
            return self.lining.rings(Z)[0]
        return [one.turned(Z) for one in self.lining.cylinders if one.along(Z) and not one.about(Z)]

    @property
    def offset(self) -> float:
        """Return the distance between the axis of the bore and that of the shaft [mm]."""
        return abs(self.bore_ring[0].point.y) if self.wanted.offset > 0 else 0.0

    @property
    def bore_diameter(self) -> float:
        """Return the diameter of the bore at the crown; no face has it if the bore is eccentric."""
        return 2 * self.bore if self.wanted.offset > 0 else Size.diameter(self.bore_ring)

    @property
    def reduction(self) -> float:
        """Return the wall reduction at its height above the joint [mm]."""
        return float(reduction_at(self.bore, self.offset, self.wanted.reduction_height))

    def _thickness(self, outer: list[Surface]) -> float:
        """Return the wall between the bore at the crown and cylinders about the shaft."""
        return Size.distance(outer[0].diameter / 2 - self.bore, self.bore_ring, outer)

    @property
    def outside_ring(self) -> list[Surface]:
        """Return the faces of the outside of the back, without a flange."""
        return self.back.rings(Z)[-2 if self.wanted.flange else -1]

    @property
    def bore(self) -> float:
        """Return the radius of the bore [mm]."""
        return self.bore_ring[0].diameter / 2 - self.offset

    @property
    def wall(self) -> float:
        """Return the wall thickness of back and lining together [mm]."""
        return self._thickness(self.outside_ring)

    @property
    def outside(self) -> float:
        """Return the outer radius of the back [mm], without a flange."""
        return self.outside_ring[0].diameter / 2

    @property
    def lining_wall(self) -> float:
        """Return the thickness of the lining [mm]; 0 if there is none."""
        return self._thickness(self.lining.rings(Z)[-1]) if self.wanted.is_lined else 0.0

    @property
    def groove_turn(self) -> float:
        """Return the angle of the groove [rad] from end to end.

        It is half a turn if the groove runs from joint to joint.
        """
        groove = self.wanted.groove
        if groove is None or groove.is_whole:
            return pi
        return 2 * nearest((_from_crown(plane) for plane in self._radial()), groove.turn / 2)

    def _radial(self) -> list[Surface]:
        return [plane for plane in self.lining.planes if plane.holds(Z)]

    def width(self) -> float:
        """Return the length along the shaft [mm]."""
        return self.back.length(Z)

    def chamfers(self) -> dict[str, float]:
        """Return the chamfer of the bore, and that of the back if there is no flange."""
        half = self.width() / 2
        bore, outside = self.bore_ring, self.outside_ring
        flange = self.wanted.flange
        drop = self.wanted.eccentric.drop if self.wanted.inner_chamfer > 0 else 0.0
        sizes = {"inner_chamfer": self.lining.chamfer(half - max(c.reach[1] for c in bore) + drop, bore)}
        if flange is None or flange.count == 1:
            reach = min(c.reach[0] for c in outside)
            sizes["outer_chamfer"] = self.back.chamfer(half + reach, outside)
        return sizes

    def relief(self) -> dict[str, float]:
        """Return the height and depth of the joint relief."""
        circles = [c for c in self.lining.cylinders if c.along(Z) and not c.about(Z)]
        if not circles or self.wanted.offset > 0:
            return {"relief_depth": 0.0}
        one = circles[0]
        height, depth = read_relief(self.bore, hypot(one.point.x, one.point.y), one.diameter / 2)
        deep = Size.distance(depth, self.bore_ring, circles)
        edge = Size(height, "edge", Place(faces_of(self.bore_ring), faces_of(circles)))
        return {"relief_height": edge, "relief_depth": deep}

    def groove(self) -> dict[str, float]:
        """Return the width, depth and angle of the oil groove, and the diameter of the oil hole."""
        holes = [c for c in self.back.cylinders if c.about(Y)]
        sizes = {"oil_hole_diameter": Size.diameter(holes) if holes else 0.0}
        groove = self.wanted.groove
        if groove is None:
            return sizes
        return {
            **sizes,
            "oil_groove_width": self._groove_width(groove.half_width),
            "oil_groove_depth": self._thickness(self._groove_bottom()),
            "oil_groove_angle": self._groove_angle(),
        }

    def _groove_width(self, half: float) -> float:
        """Return the distance between the sides of the groove, on the back if it divides the lining."""
        levels = self.lining.levels(Z)
        if not self.wanted.is_split:
            return self.lining.apart(Z, nearest(levels, -half), nearest(levels, half))
        sides = self.back.levels(Z)
        return self.back.apart(Z, nearest(sides, -levels[0]), nearest(sides, levels[0]))

    def _groove_angle(self) -> float:
        """Return the angle [deg] between the ends of the groove, which are planes through the axis."""
        angle = degrees(self.groove_turn)
        ends = [p for p in self._radial() if abs(_from_crown(p) - self.groove_turn / 2) < _SAME]
        right, left = ([p for p in ends if _side(p) == side] for side in (1, -1))
        return Size(angle, "angle", Place(faces_of(right), faces_of(left))) if right and left else angle

    def _groove_bottom(self) -> list[Surface]:
        lining = self.lining.rings(Z)
        inner = 1 if self.wanted.offset == 0 else 0  # an eccentric bore is not about the shaft
        return lining[inner] if len(lining) == inner + 2 else self.back.rings(Z)[1]

    def tang(self) -> dict[str, float]:
        """Return the sizes of the locating lip on the back."""
        tang = self.wanted.tang
        if tang is None:
            return {"tang_width": 0.0}
        levels, upright = self.back.levels(Z), [p for p in self.back.planes if not p.along(Z)]
        low, high = (nearest(levels, tang.z + side * tang.width / 2) for side in (-1, 1))
        end, height = tang.length, self.wanted.outside + tang.height
        lip = [p for p in upright if p.middle is not None and hypot(p.middle.x, p.middle.y) > self.outside]
        crown = sum(p.middle.y for p in upright if p.middle is not None)
        above = [p for p in lip if p.middle is not None and p.middle.y * crown > 0]
        length, top = _nearest_planes(above, end), _nearest_planes(lip, height)
        joint = _nearest_planes(upright, 0.0)
        return {
            "tang_width": self.back.apart(Z, low, high),
            "tang_length": Size.distance(off_axis(length[0]), joint, length),
            "tang_height": Size.distance(off_axis(top[0]) - self.outside, self.outside_ring, top),
        }

    def flange(self) -> dict[str, float]:
        """Return the sizes of the flanges."""
        flange = self.wanted.flange
        if flange is None:
            return {"flange_diameter": 0.0}
        half = self.width() / 2
        inner = half - flange.thickness
        shoulders = [z for z in self.back.levels(Z) if abs(abs(z) - inner) < 1e-4]
        return {
            "flange_diameter": self.back.diameters(Z)[-1],
            "flange_thickness": self.back.apart(Z, max(shoulders), half),
            "flanges": float(len(shoulders)),
        }


def _nearest_planes(planes: Sequence[Surface], away: float) -> list[Surface]:
    """Return the planes along the shaft whose distance from its axis is nearest to a given distance [mm]."""
    distance = nearest(map(off_axis, planes), away)
    return [plane for plane in planes if abs(off_axis(plane) - distance) < _SAME]


def off_axis(plane: Surface) -> float:
    """Return the distance [mm] between the axis of the shaft and a plane parallel to it."""
    return abs(plane.point.dot(plane.direction))


def _side(plane: Surface) -> int:
    """Return 1 if a plane through the axis of the shaft rises to the right of the crown, else -1."""
    arm = plane.direction.cross(Z)
    return 1 if (arm.x > 0) == (arm.y > 0) else -1


def _from_crown(plane: Surface) -> float:
    """Return the angle [rad] between a plane through the shaft's axis and the plane of crown and shaft."""
    return asin(min(1.0, abs(plane.direction.dot(Y))))
