"""Critical speeds, where engine orders meet natural frequencies, and the lines of a Campbell diagram.

`torsional_vibration` uses this module. An order is a number of excitations per revolution: a four-stroke
engine has whole and half orders. The natural frequencies of a chain do not depend on speed, so they are
horizontal lines in the diagram.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

PLACES = 21
"""Number of speeds at which the lines of the diagram are given."""

RPM = 2 * np.pi / 60


@units("rad/s", "1", returns="rad/s", latex=r"\frac{{{0}}}{{{1}}}")
def critical_speeds(omega: Array, orders: Array) -> Array:
    """Return the speeds [rad/s], [..., order, mode], at which orders excite the modes [..., mode]."""
    return omega[..., None, :] / np.atleast_1d(orders)[..., :, None]


@units("rad/s", returns="rad/s", latex=r"{0}_1+\frac{{i}}{{20}}\left({0}_2-{0}_1\right)")
def campbell_speeds(speeds: Array) -> Array:
    """Return equally spaced speeds [rad/s] along the diagram, between the two limits in [..., 2]."""
    if not np.ndim(speeds):
        return np.full(PLACES, np.nan)
    return np.linspace(speeds[..., 0], speeds[..., -1], PLACES, axis=-1)


@units("1", "rad/s", returns="rad/s", latex=r"{0}\,{1}")
def excitation(orders: Array, speeds: Array) -> Array:
    """Return the angular frequencies [rad/s], [..., order, speed], that orders excite at [..., speed]."""
    return np.atleast_1d(orders)[..., :, None] * speeds[..., None, :]


@units("rad/s", returns="1")
def ascending(speeds: Array) -> bool:
    """Return whether a range [rad/s] has two speeds in ascending order."""
    return np.shape(speeds)[-1:] == (2,) and bool(np.all(speeds[..., 0] < speeds[..., 1]))


@units("rad/s", "1", "rad/s", returns="1")
def resonances(critical: Array, orders: Array, speeds: Array) -> Any:
    """Return a text about the critical speeds [rad/s; ..., order, mode] in the range, if there is one."""
    if not np.ndim(speeds) or np.isnan(critical).any():
        return ""
    points = np.broadcast_shapes(critical.shape[:-2], speeds.shape[:-1], np.shape(orders)[:-1])
    sentences = np.empty(points, dtype=object)
    each = (np.broadcast_to(critical, (*points, *critical.shape[-2:])),
            np.broadcast_to(np.atleast_1d(orders), (*points, critical.shape[-2])),
            np.broadcast_to(speeds, (*points, 2)))  # fmt: skip
    for point in np.ndindex(points):
        sentences[point] = _sentence(*(values[point] for values in each))
    return sentences if points else str(sentences[()])


def _sentence(critical: Array, orders: Array, speeds: Array) -> str:
    """Return a text about the critical speeds of one chain in the range, in ascending order.

    Mode 0 of a free chain has no critical speed.
    """
    inside = (critical >= speeds[0]) & (critical <= speeds[1]) & (critical > 0)
    crossings = sorted((critical[order, mode], orders[order], mode) for order, mode in np.argwhere(inside))
    met = (f"order {order:g} meets mode {mode} at {speed / RPM:.5g} rpm" for speed, order, mode in crossings)
    return "; ".join(met) or f"none from {speeds[0] / RPM:.5g} to {speeds[1] / RPM:.5g} rpm"
