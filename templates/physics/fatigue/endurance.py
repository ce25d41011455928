"""Endurance limit and finite-life strength of a steel part: Marin factors, notch sensitivity.

The factors are those of the 10th edition of Shigley; the 11th has different ones. All are limited to 1 (the
book's size factor reaches 1.11 below 7.6 mm).

References
----------
R. G. Budynas, J. K. Nisbett: Shigley's Mechanical Engineering Design, 10th ed. 2015, sections 6-7 to 6-10.
"""

from __future__ import annotations

import numpy as np
from scipy.special import ndtri

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units

MPA = 1e6
KSI = 6.894757293168361e6
INCH = 0.0254

SURFACES = {
    "polished": (1.0, 0.0),
    "ground": (1.58, -0.085),
    "machined": (4.51, -0.265),
    "hot_rolled": (57.7, -0.718),
    "forged": (272.0, -0.995),
}
"""Factor and exponent of the ultimate strength in MPa, for each surface."""

BENDING, AXIAL = "bending", "axial"
_LOADINGS = {BENDING: 1.0, AXIAL: 0.85}
_HIGHEST = 1400 * MPA
_SMALL, _MIDDLE = 2.79e-3, 51e-3
_ADDED = 345 * MPA  # σ_F' less the ultimate strength (50 ksi), steels up to 500 HB
FIRST, KNEE = 1e3, 1e6
_MOST_AT_1000 = 0.9  # fraction of the ultimate strength


@units("Pa", returns="Pa", latex=r"\min\left(\tfrac12\,{0},700\,\mathrm{{MPa}}\right)")
def specimen_limit(ultimate: Array) -> Array:
    """Return the endurance limit [Pa] of a rotating, polished specimen from its ultimate strength [Pa]."""
    return 0.5 * np.minimum(ultimate, _HIGHEST)


@units(None, "Pa", returns="1", latex=r"k_{{\mathrm{{surface}}}}\left({1}\right)")
def surface_factor(surface: str, ultimate: Array) -> Array:
    """Return the surface factor k_a [1] = a S^b, with the ultimate strength S [Pa] in MPa; at most 1."""
    factor, exponent = SURFACES[surface]
    return np.minimum(factor * (ultimate / MPA) ** exponent, 1.0)


@units("m", returns="1", latex=r"k_{{\mathrm{{size}}}}\left({0}\right)")
def size_factor(d: Array) -> Array:
    """Return the size factor k_b [1] of a diameter [m]: 1.24 d^-0.107 up to 51 mm, then 1.51 d^-0.157.

    It is at most 1, and 1 if no diameter is given.
    """
    mm = np.maximum(np.where(np.isnan(d), _SMALL, d), _SMALL) * 1e3
    factor = np.where(mm <= _MIDDLE * 1e3, 1.24 * mm**-0.107, 1.51 * mm**-0.157)
    return np.where(np.isnan(d), 1.0, np.minimum(factor, 1.0))[()]


@units(None, returns="1", latex=r"1\ \text{{or}}\ 0.85\ \text{{(axial)}}")
def loading_factor(loading: str) -> Array:
    """Return the load factor k_c [1]: 1 in bending, 0.85 under axial load.

    The criterion accounts for shear, so torsion needs no factor.
    """
    return np.float64(_LOADINGS[loading])  # type: ignore[return-value]


@units("1", returns="1", latex=r"1-0.08\,z\left({0}\right)")
def reliability_factor(reliability: Array) -> Array:
    """Return k_e [1] = 1 - 0.08 z, with z the normal quantile of the reliability: 8 % standard deviation."""
    return 1 - 0.08 * ndtri(reliability)


@units("Pa", returns="Pa", latex=r"{0}+345\,\mathrm{{MPa}}")
def strength_coefficient(ultimate: Array) -> Array:
    """Return the fatigue strength coefficient [Pa] of steel up to 500 HB from its ultimate strength [Pa]."""
    return ultimate + _ADDED


@units(
    "Pa",
    returns="1",
    latex=r"\min\left(\frac{{\sigma_F'}}{{{0}}}\left(2\cdot10^{{3}}\right)^{{b}},0.9\right)",
)
def share_at_1000_cycles(ultimate: Array) -> Array:
    """Return the fatigue strength at 1000 cycles as a fraction f [1] of the ultimate strength [Pa].

    σ_F' = S_u + 345 MPa, and a line runs through σ_F' and the specimen's limit at 10⁶ cycles (equation 6-10).
    The fraction is at most 0.9, the value of the book below 70 ksi (figure 6-18), because below 300 MPa the
    line exceeds the ultimate strength.
    """
    first = strength_coefficient(ultimate)
    b = -np.log(first / specimen_limit(ultimate)) / np.log(2 * KNEE)
    return np.minimum(first / ultimate * (2 * FIRST) ** b, _MOST_AT_1000)


@units("Pa", returns="m", latex=r"a_{{\mathrm{{Neuber}}}}\left({0}\right)")
def neuber_length(ultimate: Array) -> Array:
    """Return Neuber's constant a [m] in bending from the ultimate strength [Pa].

    It is NaN beyond 1750 MPa, where the fit ends. The fit gives √a in √in from the strength in ksi.
    """
    S = ultimate / KSI
    root = 0.246 - 3.08e-3 * S + 1.51e-5 * S**2 - 2.67e-8 * S**3
    return np.where(root > 0, root**2 * INCH, np.nan)[()]


@units("m", "m", returns="1", latex=r"\left(1+\sqrt{{\frac{{{0}}}{{{1}}}}}\right)^{{-1}}")
def notch_sensitivity_Neuber(length: Array, radius: Array) -> Array:
    """Return the notch sensitivity q [1] of a notch radius [m] and Neuber's constant [m]; NaN if missing."""
    return 1 / (1 + np.sqrt(length / radius))


@units("1", "1", returns="1", latex=r"\frac{{1+{1}\left({0}-1\right)}}{{{0}}}")
def notch_support(K_t: Array, q: Array) -> Array:
    """Return K_f/K_t [1], the fraction of a local stress that is effective in fatigue.

    It is 1 if notch or sensitivity is missing.
    """
    share = (1 + q * (K_t - 1)) / K_t
    return np.where(np.isnan(share), 1.0, share)[()]


@units("Pa", "Pa", "1", returns="1", latex=r"\frac{{\lg\left({1}/{0}\right)}}{{\lg {2}-3}}")
def slope_of_line(at_1000: Array, endurance: Array, knee: Array) -> Array:
    """Return the exponent b [1] of the S–N line from 1000 cycles to the endurance limit at the knee."""
    return np.log(endurance / at_1000) / np.log(knee / FIRST)


@units("1", "1", returns="1")
def both_or_none(K_t: Array, other: Array) -> Truth:
    """Return whether a stress concentration factor and its notch sensitivity are both given, or neither."""
    return np.isnan(K_t) | ~np.isnan(other)
