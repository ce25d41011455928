"""Groups: an oil with its viscosity at the film temperature, and the sources of that temperature.

A template that inherits `Oil` defines the film temperature in `T_film` [K]; the viscosity follows from it,
unless it is given. A template that inherits `WarmOil` instead defines its heat balance in `balance`.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import (
    Array,
    Template,
    Truth,
    choice,
    derived,
    formula,
    given,
    require,
    shared,
)
from templates.physics.journals.heat_balance import HeatBalance
from templates.physics.journals.journal_temperature import (
    film_temperature,
    mean_is_used,
    or_reference,
    outlet_temperature,
    viscosity_known,
)
from templates.physics.journals.oil import (
    by_law,
    density,
    double_logarithm,
    temperature_logarithm,
    vogel,
    vogel_factor,
    vogel_slope,
    walther,
)
from templates.physics.journals.oil_grades import grades, viscosity_at_40, viscosity_at_100

ISO = "ISO 7902-1:1998"
NO_BALANCE = "needs supply_temperature, or ambient_temperature with heat_transfer"
NO_SUPPLY = "needs supply_temperature"
BELOW_POLE = (
    "`temperature_1` or `temperature_2` lies below the pole of Vogel's law, at minus its offset in degC"
)


class Oil(Template):
    """An oil by grade or by two viscosities, and its viscosity at the film temperature."""

    T_film: Array  # a formula of the template: the temperature of its film [K], NaN without one

    grade: str = choice(*grades(), words="oil grade", default="sae_15w_40", assumed="the oil is SAE 15W-40")
    T_1: Array = given("degC", "temperature 1", default="40 degC", ge=-100, le=500)
    T_2: Array = given("degC", "temperature 2", default="100 degC", ge=-100, le=500)
    law: str = choice("walther", "vogel", words="viscosity law", default="walther")
    c_V: Array = given("delta_degC", "Vogel offset", symbol="c_{V}", default="95 K", source="Cameron 1966")
    T_ref: Array = given("degC", "reference temperature", default="20 degC", ge=-100, le=500)
    rho_ref: Array = given("kg/m**3", "reference density", default="875 kg/m**3", gt=0)

    @derived("mm**2/s", "kinematic viscosity 1", gt=0.3)
    def nu_1(self) -> Array:
        """Default: the viscosity of the grade at 40 °C."""
        return viscosity_at_40(self.grade)

    @derived("mm**2/s", "kinematic viscosity 2", gt=0.3)
    def nu_2(self) -> Array:
        """Default: the viscosity of the grade at 100 °C."""
        return viscosity_at_100(self.grade)

    @derived(
        "delta_degC", "Vogel slope", symbol="b_{V}", shown=True, ge=0, source="Vogel 1921", absent=BELOW_POLE
    )
    def b_V(self) -> Array:
        """Vogel's slope from the two viscosities."""
        return vogel_slope(self.eta_1, self.T_1, self.eta_2, self.T_2, self.c_V)

    @derived(
        "mPa*s", "Vogel factor", symbol="a_{V}", shown=True, gt=0, source="Vogel 1921", absent=BELOW_POLE
    )
    def a_V(self) -> Array:
        """Vogel's factor from the first viscosity."""
        return vogel_factor(self.eta_1, self.T_1, self.b_V, self.c_V)

    @require("temperature_1", "temperature_2", remedy="give the viscosity at two temperatures")
    def temperatures_differ(self) -> Truth:
        """The two viscosities are known at different temperatures."""
        return self.T_1 != self.T_2

    @require("kinematic_viscosity_1", "kinematic_viscosity_2", remedy="swap the two viscosities")
    def oil_thins_when_hot(self) -> Truth:
        """The viscosity is not higher at the higher temperature."""
        return (self.nu_1 - self.nu_2) * (self.T_2 - self.T_1) >= 0

    @require(
        "viscosity_law", remedy="set `viscosity_law` to `vogel`, or omit `vogel_factor` and `vogel_slope`"
    )
    def vogel_is_asked_for(self) -> Truth:
        """Vogel's constants are given only with Vogel's law."""
        return (self.law == "vogel") | (np.isnan(self.as_given("a_V")) & np.isnan(self.as_given("b_V")))

    @require("vogel_factor", "vogel_slope", remedy="the one left out would be that of another oil")
    def vogel_is_whole(self) -> Truth:
        """Vogel's factor and slope are given together, or neither."""
        return np.isnan(self.as_given("a_V")) == np.isnan(self.as_given("b_V"))

    @require("temperature_1", "temperature_2", "vogel_offset", remedy="give viscosities above it")
    def vogel_is_known(self) -> Truth:
        """Both temperatures of Vogel's law are above its pole, which is at minus its offset in degC."""
        return (self.law != "vogel") | (np.isfinite(self.a_V) & np.isfinite(self.b_V))

    @formula("1", "Walther slope", symbol="B", source="ASTM D341")
    def B(self) -> Array:
        """Walther's slope from the two viscosities."""
        return (double_logarithm(self.nu_1) - double_logarithm(self.nu_2)) / (
            temperature_logarithm(self.T_2) - temperature_logarithm(self.T_1)
        )

    @formula("1", "Walther intercept", symbol="A", source="ASTM D341")
    def A(self) -> Array:
        """Walther's intercept from the second viscosity."""
        return double_logarithm(self.nu_2) + self.B * temperature_logarithm(self.T_2)

    @formula("mPa*s", "dynamic viscosity 1", symbol=r"\eta_{1}")
    def eta_1(self) -> Array:
        """Viscosity at temperature 1."""
        return self.nu_1 * density(self.rho_ref, self.T_1, self.T_ref)

    @formula("mPa*s", "dynamic viscosity 2", symbol=r"\eta_{2}")
    def eta_2(self) -> Array:
        """Viscosity at temperature 2."""
        return self.nu_2 * density(self.rho_ref, self.T_2, self.T_ref)

    @formula(
        "kg/m**3", "density", symbol=r"\rho", gt=0, source="Bhadke et al. 2015",
        remedy="the linear law ends 1428 K above its reference",
    )  # fmt: skip
    def rho(self) -> Array:
        """Density at the film temperature, or at the reference temperature if that is unknown."""
        return density(self.rho_ref, or_reference(self.T_film, self.T_ref), self.T_ref)

    @derived(
        "mPa*s", "dynamic viscosity", shown=True, gt=0, source="ASTM D341; Vogel 1921",
        remedy="the oil is stiff here: Walther's law overflows, or Vogel's has its pole at minus its offset",
    )  # fmt: skip
    def eta(self) -> Array:
        """Viscosity by the chosen law at the film's temperature."""
        return by_law(
            self.law,
            walther(self.A, self.B, self.T_film) * self.rho,
            vogel(self.a_V, self.b_V, self.c_V, self.T_film),
        )

    @formula("mm**2/s", "kinematic viscosity", gt=0)
    def nu(self) -> Array:
        """Kinematic viscosity: dynamic viscosity over density."""
        return self.eta / self.rho


