"""Compare a measured curve with a calculated one: measured values at calculated angles, and the differences.

Both are periodic. A measurement is interpolated linearly between its points, and from the last to the first.
Means are taken over the calculated angles with equal weights.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units

_NONE = np.array(np.nan)
_SAME = 1e-9  # tolerance as a fraction of a cycle


def periodic(theta: Array, places: Array, values: Array, cycle: Array, shift: Array) -> Array:
    """Return values (…, M) at places [rad], (M,), shifted by an angle and interpolated at theta, (…, K).

    All angles are in rad.
    """
    if not np.ndim(values):
        return _NONE
    way, last = places - places[0], values
    if abs(way[-1] - cycle) <= _SAME * cycle:  # the last point repeats the first
        way, last = way[:-1], values[..., :-1]
    way = np.append(way, cycle)
    last = np.concatenate([last, last[..., :1]], axis=-1)
    at = (theta - shift - places[0]) % cycle
    left = np.clip(np.searchsorted(way, at, side="right") - 1, 0, way.size - 2)
    share = (at - way[left]) / (way[left + 1] - way[left])
    return np.asarray(last[..., left] * (1 - share) + last[..., left + 1] * share)


def _root_mean_square(difference: Array) -> Array:
    return np.asarray(np.sqrt((difference**2).mean(axis=-1)))[()] if np.ndim(difference) else _NONE


def _mean(difference: Array) -> Array:
    return np.asarray(difference.mean(axis=-1))[()] if np.ndim(difference) else _NONE


def _largest(difference: Array) -> Array:
    return np.asarray(np.abs(difference).max(axis=-1))[()] if np.ndim(difference) else _NONE


@units("rad", returns="1")
def rises(angles: Array) -> Truth:
    """Return whether the angles are a single ascending list of three or more."""
    return np.ndim(angles) == 1 and np.size(angles) > 2 and bool(np.all(np.diff(angles) > 0))


@units("rad", "rad", returns="1")
def covers(angles: Array, cycle: Array) -> Truth:
    """Return whether angles lie within one cycle and leave no gap larger than a quarter of it."""
    if np.ndim(angles) != 1 or np.size(angles) < 3:
        return True  # another rule reports it
    gaps = np.diff(angles, append=angles[0] + cycle)
    return bool(np.all(gaps >= -_SAME * cycle) and np.all(gaps <= cycle * (0.25 + _SAME)))


@units("rad", "rad", "m", "rad", "rad", returns="m")
def film_at(theta: Array, places: Array, values: Array, cycle: Array, shift: Array) -> Array:
    """Return the measured film [m] at the calculated angles."""
    return periodic(theta, places, values, cycle, shift)


@units("m", returns="m", latex=r"\sqrt{{\overline{{{0}^2}}}}")
def rms_film(difference: Array) -> Array:
    """Return the root mean square of a difference [m]."""
    return _root_mean_square(difference)


@units("m", returns="m", latex=r"\overline{{{0}}}")
def mean_film(difference: Array) -> Array:
    """Return the mean of a difference [m]."""
    return _mean(difference)


@units("m", returns="m", latex=r"\max\left|{0}\right|")
def largest_film(difference: Array) -> Array:
    """Return the largest magnitude of a difference [m]."""
    return _largest(difference)


@units("rad", "rad", "rad/s", "rad", "rad", returns="rad/s")
def speed_at(theta: Array, places: Array, values: Array, cycle: Array, shift: Array) -> Array:
    """Return the measured speed [rad/s] at the calculated angles."""
    return periodic(theta, places, values, cycle, shift)


@units("rad/s", returns="rad/s", latex=r"\sqrt{{\overline{{{0}^2}}}}")
def rms_speed(difference: Array) -> Array:
    """Return the root mean square of a difference [rad/s]."""
    return _root_mean_square(difference)


@units("rad/s", returns="rad/s", latex=r"\overline{{{0}}}")
def mean_speed(difference: Array) -> Array:
    """Return the mean of a difference [rad/s]."""
    return _mean(difference)


@units("rad/s", returns="rad/s", latex=r"\max\left|{0}\right|")
def largest_speed(difference: Array) -> Array:
    """Return the largest magnitude of a difference [rad/s]."""
    return _largest(difference)


@units("rad", "rad", "1", "rad", "rad", returns="1")
def strain_at(theta: Array, places: Array, values: Array, cycle: Array, shift: Array) -> Array:
    """Return the measured strain [1] at the calculated angles."""
    return periodic(theta, places, values, cycle, shift)


@units("1", returns="1", latex=r"\sqrt{{\overline{{{0}^2}}}}")
def rms_strain(difference: Array) -> Array:
    """Return the root mean square of a difference [1]."""
    return _root_mean_square(difference)


@units("1", returns="1", latex=r"\overline{{{0}}}")
def mean_strain(difference: Array) -> Array:
    """Return the mean of a difference [1]."""
    return _mean(difference)


@units("1", returns="1", latex=r"\max\left|{0}\right|")
def largest_strain(difference: Array) -> Array:
    """Return the largest magnitude of a difference [1]."""
    return _largest(difference)
