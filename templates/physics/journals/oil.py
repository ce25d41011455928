"""Density and viscosity of lubricating oil over temperature, after Walther (ASTM D341) or Vogel.

Walther: lg lg(nu + 0.7) = A − B lg T, with nu in mm²/s and T in K. It is intended for mineral oils between
pour point and about 200 °C; nu must exceed 0.3 mm²/s, where the inner logarithm vanishes.

Vogel: eta = a exp(b/(t + c)), t in °C. An oil is defined by the three constants, or by two viscosities and c
= 95 K, which Cameron found suitable for mineral oils. The law has a pole at t = −c and is invalid below it.

References
----------
H. Vogel: Physikalische Zeitschrift 22, 1921, p. 645.
A. Cameron: The Principles of Lubrication, 1966, chapter 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

MM2_PER_S = 1e-6  # m²/s
_CELSIUS = 273.15  # K


@units("kg/m**3", "K", "K", returns="kg/m**3")
def density(rho_ref: Array, T: Array, T_ref: Array) -> Array:
    """Return the density [kg/m³] at T [K]: rho_ref reduced by 0.07 % per kelvin above T_ref.

    References
    ----------
    Bhadke, Chaudhari, Sharma: IJETR 3(5), 2015.
    """
    return rho_ref * (1 - 0.0007 * (T - T_ref))


@units("m**2/s", returns="1", latex=r"\lg\lg\left(\frac{{{0}}}{{\mathrm{{mm^2/s}}}}+0.7\right)")
def double_logarithm(nu: Array) -> Array:
    """Return Walther's ordinate lg lg(nu + 0.7) of the kinematic viscosity nu [m²/s].

    It is NaN at and below 0.3 mm²/s.
    """
    return np.log10(np.log10(nu / MM2_PER_S + 0.7))


@units("K", returns="1", latex=r"\lg\frac{{{0}}}{{\mathrm{{K}}}}")
def temperature_logarithm(T: Array) -> Array:
    """Return Walther's abscissa lg T of the absolute temperature T [K]."""
    return np.log10(T)


@units(
    "1",
    "1",
    "K",
    returns="m**2/s",
    latex=r"\left(10^{{10^{{{0}-{1}\,\lg {2}}}}}-0.7\right)\mathrm{{\frac{{mm^2}}{{s}}}}",
)
def walther(A: Array, B: Array, T: Array) -> Array:
    """Return the kinematic viscosity [m²/s] at the temperature T [K] from Walther's constants A, B [1].

    References
    ----------
    ASTM D341, Standard Practice for Viscosity–Temperature Equations for Liquid Petroleum Products.
    """
    return (10 ** (10 ** (A - B * np.log10(T))) - 0.7) * MM2_PER_S


@units("Pa*s", "K", "K", "K", returns="Pa*s", latex=r"{0}\,e^{{{1}/\left({3}/\mathrm{{°C}}+{2}\right)}}")
def vogel(a: Array, b: Array, c: Array, T: Array) -> Array:
    """Return the dynamic viscosity [Pa s] at T [K] from Vogel's a [Pa s], b, c [K].

    It is infinite at and below the pole −c °C.

    References
    ----------
    H. Vogel: Physikalische Zeitschrift 22, 1921, p. 645.
    """
    above = T - _CELSIUS + c
    with np.errstate(over="ignore"):  # just above the pole it overflows to infinity
        return np.where(above > 0, a * np.exp(b / np.where(above > 0, above, np.inf)), np.inf)[()]


@units("Pa*s", "K", "Pa*s", "K", "K", returns="K")
def vogel_slope(eta_1: Array, T_1: Array, eta_2: Array, T_2: Array, c: Array) -> Array:
    """Return Vogel's b [K] from two viscosities [Pa s] at T_1, T_2 [K]; NaN if one is below the pole."""
    return np.log(eta_1 / eta_2) / (1 / _above_pole(T_1, c) - 1 / _above_pole(T_2, c))


@units("Pa*s", "K", "K", "K", returns="Pa*s")
def vogel_factor(eta_1: Array, T_1: Array, b: Array, c: Array) -> Array:
    """Return Vogel's a [Pa s] from one viscosity [Pa s] at T_1 [K].

    It is NaN at and below the pole, or if it underflows.
    """
    a = eta_1 * np.exp(-b / _above_pole(T_1, c))
    return np.where(a > 0, a, np.nan)[()]


def _above_pole(T: Array, c: Array) -> Array:
    """Return the distance from Vogel's pole −c °C [K]; NaN below it."""
    above = T - _CELSIUS + c
    return np.where(above > 0, above, np.nan)


@units(None, "Pa*s", "Pa*s", returns="Pa*s", latex=r"{1}\ \text{{(Walther) or}}\ {2}\ \text{{(Vogel)}}")
def by_law(law: str, of_walther: Array | float, of_vogel: Array) -> Array:
    """Return the value [Pa s] that belongs to the given law, `walther` or `vogel`."""
    return of_vogel if law == "vogel" else np.asarray(of_walther)[()]


def viscosity_at(
    T: Array, A: Array, B: Array, a: Array, b: Array, c: Array, eta: Array, rho_ref: Array, T_ref: Array
) -> Array:
    """Return the dynamic viscosity [Pa s] at T [K].

    It is the given viscosity, if there is one; otherwise that of Vogel's law if its factor is given;
    otherwise that of Walther's law.

    Parameters
    ----------
    T
        Temperature [K].
    A, B
        Walther's intercept and slope [-].
    a, b, c
        Vogel's factor [Pa s], slope and offset [K]; a is NaN for Walther's law.
    eta
        The viscosity, if it does not depend on temperature, else NaN [Pa s].
    rho_ref, T_ref
        Density [kg/m³] at a temperature [K].
    """
    thin = np.where(np.isnan(a), walther(A, B, T) * density(rho_ref, T, T_ref), vogel(a, b, c, T))
    return np.where(np.isnan(eta), thin, eta)


@dataclass(frozen=True, kw_only=True)
class ViscousOil:
    """The viscosity of an oil over temperature, in SI; arrays that broadcast together."""

    A: Array
    B: Array
    """Walther's intercept and slope [-]."""
    a: Array
    b: Array
    offset: Array
    """Vogel's factor, NaN with Walther's law [Pa s], slope and offset [K]."""
    eta: Array
    """Viscosity, if it does not follow from the temperature, else NaN [Pa s]."""
    rho_ref: Array
    T_ref: Array
    """Density [kg/m³] at a temperature [K]."""

    def viscosity(self, T: Array) -> Array:
        """Return the dynamic viscosity at low shear [Pa s] at T [K]."""
        return viscosity_at(
            T, self.A, self.B, self.a, self.b, self.offset, self.eta, self.rho_ref, self.T_ref
        )
