r"""Rating life of rolling bearings, ISO 281:2007: equivalent load, its mean over a cycle, and reliability.

Deep groove ball bearings with an axial load take X and Y from the table for radial contact, by f0 Fa/C0.

References
----------
ISO 281:2007, 5.1 to 5.3 and table 3, first block. ISO/TR 1281-2:2008 for the reliability factor.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import on_paper, units

RELATIVE = np.array([0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89])
LIMIT = np.array([0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44])
AXIAL = np.array([2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00])
RADIAL = 0.56
WEIBULL, LEAST = 1.5, 0.05
"""Slope of the distribution of lives, and the fraction of L10 that every bearing reaches."""


def _last(value: Array, curve: Array) -> Array:
    """Return a value for each point, in a shape that broadcasts with a curve for each point."""
    return np.asarray(value)[..., None] if np.ndim(curve) else np.asarray(value)


@units("N", "1", "N", returns="1")
def relative_axial_load(F_a: Array, f_0: Array, C_0: Array) -> Array:
    """Return the largest f0 Fa/C0 over the cycle [1]; 0 without axial load."""
    largest = np.max(F_a, axis=-1) if np.ndim(F_a) else F_a
    return np.where(largest == 0, 0.0, np.where(np.isnan(f_0), 0.0, f_0) * largest / C_0)[()]


@units("N", "1", returns="1")
def factor_is_known(F_a: Array, f_0: Array) -> Truth:
    """Return whether f0 is given at all points with an axial load."""
    largest = np.max(F_a, axis=-1) if np.ndim(F_a) else F_a
    return (largest == 0) | ~np.isnan(f_0)


@units("N", None, returns="1")
def is_bearable(F_a: Array, elements: str) -> Truth:
    """Return whether this calculation covers an axial load on the given kind of rolling elements."""
    return elements == "ball" or bool(np.all(np.asarray(F_a) == 0))


@units("N", "N", "1", "N", returns="N")
def equivalent_load_ISO_281_2007(F_r: Array, F_a: Array, f_0: Array, C_0: Array) -> Array:
    """Return P = Fr, or X Fr + Y Fa where Fa/Fr > e, at each angle [N].

    X, Y and e are interpolated linearly between the rows of the table. At Fa/Fr = e the rounding of the table
    makes X Fr + Y Fa up to 1 % less than Fr; P is never less than Fr.
    """
    curve = F_r if np.ndim(F_r) else F_a
    share = _last(np.where(np.isnan(f_0), 0.0, f_0) / C_0, curve) * F_a
    e, Y = np.interp(share, RELATIVE, LIMIT), np.interp(share, RELATIVE, AXIAL)
    return np.where(F_a > e * F_r, np.maximum(F_r, RADIAL * F_r + Y * F_a), F_r + 0 * F_a)


@on_paper("mean of P^p over the cycle, to the power 1/p")
@units(None, "1", returns="N")
def mean_load(P: Array, p: Array) -> Array:
    """Return the constant load that gives the same life [N].

    It is the mean of P^p at equal steps, to the power 1/p.
    """
    if not np.ndim(P):
        return np.asarray(P)[()]
    largest = np.max(P, axis=-1, keepdims=True)
    share = P / np.where(largest > 0, largest, 1.0)
    return np.asarray(largest[..., 0] * np.mean(share**p, axis=-1) ** (1 / p))[()]


@units("N", "N", returns="N")
def static_load_ISO_76_2006(F_r: Array, F_a: Array) -> Array:
    """Return the greatest static equivalent load of the cycle [N]: max(0.6 Fr + 0.5 Fa, Fr)."""
    P_0 = np.maximum(0.6 * F_r + 0.5 * F_a, F_r + 0 * F_a)
    return np.max(P_0, axis=-1) if np.ndim(P_0) else P_0


@units(None, returns="1", latex=r"3\ \text{{(balls) or}}\ \tfrac{{10}}{{3}}\ \text{{(rollers)}}")
def life_exponent(elements: str) -> Array:
    """Return the life exponent: 3 for balls, 10/3 for rollers."""
    return np.float64(3.0 if elements == "ball" else 10 / 3)  # type: ignore[return-value]


@units("1", returns="1", latex=r"0.95\left(\frac{{\ln {0}}}{{\ln 0.9}}\right)^{{2/3}}+0.05")
def reliability_factor(S: Array) -> Array:
    """Return a1 [1] of a reliability: 1 at 0.9, by a Weibull distribution with a minimum life."""
    return (1 - LEAST) * (np.log(S) / np.log(0.9)) ** (1 / WEIBULL) + LEAST


@units("1", "1", returns="1", latex=r"10^6\,{0}^{{-{1}}}")
def rating_life(ratio: Array, p: Array) -> Array:
    """Return L10 = 10⁶ (C/P)^p [revolutions]; NaN without load."""
    return (1e6 * np.where(ratio > 0, ratio, np.nan) ** -p)[()]


@units("1", "rad/s", returns="s", latex=r"\frac{{2\pi\,{0}}}{{{1}}}")
def time_of_turns(turns: Array, omega: Array) -> Array:
    """Return the duration of a number of revolutions [s]."""
    return 2 * np.pi * turns / omega


@units("N", "N", returns="1", latex=r"\frac{{{0}}}{{{1}}}")
def safety(C_0: Array, P_0: Array) -> Array:
    """Return the ratio of static capacity to static load [1]; NaN without load."""
    return (C_0 / np.where(P_0 > 0, P_0, np.nan))[()]
