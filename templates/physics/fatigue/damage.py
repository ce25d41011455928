r"""Damage of counted cycles: equivalent reversed amplitudes, Miner's sum, the governing point.

References
----------
A. Palmgren 1924, M. A. Miner: Cumulative damage in fatigue. J. Appl. Mech. 12, 1945.
E. Haibach: Betriebsfestigkeit, 3rd ed. 2006: below the endurance limit the line continues with the slope
    2 k - 1.
J. Goodman 1899, W. Gerber 1874, J. Morrow (SAE Fatigue Design Handbook) 1968 for the mean stress.
R. G. Budynas, J. K. Nisbett: Shigley's Mechanical Engineering Design, 10th ed. 2015: a compressive mean
    stress is ignored.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units
from templates.physics.fatigue.findley import CriticalPlane, critical_planes, uniaxial_equivalent
from templates.physics.fatigue.rainflow import Cycles, by_extremes, by_rainflow
from templates.physics.fatigue.tensors import PROPORTIONAL, leading_tensor, signed_von_mises, von_mises_1913

FINDLEY, SIGNED = "findley", "signed_von_mises"
GOODMAN, GERBER, MORROW, NONE = "goodman", "gerber", "morrow", "none"
HAIBACH, ORIGINAL, ELEMENTARY = "haibach", "original", "elementary"
NO, YES = "no", "yes"
EXTREMES, RAINFLOW = "extremes", "rainflow"
_LARGEST = 690.0  # limit of logarithms of cycles and damages


@dataclass(frozen=True)
class CycleCounts:
    """Cycles of every point, and the lowest stress that contributes to a compressive mean."""

    cycles: Cycles  # [..., point, cycle]; with Findley amplitudes of shear
    high: Array | None  # [..., point] [Pa], the normal stress combined with the shear; only with Findley
    low: Array  # [..., point] [Pa]


def counted_cycles(history: Array, criterion: str, level: str, k: Array, credit: str) -> CycleCounts:
    """Return the cycles of stress histories [..., point, angle, 6] [Pa] by criterion and counting method."""
    count = by_extremes if level == EXTREMES else by_rainflow
    if criterion == SIGNED:
        signed = signed_von_mises(history)
        return CycleCounts(count(signed), None, signed.min(axis=-1))
    plane = critical_planes(history, float(k), credit=credit == YES)
    return CycleCounts(count(plane.shear), _normal_that_counts(plane, credit), plane.normal_low)


def _normal_that_counts(plane: CriticalPlane, credit: str) -> Array:
    if credit == YES:
        return plane.normal_high
    return np.maximum(plane.normal_high, plane.normal_amplitude())


def _to_points(value: Array) -> Array:
    """Return values of the inputs, one for each point, shaped to broadcast with [..., point]."""
    return np.asarray(value)[..., None]


def _to_cycles(value: Array) -> Array:
    """Return values of the inputs, one for each point, shaped to broadcast with [..., point, cycle]."""
    return np.asarray(value)[..., None, None]


@units(None, None, returns="1")
def one_tensor_leads(criterion: str, history: Array) -> Truth:
    """Return whether a single tensor dominates the stress of every point, if the criterion needs a sign."""
    return criterion != SIGNED or np.all(leading_tensor(history)[1] >= PROPORTIONAL, axis=-1)[()]


@units(None, returns="1")
def shares_of_leading_tensors(history: Array) -> Array:
    """Return the fraction of the squared stress of each point that its leading tensor contributes [1]."""
    return leading_tensor(history)[1]


@units(None, returns="Pa")
def greatest_von_mises(history: Array) -> Array:
    """Return the greatest von Mises stress of each point [Pa]."""
    return np.max(von_mises_1913(history), axis=-1)


@units(None, None, "1", "Pa", returns="1")
def compression_used(counted: CycleCounts, credit: str, support: Array, yield_strength: Array) -> Array:
    """Return the largest compressive stress of each point relative to the yield strength [1].

    It is 0 if compressive mean stresses get no credit.
    """
    if credit == NO:
        return np.zeros(np.broadcast_shapes(counted.low.shape, _to_points(support).shape))
    return np.maximum(-counted.low * _to_points(support), 0.0) / _to_points(yield_strength)


@units(None, "1", None, None, "Pa", "Pa", "1", "1", returns="Pa")
def reversed_amplitudes(
    counted: CycleCounts, support: Array, correction: str, credit: str, ultimate: Array, coefficient: Array,
    k: Array, compression: Array,
) -> Array:  # fmt: skip
    """Return the reversed uniaxial amplitudes [..., point, cycle] [Pa] that do the same damage as each cycle.

    The amplitude is 0 without a cycle, and infinite if a mean stress reaches the strength that limits it.
    """
    amplitude = counted.cycles.amplitude * _to_cycles(support)
    present = counted.cycles.count > 0
    if counted.high is not None:
        beside = counted.high[..., None] * _to_cycles(support)
        equivalent = uniaxial_equivalent(np.maximum(amplitude + k * beside, 0.0), k)
    else:
        mean = counted.cycles.mean * _to_cycles(support)
        share = mean_shares(correction, credit, mean, ultimate, coefficient)
        equivalent = np.where(share < 1, amplitude / np.where(share < 1, 1 - share, 1.0), np.inf)
    broken = np.isnan(compression)[..., None]
    return np.where(broken, np.nan, np.where(present, equivalent, 0.0))


def mean_shares(correction: str, credit: str, mean: Array, ultimate: Array, coefficient: Array) -> Array:
    """Return the share of the bearable amplitude that mean stresses [..., point, cycle] [Pa] use up [1].

    A compressive mean stress uses up nothing; only with `credit` does it increase the bearable amplitude.
    """
    used = mean if credit == YES else np.maximum(mean, 0.0)
    strength = _to_cycles(coefficient if correction == MORROW else ultimate)
    share = used / strength
    return {GOODMAN: share, GERBER: share * np.abs(share), MORROW: share, NONE: 0 * share}[correction]


@units(None, returns="Pa")
def largest_amplitudes(equivalent: Array) -> Array:
    """Return the largest reversed amplitude of each point [Pa]."""
    return np.max(equivalent, axis=-1)


@units(None, None, "Pa", "1", "1", None, returns="1")
def damages(
    equivalent: Array, counted: CycleCounts, endurance: Array, slope: Array, knee: Array, rule: str
) -> Array:
    """Return Miner's damage of each point in one engine cycle [..., point] [1]."""
    limit, b = _to_cycles(endurance), _to_cycles(slope)
    ratio = equivalent / limit
    with np.errstate(divide="ignore"):
        logarithm = np.log(ratio)
    k = np.where(ratio < 1, 2 / np.abs(b) - 1, 1 / np.abs(b)) if rule == HAIBACH else 1 / np.abs(b)
    one = np.exp(np.clip(k * logarithm - np.log(_to_cycles(knee)), -_LARGEST, _LARGEST))
    counts = (ratio > 0) & ~((rule == ORIGINAL) & (ratio <= 1))
    if rule == HAIBACH:
        counts = counts & np.any(ratio > 1, axis=-1, keepdims=True)
    total = np.sum(np.where(counts, one * counted.cycles.count, 0.0), axis=-1)
    return np.where(np.isnan(equivalent).any(axis=-1), np.nan, total)


