"""Mixed friction of a journal bearing: film and asperities share the load; the Stribeck curve.

Asperity contact carries the part of the load that the film does not carry. At low speed it carries all of the
load, and contact causes the friction; at high speed it carries nothing, and the oil causes the friction. In
between, the curve has its minimum.
"""

from __future__ import annotations

from templates.core.language.template import (
    Array,
    Truth,
    derived,
    formula,
    given,
    profile,
    require,
    shared,
    text,
)
from templates.groups.film_assumptions import ISOTHERMAL, PARALLEL, RIGID
from templates.groups.oil import Oil
from templates.physics.journals.lubrication_regime import film_parameter, regime_of_contact
from templates.physics.journals.mixed_journal import (
    FULL_FILM,
    LEVELS,
    MAP,
    MULTIPLES,
    LeastFriction,
    MixedFilm,
    MixedJournal,
    RoughJournal,
    composite_roughness,
    contact_pressure,
    least_friction,
    mixed_film,
    mixed_films,
    mixed_journal,
    roughness_asymmetry,
    speed_at_gap,
)
from templates.physics.numerics.arrays import spread
from templates.physics.roughness.asperities import contact_scale

GREENWOOD = "Greenwood, Tripp 1970"
STRIBECK = "Stribeck 1902"
ISO = "ISO 7902-1:1998"
UNBORNE = "film and roughness do not bear this load: lower it, or raise speed, viscosity or the modulus"
SMOOTH = "the surfaces are perfectly smooth"
NO_LOWEST = "the curve has no lowest point from a thousandth of the speed to a hundred times it"
NO_TRANSITION = "the roughness alone bears the load with this gap, or the gap is no part of the clearance"
UNBORNE_ON_CURVE = "at some speed of the curve film and roughness do not bear the load"


