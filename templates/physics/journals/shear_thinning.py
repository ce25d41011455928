r"""Shear thinning of multigrade oils: Cross's law, with its critical shear rate from one HTHS viscosity.

.. math:: \eta = \eta_\infty + \frac{\eta_0-\eta_\infty}{1+(\dot\gamma/\dot\gamma_c)^n}

The HTHS viscosity of SAE J300 is measured at 150 °C and 1e6 1/s. Together with the viscosities at low and at
infinite shear rate at 150 °C it gives gamma_c. `critical_rate_at` converts gamma_c to another temperature:
the product of gamma_c and eta_0 stays constant, as in time-temperature superposition. We found no source for
this step in engine oils; to avoid it, give a gamma_c at the temperature of the film.

References
----------
M. M. Cross: J. Colloid Sci. 20, 1965, p. 417.
SAE J300; ASTM D4683 for the HTHS viscosity.
"""

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units

HTHS_RATE = 1e6
"""Shear rate of the HTHS viscosity [1/s]."""
HTHS_TEMPERATURE = 423.15
"""Temperature of the HTHS viscosity, 150 °C [K]."""


@units("1/s", "Pa*s", "Pa*s", "1/s", "1", returns="Pa*s")
def viscosity_Cross_1965(rate: Array, eta_0: Array, eta_inf: Array, critical: Array, n: Array) -> Array:
    """Return the dynamic viscosity at a shear rate [Pa s].

    Parameters
    ----------
    rate
        Magnitude of the shear rate, 0 or more [1/s].
    eta_0, eta_inf
        Viscosities at low and at infinite shear rate [Pa s].
    critical
        Shear rate gamma_c at which the viscosity is the mean of eta_0 and eta_inf [1/s].
    n
        Exponent, above 0 [-].

    Examples
    --------
    >>> float(viscosity_Cross_1965(1e6, 0.012, 0.008, 1e6, 1.0))
    0.01
    """
    with np.errstate(over="ignore"):  # at infinite shear rate nothing of the difference remains
        kept = 1 / (1 + (np.asarray(rate, float) / critical) ** n)
    return (eta_0 * kept + eta_inf * (1 - kept))[()]


@units("Pa*s", "Pa*s", "Pa*s", "1", returns="1/s")
def critical_rate_of_HTHS(hths: Array, eta_0: Array, eta_inf: Array, n: Array) -> Array:
    """Return the critical shear rate at which Cross's law gives the HTHS viscosity [1/s].

    The result is NaN if there is none.

    Parameters
    ----------
    hths
        Viscosity at 150 °C and 1e6 1/s [Pa s].
    eta_0, eta_inf
        Viscosities at low and at infinite shear rate at 150 °C; hths lies between them [Pa s].
    n
        Exponent, above 0 [-].
    """
    thins = (hths < eta_0) & (hths > eta_inf)
    ratio = np.where(thins, hths - eta_inf, 1.0) / np.where(thins, eta_0 - hths, 1.0)
    return np.where(thins, HTHS_RATE * ratio ** (1 / np.asarray(n, float)), np.nan)[()]


@units("1/s", "Pa*s", "Pa*s", returns="1/s")
def critical_rate_at(critical: Array, eta_there: Array, eta_0: Array) -> Array:
    """Return the critical shear rate for another low-shear viscosity; their product is constant [1/s].

    Parameters
    ----------
    critical
        The known critical shear rate [1/s].
    eta_there, eta_0
        Low-shear viscosity for the known rate, and for the wanted rate [Pa s].
    """
    return critical * eta_there / eta_0
