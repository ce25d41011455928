"""A journal bearing with its groove, its oil and its thermal boundary conditions, in SI."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import units
from templates.physics.journals.oil import ViscousOil
from templates.physics.thermal.energy import HeatSources
from templates.physics.thermal.thermal_balance import Bearing


@dataclass(frozen=True, kw_only=True)
class ThermalCase(ViscousOil):
    """A bearing with its oil, in SI; arrays that broadcast together, NaN where data are not given."""

    F: Array
    """Load [N]."""
    D: Array
    W: Array
    """Diameter and width of the bearing [m]."""
    psi: Array
    """Relative clearance [-]."""
    omega: Array
    """Speed of the journal [rad/s]."""
    pressure: Array
    """Supply pressure above ambient [Pa]."""
    angle: Array
    """Angle from the load to the groove's middle [rad]."""
    extent: Array
    """Angular width of the groove [rad]."""
    length: Array
    """Axial length of the groove over the bearing's width [-]."""
    carry_over: Array
    """Fraction of the oil arriving at the groove that continues into the film [-]."""
    supply: Array
    """Temperature of the fresh oil [K]."""
    heat_capacity: Array
    """Heat capacity of the oil per volume [J/(m³ K)]."""
    conductivity: Array
    """Thermal conductivity of the oil [W/(m K)]."""
    held: Array
    """Given temperature of the bush, else NaN [K]."""
    transfer: Array
    """Heat transfer coefficient of the bush, else NaN [W/(m² K)]."""
    ambient: Array
    """Temperature behind the bush, else NaN [K]."""
    journal: Array
    """Temperature of the journal; NaN for a journal without net heat flow [K]."""

    def is_whole(self) -> bool:
        """Return whether all data that a film needs are known."""
        needed = (self.F, self.D, self.W, self.psi, self.omega, self.pressure, self.viscosity(self.supply))
        return bool(np.isfinite(needed).all())

    def bearing(self) -> Bearing:
        """Return one point as a dimensionless bearing."""
        eta = float(self.viscosity(self.supply))
        scale = eta * self.omega / self.psi**2
        per_second = self.heat_capacity * self.omega
        clearance = self.psi * self.D / 2
        held, cooled = np.isfinite(self.held), np.isfinite(self.transfer) & np.isfinite(self.ambient)
        wall = self.transfer / (per_second * clearance) if cooled else 0.0
        outside = self.held if held else self.ambient if cooled else self.supply
        heating = HeatSources(
            float(scale / self.heat_capacity), float(self.conductivity / (per_second * clearance**2)),
            np.inf if held else float(wall), float(outside), float(self.supply), float(self.journal),
            float(self.carry_over),
        )  # fmt: skip
        return Bearing(
            float(self.F / (self.D * self.W * scale)), float(self.W / self.D), float(self.pressure / scale),
            (float(self.angle), float(self.extent), float(self.length)), heating,
            self._thinner(eta),
        )  # fmt: skip

    def _thinner(self, eta: float) -> Callable[[Array], Array]:
        """Return a viscosity [Pa s] over that at a temperature [K]; 0 where the oil is almost solid."""

        def fluidity(T: Array) -> Array:
            with np.errstate(over="ignore"):
                return np.asarray(eta / self.viscosity(T))

        return fluidity


@units(None, "K", returns="Pa*s", latex=r"\eta\left({1}\right)")
def warm_viscosity(case: ThermalCase, T: Array) -> Array:
    """Return the viscosity of the case's oil at a temperature T [K]; NaN where T is NaN [Pa s]."""
    return np.where(np.isnan(T), np.nan, case.viscosity(T))[()]
