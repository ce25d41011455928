"""Solids revolved from a polygon, holes drilled through their walls, and the closed forms of both volumes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import acos, asin, cos, pi, radians, sin, sqrt

from cadquery import Shape, Solid, Vector
from cadquery.func import face, polyline, revolve
from scipy.integrate import quad

Point = tuple[float, float]


def outline(*corners: Point) -> list[Point]:
    """Return the closed line through corners (r, z) [mm]; coincident corners count once."""
    points: list[Point] = []
    for corner in corners:
        if not points or corner != points[-1]:
            points.append(corner)
    return points if points[0] == points[-1] else [*points, points[0]]


def turned(points: Sequence[Point], start: float = 270.0, turn: float = 360.0) -> Shape:
    """Return a closed line (r, z) revolved about z through an angle [deg], from an angle [deg] off +x.

    A full turn begins at -y, so that its seam is away from a hole at the crown.
    """
    across, up = cos(radians(start)), sin(radians(start))
    if start % 90 == 0:
        across, up = float(round(across)), float(round(up))
    line = polyline(*(Vector(r * across, r * up, z) for r, z in points))
    return revolve(face(line), (0, 0, 0), (0, 0, 1), turn)


def turned_volume(points: Sequence[Point], turn: float = 360.0) -> float:
    """Return the volume [mm³] of a closed line (r, z) revolved about z through an angle [deg]: ∮ r²/2 dz."""
    sides = ((a[0] ** 2 + a[0] * b[0] + b[0] ** 2) * (b[1] - a[1]) for a, b in pairwise(points))
    return abs(sum(sides)) / 6 * radians(turn)


def area(points: Sequence[Point]) -> float:
    """Return the area [mm²] enclosed by a closed line."""
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(points))) / 2


def drill(radius: float, reach: float, z: float = 0.0) -> Solid:
    """Return the solid that a hole removes: a cylinder along +y, from the axis to beyond a reach [mm]."""
    return Solid.makeCylinder(radius, 1.1 * reach, Vector(0, 0, z), Vector(0, 1, 0))


def drilled_volume(
    hole: float,
    outside: float,
    inside: float,
    groove: float = 0.0,
    half_groove: float = 0.0,
    offset: float = 0.0,
) -> float:
    """Return the volume that a radial hole removes from a cylindrical wall [mm³], from its chords.

    With x = a sin t and z = a cos t on the circle of radius a the integrand is smooth; it has one kink, where
    the circle crosses the edge of a groove round the inside.

    Parameters
    ----------
    hole, outside, inside, groove
        Radii [mm] of the hole, of the wall and of the groove's bottom.
    half_groove
        Half the width of the groove [mm], which is centred on the hole; 0 for no groove.
    offset
        By how much the axis of an eccentric bore is below that of the wall [mm]; `inside` then is the bore at
        the crown.
    """
    if hole == 0:
        return 0.0

    def slice_at(t: float) -> float:
        x, z = hole * sin(t), hole * cos(t)
        in_groove = min(z, half_groove)
        near = sqrt((inside + offset) ** 2 - x * x) - offset
        far, deep = sqrt(outside**2 - x * x), sqrt(groove**2 - x * x) if groove > inside else near
        return 2 * z * (z * far - in_groove * deep - (z - in_groove) * near)

    kink = acos(min(half_groove / hole, 1.0))
    pieces = ((0.0, kink), (kink, pi / 2))
    return 2 * sum(quad(slice_at, low, high, epsabs=0, epsrel=1e-11)[0] for low, high in pieces)


def sheet_under_arc(radius: float, half_width: float) -> float:
    """Return the area [mm²] between a diameter and the arc above it, up to half a width on either side."""
    x = half_width / radius
    return radius**2 * (x * sqrt(1 - x * x) + asin(x))


def nearest(values: Iterable[float], wanted: float) -> float:
    """Return the value that is nearest to the wanted one.

    Raises
    ------
    LookupError
        If there are no values.
    """
    listed = list(values)
    if not listed:
        raise LookupError(f"the file has no surface with a size near {wanted:.9g} mm")
    return min(listed, key=lambda value: abs(value - wanted))
