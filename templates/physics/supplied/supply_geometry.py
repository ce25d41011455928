"""Oil supply of a bearing as on a drawing: a groove and a hole in the sleeve, a hole in the pin.

Angles are positive from x to y. At crank angle 0 the axes of frame, sleeve and journal coincide: the angle of
a hole in the pin is measured from the throw, the angles of groove and hole in a rod's bore from the rod's
axis.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Mask, Truth
from templates.core.language.declare import units
from templates.physics.orbits.cyclic_film import Duty, cycle_of, weights
from templates.physics.orbits.rotation import turning
from templates.physics.supplied.supply import LONGEST, Pocket, Supply

UNDER_LOAD = np.pi / 3
"""A hole within this angle of the load's direction is under the load [rad]."""
HALF = np.pi / 3
"""Largest deviation of a half groove's extent from 180° [rad]."""
AROUND = 2 * np.pi * (1 - 1e-9)
"""Smallest extent that counts as a full circle [rad]."""


@dataclass(frozen=True)
class SupplyGeometry:
    """Groove and holes of some points, in SI, each axially centred; NaN if absent."""

    D: Array
    """Diameter of the bearing [m]."""
    W: Array
    """Width of the bearing [m]."""
    groove_width: Array
    """Width of the groove in the sleeve [m]."""
    groove_start: Array
    """Angle from the sleeve's axis at which the groove begins [rad]."""
    groove_extent: Array
    """Angle that the groove extends [rad]."""
    sleeve_length: Array
    """Axial length of the hole or slot in the sleeve [m]."""
    sleeve_arc: Array
    """Circumferential length of the hole or slot in the sleeve [m]."""
    sleeve_angle: Array
    """Angle of the middle of the sleeve's hole from the sleeve's axis [rad]."""
    pin_length: Array
    """Axial length of the hole or slot in the pin [m]."""
    pin_arc: Array
    """Circumferential length of the hole or slot in the pin [m]."""
    pin_angle: Array
    """Angle of the middle of the pin's hole from the throw [rad]."""

    @property
    def grooved(self) -> Mask:
        """Return a mask of the points with a groove."""
        return np.isfinite(self.groove_width)

    @property
    def sleeve_holed(self) -> Mask:
        """Return a mask of the points with a hole in the sleeve."""
        return np.isfinite(self.sleeve_length)

    @property
    def pin_holed(self) -> Mask:
        """Return a mask of the points with a hole in the pin."""
        return np.isfinite(self.pin_length)

    @property
    def count(self) -> Array:
        """Return how many of the three inlets each point has."""
        return np.asarray(1.0 * self.grooved + self.sleeve_holed + self.pin_holed)[()]

    def partial(self) -> Mask:
        """Return a mask of the points whose groove does not extend all around."""
        return np.asarray(self.grooved & (self.groove_extent < AROUND))

    def parts(self) -> Iterator[tuple[Mask, Array, Array, Array, bool]]:
        """Return for each inlet: existence, middle, half extent [rad], length [m], whether in the pin."""
        half = self.groove_extent / 2
        yield self.grooved, self.groove_start + half, half, self.groove_width, False
        yield self.sleeve_holed, self.sleeve_angle, self.sleeve_arc / self.D, self.sleeve_length, False
        yield self.pin_holed, self.pin_angle, self.pin_arc / self.D, self.pin_length, True

    def pockets(self, shape: tuple[int, ...]) -> Iterator[tuple[Pocket, ...]]:
        """Yield the pockets of each point of a shape, without those that round to size zero."""
        for number in range(int(np.prod(shape))):
            pockets = []
            for present, middle, half, length, on_journal in self.parts():
                of_point = (present, middle, half, length / self.W)
                exists, centre, extent, across = (np.broadcast_to(v, shape).flat[number] for v in of_point)
                if exists and min(float(extent), float(across)) > 0:
                    pockets.append(
                        Pocket(float(centre), min(float(extent), np.pi), _fitted(float(across)), on_journal)
                    )
            yield tuple(pockets)


def _fitted(across: float) -> float:
    """Return a length relative to the width, corrected if it exceeds its limit only by rounding."""
    return LONGEST if LONGEST < across <= LONGEST * (1 + 1e-9) else across


def supplies_of(feeding: SupplyGeometry, pressure: Array) -> NDArray[np.object_]:
    """Return the `Supply` of each point, (...).

    It is None if there are no inlets, if there is no pressure P = p psi²/(eta Omega) [-], or if an inlet is
    too long, which a rule refuses.
    """
    sizes = (np.shape(getattr(feeding, field.name)) for field in fields(feeding))
    shape = np.broadcast_shapes(np.shape(pressure), *sizes)
    pressures = np.broadcast_to(pressure, shape).ravel().tolist()
    supplies = np.empty(len(pressures), dtype=object)
    for number, (pockets, P) in enumerate(zip(feeding.pockets(shape), pressures, strict=True)):
        fits = all(pocket.half_length <= LONGEST for pocket in pockets)
        supplies[number] = Supply(pockets, P) if pockets and fits and 0 < P < np.inf else None
    return supplies.reshape(shape)


