"""The temperature of a journal bearing's film: a mean, the result of a heat balance, or unknown."""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array, Mask
from templates.core.language.declare import on_paper, units
from templates.physics.journals.heat_balance import HeatBalance, asked_for


@units("K", None, returns="K", latex=r"{0}\ \text{{or that of the heat balance}}")
def film_temperature(T_mean: Array, balance: HeatBalance) -> Array:
    """Return the temperature from the heat balance if there is one, otherwise the mean temperature [K].

    The result is NaN if neither is known.
    """
    return np.where(np.isnan(balance.T), T_mean, balance.T)[()]


@on_paper("solved numerically by bracketing the film temperature in the heat balance of ISO 7902-1")
@units(None, returns="K")
def outlet_temperature(balance: HeatBalance) -> Array:
    """Return the temperature of the outflowing oil from the heat balance [K].

    The result is NaN without a balance or a supply.
    """
    return balance.T_out


@units("K", "K", returns="K", latex=r"{0}")
def or_reference(T: Array, T_ref: Array) -> Array:
    """Return T, or the reference temperature if T is NaN, so that a density remains unchanged [K]."""
    return np.where(np.isnan(T), T_ref, T)[()]


def viscosity_known(
    eta: Array, T_in: Array, T_out: Array, T_supply: Array, T_ambient: Array, kA: Array
) -> Mask:
    """Return whether the viscosity is given (not NaN) or follows from a temperature."""
    means = np.isfinite(T_in) & np.isfinite(T_out)
    return np.asarray(np.isfinite(eta) | means | asked_for(T_supply, T_ambient, kA))[()]


def mean_is_used(T_in: Array, T_out: Array, T_supply: Array, T_ambient: Array, kA: Array) -> Mask:
    """Return whether given inlet and outlet temperatures determine the film's temperature."""
    given = np.isfinite(T_in) | np.isfinite(T_out)
    return np.asarray(~(given & asked_for(T_supply, T_ambient, kA)))[()]