class WarmOil(Oil):
    """An oil whose film temperature is a given mean, follows from a heat balance, or is unknown."""

    balance: HeatBalance  # shared by the template: NaN where no balance is requested

    T_in: Array = given("degC", "oil inlet temperature", alternative=True, ge=-100, le=500)
    T_out: Array = given("degC", "oil outlet temperature", alternative=True, ge=-100, le=500)
    T_s: Array = given("degC", "supply temperature", alternative=True, ge=-100, le=499)
    T_amb: Array = given("degC", "ambient temperature", alternative=True, ge=-100, le=499)
    kA: Array = given("W/K", "heat transfer", alternative=True, ge=0)
    rho_c: Array = given("kJ/(m**3*K)", "heat capacity", default="1800 kJ/(m**3*K)", gt=0, source=ISO)

    @require(
        "oil_inlet_temperature", "oil_outlet_temperature", missing=True,
        remedy="both; or `supply_temperature`; or `ambient_temperature`, `heat_transfer`; "
               "or `dynamic_viscosity`",
    )  # fmt: skip
    def viscosity_follows(self) -> Truth:
        """The viscosity is given, or follows from a temperature."""
        return self.viscosity_is_known

    @require(
        "oil_inlet_temperature", "oil_outlet_temperature", warning="unused_input",
        remedy="omit them, or omit the supply and ambient temperatures",
    )  # fmt: skip
    def mean_not_overruled(self) -> Truth:
        """Inlet and outlet temperature are used only if no heat balance gives the film temperature."""
        return self.mean_is_used

    @shared
    def viscosity_is_known(self) -> Truth:
        """Return whether the viscosity is given or follows from a temperature."""
        return viscosity_known(self.as_given("eta"), self.T_in, self.T_out, self.T_s, self.T_amb, self.kA)

    @shared
    def mean_is_used(self) -> Truth:
        """Return whether given inlet and outlet temperatures are used."""
        return mean_is_used(self.T_in, self.T_out, self.T_s, self.T_amb, self.kA)

    @formula("degC", "service temperature", absent="needs oil_inlet_temperature and oil_outlet_temperature")
    def T(self) -> Array:
        """Mean of inlet and outlet temperature."""
        return (self.T_in + self.T_out) / 2

    @formula(
        "degC", "film temperature", absent="no temperature is given; the dynamic viscosity is",
        remedy="the heat balance finds none below 500 °C: cool more, or lower load or speed",
    )  # fmt: skip
    def T_film(self) -> Array:
        """Temperature from the heat balance, or the mean temperature."""
        return film_temperature(self.T, self.balance)

    @formula("degC", "outlet temperature", symbol=r"T_{e}", absent=NO_SUPPLY, source=ISO)
    def T_e(self) -> Array:
        """Temperature of the outflowing oil, from the heat balance."""
        return outlet_temperature(self.balance)

    @formula("delta_degC", "temperature rise", symbol=r"\Delta T", absent=NO_SUPPLY, source=ISO)
    def rise(self) -> Array:
        """Difference between outlet and supply temperature."""
        return self.T_e - self.T_s

    @formula("1", "heat balance residual", absent=NO_BALANCE)
    def residual(self) -> Array:
        """Fraction of the heat that the balance does not account for."""
        return self.balance.residual
