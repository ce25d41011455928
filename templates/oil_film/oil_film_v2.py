"""Oil film of a journal bearing under static load, at five levels of fidelity.

One bearing and one interface, from Ocvirk's closed form to a mass-conserving solution of the Reynolds
equation; each answer says by which level, and how far off it may be.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.declare import limits
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
    table,
    text,
)
from templates.physics.journals.heat_balance import HeatBalance, Running, heat_balance
from templates.physics.journals.journal_coefficients import Linear, linear_at
from templates.physics.journals.journal_motion import (
    hydrodynamic_speed,
    mass_of_weight,
    sliding_speed,
    whirl_speed,
)
from templates.physics.journals.journal_temperature import (
    film_temperature,
    mean_is_used,
    or_reference,
    outlet_temperature,
    viscosity_known,
)
from templates.physics.journals.lubrication_regime import (
    duty_parameter,
    film_parameter,
    friction_coefficient,
    lubrication_regime,
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
from templates.physics.journals.smallest_film import smallest_film_ISO_7902
from templates.physics.journals.static_journal import (
    BOUNDARY,
    FED,
    JournalFilm,
    is_fed,
    ladder,
    static_film_at,
)

ISO = "ISO 7902-1:1998"
NO_COEFFICIENTS = "level fit has none, nor a film whose cavities do not settle; take another level"
NO_BALANCE = "needs supply_temperature, or ambient_temperature with heat_transfer"
NO_SUPPLY = "needs supply_temperature"
BELOW_POLE = "temperature_1 or temperature_2 lies below the pole of Vogel's law, at minus its offset in degC"
NEVER_WHIRLS = "stable at every speed, or without mass; level fit cannot tell"
UNBORNE = (
    "no film bears this: change load, clearance, speed or viscosity, or move the grooves; "
    "supply pressure alone may lift more"
)


class OilFilm(Template):
    """Oil film of a journal bearing under static load, at five levels of fidelity.

    One bearing and one interface, from Ocvirk's closed form to a mass-conserving solution of the Reynolds
    equation; each answer says by which level, and how far off it may be. Rigid, aligned, laminar, isothermal
    film at an effective viscosity that is given, or follows from temperatures, or from a heat balance.

    Limits
    ------
    Level short_bearing: Ocvirk's half film, meant for B/D up to 1/4; without the film's end effects it bears
    too much beyond (18 % at eps 0.99 even at B/D 0.05).
    Level fit: DIN 31652-2 / ISO 7902-2, refused outside 1/8 ≤ B/D ≤ 1, where it is wrong tenfold; it has no
    maximum pressure and no stiffness.
    Levels map and reynolds: B/D 0.01 … 100 and eps up to 1 − 1e-7.
    Level mass_conserving alone knows grooves and supply pressure; where either is given it is taken unless
    another level is requested by name. Its friction is by the oil there is; elsewhere shear acts over the
    full circle, as in the standards. Its error was measured without grooves and supply pressure; with them
    none is reported: grooves narrower than 5° or nearer to each other are not resolved.
    Angles count from the load in the sense of the hydrodynamic speed, those of grooves too.
    Laminar flow: a warning says where the film Reynolds number exceeds 41.3 √(D/c).
    Rigid and isoviscous: pressure deforms the bearing and thickens the oil. Criteria with warnings say where
    it deforms steel by the clearance, or makes the oil 22 000 times as thick; both matter well below that.
    A film below 0.05 µm, or below the roughness of the surfaces, is no film: criteria with warnings say so.
    The heat balance takes power and side flow from level map whatever the level, so that temperature and
    viscosity do not depend on it; flow driven by the supply pressure is left out, which errs to the hot side.
    Vogel's law eta = a exp(b/(t + c)), t in °C, takes two viscosities and its offset c, 95 K after Cameron,
    or all its constants.
    A multigrade oil is thinner at a bearing's shear rates than its kinematic viscosity suggests.
    Whirl: coefficients are those at the speed given; the rotor is rigid and carries the load by its mass,
    unless rotor_mass says otherwise.

    Errata
    ------
    Relative clearance is c/D here, as in DIN 31652; version 1 follows its paper with c/d.
    Half of the clearance times 1 − eps is the smallest film here; version 1 is high by (D − d)/d.
    Shear goes with the difference of journal and sleeve speed; the couple of the load, F e sin(beta)/2 on
    each surface, is statics and goes with neither. Both make the torque; DIN 31652 has one speed for
    both.

    References
    ----------
    DIN 31652:1983, ISO 7902:1998, parts 1 to 3.
    Ocvirk: NACA TN 2808, 1952.
    Holmes: Journal of Mechanical Engineering Science 2, 1960, for the short bearing's stiffness.
    Butenschön: Dissertation, Karlsruhe 1976, the tables behind the standards.
    Woloszynski, Podsiadlo, Stachowiak: Tribology Letters 58:18, 2015, for mass-conserving cavitation.
    Lund, Thomsen: ASME 1978, for the coefficients; Lund: Journal of Applied Mechanics 87, 1965, for whirl.
    ASTM D341 (Walther) or Vogel: Physikalische Zeitschrift 22, 1921, p. 645 and Cameron: The Principles of
    Lubrication, 1966, for the viscosity; SAE J300 and ISO 3448 for the grades.
    """

    levels = ("short_bearing", "fit", "map", "reynolds", "mass_conserving")
    default_level = "map"
    most_points = {"reynolds": 400, "mass_conserving": 20}
    precision = 1e-8
    example = {
        "radial_load": "25 kN",
        "diametral_clearance": "0.055 mm",
        "bearing_diameter": "48 mm",
        "bearing_width": "18 mm",
        "speed": "5000 rpm",
        "oil_inlet_temperature": "80 degC",
        "oil_outlet_temperature": "87.762 degC",
        "journal_roughness": "0.2 um",
        "bearing_roughness": "0.4 um",
    }
    criteria = {
        "film": {
            "require": "minimum_film_thickness >= smallest_permissible_film",
            "words": "the smallest film is not thinner than the smallest permissible one",
            "source": "ISO 7902-3:1998, table 1, as textbooks quote it",
            "unverified": "no public copy of ISO 7902-3 was at hand, and copies of its table differ",
        },
        "own_film": {
            "require": "minimum_film_thickness >= permissible_film",
            "words": "the smallest film is not thinner than its user permits",
            "limits": {"permissible_film": {"unit": "um", "words": "smallest film that its user permits"}},
        },
        "film_exists": {
            "require": "minimum_film_thickness >= 0.05 um",
            "words": "the film is not thinner than the finest surfaces are rough",
            "source": "ISO 1302:1992, grade N2: Ra 0.05 um, lapped or superfinished",
            "warning": "film_too_thin",
        },
        "roughness": {
            "require": "film_parameter >= 1",
            "words": "the smallest film is thicker than the surfaces are rough",
            "source": "Hamrock, Schmid, Jacobson 2004, section 1.3: boundary friction below 1",
            "warning": "film_below_roughness",
        },
        "full_film": {
            "require": "film_parameter >= 3",
            "words": "the film parts the surfaces wholly",
            "source": "Hamrock, Schmid, Jacobson 2004, section 1.3: mixed friction from 1 to 3",
            "warning": "mixed_friction",
        },
        "pressure": {
            "require": "maximum_pressure <= permissible_pressure",
            "words": "the pressure of the film is within what the bearing material bears",
            "limits": {
                "permissible_pressure": {
                    "unit": "MPa",
                    "words": "largest pressure of the film that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
        "rigid": {
            "require": "maximum_pressure <= 231 GPa * relative_clearance",
            "words": "the pressure deforms the steel by less than the clearance",
            "source": "elasticity: steel deforms by about p D/E' with E' = 210 GPa/(1 - 0.3**2) = 231 GPa",
            "warning": "pressure_deforms_bearing",
        },
        "isoviscous": {
            "require": "maximum_pressure <= 500 MPa",
            "words": "the pressure does not make the oil thousands of times thicker",
            "source": "Barus 1893, 20 1/GPa for mineral oil: at 500 MPa it is e**10 = 22 000 times as thick",
            "warning": "pressure_thickens_oil",
        },
        "specific_load": {
            "require": "radial_load / (bearing_diameter * bearing_width) <= permissible_specific_load",
            "words": "the load over bore times width is within what the bearing material bears",
            "limits": {
                "permissible_specific_load": {
                    "unit": "MPa",
                    "words": "largest load over bore times width that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
        "temperature": {
            "require": "film_temperature <= permissible_temperature",
            "words": "the film is no hotter than the bearing material bears",
            "limits": {
                "permissible_temperature": {
                    "unit": "degC",
                    "words": "largest temperature that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
        "oil_temperature": {
            "require": "film_temperature <= permissible_oil_temperature",
            "words": "the film is no hotter than the oil bears",
            "limits": {
                "permissible_oil_temperature": {
                    "unit": "degC",
                    "words": "largest temperature that the oil bears, by its supplier",
                }
            },
        },
        "laminar": {
            "require": "film_reynolds_number <= laminar_limit",
            "words": "the flow in the film is laminar",
            "source": "ISO 7902-1:1998",
            "warning": "turbulent_flow",
        },
        "whirl": {
            "require": "abs(speed) <= whirl_threshold_speed",
            "words": "the journal turns more slowly than where it begins to whirl",
            "source": "Lund 1965, for a rigid rotor",
            "warning": "journal_whirls",
            "absent": {
                "whirl_threshold_speed": {
                    "with": "stiffness_xx",
                    "reason": "there is no threshold: the film is stable at every speed, or carries no mass",
                    # the same without a root: m γ² ω² ≤ k_0 ω_h², k_0 the stiffness and γ the ratio of whirl
                    "instead": "rotor_mass * abs(speed)**2 * ((stiffness_xx - (stiffness_xx * damping_yy"
                    " + stiffness_yy * damping_xx - stiffness_xy * damping_yx - stiffness_yx * damping_xy)"
                    " / (damping_xx + damping_yy)) * (stiffness_yy - (stiffness_xx * damping_yy"
                    " + stiffness_yy * damping_xx - stiffness_xy * damping_yx - stiffness_yx * damping_xy)"
                    " / (damping_xx + damping_yy)) - stiffness_xy * stiffness_yx)"
                    " <= (stiffness_xx * damping_yy + stiffness_yy * damping_xx - stiffness_xy * damping_yx"
                    " - stiffness_yx * damping_xy) / (damping_xx + damping_yy) * hydrodynamic_speed**2"
                    " * (damping_xx * damping_yy - damping_xy * damping_yx)",
                }
            },
        },
        "pressure_times_speed": {
            "require": "radial_load * abs(sliding_speed) / (2 * bearing_width)"
            " <= permissible_pressure_times_speed",
            "words": "specific load times sliding speed is within what its user permits",
            "limits": {
                "permissible_pressure_times_speed": {
                    "unit": "MPa*m/s",
                    "words": "largest specific load times sliding speed that its user permits",
                }
            },
        },
    }

    F: Array = given("N", "radial load", ge=0, also=("bearing load", "load"))
    c: Array = given("mm", "diametral clearance", gt=0)
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    omega_J: Array = given("rpm", "speed", also=("journal speed",))
    omega_B: Array = given("rpm", "sleeve speed", default="0 rpm")
    omega_F: Array = given("rpm", "load speed", default="0 rpm")
    grade: str = choice(*grades(), words="oil grade", default="sae_15w_40")
    T_1: Array = given("degC", "temperature 1", default="40 degC", ge=-100, le=500)
    T_2: Array = given("degC", "temperature 2", default="100 degC", ge=-100, le=500)
    law: str = choice("walther", "vogel", words="viscosity law", default="walther")
    c_V: Array = given("K", "Vogel offset", symbol="c_{V}", default="95 K", source="Cameron 1966")
    T_ref: Array = given("degC", "reference temperature", default="20 degC", ge=-100, le=500)
    rho_ref: Array = given("kg/m**3", "reference density", default="875 kg/m**3", gt=0)
    T_in: Array = given("degC", "oil inlet temperature", alternative=True, ge=-100, le=500)
    T_out: Array = given("degC", "oil outlet temperature", alternative=True, ge=-100, le=500)
    T_s: Array = given("degC", "supply temperature", alternative=True, ge=-100, le=499)
    T_amb: Array = given("degC", "ambient temperature", alternative=True, ge=-100, le=499)
    kA: Array = given("W/K", "heat transfer", alternative=True, ge=0)
    rho_c: Array = given("kJ/(m**3*K)", "heat capacity", default="1800 kJ/(m**3*K)", gt=0, source=ISO)
    grooves: tuple[tuple[float, float], ...] = table(
        "deg", "grooves", "angle from the load", "width", ge=-360, le=720
    )
    p_s: Array = given("bar", "supply pressure", default="0 bar", ge=0)
    R_J: Array = given("um", "journal roughness", optional=True, ge=0)
    R_B: Array = given("um", "bearing roughness", optional=True, ge=0)

    @derived("mm**2/s", "kinematic viscosity 1", gt=0.3)
    def nu_1(self) -> Array:
        return viscosity_at_40(self.grade)

    @derived("mm**2/s", "kinematic viscosity 2", gt=0.3)
    def nu_2(self) -> Array:
        return viscosity_at_100(self.grade)

    @derived("K", "Vogel slope", symbol="b_{V}", shown=True, ge=0, source="Vogel 1921", absent=BELOW_POLE)
    def b_V(self) -> Array:
        return vogel_slope(self.eta_1, self.T_1, self.eta_2, self.T_2, self.c_V)

    @derived(
        "mPa*s", "Vogel factor", symbol="a_{V}", shown=True, gt=0, source="Vogel 1921", absent=BELOW_POLE
    )
    def a_V(self) -> Array:
        return vogel_factor(self.eta_1, self.T_1, self.b_V, self.c_V)

    @derived("kg", "rotor mass", symbol="m", ge=0)
    def m(self) -> Array:
        return mass_of_weight(self.F)

    @require("diametral_clearance", "bearing_diameter", remedy="give the clearance as bore minus journal")
    def clearance_within_bearing(self) -> Truth:
        """The diametral clearance is smaller than the bearing diameter."""
        return self.c < self.D

    @require("temperature_1", "temperature_2", remedy="give the viscosity at two temperatures")
    def temperatures_differ(self) -> Truth:
        """The two viscosities are known at different temperatures."""
        return self.T_1 != self.T_2

    @require("kinematic_viscosity_1", "kinematic_viscosity_2", remedy="swap the two viscosities")
    def oil_thins_when_hot(self) -> Truth:
        """The oil is not thicker at the higher temperature."""
        return (self.nu_1 - self.nu_2) * (self.T_2 - self.T_1) >= 0

    @require("viscosity_law", remedy="say viscosity_law vogel, or leave out vogel_factor and vogel_slope")
    def vogel_is_asked_for(self) -> Truth:
        """Vogel's constants are given for Vogel's law only."""
        return (self.law == "vogel") | (np.isnan(self.as_given("a_V")) & np.isnan(self.as_given("b_V")))

    @require("vogel_factor", "vogel_slope", remedy="the one left out would be that of another oil")
    def vogel_is_whole(self) -> Truth:
        """Vogel's factor and slope are given both, or neither."""
        return np.isnan(self.as_given("a_V")) == np.isnan(self.as_given("b_V"))

    @require("temperature_1", "temperature_2", "vogel_offset", remedy="give viscosities above it")
    def vogel_is_known(self) -> Truth:
        """Vogel's law is known from two temperatures above its pole, at minus its offset in degC."""
        return (self.law != "vogel") | (np.isfinite(self.a_V) & np.isfinite(self.b_V))

    @require(
        "oil_inlet_temperature", "oil_outlet_temperature", missing=True,
        remedy="both; or supply_temperature; or ambient_temperature, heat_transfer; or dynamic_viscosity",
    )  # fmt: skip
    def viscosity_follows(self) -> Truth:
        """The viscosity follows from some temperature, or is given."""
        return self.viscosity_is_known

    @require(
        "oil_inlet_temperature", "oil_outlet_temperature", warning="unused_input",
        remedy="leave them out, or the supply and ambient temperatures",
    )  # fmt: skip
    def mean_not_overruled(self) -> Truth:
        """Inlet and outlet temperature are not used where a heat balance gives the film temperature."""
        return self.mean_is_used

    @require("grooves", remedy="give rows of angle and width")
    def grooves_fit(self) -> Truth:
        """Seen around the bearing each groove is 0° to 360° wide."""
        return all(0 <= width <= 2 * np.pi + 1e-9 for _, width in self.grooves)

    @require("grooves", "supply_pressure", warning="unused_input", remedy="take level mass_conserving")
    def feed_is_used(self) -> Truth:
        """Grooves and supply pressure count at level mass_conserving alone."""
        return self.level == FED or not is_fed(self.p_s, self.grooves)

    def ladder(self) -> tuple[str, ...]:
        """The levels that know how the bearing is fed."""
        return ladder(self.levels, self.p_s, self.grooves)

    def is_measured(self) -> bool:
        """Errors were measured without grooves and supply pressure; at other levels these are not used."""
        return not (self.level == FED and is_fed(self.p_s, self.grooves))

    @shared
    def viscosity_is_known(self) -> Truth:
        """Whether it is given or follows from a temperature."""
        return viscosity_known(self.as_given("eta"), self.T_in, self.T_out, self.T_s, self.T_amb, self.kA)

    @shared
    def mean_is_used(self) -> Truth:
        """Whether inlet and outlet temperature are used, where given."""
        return mean_is_used(self.T_in, self.T_out, self.T_s, self.T_amb, self.kA)

    @formula("mm", "journal diameter")
    def d(self) -> Array:
        return self.D - self.c

    @formula("1", "relative clearance", symbol=r"\psi", source=ISO)
    def psi(self) -> Array:
        return self.c / self.D

    @formula(
        "1", "width ratio", ge=0.01, le=100, remedy="another level may hold here",
        per_level={"short_bearing": limits(0.01, 100, published=(None, 0.25)), "fit": limits(0.125, 1)},
    )  # fmt: skip
    def b(self) -> Array:
        return self.W / self.D

    @formula(
        "rad/s", "hydrodynamic speed", symbol=r"\omega_{h}", source=ISO, gt=0,
        remedy="without it there is no film: speed + sleeve speed must differ from twice the load speed",
    )  # fmt: skip
    def omega_h(self) -> Array:
        return hydrodynamic_speed(self.omega_J, self.omega_B, self.omega_F)

    @formula("rad/s", "sliding speed", symbol=r"\omega_{s}")
    def omega_s(self) -> Array:
        return sliding_speed(self.omega_J, self.omega_B, self.omega_F)

    @formula("1", "Walther slope", symbol="B", source="ASTM D341")
    def B(self) -> Array:
        return (double_logarithm(self.nu_1) - double_logarithm(self.nu_2)) / (
            temperature_logarithm(self.T_2) - temperature_logarithm(self.T_1)
        )

    @formula("1", "Walther intercept", symbol="A", source="ASTM D341")
    def A(self) -> Array:
        return double_logarithm(self.nu_2) + self.B * temperature_logarithm(self.T_2)

    @formula("mPa*s", "dynamic viscosity 1", symbol=r"\eta_{1}")
    def eta_1(self) -> Array:
        return self.nu_1 * density(self.rho_ref, self.T_1, self.T_ref)

    @formula("mPa*s", "dynamic viscosity 2", symbol=r"\eta_{2}")
    def eta_2(self) -> Array:
        return self.nu_2 * density(self.rho_ref, self.T_2, self.T_ref)

    @shared
    def balance(self) -> HeatBalance:
        """The heat balance, if one is requested."""
        return heat_balance(
            Running(
                self.F, self.D, self.W, self.psi, self.omega_h, self.omega_s,
                self.A, self.B, by_law(self.law, np.nan, self.a_V), self.b_V, self.c_V,
                self.as_given("eta"), self.rho_ref, self.T_ref,
                self.rho_c, self.T_s, self.T_amb, self.kA,
            )
        )  # fmt: skip

    @formula("degC", "service temperature", absent="needs oil_inlet_temperature and oil_outlet_temperature")
    def T(self) -> Array:
        return (self.T_in + self.T_out) / 2

    @formula(
        "degC", "film temperature", absent="no temperature is given; the dynamic viscosity is",
        remedy="the heat balance finds none below 500 °C: cool more, or lower load or speed",
    )  # fmt: skip
    def T_film(self) -> Array:
        return film_temperature(self.T, self.balance)

    @formula("degC", "outlet temperature", symbol=r"T_{e}", absent=NO_SUPPLY, source=ISO)
    def T_e(self) -> Array:
        return outlet_temperature(self.balance)

    @formula("K", "temperature rise", symbol=r"\Delta T", absent=NO_SUPPLY, source=ISO)
    def rise(self) -> Array:
        return self.T_e - self.T_s

    @formula("1", "heat balance residual", absent=NO_BALANCE)
    def residual(self) -> Array:
        return self.balance.residual

    @formula(
        "kg/m**3", "density", symbol=r"\rho", gt=0, source="Bhadke et al. 2015",
        remedy="the linear law ends 1428 K above its reference",
    )  # fmt: skip
    def rho(self) -> Array:
        return density(self.rho_ref, or_reference(self.T_film, self.T_ref), self.T_ref)

    @derived(
        "mPa*s", "dynamic viscosity", shown=True, gt=0, source="ASTM D341; Vogel 1921",
        remedy="the oil is stiff here: Walther's law overflows, or Vogel's has its pole at minus its offset",
    )  # fmt: skip
    def eta(self) -> Array:
        return by_law(
            self.law,
            walther(self.A, self.B, self.T_film) * self.rho,
            vogel(self.a_V, self.b_V, self.c_V, self.T_film),
        )

    @formula("mm**2/s", "kinematic viscosity", gt=0)
    def nu(self) -> Array:
        return self.eta / self.rho

    @formula("1", "Sommerfeld number", symbol=r"S_{0}", ge=0, source=ISO)
    def S_0(self) -> Array:
        return self.F * self.psi**2 / (self.D * self.W * self.eta * self.omega_h)

    @formula("1", "relative supply pressure", symbol=r"\bar p_{s}")
    def P_s(self) -> Array:
        return self.p_s * self.psi**2 / (self.eta * self.omega_h)

    @shared
    def unbounded_film(self) -> JournalFilm:
        """The film at this level, wherever it leads."""
        return static_film_at(self.level, self.S_0, self.b, self.P_s, self.grooves)

    @formula("1", "relative eccentricity", ge=0, lt=1, assumes=("b", "turbulence"), remedy=UNBORNE)
    def eps(self) -> Array:
        return self.unbounded_film.eps

    @shared
    def film(self) -> JournalFilm:
        """The film, where it bears the load."""
        return self.unbounded_film.admitted(self.eps)

    @text("boundary condition")
    def boundary(self) -> str:
        return self.boundary_of_level

    @shared
    def boundary_of_level(self) -> str:
        """What the level takes for the pressure at the film's borders."""
        return BOUNDARY[self.level]

    @formula("deg", "attitude angle", symbol=r"\beta")
    def beta(self) -> Array:
        return self.film.attitude

    @formula("um", "minimum film thickness", symbol=r"h_{0}")
    def h_0(self) -> Array:
        return self.c * (1 - self.eps) / 2

    @formula("MPa", "maximum pressure", absent="level fit has none; take another level")
    def p_max(self) -> Array:
        return self.film.P_max * self.eta * self.omega_h / self.psi**2

    @formula(
        "deg", "maximum pressure angle", symbol=r"\theta_{p}", absent="level fit has none; take another level"
    )
    def theta_p(self) -> Array:
        return self.film.attitude + self.film.peak

    @formula("N*m", "shear torque", symbol=r"M_{s}", source=ISO)
    def M_s(self) -> Array:
        return self.film.shear * self.eta * self.omega_s * self.W * self.D**2 / (2 * self.psi)

    @formula("N*m", "load couple", symbol=r"M_{F}")
    def M_F(self) -> Array:
        return self.F * self.eps * self.c * np.sin(self.beta) / 4

    @formula("N*m", "friction torque", symbol=r"M_{f}")
    def M_f(self) -> Array:
        return self.M_s + self.M_F

    @formula("1", "friction coefficient", symbol="f", absent="there is no load to relate friction to")
    def f(self) -> Array:
        return friction_coefficient(self.M_f, self.F, self.D)

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.M_s * self.omega_s + self.M_F * self.omega_h

    @formula("l/min", "side flow", symbol="Q", source=ISO)
    def Q(self) -> Array:
        return self.film.side_flow * (self.D / 2) ** 3 * self.psi * self.omega_h

    @formula("1", "film Reynolds number", symbol=r"\mathrm{Re}", source=ISO)
    def Re(self) -> Array:
        return self.rho * abs(self.omega_s) * self.D * self.c / (4 * self.eta)

    @formula("1", "laminar limit", symbol=r"\mathrm{Re}_{cr}", source=ISO)
    def Re_cr(self) -> Array:
        return 41.3 / np.sqrt(self.psi)

    @formula(
        "1", "turbulence ratio", symbol=r"\tau", source=ISO, published=(None, 1),
        remedy="beyond it the flow is no longer laminar",
    )  # fmt: skip
    def turbulence(self) -> Array:
        return self.Re / self.Re_cr

    @formula("1", "Stribeck duty parameter", symbol="Z", absent="there is no load to relate speed to")
    def Z(self) -> Array:
        return duty_parameter(self.eta, self.omega_s, self.D, self.W, self.F)

    @formula(
        "um", "smallest permissible film", symbol=r"h_{lim}",
        source="ISO 7902-3:1998 as textbooks quote it, not checked",
        absent="the table covers journals above 24 mm up to 2500 mm",
    )  # fmt: skip
    def h_lim(self) -> Array:
        return smallest_film_ISO_7902(self.d, abs(self.omega_s) * self.d / 2)

    @formula("1", "film parameter", symbol=r"\Lambda", absent="the surfaces are perfectly smooth")
    def film_parameter(self) -> Array:
        return film_parameter(self.h_0, self.R_J, self.R_B)

    @text("lubrication regime")
    def regime(self) -> str:
        return lubrication_regime(self.film_parameter)

    @shared
    def linear(self) -> Linear:
        """Stiffness, damping and threshold mass, dimensionless."""
        return linear_at(self.level, self.eps, self.b, self.beta, self.P_s, self.grooves)

    @formula("N/m", "stiffness scale", symbol=r"k_{0}")
    def k_0(self) -> Array:
        return 2 * self.W * self.D * self.eta * self.omega_h / (self.psi**2 * self.c)

    @formula("N*s/m", "damping scale", symbol=r"b_{0}")
    def b_0(self) -> Array:
        return self.k_0 / self.omega_h

    @formula("N/m", "stiffness xx", absent=NO_COEFFICIENTS)
    def k_xx(self) -> Array:
        return self.linear.K_xx * self.k_0

    @formula("N/m", "stiffness xy", absent=NO_COEFFICIENTS)
    def k_xy(self) -> Array:
        return self.linear.K_xy * self.k_0

    @formula("N/m", "stiffness yx", absent=NO_COEFFICIENTS)
    def k_yx(self) -> Array:
        return self.linear.K_yx * self.k_0

    @formula("N/m", "stiffness yy", absent=NO_COEFFICIENTS)
    def k_yy(self) -> Array:
        return self.linear.K_yy * self.k_0

    @formula("N*s/m", "damping xx", absent=NO_COEFFICIENTS)
    def b_xx(self) -> Array:
        return self.linear.B_xx * self.b_0

    @formula("N*s/m", "damping xy", absent=NO_COEFFICIENTS)
    def b_xy(self) -> Array:
        return self.linear.B_xy * self.b_0

    @formula("N*s/m", "damping yx", absent=NO_COEFFICIENTS)
    def b_yx(self) -> Array:
        return self.linear.B_yx * self.b_0

    @formula("N*s/m", "damping yy", absent=NO_COEFFICIENTS)
    def b_yy(self) -> Array:
        return self.linear.B_yy * self.b_0

    @formula("rpm", "whirl threshold speed", symbol=r"\omega_{w}", absent=NEVER_WHIRLS, source="Lund 1965")
    def omega_w(self) -> Array:
        return whirl_speed(self.linear.M_c, self.k_0, self.m)
