"""Sizes of an engine's cylinders, common to all or one for each, and rules about them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.engine.offset_crank import OffsetCrank, RodMasses, radius_of_stroke, rod_masses
from templates.physics.numerics.crank_grid import angles_in

MOST_VALUES = 6_000_000


def each(value: Array) -> Array:
    """Return an input with a last axis for the cylinders, (..., cylinders), in the unit of the input."""
    return np.atleast_1d(value)


def crank_of(stroke: Array, radius: Array, rod: Array, offset: Array) -> OffsetCrank:
    """Return the mechanisms from stroke or crank radius [m], whichever is given."""
    s, r, l, e = (each(value) for value in (stroke, radius, rod, offset))  # noqa: E741
    with np.errstate(invalid="ignore"):
        known = np.where(np.isnan(r), radius_of_stroke(s, l, e), r)
    return OffsetCrank(known, l, e)


def masses_of(mass: Array, centre: Array, inertia: Array, rod: Array) -> RodMasses:
    """Return the rods, each as two masses."""
    return rod_masses(each(mass), each(centre), each(inertia), each(rod))


def _at_all(holds: NDArray[np.bool_]) -> Truth:
    whole = np.all(np.atleast_1d(holds), axis=-1)
    return bool(whole) if whole.ndim == 0 else whole


@units("m", "m", returns="1")
def is_either(one: Array, other: Array) -> Truth:
    """Return whether exactly one of two inputs is given."""
    return bool(np.isnan(one).all()) != bool(np.isnan(other).all())


@units("m", "m", returns="1")
def is_within(place: Array, length: Array) -> Truth:
    """Return whether positions lie within lengths."""
    return _at_all(place <= length)


@units(None, "1", "rad", "rad", returns="1")
def has_one_each(values: tuple[Array, ...], order: Array, pins: Array, firing: Array) -> Truth:
    """Return whether each input is a single number or has one value for each cylinder."""
    count = max((np.shape(one)[-1] for one in (order, pins, firing) if np.ndim(one)), default=1)
    return all(np.ndim(value) == 0 or np.shape(value)[-1] in (1, count) for value in values)


@units("m", "1", "rad", "rad", returns="1")
def has_a_place_each(places: Array, order: Array, pins: Array, firing: Array) -> Truth:
    """Return whether there is one position for each cylinder."""
    count = max((np.shape(one)[-1] for one in (order, pins, firing) if np.ndim(one)), default=1)
    return np.ndim(places) <= 1 and each(places).size == count


@units("rad", returns="1")
def is_one_list(values: Array) -> Truth:
    """Return whether the input is a number or a single list, not a table for several engines."""
    return np.ndim(values) <= 1


@units(None, None, "1", "rad", returns="1")
def is_manageable(points: tuple[int, ...], throw: NDArray[np.intp], strokes: Array, step: Array) -> Truth:
    """Return whether the curves of all cylinders at this number of points fit into memory."""
    return bool(np.prod(points, dtype=float) * throw.size * angles_in(strokes, step) <= MOST_VALUES)


def or_none(value: Array) -> Array:
    """Return an optional list in its unit; an empty list if it is missing."""
    return np.atleast_1d(value) if np.ndim(value) else np.zeros(0)


@units("1", returns="1")
def orders_are_whole(orders: Array) -> Truth:
    """Return whether the orders are a single list that applies to all points."""
    return np.ndim(orders) <= 1
