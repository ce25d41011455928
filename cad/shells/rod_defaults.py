"""Sizes of a rod's features by default: usual ones where they have room, otherwise none."""

from __future__ import annotations

import numpy as np

from cad.shells.shank import meeting, reach, root
from templates.core.language.declare import on_paper
from templates.core.language.template import Array, Truth, units

LEAST = 0.005
"""Smallest feature by default, as a share of the big end's bore."""


@units("m", None, "m", returns="m")
def either(length: Array, possible: Truth, other: Array) -> Array:
    """Return a length, or the other one if it is not possible."""
    return np.where(possible, length, other)[()]


@units("m", None, returns="m")
def if_possible(length: Array, possible: Truth) -> Array:
    """Return a length, or 0 if it is not possible."""
    return either(length, possible, 0 * length)


@on_paper("at least 0.5 % of the bore, or none")
@units("m", "m", returns="m")
def if_visible(length: Array, bore: Array) -> Array:
    """Return a length, or 0 if it is too small a share of the big end's bore."""
    return if_possible(length, length >= LEAST * bore)


@units("m", "m", returns="m")
def chord(radius: Array, height: Array) -> Array:
    """Return half the width of a circle at a height above its axis; 0 beyond the circle."""
    return np.sqrt(np.maximum(radius**2 - height**2, 0 * radius**2))


@on_paper("5°, or less for a long narrow shank or pocket, or if the shank is nearly as broad as the big end")
@units("m", "m", "m", "m", returns="rad")
def usual_taper(shank: Array, pocket: Array, breadth: Array, length: Array) -> Array:
    """Return the angle between the sides of a shank: 5°, or less if it is long and narrow.

    0 for a shank that is nearly as broad as the big end. The arguments are the widths of shank and pocket,
    the breadth of the big end and the length of the shank.
    """
    narrow = 0.4 * either(pocket, pocket > 0, shank)
    slope = np.minimum(np.minimum(narrow, 0.85 * breadth - 0.9 * shank) / length, np.tan(np.pi / 72))
    return 2 * np.arctan(np.where(slope > 0.002, slope, 0 * slope)[()])


@on_paper("beyond the ends of the bolt holes; the shoulder if the round would be narrower than the shank")
@units("m", "m", "m", "m", "m", "rad", returns="m")
def usual_boss(shoulder: Array, breadth: Array, bolt: Array, depth: Array, side: Array, lean: Array) -> Array:
    """Return the height of the bosses beside the shank.

    Parameters
    ----------
    shoulder, breadth
        Height of the shoulder and breadth of the big end.
    bolt, depth
        Diameter and depth of the bolt holes.
    side, lean
        Distance of a side of the shank from the pin, and half the taper.
    """
    height = np.maximum(0.55 * shoulder, np.sign(bolt) * depth / 0.92)
    edge, foot = chord(shoulder, height), meeting(False, shoulder, side, 0 * side, lean)
    stands_out = (height <= 0.97 * shoulder) & (edge <= 0.49 * breadth)
    return either(height, stands_out & (foot <= 0.95 * edge) & (side <= 0.95 * shoulder), shoulder)


@on_paper("where the seats have room for the bolt holes; the height of the cap if there is none")
@units("m", "m", "m", "m", returns="m")
def usual_seat(cap: Array, breadth: Array, bolt: Array, spacing: Array) -> Array:
    """Return the depth of the seats of the bolt heads below the joint.

    The arguments are the height of the cap, the breadth of the big end, diameter and spacing of the bolts.
    """
    free = either(0.48 * (spacing - bolt), bolt > 0, cap)
    height = np.maximum(0.55 * cap, 1.03 * chord(cap, free))
    return either(height, (height <= 0.97 * cap) & (chord(cap, height) <= 0.49 * breadth), cap)


@on_paper("0.7 of the shank's width, or none if it has no room")
@units(None, "m", "m", "m", "rad", "m", "m", returns="m")
def usual_big_end_fillet(
    square: Truth, shank: Array, shoulder: Array, side: Array, lean: Array, room: Array, end: Array
) -> Array:
    """Return the radius between shank and big end.

    Parameters
    ----------
    square
        Whether the shoulder is square.
    shank, shoulder
        Width of the shank and height of the shoulder.
    side, lean
        Distance of a side of the shank from the pin, and half the taper.
    room, end
        How far from the middle, and how far along the side, the fillet may reach.
    """
    radius = 0.7 * shank
    lands = meeting(square, shoulder, side, radius, lean) <= 0.95 * room
    return if_possible(radius, lands & (root(square, shoulder, side, radius, lean) <= end))


@on_paper("half the shank's width, or none if it has no room")
@units("m", "m", "m", "m", returns="m")
def usual_small_end_fillet(shank: Array, radius: Array, side: Array, end: Array) -> Array:
    """Return the radius between shank and small end.

    The arguments are the width of the shank, the radius of the small end, the distance of a side of the shank
    from its axis, and how far along the side the fillet may reach.
    """
    return if_possible(shank / 2, reach(radius, side, shank / 2) <= end)
