"""Sizes of a half shell, read from the surfaces of its back and its lining."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import asin, degrees, hypot, pi

from cad.revolution import nearest
from cad.shells.half_shell import HalfShell
from cad.shells.relief import read_relief
from cad.surfaces import PartSurfaces, Surface, Y, Z

_SAME = 1e-6  # [mm]


@dataclass(frozen=True)
class ShellReadback:
    """Back and lining of one shell, and what it should be: of equal sizes the nearer one is meant.

    Without a lining the back stands for it.
    """

    back: PartSurfaces
    lining: PartSurfaces
    wanted: HalfShell

    def sizes(self, *, with_oil: bool, side: int) -> dict[str, float]:
        """Every parameter by name; `side` is 1 of an upper shell, -1 of a lower one, 0 of a full bush."""
        joint = self.back.levels(Y)[0 if side > 0 else -1] if side else 0.0
        return {
            "inner_diameter": 2 * self.bore,
            "wall": self.wall,
            "width": self.width(),
            "lining_thickness": self.lining_wall,
            "crush_height": -side * joint + 0.0,
            **self.chamfers(),
            **self.relief(),
            **self.tang(),
            **self.flange(),
            **(self.groove() if with_oil else {}),
        }

    @property
    def bore(self) -> float:
        """Return the radius [mm]."""
        return self.lining.diameters(Z)[0] / 2

    @property
    def wall(self) -> float:
        """Return the back and lining [mm]."""
        return self.outside - self.bore

    @property
    def outside(self) -> float:
        """Return the radius of the back [mm]; a flange is larger."""
        diameters = self.back.diameters(Z)
        return diameters[-2 if self.wanted.flange else -1] / 2

    @property
    def lining_wall(self) -> float:
        """Return the thickness of the lining [mm]; 0 if there is none."""
        return self.lining.diameters(Z)[-1] / 2 - self.bore if self.wanted.is_lined else 0.0

    @property
    def groove_turn(self) -> float:
        """Return the angle of the groove [rad] from end to end; half a turn from joint to joint."""
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
        """Return the chamfers of the bore, and of the back where it has no flange."""
        half = self.width() / 2
        bore = self._highest(self.lining, self.bore)
        flange = self.wanted.flange
        sizes = {"inner_chamfer": half - bore}
        if flange is None or flange.count == 1:
            reaches = [c.reach[0] for c in self.back.about(Z) if abs(c.diameter / 2 - self.outside) < _SAME]
            sizes["outer_chamfer"] = half + min(reaches)
        return sizes

    def _highest(self, seen: PartSurfaces, radius: float) -> float:
        return max(c.reach[1] for c in seen.about(Z) if abs(c.diameter / 2 - radius) < _SAME)

    def relief(self) -> dict[str, float]:
        """Return the height and depth of the joint relief."""
        circles = [c for c in self.lining.cylinders if c.along(Z) and not c.about(Z)]
        if not circles:
            return {"relief_depth": 0.0}
        one = circles[0]
        height, depth = read_relief(self.bore, hypot(one.point.x, one.point.y), one.diameter / 2)
        return {"relief_height": height, "relief_depth": depth}

    def groove(self) -> dict[str, float]:
        """Return the width, depth and turn of the oil groove, and the diameter of the oil hole."""
        holes = [c.diameter for c in self.back.cylinders if c.about(Y)]
        sizes = {"oil_hole_diameter": holes[0] if holes else 0.0}
        groove = self.wanted.groove
        if groove is None:
            return sizes
        levels, half = self.lining.levels(Z), groove.half_width
        width = 2 * levels[0] if self.wanted.is_split else nearest(levels, half) - nearest(levels, -half)
        return {
            **sizes,
            "oil_groove_width": width,
            "oil_groove_depth": self._groove_bottom() - self.bore,
            "oil_groove_angle": degrees(self.groove_turn),
        }

    def _groove_bottom(self) -> float:
        lining = self.lining.diameters(Z)
        deep: Sequence[float] = self.back.diameters(Z)
        return lining[1] / 2 if len(lining) == 3 else deep[1] / 2

    def tang(self) -> dict[str, float]:
        """Return the lip at the back."""
        tang = self.wanted.tang
        if tang is None:
            return {"tang_width": 0.0}
        levels, upright = self.back.levels(Z), [p for p in self.back.planes if not p.along(Z)]
        away = [abs(p.point.dot(p.direction)) for p in upright]
        low, high = (nearest(levels, tang.z + side * tang.width / 2) for side in (-1, 1))
        return {
            "tang_width": high - low,
            "tang_length": nearest(away, tang.length),
            "tang_height": nearest(away, self.wanted.outside + tang.height) - self.outside,
        }

    def flange(self) -> dict[str, float]:
        """Return the collars."""
        flange = self.wanted.flange
        if flange is None:
            return {"flange_diameter": 0.0}
        half = self.width() / 2
        inner = half - flange.thickness
        shoulders = [z for z in self.back.levels(Z) if abs(abs(z) - inner) < 1e-4]
        return {
            "flange_diameter": self.back.diameters(Z)[-1],
            "flange_thickness": half - max(shoulders),
            "flanges": float(len(shoulders)),
        }


def _from_crown(plane: Surface) -> float:
    """Return the angle [rad] of a plane that holds the shaft's axis, against the plane of crown and shaft."""
    return asin(min(1.0, abs(plane.direction.dot(Y))))
