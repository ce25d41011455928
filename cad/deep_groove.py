"""Deep groove ball bearings: sizes by designation, the cage, and load ratings.

References
----------
ISO 15:2017, Rolling bearings, radial bearings, boundary dimensions, general plan.
ISO 281:2007, Rolling bearings, dynamic load ratings and rating life, 5.1.1 and table 2.
ISO 76:2006, Rolling bearings, static load ratings, 5.1 and table 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, cos, degrees, pi, sin
from pathlib import Path

import numpy as np
from cadquery import Shape, Solid, Vector

from cad.revolution import drilled_volume, outline, turned
from templates.core.language.template import Array, units

_MODELS = Path(__file__).with_name("models")


def _table(name: str) -> np.ndarray:
    return np.genfromtxt(
        _MODELS / name, skip_header=2, delimiter=",", names=True, dtype=None, encoding="utf-8"
    )


SIZES: dict[str, tuple[float, float, float]] = {
    str(row["designation"]): (float(row["inner_diameter"]), float(row["outer_diameter"]), float(row["width"]))
    for name in ("deep_groove_sizes_618.csv", "deep_groove_sizes.csv")
    for row in _table(name)
}
"""Bore, outer diameter and width [mm] by designation."""
RATIOS = np.arange(0.01, 0.405, 0.01)
"""Ball diameter over pitch diameter, in the rows of both tables."""
DYNAMIC = np.array([
    29.1, 35.8, 40.3, 43.8, 46.7, 49.1, 51.1, 52.8, 54.3, 55.5,
    56.6, 57.5, 58.2, 58.8, 59.3, 59.6, 59.8, 59.9, 60.0, 59.9,
    59.8, 59.6, 59.3, 59.0, 58.6, 58.2, 57.7, 57.1, 56.6, 56.0,
    55.3, 54.6, 53.9, 53.2, 52.4, 51.7, 50.9, 50.0, 49.2, 48.4,
])  # fmt: skip
"""f_c of ISO 281, table 2, single-row radial contact, grooves of at most 0.52 of the ball's diameter."""
STATIC = np.array([
    14.9, 15.1, 15.3, 15.5, 15.7, 15.9, 16.1, 16.3, 16.5, 16.4,
    16.1, 15.9, 15.6, 15.4, 15.2, 14.9, 14.7, 14.4, 14.2, 14.0,
    13.7, 13.5, 13.2, 13.0, 12.8, 12.5, 12.3, 12.1, 11.8, 11.6,
    11.4, 11.2, 10.9, 10.7, 10.5, 10.3, 10.0, 9.8, 9.6, 9.4,
])  # fmt: skip
"""f_0 of ISO 76, table 1, radial contact groove ball bearings."""
MATERIAL = 1.3  # b_m of ISO 281, table 1: contemporary, commonly used steel
LARGE_BALL = 25.4  # [mm], diameter from which capacity grows with the power 1.4 instead of 1.8


@units(None, returns="m")
def bore_by_designation(designation: str) -> Array:
    """Return the bore [m] of a designation by ISO 15."""
    return np.asarray(SIZES[designation][0] / 1e3)


@units(None, returns="m")
def outside_by_designation(designation: str) -> Array:
    """Return the outer diameter [m] of a designation by ISO 15."""
    return np.asarray(SIZES[designation][1] / 1e3)


@units(None, returns="m")
def width_by_designation(designation: str) -> Array:
    """Return the width [m] of a designation by ISO 15."""
    return np.asarray(SIZES[designation][2] / 1e3)


@units("m", "m", "1", returns="N")
def dynamic_capacity_ISO_281_2007(D_w: Array, D_pw: Array, Z: Array) -> Array:
    """Return the dynamic load rating C = b_m f_c Z^(2/3) D_w^1.8 [N], with D_w in mm.

    For balls above 25.4 mm it is C = b_m f_c Z^(2/3) 3.647 D_w^1.4.
    """
    ball = np.asarray(D_w) * 1e3
    size = np.where(ball <= LARGE_BALL, ball**1.8, 3.647 * ball**1.4)
    factor: Array = np.interp(D_w / D_pw, RATIOS, DYNAMIC)
    return MATERIAL * factor * Z ** (2 / 3) * size


@units("m", "m", returns="1")
def static_factor_ISO_76_2006(D_w: Array, D_pw: Array) -> Array:
    """Return the factor f_0 [1], interpolated linearly between the rows of the table."""
    factor: Array = np.interp(D_w / D_pw, RATIOS, STATIC)
    return factor


@units("1", "1", "m", returns="N")
def static_capacity_ISO_76_2006(f_0: Array, Z: Array, D_w: Array) -> Array:
    """Return the static load rating C0 = f_0 Z D_w² [N], with D_w in mm."""
    return f_0 * Z * (np.asarray(D_w) * 1e3) ** 2


@dataclass(frozen=True)
class Cage:
    """A cage [mm]: a ring about the pitch circle with a round pocket for each ball."""

    pitch_radius: float
    thickness: float
    width: float
    pocket: float  # radius
    balls: int

    @property
    def inside(self) -> float:
        """Return the inner radius of the cage."""
        return self.pitch_radius - self.thickness / 2

    @property
    def outside(self) -> float:
        """Return the outer radius of the cage."""
        return self.pitch_radius + self.thickness / 2

    def solid(self) -> Shape:
        """Return the ring minus its pockets; the seam of the ring lies between two pockets."""
        b, half_pitch = self.width / 2, degrees(pi / self.balls)
        section = outline((self.inside, -b), (self.outside, -b), (self.outside, b), (self.inside, b))
        ring = turned(section, half_pitch)
        return ring.cut(*(self._drill(2 * pi * i / self.balls) for i in range(self.balls)))

    def _drill(self, angle: float) -> Shape:
        along = Vector(cos(angle), sin(angle), 0)
        reach = self.inside * cos(asin(self.pocket / self.inside))  # where the pocket's sides meet the bore
        start = 0.5 * reach
        return Solid.makeCylinder(self.pocket, 1.1 * self.outside - start, along * start, along)

    def volume(self) -> float:
        """Return the volume of the ring minus that of its pockets [mm³]."""
        ring = pi * (self.outside**2 - self.inside**2) * self.width
        return ring - self.balls * drilled_volume(self.pocket, self.outside, self.inside)