class MixedFriction(Oil):
    """Mixed friction of a journal bearing: film and asperities share the load; the Stribeck curve.

    Asperity contact carries the part of the load that the film does not carry. At low speed it carries all of
    the load, and contact causes the friction; at high speed it carries nothing, and the oil causes the
    friction. In between, the curve has its minimum.

    Limits
    ------
    Static load, aligned rigid bearing without grooves; only the journal rotates. There is one viscosity,
    given or from the oil temperature. Far from the operating speed the oil would be warmer or colder; the
    curve neglects this.
    Contact after Greenwood and Tripp: elastic summits of one radius with normally distributed heights.
    Plastic contact, running-in and boundary layers are neglected; the friction coefficient of the contact is
    given.
    Gaps are measured between the mean lines of the surfaces. A load at which these would meet is refused.
    Level map uses the film of smooth surfaces, level averaged that of the average Reynolds equation of Patir
    and Cheng with isotropic roughness. Measured by `c29dd3ed:benchmarks/mixed_friction.py` at a width of half
    the diameter and a roughness of 0.02 of the radial clearance: surfaces of equal roughness carry 1, 5, 10
    and 42 % more at gaps of 5, 3, 2 and 0.5 times the roughness; a rough journal in a smooth bearing carries
    2 to 3 % less at gaps of 5 to 2 times the roughness, a smooth journal in a rough bearing 5 to 23 % more.
    Between the eccentricities at which the equation is solved, the load has an error of 0.3 %. The tables end
    at a gap of half the roughness; below it load and attitude angle keep the ratios that they have there.
    The friction of the oil is the shear over the full circle at the mean gap; shear stress factors are not
    applied.
    The friction of the contact moves the journal against its rotation; the load balance includes this.
    The transition speed is the speed at which the smallest gap equals the transition film: by default three
    times the roughness, as the smallest permissible film of ISO 7902-3.
    The curve has 41 speeds from a thousandth of the operating speed to a hundred times it.
    The lubrication regime follows from the share of the load that the contact carries: boundary above half,
    full_film up to 0.01 %, mixed in between. The film parameter alone does not determine it: under heavy load
    the film carries nearly all the load even at a parameter below 1.
    Wear: the product of contact pressure and sliding speed is returned as its integral over the surface and
    as its largest value. The user's own wear coefficient gives the wear rate.

    References
    ----------
    Greenwood, Tripp: Proceedings of the Institution of Mechanical Engineers 185, 1970–71, p. 625.
    Patir, Cheng: Journal of Lubrication Technology 100, 1978, p. 12; 101, 1979, p. 220.
    Stribeck: Zeitschrift des VDI 46, 1902.
    Hamrock, Schmid, Jacobson: Fundamentals of Fluid Film Lubrication, 2nd ed. 2004, for the regimes.
    ISO 7902-1:1998, for the transition.
    """

    assumptions = (RIGID, PARALLEL, ISOTHERMAL)
    levels = LEVELS
    default_level = MAP
    most_points = {"map": 5_000, "averaged": 100}
    precision = 1e-8

    example = {
        "radial_load": "10 kN",
        "diametral_clearance": "0.05 mm",
        "bearing_diameter": "50 mm",
        "bearing_width": "25 mm",
        "speed": "300 rpm",
        "oil_temperature": "80 degC",
        "journal_roughness": "0.2 um",
        "bearing_roughness": "0.4 um",
        "roughness_product": 0.05,
        "summit_slenderness": 0.01,
        "composite_modulus": "80 GPa",
        "contact_friction": 0.12,
    }
    main_results = (
        "radial_load", "speed", "minimum_film_thickness", "film_parameter", "friction_torque", "power_loss",
        "wear_intensity",
    )  # fmt: skip
    criteria = {
        "full_film": {
            "require": "film_parameter >= 3",
            "words": "the gap is at least three times the composite roughness",
            "source": "Hamrock, Schmid, Jacobson 2004, section 1.3: mixed friction from 1 to 3",
        },
        "above_transition": {
            "require": "speed >= transition_speed",
            "words": "the journal turns faster than where friction becomes mixed",
            "source": "ISO 7902-1:1998",
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
        "wear": {
            "require": "wear_intensity <= permissible_wear_intensity",
            "words": "contact pressure times sliding speed is within what its user permits",
            "limits": {
                "permissible_wear_intensity": {
                    "unit": "MPa*m/s",
                    "words": "largest contact pressure times sliding speed that its user permits",
                }
            },
        },
    }

    F: Array = given("N", "radial load", gt=0, also=("bearing load", "load"))
    c: Array = given("mm", "diametral clearance", gt=0)
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    omega: Array = given("rpm", "speed", gt=0, also=("journal speed",))
    T_film: Array = given("degC", "oil temperature", symbol="T", alternative=True, ge=-100, le=500)
    R_J: Array = given("um", "journal roughness", ge=0)
    R_B: Array = given("um", "bearing roughness", ge=0)
    product: Array = given("1", "roughness product", symbol=r"\sigma\beta\eta_\mathrm{s}", gt=0, le=10,
                           remedy="roughness times radius times density of the summits")  # fmt: skip
    slender: Array = given("1", "summit slenderness", symbol=r"\sigma/\beta_\mathrm{s}", gt=0, le=10,
                           remedy="roughness over the radius of the summits")  # fmt: skip
    E: Array = given("GPa", "composite modulus", symbol="E'", gt=0,
                     remedy="1/E' is the sum of (1 - nu**2)/E of both faces")  # fmt: skip
    mu: Array = given("1", "contact friction", symbol=r"\mu", ge=0, le=2)

    @derived("um", "transition film", symbol=r"h_\mathrm{tr}", ge=0, shown=True)
    def h_tr(self) -> Array:
        return FULL_FILM * self.sigma

    @require("diametral_clearance", "bearing_diameter", remedy="give the clearance as bore minus journal")
    def clearance_within_bearing(self) -> Truth:
        """The diametral clearance is smaller than the bearing diameter."""
        return self.c < self.D

    @require("journal_roughness", "bearing_roughness", "diametral_clearance",
             remedy="check the unit of the roughness, in um")  # fmt: skip
    def roughness_within_clearance(self) -> Truth:
        """The radial clearance is at least three times the composite roughness; else no full film forms."""
        return self.c / 2 >= FULL_FILM * self.sigma

    @formula("um", "composite roughness", symbol=r"\sigma")
    def sigma(self) -> Array:
        return composite_roughness(self.R_J, self.R_B)

    @formula("1", "relative clearance", symbol=r"\psi", source=ISO)
    def psi(self) -> Array:
        return self.c / self.D

    @formula("1", "width ratio", ge=0.01, le=100, remedy="the film map ends here")
    def b(self) -> Array:
        return self.W / self.D

    @formula("m/s", "sliding speed", symbol="U")
    def U(self) -> Array:
        return self.omega * self.D / 2

    @formula("MPa", "contact scale", symbol="p_0", source=GREENWOOD)
    def p_0(self) -> Array:
        return contact_scale(self.product, self.slender, self.E)

    @shared
    def bearing(self) -> RoughJournal:
        """Return the bearing with its roughness."""
        return RoughJournal(
            F=self.F, viscous=self.W * self.D * self.eta / self.psi**2, area=self.W * self.D / 2,
            ratio=self.b, psi=self.psi, roughness=self.sigma / (self.c / 2),
            asymmetry=roughness_asymmetry(self.R_J, self.R_B), contact=self.p_0, mu=self.mu,
        )  # fmt: skip

    @shared
    def journal(self) -> MixedJournal:
        """Return the bearing with its film at any eccentricity."""
        return mixed_journal(self.level, self.bearing)

    @shared
    def balance(self) -> MixedFilm:
        """Return the equilibrium of load, film and contact at the operating speed."""
        return mixed_film(self.journal, self.omega)

    @shared
    def film(self) -> MixedFilm:
        """Return the equilibrium at the operating speed; NaN if none exists."""
        return self.balance.admitted(self.eps)

    @shared
    def films(self) -> MixedFilm:
        """Return the equilibria at the speeds of the curve."""
        return mixed_films(self.journal, spread(self.omega, MULTIPLES))

    @shared
    def lowest(self) -> LeastFriction:
        """Return the minimum of the curve."""
        return least_friction(self.journal, self.omega, self.films)

    @formula("1", "relative eccentricity", symbol=r"\varepsilon", ge=0, remedy=UNBORNE)
    def eps(self) -> Array:
        return self.balance.eps

    @formula("deg", "attitude angle", symbol=r"\beta")
    def beta(self) -> Array:
        return self.film.attitude

    @formula("um", "minimum film thickness", symbol="h_0")
    def h_0(self) -> Array:
        return self.c / 2 * (1 - self.eps)

    @formula("1", "film parameter", symbol=r"\Lambda", absent=SMOOTH,
             published=(0.5, None), remedy="so thin a gap is not that of a film")  # fmt: skip
    def film_parameter(self) -> Array:
        return film_parameter(self.h_0, self.R_J, self.R_B)

    @text("lubrication regime")
    def regime(self) -> str:
        return regime_of_contact(self.film.contact_share)

    @formula("N", "film load", symbol=r"F_\mathrm{f}")
    def F_f(self) -> Array:
        return self.F * self.film.film_share

    @formula("N", "contact load", symbol=r"F_\mathrm{c}", source=GREENWOOD)
    def F_c(self) -> Array:
        return self.F * self.film.contact_share

    @formula("MPa", "largest contact pressure", symbol=r"p_\mathrm{c}", source=GREENWOOD)
    def p_c(self) -> Array:
        return contact_pressure(self.p_0, self.h_0, self.sigma)

    @formula("N", "film friction", symbol=r"R_\mathrm{f}")
    def R_f(self) -> Array:
        return self.F * self.film.shear

    @formula("N", "contact friction force", symbol=r"R_\mathrm{c}")
    def R_c(self) -> Array:
        return self.mu * self.F * self.film.contact_sum

    @formula("1", "friction coefficient", symbol="f", source=STRIBECK)
    def f(self) -> Array:
        return (self.R_f + self.R_c) / self.F

    @formula("N*m", "friction torque", symbol="M")
    def M(self) -> Array:
        return (self.R_f + self.R_c) * self.D / 2

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.M * self.omega

    @formula("W", "wear power", symbol=r"P_\mathrm{w}")
    def wear(self) -> Array:
        return self.U * self.F * self.film.contact_sum

    @formula("MPa*m/s", "wear intensity", symbol=r"p_\mathrm{c}U")
    def pU(self) -> Array:
        return self.p_c * self.U

    @formula("rpm", "transition speed", symbol=r"\omega_\mathrm{tr}", source=ISO, absent=NO_TRANSITION)
    def omega_tr(self) -> Array:
        return speed_at_gap(self.journal, self.h_tr / (self.c / 2))

    @profile("rpm", "speed of the curve", along="curve", symbol=r"\omega_k", latex=r"\omega\,x_k")
    def omega_k(self) -> Array:
        return spread(self.omega, MULTIPLES)

    @profile("1", "friction over speed", along="curve", symbol="f_k", source=STRIBECK, latex=r"f(\omega_k)",
             absent=UNBORNE_ON_CURVE)  # fmt: skip
    def f_k(self) -> Array:
        return self.films.friction

    @profile("1", "contact share over speed", along="curve", symbol="s_k", latex=r"F_\mathrm{c}/F(\omega_k)",
             absent=UNBORNE_ON_CURVE)  # fmt: skip
    def s_k(self) -> Array:
        return self.films.contact_share

    @profile("1", "eccentricity over speed", along="curve", symbol=r"\varepsilon_k",
             latex=r"\varepsilon(\omega_k)", absent=UNBORNE_ON_CURVE)  # fmt: skip
    def eps_k(self) -> Array:
        return self.films.eps

    @formula("rpm", "speed of least friction", symbol=r"\omega_\mathrm{min}", absent=NO_LOWEST)
    def omega_min(self) -> Array:
        return self.omega * self.lowest.multiple

    @formula("1", "least friction", symbol=r"f_\mathrm{min}", absent=NO_LOWEST)
    def f_min(self) -> Array:
        return self.lowest.friction