def supply_kind(feeding: SupplyGeometry) -> str:
    """Return the kind of supply of all points; empty if the points differ."""
    half = np.abs(feeding.groove_extent - np.pi) <= HALF + 1e-9
    kinds = {
        "none": feeding.count == 0,
        "several": feeding.count > 1,
        "full_groove": (feeding.count == 1) & feeding.grooved & ~feeding.partial(),
        "half_groove": (feeding.count == 1) & feeding.partial() & half,
        "partial_groove": (feeding.count == 1) & feeding.partial() & ~half,
        "sleeve_hole": (feeding.count == 1) & feeding.sleeve_holed,
        "pin_hole": (feeding.count == 1) & feeding.pin_holed,
    }
    return next((kind for kind, holds in kinds.items() if np.all(holds)), "")


def sleeve_motion(duty: Duty) -> str:
    """Return how the sleeve of all points moves in the block: fixed, swinging, or empty for anything else.

    A swinging sleeve, such as a rod, has zero mean speed. The crank has the mean speed of the journal, and
    the axes of the load do not rotate.
    """
    journal, sleeve = (np.mean(np.atleast_1d(speed), axis=-1) for speed in (duty.omega_J, duty.omega_B))
    slow = 1e-3 * duty.Omega
    if np.any(duty.omega_F) or not np.all(
        (np.abs(np.abs(journal) - duty.Omega) <= slow) & (np.abs(sleeve) <= slow)
    ):
        return ""
    swings = np.ptp(np.atleast_1d(duty.omega_B), axis=-1) > slow
    return "swinging" if np.all(swings) else "" if np.any(swings) else "fixed"


def within_bearing(length: Array, W: Array, arc: Array, D: Array) -> Truth:
    """Return whether a groove or hole leaves a land at both ends and extends at most once around."""
    inside = (length <= LONGEST * W) & ~(arc > np.pi * D)
    return np.asarray(np.isnan(length) | inside)[()]


@units(None, "rad/s", None, returns="1")
def is_back(duty: Duty, speed: Array, needed: Mask) -> Truth:
    """Return whether a part returns to its position in the load's frame after the cycle, if required.

    The result is true for angles that do not cover a cycle, because another rule refuses them.
    """
    period = cycle_of(duty.angle)
    if not (np.any(needed) and np.isfinite(period)):
        return True
    curves = np.broadcast_arrays((speed - duty.omega_F) / duty.Omega[..., None], duty.angle)
    points = curves[0].shape[:-1]
    turned = turning(duty.angle, period, curves[0].reshape(-1, duty.angle.size))
    return np.asarray(~needed | np.isfinite(turned.turns.reshape(points)))[()]


def feed_under_load(duty: Duty, feeding: SupplyGeometry) -> Array:
    """Return the fraction of the cycle with every groove and hole within 60° of the load's direction [-].

    It is NaN if there are none. A groove or slot that extends beyond 60° is never completely under the load.
    """
    direction, sleeve, journal = _in_frame(duty)
    under, fed = np.ones(direction.shape, bool), np.zeros((), bool)
    for present, middle, half, _, on_journal in feeding.parts():
        turned = journal if on_journal else sleeve
        off = (direction - turned - middle[..., None] + np.pi) % (2 * np.pi) - np.pi
        there = (np.abs(off) <= UNDER_LOAD) & (half[..., None] <= UNDER_LOAD)
        under, fed = under & (there | ~present[..., None]), fed | present
    period = cycle_of(duty.angle)
    share = under @ weights(duty.angle, period) / period
    return np.where(fed, share, np.nan)[()]


def _in_frame(duty: Duty) -> tuple[Array, Array, Array]:
    """Return load direction and rotation of sleeve and journal in the frame, (..., N) each [rad]."""
    period, Omega = cycle_of(duty.angle), np.asarray(duty.Omega)[..., None]
    of_sleeve, of_journal = ((speed - duty.omega_F) / Omega for speed in (duty.omega_B, duty.omega_J))
    x, y, *speeds, _ = np.broadcast_arrays(duty.F_x, duty.F_y, of_sleeve, of_journal, duty.angle)
    parts = (turning(duty.angle, period, speed.reshape(-1, duty.angle.size)) for speed in speeds)
    sleeve, journal = (part.at(duty.angle, part.swing).reshape(x.shape) for part in parts)
    return np.arctan2(y, x), sleeve, journal
