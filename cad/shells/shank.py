"""The side of a tapered shank with its fillets, as functions of arrays; lengths in one unit, angles in rad.

The side is a straight line that leans towards the middle of the rod by half the taper. Its distance from an
axis along the pin is measured along its normal. A fillet touches the side and either a circle about that axis
or a straight shoulder. With a radius of 0 the results belong to the point where the side meets them.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Truth, units

Value = Array | float


@units("m", "m", "rad", returns="m")
def away(half_width: Value, above: Value, lean: Value) -> Array:
    """Return the distance of the side from an axis; the half width is given at a height above it."""
    return (half_width + above * np.tan(lean)) * np.cos(lean)


@units("m", "m", "m", returns="m")
def reach(radius: Value, distance: Value, fillet: Value) -> Array:
    """Return how far along the side a fillet on a circle ends, from the foot of the circle's axis."""
    return np.sqrt(np.maximum((radius - distance) * (radius + distance + 2 * fillet), 0 * radius))


@units(None, "m", "m", "m", "rad", returns="m")
def meeting(square: Truth, height: Value, distance: Value, fillet: Value, lean: Value) -> Array:
    """Return how far from the middle of the rod the side, or its fillet, meets the big end.

    Parameters
    ----------
    square
        Whether the shoulder is straight; otherwise it is a circle.
    height
        Of the shoulder above the axis; the radius of the circle.
    distance
        Of the side from the axis.
    fillet, lean
        The radius of the fillet, and half the taper.
    """
    flat = (distance + fillet - (height + fillet) * np.sin(lean)) / np.cos(lean)
    along = reach(height, distance, fillet)
    across = (distance + fillet) * np.cos(lean) - along * np.sin(lean)
    return np.where(square, flat, height / (height + fillet) * across)[()]


@units(None, "m", "m", "m", "rad", returns="m")
def root(square: Truth, height: Value, distance: Value, fillet: Value, lean: Value) -> Array:
    """Return how far along the side its fillet at the big end reaches, from the foot of the axis.

    The parameters are those of `meeting`.
    """
    across = meeting(square, height, distance, fillet, lean)
    flat = (height + fillet) * np.cos(lean) - across * np.sin(lean)
    return np.where(square, flat, reach(height, distance, fillet))[()]
