"""Fatigue life by stress: Basquin's line, mean stress by Goodman, Gerber or Morrow.

This applies to smooth or notched steel parts under constant amplitude, where stresses stay elastic (beyond
some 10³ cycles). Lives commonly scatter by a factor of three and more; these formulas include no reliability.

Compressive mean stress: Goodman's and Gerber's lines were fitted to tests in tension. In compression,
Gerber's parabola would reduce life as in tension, and Goodman's line would increase it; here a compressive
mean stress counts as zero for both, after Budynas and Nisbett. Morrow's formula is used unchanged:
compression increases life (Dowling).

References
----------
O. H. Basquin: The exponential law of endurance tests. Proc. ASTM 10, 1910.
J. Goodman: Mechanics Applied to Engineering, 1899; W. Gerber, Z. Bayer. Archit. Ing.-Ver. 6, 1874.
J. Morrow: Fatigue Design Handbook, SAE, 1968, section 3.2.
N. E. Dowling: Mechanical Behavior of Materials, 4th ed. 2013, chapter 9.
R. G. Budynas, J. K. Nisbett: Shigley's Mechanical Engineering Design, 9th ed. 2011, chapter 6.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

GOODMAN, GERBER, MORROW, NONE = "goodman", "gerber", "morrow", "none"

_SHARES = (
    r"\frac{{{1}}}{{{2}}}\ \text{{(Goodman),}}\ "
    r"\left(\frac{{{1}}}{{{2}}}\right)^{{2}}\ \text{{(Gerber) or}}\ "
    r"\frac{{{1}}}{{{3}}}\ \text{{(Morrow)}}"
)
_SAFETY = (
    r"\left(\frac{{{1}}}{{{2}}}+{3}\right)^{{-1}}\ \text{{(Gerber: from}}\ "
    r"\frac{{n\,{1}}}{{{2}}}+n^{{2}}\,{3}=1\text{{)}}"
)

_LONGEST = np.log(1e300)  # ln of the longest life that is reported as a number


@units(None, "Pa", "Pa", "Pa", returns="1", latex=_SHARES)
def mean_share(correction: str, mean: Array, ultimate: Array, coefficient: Array) -> Array:
    """Return the share of the bearable amplitude that a mean stress [Pa] uses up [1], at most 1.

    Goodman: sigma_m/sigma_u. Gerber: (sigma_m/sigma_u)². Morrow: sigma_m/sigma_f'.
    """
    if correction == MORROW:
        return mean / coefficient
    share = np.maximum(mean, 0) / ultimate
    return {GOODMAN: share, GERBER: share**2, NONE: 0 * share}[correction]


@units("Pa", "Pa", "1", "Pa", returns="1", latex=r"\frac{{1}}{{2}}\left(\frac{{{0}}}{{{1}}}\right)^{{1/{2}}}")
def cycles_Basquin_1910(amplitude: Array, coefficient: Array, exponent: Array, endurance: Array) -> Array:
    """Return the cycles to failure N [1] at a reversed amplitude [Pa], from sigma_ar = sigma_f' (2 N)^b.

    The life is infinite, returned as NaN, up to the endurance limit [Pa] (NaN if there is none), without
    stress, and beyond 1e300 cycles.
    """
    with np.errstate(divide="ignore", over="ignore"):
        logarithm = (np.log(amplitude) - np.log(coefficient)) / exponent - np.log(2)
    endless = (amplitude <= endurance) | (logarithm > _LONGEST)
    return np.exp(np.where(endless, np.nan, logarithm))[()]


@units("Pa", "Pa", "1", "1", returns="Pa", latex=r"\max\left({1}\,\left(2\,{3}\right)^{{{2}}},{0}\right)")
def allowable_amplitude(endurance: Array, coefficient: Array, exponent: Array, life: Array) -> Array:
    """Return the permissible reversed amplitude [Pa] for a number of cycles; NaN cycles mean infinite life.

    It is the larger of Basquin's line at that life and the endurance limit [Pa]; NaN if there is neither.
    """
    return np.fmax(coefficient * (2 * life) ** exponent, endurance)


@units(None, "Pa", "Pa", "1", returns="1", latex=_SAFETY)
def load_safety_factor(correction: str, amplitude: Array, allowable: Array, share: Array) -> Array:
    """Return the factor by which amplitude [Pa] and mean stress may grow together; NaN if unbounded.

    Goodman and Morrow: 1/n = sigma_a/S + sigma_m/strength. Gerber: n sigma_a/S + (n sigma_m/sigma_u)² = 1
    (Budynas and Nisbett, chapter 6), solved without loss of digits.
    """
    used = amplitude / allowable
    total = (used + np.sqrt(used**2 + 4 * share)) / 2 if correction == GERBER else used + share
    return np.where(total > 0, 1 / np.where(total > 0, total, 1.0), np.nan)[()]


@units("Pa", "Pa", returns="1", latex=r"\frac{{{0}}}{{{1}}}")
def ratio_or_none(strength: Array, stress: Array) -> Array:
    """Return strength over stress, both in Pa [1]; NaN without stress."""
    return np.where(stress > 0, strength / np.where(stress > 0, stress, 1.0), np.nan)[()]


@units(None, "Pa", returns="1")
def mean_is_used(correction: str, mean: Array) -> Any:
    """Return whether the correction uses the mean stress [Pa] itself, instead of zero for compression."""
    return ~((mean < 0) & (correction in (GOODMAN, GERBER)))


@units(None, "Pa", returns="1")
def either_is_given(one: Array, other: Array) -> Any:
    """Return whether at least one of two stresses [Pa] is given."""
    return ~(np.isnan(one) & np.isnan(other))


@units("Pa", "Pa", "Pa", returns="1")
def is_borne_once(amplitude: Array, mean: Array, ultimate: Array) -> Any:
    """Return whether amplitude plus mean is below the ultimate strength [Pa]; true if one is missing."""
    return ~(amplitude + mean >= ultimate)


@units("Pa", "Pa", returns="1")
def is_below(one: Array, other: Array) -> Any:
    """Return whether one stress [Pa] is below another; true if one is missing."""
    return ~(one >= other)


@units("1", "Pa", returns="1")
def life_in_words(cycles: Array, amplitude: Array) -> Any:
    """Return a text that states whether a life is finite or infinite; empty if the amplitude [Pa] is NaN."""
    words = np.select([np.isnan(amplitude), np.isnan(cycles)], ["", "endless"], "finite")
    return words if words.ndim else str(words)
