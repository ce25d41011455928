"""Fields on the surface of a crankshaft: values round its fillets, and the angle of a torsional mode.

A fillet is a separate face. A face counts as a fillet if all its vertices lie in one fillet region, so the
plain cylinders between two fillets have no value.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np

from cad.cranks.whole import WholeShaft
from cad.fillets import Crank, Ring
from templates.core.arrays import Array, Integers


def at_fillets(
    sizes: Crank,
    places: Sequence[tuple[float, float]],
    corners: Array,
    faces: Integers,
    points: Array,
    values: Array,
) -> Array:
    """Return values at the vertices [n, 3] of a shaft, from values at points of one throw's fillets.

    Values elsewhere are NaN.

    Points [p, 3] are in the axes of the throw: z = 0 is mid-pin, x points to the pin. `places` are the angle
    of the pin [rad] and the z coordinate of mid-pin [mm] of each throw; every throw gets the same values.
    Around a fillet, values are interpolated linearly in the angle between the points.
    """
    painted = np.full(len(corners), np.nan)
    for angle, middle in places:
        own = in_throw(corners, angle, middle)
        for ring in sizes.rings():
            here = ring.holds(points)
            if not here.any():
                continue
            beyond = np.logical_not(ring.holds(own))
            whole_faces = np.bincount(faces, weights=beyond)[faces] == 0
            painted[whole_faces] = _round(ring, own[whole_faces], points[here], values[here])
    return painted


def places_of(whole: WholeShaft) -> list[tuple[float, float]]:
    """Return the pin angle [rad] and the z coordinate of mid-pin [mm] of each throw of a shaft."""
    return [(throw.angle, whole.pitch * (number + 0.5)) for number, throw in enumerate(whole.throws)]


def in_throw(corners: Array, angle: float, middle: float) -> Array:
    """Return vertices in the axes of a throw whose pin is at an angle [rad] and whose middle is at z [mm]."""
    x, y, z = corners.T
    along, across = x * cos(angle) + y * sin(angle), y * cos(angle) - x * sin(angle)
    return np.column_stack([along, across, z - middle])


def _round(ring: Ring, corners: Array, points: Array, values: Array) -> Array:
    """Return values at vertices, interpolated by their angle about the axis of a ring between its points."""
    angle, known = (np.arctan2(at[:, 1], at[:, 0] - ring.axis) for at in (corners, points))
    return np.asarray(np.interp(angle, known, values, period=2 * pi))


def along_shaft(
    whole: WholeShaft, corners: Array, angles: Sequence[float], ends: tuple[float, float]
) -> Array:
    """Return the mode angle at the vertices, from its values at each pin, the nose end and the flange end.

    Between these the angle is interpolated linearly in z.
    """
    pins = [middle for _, middle in places_of(whole)]
    places = [whole.low, *pins, whole.high]
    return np.asarray(np.interp(corners[:, 2], places, [ends[0], *angles, ends[1]]))
