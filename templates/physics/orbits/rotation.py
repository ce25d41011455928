"""Angles of sleeve and journal in the frame of the load, from their speeds over the cycle.

The axes of frame, sleeve and journal coincide at crank angle 0, as in `supply`. A part returns to its
position after each cycle only if it makes whole revolutions in the frame; a groove in any other part has a
different position in every cycle.
"""

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array, Mask

CLOSED = np.radians(2.0)
"""Largest angle by which a sum of speeds may differ from whole revolutions [rad]."""


@dataclass(frozen=True)
class PartRotation:
    """The angle of a part in the frame, for some cases: uniform rotation plus a periodic swing."""

    turns: Array
    """(C,) revolutions in the frame per cycle; NaN if this is not an integer [-]."""
    period: float
    """The cycle [rad]."""
    swing: Array
    """(C, N) angle at the load's angles minus the uniform rotation, 0 at crank angle 0 [rad]."""

    def of(self, cases: Mask) -> "PartRotation":
        """Return the same object for a subset of the cases."""
        return PartRotation(self.turns[cases], self.period, self.swing[cases])

    def at(self, place: Array, swing: Array) -> Array:
        """Return the angle at crank angles, given the swing there, (C, K) [rad]."""
        return np.asarray(swing + 2 * np.pi * self.turns[:, None] * place / self.period)


def turning(angle: Array, period: float, speed: Array) -> PartRotation:
    """Return the rotation of a part from its speed in the frame, relative to the speed of the crank.

    Parameters
    ----------
    angle
        (N,) crank angles of one cycle [rad].
    period
        The cycle [rad].
    speed
        (C, N) at these angles, linear between them [-].

    Examples
    --------
    >>> angle = np.arange(0, 4 * np.pi, np.pi / 90)
    >>> rod = turning(angle, 4 * np.pi, -0.25 * np.cos(angle)[None])
    >>> rod.turns.tolist(), round(float(np.degrees(rod.swing.min())), 1)
    ([0.0], -14.3)
    """
    widths = np.diff(angle, append=angle[0] + period)
    steps = widths * (speed + np.roll(speed, -1, axis=-1)) / 2
    whole = steps.sum(axis=-1)
    turns = np.round(whole / (2 * np.pi))
    missed = whole - 2 * np.pi * turns
    turns = np.where(np.abs(missed) <= CLOSED, turns, np.nan)
    past = np.cumsum(steps, axis=-1) - steps
    swing = past - whole[:, None] * (angle - angle[0]) / period
    start = [np.interp(0.0, angle, row, period=period) for row in swing]
    return PartRotation(turns, period, swing - np.array(start)[:, None])
