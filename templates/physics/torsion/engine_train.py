"""A train excited by cylinders: its parts from lists of inputs, its response, and limits of its size."""

from __future__ import annotations

import math

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.torsion.forced_train import Propeller, Response, Train
from templates.physics.torsion.torque_harmonics import Excitation, cycle_of
from templates.physics.torsion.train_layout import TrainLayout, numbered

MOST_SPEEDS, MOST_CYLINDERS = 2000, 100
_MOST_VALUES, _MOST_STEPS = 4e6, 1e9  # limits: angles of all inertias; elimination steps


def train_of(
    layout: TrainLayout | None,
    J: Array,
    k: Array,
    c: Array,
    eta: Array,
    absolute: Array,
    excited: Array,
    propeller: Propeller | None,
) -> Train:
    """Return the train with a layout that satisfies the rules."""
    assert layout is not None
    return Train(layout, J, k, c, eta, absolute, propeller, int(numbered(excited)[0]))


def propeller_of(number: Array, torque: Array, speed: Array, factor: Array) -> Propeller | None:
    """Return the propeller on the inertia with a given number; None if no propeller is given."""
    return None if np.isnan(number) else Propeller(int(number) - 1, torque, speed, factor)


def response_of(
    train: Train, excitation: Excitation, speeds: Array, excited: Array, factors: Array, firing: Array
) -> Response:
    """Return the response to the cylinders on the excited inertias."""
    each = np.broadcast_to(factors, np.broadcast_shapes(np.shape(factors), np.shape(firing)))
    cylinders = excitation.of_cylinders(speeds, each, firing)
    places = np.equal.outer(numbered(excited), np.arange(train.layout.count)).astype(float)
    return train.respond(speeds, excitation.orders, np.asarray(cylinders @ places))


@units("1", "rad", returns="1")
def fire_each(excited: Array, firing: Array) -> bool:
    """Return whether there is a firing angle [rad] for each excited inertia, and not too many of them."""
    count = np.shape(excited)[-1:]
    return np.ndim(excited) == 1 and count == np.shape(firing)[-1:] and count[0] <= MOST_CYLINDERS


@units("N*m", "N*m", returns="1")
def are_excited(gas: Array, inertia: Array) -> bool:
    """Return whether a gas torque or an inertia torque [N m] is given, or both."""
    return bool(np.ndim(gas) or np.ndim(inertia))


@units("N*m", "rad/s", returns="1")
def has_its_speed(inertia: Array, speed: Array) -> bool:
    """Return whether an inertia torque [N m] and its speed [rad/s] are both given, or neither."""
    return bool(np.ndim(inertia)) != bool(np.all(np.isnan(speed)))


@units("1", "N*m", "rad/s", returns="1")
def is_whole_propeller(number: Array, torque: Array, speed: Array) -> bool:
    """Return whether inertia, torque [N m] and speed [rad/s] of the propeller are all given, or none."""
    return len({bool(np.all(np.isnan(one))) for one in (number, torque, speed)}) == 1


@units(None, "kg*m**2", "rad/s", "rad", "1", returns="1")
def is_manageable(points: tuple[int, ...], J: Array, speeds: Array, theta: Array, highest: Array) -> bool:
    """Return whether the number of points, speeds and orders together is within the limit."""
    cycle, count = cycle_of(theta), np.shape(J)[-1]
    if cycle is None:
        return True
    systems = math.prod(points) * np.shape(speeds)[-1] * max(1.0, float(highest) * cycle.strokes / 2)
    return (
        np.shape(speeds)[-1] <= MOST_SPEEDS
        and systems * count <= _MOST_VALUES
        and systems * count**3 <= _MOST_STEPS
    )
