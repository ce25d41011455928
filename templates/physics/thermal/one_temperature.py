"""The one-temperature level: the heat balance of ISO 7902-1 with the film map, for many points at once.

It ignores groove and supply pressure, but includes cooling by air on the back of the bush, as `oil_film`
does.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.films.film_map import NARROWEST, WIDEST
from templates.physics.journals.heat_balance import OperatingPoint, heat_balance
from templates.physics.journals.static_journal import static_film_at
from templates.physics.thermal.thermal_case import ThermalCase


def mapped_values(case: ThermalCase) -> dict[str, Array]:
    """Return the values of `WarmFilm` at a single temperature; eps is infinite if there is no balance."""
    area = np.pi * case.D * case.W
    running = OperatingPoint(
        F=case.F, D=case.D, W=case.W, psi=case.psi, omega_m=case.omega, omega_s=case.omega, A=case.A,
        B=case.B, a=case.a, b=case.b, offset=case.offset, eta=case.eta, rho_ref=case.rho_ref,
        T_ref=case.T_ref, heat_capacity=case.heat_capacity, T_supply=case.supply, T_ambient=case.ambient,
        kA=case.transfer * area,
    )  # fmt: skip
    balance, ratio = heat_balance(running), case.W / case.D
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        T = np.where(np.isfinite(balance.T), balance.T, np.nan)
        inside = (ratio >= NARROWEST) & (ratio <= WIDEST)
        thin = case.viscosity(T)
        So = case.F * case.psi**2 / (case.D * case.W * thin * case.omega)
        film = static_film_at("map", np.where(inside, So, np.nan), np.where(inside, ratio, 1.0))
        less = thin / case.viscosity(case.supply)
        delta = case.viscosity(case.supply) * case.omega / (case.heat_capacity * case.psi**2)
        torque = 2 * less * (film.shear + film.eps * film.So * np.sin(film.attitude) / 2)
        side = film.side_flow * case.D / (2 * case.W)
        by_oil = side * (balance.T_out - case.supply)
        conducted = running.kA / (case.heat_capacity * case.omega * case.psi * case.D**2 * case.W / 4)
        by_bush = np.nan_to_num(conducted * (T - case.ambient), nan=0.0) + 0 * T
        top = np.fmax(T, balance.T_out)
    return {
        "eps": np.where(np.isinf(balance.T), np.inf, film.eps), "attitude": film.attitude,
        "P_max": film.P_max * less, "T_max": top, "bush_max": top, "T_side": balance.T_out,
        "torque": torque, "side": side, "dissipated": delta * torque, "by_oil": by_oil, "by_bush": by_bush,
        "one_T": T,
    }  # fmt: skip