@units(None, None, None, None, "Pa", "Pa", "Pa", "1", returns="1")
def load_uses(
    counted: CycleCounts, equivalent: Array, correction: str, credit: str, endurance: Array, ultimate: Array,
    coefficient: Array, support: Array,
) -> Array:  # fmt: skip
    """Return 1/n of each point [1], where n is the safety factor on load.

    All loads, including mean stresses, may grow n-fold until the endurance limit is reached. Goodman and
    Morrow: 1/n = sigma_a/S_e + sigma_m/strength. Gerber: n is the root of n sigma_a/S_e + (n sigma_m/S_u)² =
    1. Findley's parameter is proportional to the loads.
    """
    limit = _to_cycles(endurance)
    if counted.high is not None:
        return np.max(equivalent / limit, axis=-1)
    used = counted.cycles.amplitude * _to_cycles(support) / limit
    mean = counted.cycles.mean * _to_cycles(support)
    share = mean_shares(correction, credit, mean, ultimate, coefficient)
    total = (used + np.sqrt(used**2 + 4 * np.maximum(share, 0))) / 2 if correction == GERBER else used + share
    total = np.where(counted.cycles.count > 0, np.maximum(total, 0.0), 0.0)
    return np.where(np.isnan(equivalent).any(axis=-1), np.nan, np.max(total, axis=-1))


@units(None, returns="1")
def numbers_of_points(history: Array) -> Array:
    """Return the point numbers 1, 2, … of a history."""
    return np.arange(1, history.shape[-3] + 1, dtype=float)


@units(None, None, returns="1")
def governing_point(damage: Array, uses: Array) -> Array:
    """Return the number of the point with the largest damage.

    If there is no damage, it is the point with the smallest safety factor.
    """
    first = np.where(damage.max(axis=-1, keepdims=True) > 0, damage, uses)
    known = ~np.isnan(first).any(axis=-1)
    place = np.argmax(np.where(np.isnan(first), -np.inf, first), axis=-1) + 1.0
    return np.where(known, place, np.nan)[()]


@units(None, returns="1")
def largest(values: Array) -> Array:
    """Return the largest value of all points [1]."""
    return np.max(values, axis=-1)[()]


@units("1", returns="1", latex=r"\frac{{1}}{{{0}}}")
def inverse_or_none(value: Array) -> Array:
    """Return 1 over a value [1]; NaN if the value is 0."""
    return np.where(value > 0, 1 / np.where(value > 0, value, 1.0), np.nan)[()]


@units("1", returns="1")
def life_in_words(damage: Array) -> Any:
    """Return a text that states whether a life is finite or infinite."""
    words = np.select([np.isnan(damage), damage > 0], ["", "finite"], "endless")
    return words if words.ndim else str(words)
