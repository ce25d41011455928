"""Hydrostatic pads: a deep recess, fed through a restrictor and bounded by circular lands of uniform film.

In the land the pressure falls with ln r from the recess to the edge: (1/r) d/dr(r h³ dp/dr) = 0. The outer
land spans R_0 … R. An annular pad also has an inner land r … r_0; a circular pad has none, and its inner
radii are NaN.

References
----------
H. C. Rippel: Cast Bronze Hydrostatic Bearing Design Manual, 1963.
B. J. Hamrock, S. R. Schmid, B. O. Jacobson: Fundamentals of Fluid Film Lubrication, 2nd ed. 2004, chapter 13.
"""

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

CAPILLARY, ORIFICE, CONSTANT_FLOW = "capillary", "orifice", "constant_flow"
RESTRICTORS = (CAPILLARY, ORIFICE, CONSTANT_FLOW)
"""The restrictors that can feed a recess."""


@units("m", "m", returns="1", latex=r"\ln\frac{{{1}}}{{{0}}}")
def logarithm_of_land(inner: Array, outer: Array) -> Array:
    """Return ln(outer/inner) of a land between two radii or diameters [m], accurate for narrow lands [-]."""
    return np.log1p((outer - inner) / inner)


@units(
    "m",
    "m",
    "m",
    "m",
    returns="m**2",
    latex=r"\frac{{\pi}}{{8}}\left(\frac{{{0}^2-{1}^2}}{{\ln({0}/{1})}}-\frac{{{2}^2-{3}^2}}{{\ln({2}/{3})}}\right)",
)
def effective_area(D: Array, D_0: Array, d_0: Array, d: Array) -> Array:
    r"""Return the effective area: load over recess pressure [m²].

    .. math:: A_e = \frac{\pi}{2}\left[\frac{R^2-R_0^2}{\ln(R/R_0)} - \frac{r_0^2-r^2}{\ln(r_0/r)}\right]

    Parameters
    ----------
    D, D_0
        Outer diameters of the pad and of its recess [m].
    d_0, d
        Inner diameters of the recess and of the pad; NaN for a circular pad [m].

    Examples
    --------
    >>> round(float(effective_area(2.0, 1.0, np.nan, np.nan)), 4)
    1.6996
    """
    outer = (D - D_0) * (D + D_0) / logarithm_of_land(D_0, D)
    inner = (d_0 - d) * (d_0 + d) / logarithm_of_land(d, d_0)
    return np.pi / 8 * (outer - np.where(np.isnan(d_0 + d), 0.0, inner))[()]


@units(
    "m",
    "m",
    "m",
    "m",
    returns="1",
    latex=r"\frac{{\pi}}{{6}}\left(\frac{{1}}{{\ln({0}/{1})}}+\frac{{1}}{{\ln({2}/{3})}}\right)",
)
def land_conductance(D: Array, D_0: Array, d_0: Array, d: Array) -> Array:
    r"""Return the flow Q eta/(p h³) over all lands [-].

    .. math:: q = \frac{\pi}{6}\left[\frac{1}{\ln(R/R_0)} + \frac{1}{\ln(r_0/r)}\right]

    Parameters
    ----------
    D, D_0
        Outer diameters of the pad and of its recess [m].
    d_0, d
        Inner diameters of the recess and of the pad; NaN for a circular pad [m].
    """
    inner = 1 / logarithm_of_land(d, d_0)
    return np.pi / 6 * (1 / logarithm_of_land(D_0, D) + np.where(np.isnan(d_0 + d), 0.0, inner))[()]


@units(
    "m",
    "m",
    "m",
    "m",
    returns="m**4",
    latex=r"\frac{{\pi}}{{32}}\left({0}^4-{1}^4+{2}^4-{3}^4\right)",
)
def polar_moment_of_lands(D: Array, D_0: Array, d_0: Array, d: Array) -> Array:
    """Return the integral of r² over the lands [m⁴], which gives the friction torque of a rotating collar.

    Parameters
    ----------
    D, D_0
        Outer diameters of the pad and of its recess [m].
    d_0, d
        Inner diameters of the recess and of the pad; NaN for a circular pad [m].
    """
    inner = np.where(np.isnan(d_0 + d), 0.0, d_0**4 - d**4)
    return np.pi / 32 * (D**4 - D_0**4 + inner)[()]


