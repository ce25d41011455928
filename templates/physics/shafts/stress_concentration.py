"""Stress concentration at the shoulder fillet of a round shaft, and its effect in fatigue.

The formulas are for a step between two coaxial round sections. The fillet between a crank's pin and web has a
different shape: use finite elements or a measured factor if that matters.

References
----------
W. D. Pilkey, D. F. Pilkey: Peterson's Stress Concentration Factors, 3rd ed. 2008, charts 3.10 (bending) and
    3.12 (torsion): polynomials in 2 t/D with coefficients in t/r, where t = (D - d)/2 is the height of the
    shoulder.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

TORSION, BENDING = "torsion", "bending"

_TORSION = ((0.905, 0.783, -0.075), (-0.437, -1.969, 0.553), (1.557, 1.073, -0.578), (-1.061, 0.171, 0.086))
_BENT = ((0.947, 1.206, -0.131), (0.022, -3.405, 0.915), (0.869, 1.777, -0.555), (-0.810, 0.422, -0.260))
_BENT_SHARP = (
    (1.232, 0.832, -0.008), (-3.813, 0.968, -0.260), (7.423, -4.868, 0.869), (-3.839, 3.070, -0.600)
)  # fmt: skip
_SHARP = 2.0  # t/r above which the second set of coefficients applies in bending
_CHARTED = {TORSION: (0.25, 4.0), BENDING: (0.1, 20.0)}


@units(None, "m", "m", "m", returns="1", latex=r"K_{{t}}^{{\mathrm{{Pilkey}}}}\left({1},{2},{3}\right)")
def shoulder_fillet_Pilkey_2008(loading: str, D: Array, d: Array, r: Array) -> Array:
    """Return the stress concentration factor [1] of a fillet r between diameters D > d [m], on section d.

    It applies to the normal stress in bending and to the shear stress in torsion; NaN if a dimension is
    missing.
    """
    height = (D - d) / 2
    slope, step = height / r, 2 * height / D
    if loading == TORSION:
        return _polynomial(_TORSION, slope, step)
    return np.where(slope <= _SHARP, _polynomial(_BENT, slope, step), _polynomial(_BENT_SHARP, slope, step))[
        ()
    ]


@units(None, "1", None, returns="1")
def is_charted(loading: str, slope: Array, K_t: Array) -> Any:
    """Return whether shoulder height over fillet radius [1] is within the chart, or K_t is given."""
    low, high = _CHARTED[loading]
    return ~((slope < low) | (slope > high)) | ~np.isnan(K_t)


@units("m", "m", returns="1")
def is_wider(D: Array, d: Array) -> Any:
    """Return whether one diameter is larger than the other [m]; true if one of them is missing."""
    return ~(D <= d)


@units(None, "1", None, "Pa", None, "Pa", returns="1")
def notch_is_known(K_t: Array, slope: Array, amplitude: Array, S_a: Array, mean: Array, S_m: Array) -> Any:
    """Return whether K_t [1] is given, follows from a shoulder, or is not needed."""
    needed = (np.isnan(amplitude) & ~np.isnan(S_a)) | (np.isnan(mean) & ~np.isnan(S_m))
    return ~needed | ~np.isnan(K_t) | ~np.isnan(slope)


@units("1", "1", returns="1", latex=r"1+{1}\left({0}-1\right)")
def fatigue_notch_factor_Peterson(K_t: Array, q: Array) -> Array:
    """Return the fatigue notch factor [1] from a factor K_t [1] and a notch sensitivity q [1]."""
    return 1 + q * (K_t - 1)


@units(None, "Pa", "1", returns="Pa", latex=r"c_{{\mathrm{{load}}}}\,{2}\,{1}")
def local_stress(loading: str, nominal: Array, K_f: Array) -> Array:
    """Return the local stress [Pa] in bending, or the von Mises stress of the local shear in torsion."""
    return (np.sqrt(3) if loading == TORSION else 1.0) * K_f * nominal


def _polynomial(coefficients: tuple[tuple[float, float, float], ...], slope: Array, step: Array) -> Array:
    """Return Pilkey's polynomial: cubic in 2 t/D, with coefficients in the root of t/r."""
    root = np.sqrt(slope)
    return sum((a + b * root + c * slope) * step**i for i, (a, b, c) in enumerate(coefficients))  # type: ignore[return-value]
