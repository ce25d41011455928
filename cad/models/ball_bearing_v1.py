"""Single-row deep groove ball bearing: two rings and their balls, with standard boundary dimensions.

Use it for main and big-end bearings of small engines, and as a placeholder for a bought part in an assembly.
At a standard bore the default outer diameter and width are those of dimension series 02 of ISO 15 (50 mm:
6210, 90 × 20). Between standard bores they are interpolated; beyond the table they keep the proportions of
its ends. The standard leaves the internal geometry to the maker: balls, grooves and chamfers have proportions
that are common among makers, suitable for appearance, mass and clearances, but not for a life calculation.
There is no cage.

References
----------
ISO 15:2017, Rolling bearings, radial bearings, boundary dimensions, general plan.
Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed. 2006, ch. 2: osculation, pitch
    diameter.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from pathlib import Path

import numpy as np

from cad.ball_row import BallRow
from cad.model import Part, mm
from cad.surfaces import PartSurfaces, Size, Z
from templates.core.language.template import Array, derived, formula, given, units

SIZES = np.genfromtxt(
    Path(__file__).with_name("deep_groove_sizes.csv"),
    skip_header=2, delimiter=",", names=True, dtype=None, encoding="utf-8",
)  # fmt: skip
SERIES_02 = SIZES[SIZES["series"] == 62]


@units("m", returns="m")
def standard_outer_diameter(bore: Array) -> Array:
    """Return the outer diameter [m] for a bore [m], ISO 15, dimension series 02."""
    return _standard("outer_diameter", bore)


@units("m", returns="m")
def standard_width(bore: Array) -> Array:
    """Return the width [m] for a bore [m], ISO 15, dimension series 02."""
    return _standard("width", bore)


def _standard(column: str, bore: Array) -> Array:
    """Return a dimension, interpolated within the table and proportional to the bore beyond it."""
    bores = SERIES_02["inner_diameter"] / 1e3
    nearest = np.clip(bore, bores[0], bores[-1])
    return np.interp(nearest, bores, SERIES_02[column] / 1e3) * (bore / nearest)


class BallBearing(BallRow):
    """Deep groove ball bearing with standard outer dimensions at a standard bore, or of any other size."""

    example = {"inner_diameter": "50 mm"}
    toleranced = {
        "inner_diameter": {"datum": "A", "cylindricity": 0.5},
        "outer_diameter": {"cylindricity": 0.5},
        "width": {"perpendicularity": 1, "to": "A"},
        "ball_diameter": {},
    }

    d: Array = given(
        "mm", "inner diameter", symbol="d", ge=1, le=2000, also=("bearing diameter", "bore", "shaft diameter")
    )

    @derived("mm", "outer diameter", symbol="D", ge=1, le=5000, source="ISO 15, dimension series 02")
    def D(self) -> Array:
        return standard_outer_diameter(self.d)

    @derived(
        "mm",
        "width",
        symbol="B",
        ge=0.1,
        le=2000,
        also=("bearing width",),
        source="ISO 15, dimension series 02",
    )
    def B(self) -> Array:
        return standard_width(self.d)

    @derived("mm", "ball diameter", symbol="D_w", ge=0.003, le=1000)
    def D_w(self) -> Array:
        return np.minimum(np.maximum(0.3 * (self.D - self.d), 0.004 * self.d), 0.9 * self.B)

    @derived("1", "balls", symbol="Z", integer=True, ge=3, le=200)
    def n(self) -> Array:
        return np.clip(np.round(0.58 * pi * self.D_pw / self.D_w), 3, 200)

    @formula("mm", "shoulder height over the ball's centre", name="shoulder", symbol="s")
    def s(self) -> Array:
        return 0.3 * self.D_w

    @formula("mm", "chamfer", symbol="r_s")
    def c(self) -> Array:
        return 0.05 * np.minimum(self.h, self.B)

    def build(self) -> tuple[Part, ...]:
        """Return two rings and the balls."""
        return self.rings_and_balls(self.ring(mm(self.s), mm(self.c)))

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
        """Return every parameter, as the parts show it."""
        inner, outer, ball = seen["inner_ring"], seen["outer_ring"], seen["ball"]
        return {
            "inner_diameter": inner.diameters(Z)[0],
            "outer_diameter": outer.diameters(Z)[-1],
            "width": inner.length(Z),
            "balls": ball.count,
            "ball_diameter": Size.sphere(ball.spheres),
        }