@units(None, "Pa", "m", "m", "1", "Pa*s", "kg/m**3", "m**3/s", returns="m**3/s")
def restrictor_flow(
    kind: str,
    drop: Array,
    diameter: Array,
    length: Array,
    discharge: Array,
    eta: Array,
    rho: Array,
    pump_flow: Array,
) -> Array:
    r"""Return the flow of oil into the recess [m³/s].

    .. math::
        Q_{capillary} = \frac{\pi d^4 \Delta p}{128\,\eta\,l}, \quad
        Q_{orifice} = C_d \frac{\pi d^2}{4}\sqrt{\frac{2\Delta p}{\rho}}

    Parameters
    ----------
    kind
        One of `RESTRICTORS`.
    drop
        Pressure drop along the restrictor [Pa].
    diameter, length
        Diameter and length of the capillary; an orifice has no length [m].
    discharge
        Discharge coefficient of the orifice [-].
    eta
        Dynamic viscosity [Pa s].
    rho
        Density [kg/m³].
    pump_flow
        Flow of a constant-flow pump [m³/s].
    """
    if kind == CAPILLARY:
        return np.pi * diameter**4 * drop / (128 * eta * length)
    if kind == ORIFICE:
        return discharge * np.pi * diameter**2 / 4 * np.sqrt(2 * drop / rho)
    return pump_flow + 0 * drop


@units(None, "1", returns="1")
def stiffness_factor(kind: str, beta: Array) -> Array:
    """Return the stiffness −dW/dh over W/h, from the balance of restrictor and land flows [-].

    Parameters
    ----------
    kind
        One of `RESTRICTORS`.
    beta
        Recess over supply pressure, 0 … 1 [-].
    """
    if kind == CAPILLARY:
        return 3 * (1 - beta)
    if kind == ORIFICE:
        return 6 * (1 - beta) / (2 - beta)
    return 3 + 0 * beta


@units(None, returns="1")
def stiffest_ratio(kind: str) -> Array:
    """Return the recess over supply pressure at which a pad of given film and supply is stiffest [-].

    It is 1/2 with a capillary and 2 − √2 with an orifice. With constant flow the stiffness has no maximum,
    and the result is NaN.

    Parameters
    ----------
    kind
        One of `RESTRICTORS`.
    """
    best = {CAPILLARY: 0.5, ORIFICE: 2 - np.sqrt(2)}
    return np.asarray(best.get(kind, np.nan))[()]


@units(None, "Pa", "Pa", returns="Pa")
def pump_pressure(kind: str, supply: Array, recess: Array) -> Array:
    """Return the pressure against which the pump works; with constant flow, the recess pressure [Pa].

    Parameters
    ----------
    kind
        One of `RESTRICTORS`.
    supply, recess
        Pressures upstream and downstream of the restrictor [Pa].
    """
    return recess if kind == CONSTANT_FLOW else supply


@units("m", "m", returns="m**2", latex=r"\frac{{\pi}}{{4}}\left({0}^2-{1}^2\right)")
def pad_area(D: Array, d: Array) -> Array:
    """Return the area of the pad including its recess [m²].

    Parameters
    ----------
    D, d
        Outer and inner diameter; the inner one of a circular pad is NaN [m].
    """
    return np.pi / 4 * (D**2 - np.where(np.isnan(d), 0.0, d) ** 2)[()]


@units("W", "W", returns="1", latex=r"\frac{{{0}}}{{{1}}}")
def power_ratio(friction: Array, pumping: Array) -> Array:
    """Return the ratio of friction power to pumping power; NaN without friction [-].

    For a given film and load, the total power is least at the viscosity that makes the ratio 1. For a given
    viscosity and load, it is least at the film that makes the ratio 3, because pumping power is proportional
    to h³ and friction power to 1/h.
    """
    return np.where(friction > 0, friction / pumping, np.nan)[()]


@units(None, "kg/m**3", "m**3/s", "m", "Pa*s", returns="1", latex=r"\frac{{4\,{1}\,{2}}}{{\pi\,{3}\,{4}}}")
def capillary_Reynolds_number(kind: str, rho: Array, Q: Array, diameter: Array, eta: Array) -> Array:
    """Return the Reynolds number in a capillary, from mean velocity and diameter [-].

    It is NaN for other restrictors.

    Parameters
    ----------
    kind
        One of `RESTRICTORS`.
    rho
        Density [kg/m³].
    Q
        Flow [m³/s].
    diameter
        Diameter of the capillary [m].
    eta
        Dynamic viscosity [Pa s].
    """
    number = 4 * rho * Q / (np.pi * diameter * eta)
    return number if kind == CAPILLARY else np.nan * number
