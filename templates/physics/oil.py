"""Density and viscosity of lubricating oil over temperature; the viscosity after Walther (ASTM D341).

lg lg(nu + 0.7) = A − B lg T, with nu in mm²/s and T in K. Meant for mineral oils between pour point and
about 200 °C; nu must exceed 0.3 mm²/s, where the inner logarithm vanishes.
"""

from __future__ import annotations

import numpy as np

from templates.core.declare import Array, units

MM2_PER_S = 1e-6  # m²/s


@units("kg/m**3", "K", "K", returns="kg/m**3")
def density(rho_ref: Array, T: Array, T_ref: Array) -> Array:
    """Density [kg/m³] at the temperature T [K], falling by 0.07 % of rho_ref [kg/m³] per kelvin above T_ref.

    References
    ----------
    Bhadke, Chaudhari, Sharma: IJETR 3(5), 2015.
    """
    return rho_ref * (1 - 0.0007 * (T - T_ref))


@units("m**2/s", returns="1", latex=r"\lg\lg\left(\frac{{{0}}}{{\mathrm{{mm^2/s}}}}+0.7\right)")
def double_logarithm(nu: Array) -> Array:
    """Walther's ordinate lg lg(nu + 0.7) of the kinematic viscosity nu [m²/s]; NaN from 0.3 mm²/s down."""
    return np.log10(np.log10(nu / MM2_PER_S + 0.7))


@units("K", returns="1", latex=r"\lg\frac{{{0}}}{{\mathrm{{K}}}}")
def temperature_logarithm(T: Array) -> Array:
    """Walther's abscissa lg T of the absolute temperature T [K]."""
    return np.log10(T)


@units(
    "1",
    "1",
    "K",
    returns="m**2/s",
    latex=r"\left(10^{{10^{{{0}-{1}\,\lg {2}}}}}-0.7\right)\mathrm{{\frac{{mm^2}}{{s}}}}",
)
def walther(A: Array, B: Array, T: Array) -> Array:
    """Kinematic viscosity [m²/s] at the temperature T [K] from Walther's constants A, B [1].

    References
    ----------
    ASTM D341, Standard Practice for Viscosity–Temperature Equations for Liquid Petroleum Products.
    """
    return (10 ** (10 ** (A - B * np.log10(T))) - 0.7) * MM2_PER_S
