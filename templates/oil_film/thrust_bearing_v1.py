"""Thrust bearing: a collar on fixed-incline sector pads, with its heat balance (MEC 315).

The film follows from the load, and its temperature from the friction heat that the oil carries off. The film
is isothermal with an effective viscosity, incompressible and laminar; faces are rigid, and the pressure
around the pads is ambient.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.template import Array, Truth, formula, given, require, shared
from templates.groups.film_assumptions import ISOTHERMAL
from templates.groups.film_criteria import film_exists, hot_oil, temperature
from templates.groups.oil import Oil
from templates.physics.journals.oil import by_law, viscosity_at
from templates.physics.pads.thrust_collar import Collar, CollarFilm, working_collar

NO_SUPPLY = "needs supply_temperature"
UNBORNE = (
    "no film ratio from 1.000001 to 100 bears this load with a film below 500 °C: change taper, speed, "
    "viscosity or pads, or cool more"
)
MEC = "MEC 315"


class ThrustBearing(Oil):
    """Thrust bearing: a collar on fixed-incline sector pads, with its heat balance (MEC 315).

    The film follows from the load, and its temperature from the friction heat that the oil removes. The film
    is isothermal with an effective viscosity, incompressible and laminar; faces are rigid, and the pressure
    around the pads is ambient.

    Limits
    ------
    Each pad slopes over its whole angle: the film thickness decreases linearly with the angle, by the taper,
    and is the same at all radii. Pads with a flat part and tilting pads have other films.
    Each pad is solved as a sector, on 16 × 4 and 32 × 8 intervals, which are extrapolated. Relative to finer
    meshes its load has an error of 0.1 %, its flows of 0.06 % of the inlet flow for film ratios to 5, b/l 0.3
    to 3 and diameter ratios to 3; at the worst corner of the accepted range (film ratio 100, b/l 10, diameter
    ratio 5) 0.7 % and 7 %. A rectangle of the pad's mean length, which slider_bearing 1 calculates, has 8 to
    10 % less torque at a diameter ratio of 2 (`c29dd3ed:benchmarks/thrust_bearing.py`).
    The load is distributed evenly over all pads, without runout of the collar.
    Heat: the oil of a pad leaves at its outlet with the outlet temperature, and at its sides with the mean of
    inlet and outlet, which is the film temperature. The carried-over share of the outlet's oil flows under
    the next pad. This share depends on the grooves; its default of one half has no source; 0 gives the
    lowest, 1 the highest temperature. No heat is lost through pads and collar.
    Without a supply temperature there is no heat balance; give the viscosity.
    The film Reynolds number is that of the inlet film at the mean radius; the film is laminar up to about
    1000.

    References
    ----------
    Course MEC 315, hydrodynamic lubrication.
    Michell: Zeitschrift für Mathematik und Physik 52, 1905, p. 123, for pads of finite width.
    ASTM D341 (Walther) or Vogel: Physikalische Zeitschrift 22, 1921, p. 645, for the viscosity.
    """

    precision = 1e-8

    assumptions = (ISOTHERMAL, "pads and collar are rigid and smooth", "every pad bears its share")
    example = {
        "load": "20 kN",
        "outer_diameter": "200 mm",
        "inner_diameter": "110 mm",
        "pads": 8,
        "taper": "30 um",
        "speed": "1500 rpm",
        "oil_grade": "iso_vg_46",
        "supply_temperature": "40 degC",
    }
    main_results = (
        "load", "speed", "specific_load", "minimum_film_thickness", "power_loss", "fresh_oil_flow",
        "outlet_temperature",
    )  # fmt: skip
    criteria = {
        "film": {
            "require": "minimum_film_thickness >= smallest_permissible_film",
            "words": "the smallest film is not thinner than the smallest permissible one",
            "limits": {
                "smallest_permissible_film": {
                    "unit": "um",
                    "words": "smallest film that the bearing may have",
                }
            },
        },
        "film_exists": film_exists(),
        "specific_load": {
            "require": "specific_load <= permissible_specific_load",
            "words": "the load over the area of the pads is within what the bearing material bears",
            "limits": {
                "permissible_specific_load": {
                    "unit": "MPa",
                    "words": "largest load over the area of the pads that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
        "temperature": temperature(
            "outlet_temperature", "the oil at the outlet is no hotter than the bearing material bears"
        ),
        "hot_oil": hot_oil("outlet_temperature"),
        "laminar": {
            "require": "film_reynolds_number <= 1000",
            "words": "the flow in the film is laminar",
            "source": "MEC 315",
            "warning": "turbulent_flow",
        },
    }

    F: Array = given("kN", "load", symbol="F", gt=0)
    D_o: Array = given("mm", "outer diameter", gt=0)
    D_i: Array = given("mm", "inner diameter", gt=0)
    z: Array = given("1", "pads", symbol="z", integer=True, ge=1, le=1000)
    share: Array = given("1", "pad share", symbol=r"\kappa", default=0.8, gt=0, lt=1,
                         remedy="the part of the circle that pads cover; grooves are the rest")  # fmt: skip
    t: Array = given("um", "taper", symbol="t", gt=0)
    omega: Array = given("rpm", "speed", gt=0)
    T_s: Array = given("degC", "supply temperature", alternative=True, ge=-100, le=499)
    k: Array = given("1", "carried over share", symbol="k", default=0.5, ge=0, le=1)
    rho_c: Array = given("kJ/(m**3*K)", "heat capacity", default="1800 kJ/(m**3*K)", gt=0)

    @require("inner_diameter", "outer_diameter", remedy="swap them")
    def pads_have_a_width(self) -> Truth:
        """The inner diameter is smaller than the outer one."""
        return self.D_i < self.D_o

    @require("supply_temperature", missing=True, remedy="give it, or `dynamic_viscosity`")
    def viscosity_follows(self) -> Truth:
        """The viscosity follows from the heat balance, or is given."""
        return ~(np.isnan(self.T_s) & np.isnan(self.as_given("eta")))

    @require("load", "speed", remedy="take fewer points at once")
    def manageable(self) -> Truth:
        """There are at most 10 000 points."""
        return bool(np.prod(self.shape_of_points(), dtype=float) <= 10_000)

    @formula("deg", "pad angle", symbol=r"\varphi")
    def phi(self) -> Array:
        return 2 * np.pi * self.share / self.z

    @formula("mm", "pad width", symbol="b")
    def b(self) -> Array:
        return (self.D_o - self.D_i) / 2

    @formula("mm", "mean diameter", symbol="D_m")
    def D_m(self) -> Array:
        return (self.D_o + self.D_i) / 2

    @formula("mm", "mean pad length", symbol="l")
    def l(self) -> Array:  # noqa: E743, the course's symbol
        return self.phi * self.D_m / 2

    @formula("1", "width ratio", symbol=r"\lambda", ge=0.1, le=10,
             remedy="pads 0.1 to 10 times as wide as long are resolved: change their number")  # fmt: skip
    def ratio(self) -> Array:
        return self.b / self.l

    @formula("1", "diameter ratio", symbol=r"\chi", le=5, remedy="sectors of up to 5 are resolved")
    def reach(self) -> Array:
        return self.D_o / self.D_i

    @formula("cm**2", "pad area", symbol=r"A_\mathrm{p}")
    def area(self) -> Array:
        return self.z * self.l * self.b

    @formula("MPa", "specific load", symbol=r"\bar{p}")
    def p(self) -> Array:
        return self.F / self.area

    @shared
    def collar(self) -> Collar:
        """Return the collar in operation."""
        return Collar(
            load=self.p, taper=self.t, omega=self.omega, radius=self.D_m / 2, angle=self.phi,
            reach=self.reach + 0 * self.ratio, heat_capacity=self.rho_c, T_supply=self.T_s, carried=self.k,
        )  # fmt: skip

    @shared
    def film(self) -> CollarFilm:
        """Return the film that carries the load, with the heat balance, dimensionless."""
        return working_collar(
            self.collar, viscosity_at, self.A, self.B, by_law(self.law, np.nan, self.a_V),
            self.b_V, self.c_V, self.as_given("eta"), self.rho_ref, self.T_ref,
        )  # fmt: skip

    @formula("1", "film ratio", symbol="a", gt=1, le=100, remedy=UNBORNE)
    def a(self) -> Array:
        return self.film.a

    @formula("um", "minimum film thickness", symbol="h_o", gt=0)
    def h_o(self) -> Array:
        return self.t / (self.a - 1)

    @formula("N*m", "friction torque", symbol="M")
    def M(self) -> Array:
        return self.F * self.D_m / 2 * self.h_o / self.l * self.film.friction

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.M * self.omega

    @formula("1", "friction coefficient", symbol="f")
    def f(self) -> Array:
        return self.M / (self.F * self.D_m / 2)

    @formula("l/min", "inlet flow", symbol=r"Q_\mathrm{i}")
    def Q_i(self) -> Array:
        return self.z * self.omega * self.D_m / 2 * self.h_o * self.b * self.film.inlet

    @formula("l/min", "side flow", symbol=r"Q_\mathrm{s}")
    def Q_s(self) -> Array:
        return self.z * self.omega * self.D_m / 2 * self.h_o * self.b * self.film.side

    @formula("l/min", "fresh oil flow", symbol="Q")
    def Q(self) -> Array:
        return self.Q_i - self.k * (self.Q_i - self.Q_s)

    @formula("delta_degC", "temperature gain", symbol=r"\delta T")
    def gain(self) -> Array:
        return self.P / (self.rho_c * (self.Q_i - self.Q_s / 2))

    @formula("degC", "inlet temperature", symbol="T_{i}", absent=NO_SUPPLY)
    def T_i(self) -> Array:
        return self.T_s + self.gain * (self.Q_i - self.Q) / self.Q

    @formula("degC", "outlet temperature", symbol="T_{e}", absent=NO_SUPPLY)
    def T_e(self) -> Array:
        return self.T_i + self.gain

    @formula("degC", "film temperature", symbol="T", absent=NO_SUPPLY)
    def T_film(self) -> Array:
        return (self.T_i + self.T_e) / 2

    @formula("delta_degC", "temperature rise", symbol=r"\Delta T", absent=NO_SUPPLY)
    def rise(self) -> Array:
        return self.T_e - self.T_s

    @formula("1", "film Reynolds number", symbol=r"\mathrm{Re}", source=MEC, published=(None, 1000))
    def Re(self) -> Array:
        return self.rho * self.omega * self.D_m / 2 * self.a * self.h_o / self.eta
