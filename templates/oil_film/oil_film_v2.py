"""Oil film of a journal bearing under static load: any bore, aligned or not, at five levels of fidelity.

One bearing and one interface, from Ocvirk's closed form for a plain bore to a mass-conserving solution for
lobes, bell mouths and a tilted journal; each answer states its level and its error.
"""

from __future__ import annotations

from operator import attrgetter

import numpy as np

from templates.core.language.declare import limits
from templates.core.language.template import (
    Array,
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
from templates.groups.film_assumptions import ISOTHERMAL, RIGID
from templates.groups.journal import ISO, Journal
from templates.groups.journal_criteria import CRITERIA
from templates.groups.oil import WarmOil
from templates.physics.journals.heat_balance import HeatBalance, OperatingPoint, heat_balance
from templates.physics.journals.journal_coefficients import Linear
from templates.physics.journals.journal_motion import mass_of_weight, whirl_speed
from templates.physics.journals.lubrication_regime import (
    duty_parameter,
    film_parameter,
    friction_coefficient,
    lubrication_regime,
)
from templates.physics.journals.oil import by_law
from templates.physics.journals.shaped_journal import (
    BORES,
    START_LINES,
    Shape,
    StaticFilm,
    departure,
    is_shaped,
    journal_film_at,
    linear_of,
    middle_of_least_gap,
)
from templates.physics.journals.smallest_film import smallest_film_ISO_7902
from templates.physics.journals.static_journal import BOUNDARY, FED, is_fed, ladder

NO_COEFFICIENTS = (
    "level `fit` has none, nor a moving start line at level `mass_conserving` or with a tilt; "
    "take another level"
)
NEVER_WHIRLS = (
    "stable at every speed, or without mass; level `fit` cannot tell, nor where there is no stiffness"
)
NO_MESH = "a plain, aligned bearing without grooves has none; the error of its level is measured"
UNBORNE = (
    "no film was found that bears this: change load, clearance, speed, viscosity or tilt. If a groove lies "
    "near the load, the oil leaves through it where the film would carry, and the journal sinks until it "
    "touches: move that groove away, or raise the supply pressure until it lifts the journal"
)
MESH_ERRORS = {
    "minimum_film_thickness": attrgetter("mesh_error"),
    "film_parameter": attrgetter("mesh_error"),
    "relative_eccentricity": attrgetter("place_error"),
    "attitude_angle": attrgetter("place_error"),
    "maximum_pressure": attrgetter("pressure_error"),
    "side_flow": attrgetter("flow_error"),
}
"""Outputs with a mesh error if the bearing is not plain, and the attribute of the film with that error."""
TAKE_A_SOLUTION = "lobes, bell mouth and tilt need level `reynolds` or `mass_conserving`"


class OilFilm(WarmOil, Journal):
    """Oil film of a journal bearing under static load: any bore, aligned or not, at five levels of fidelity.

    One bearing and one interface, from Ocvirk's closed form for a plain bore to a mass-conserving solution
    for lobes, bell mouths and a tilted journal; each answer states its level and its error.
    The film is rigid-walled, laminar and isothermal at an effective viscosity that is given, or follows from
    temperatures or from a heat balance.

    Limits
    ------
    Clearance and bearing diameter are those of the largest cylinder that fits into the bore. The relative
    clearance, the Sommerfeld number and the relative eccentricity refer to it for any shape. In a lobed bore
    the relative eccentricity at mid-width may exceed 1.
    Lobes are arcs of the same radius, which exceeds that of the journal by the machined clearance c_p;
    preload is 1 - c/c_p. Shape lemon has two lobes, one centred at lobe_angle from the load. Shape offset has
    two halves displaced along their split so that the gap narrows in the sense of the hydrodynamic speed to
    the end of each half. Shape multi_lobe has the number of lobes in lobes. lobe_offset is the fraction of a
    lobe's arc before its least gap.
    A tilt is the slope of the journal's axis relative to that of the bearing, in the planes along the load
    and 90° ahead of it; it is stationary relative to the load. The couples are those of the film against the
    tilt.
    A bell mouth is a parabola that begins at its length from each end and has the given depth at the end.
    Level short_bearing: Ocvirk's half film, intended for B/D up to 1/4. It neglects circumferential pressure
    flow and carries too much load beyond (18 % at eps 0.99 even at B/D 0.05).
    Level fit: DIN 31652-2 / ISO 7902-2, refused outside 1/8 ≤ B/D ≤ 1, where its error reaches a factor of
    ten; it has no maximum pressure and no stiffness.
    Levels short_bearing, fit and map apply to a plain, aligned bore. Levels map and reynolds: B/D 0.01 … 100.
    Films in plain, aligned bores without grooves are available up to eps 1 - 1e-7, other films down to a
    relative gap of 1e-6.
    Level reynolds models lobes, bell mouth and tilt; in a plain, aligned bore it ignores grooves. Level
    mass_conserving models everything; it is used if grooves or supply pressure are given.
    Without grooves a lobed bore is fed along the joints of its lobes, any other bore along its widest gap.
    The error of each level was measured for plain, aligned bearings without grooves. Lobed and grooved
    bearings state the error of their meshes for film, eccentricity, attitude, largest pressure and side flow:
    1.25 times the last change by refinement, or more if the previous change was large. With a tilt, a bell
    mouth or supply pressure only mesh_error is stated. The film is extrapolated from 64 x 8 and 128 x 16
    intervals. If these differ by over 1 %, 256 x 32 intervals follow; if the changes then do not decrease
    with the square of the mesh size, the result of the finest mesh is returned. Grooves narrower than 5° or
    closer to each other are not resolved.
    Start line: while the journal is displaced from its equilibrium, the supply line at the widest gap either
    stays in place (fixed, like a hole in the sleeve) or rotates with the journal (moving). At eps 0.1 and B/D
    1, K_xx is 0.83 W/c with the first and 1.91 W/c with the second.
    Angles are measured from the load in the sense of the hydrodynamic speed, including those of grooves and
    lobes.
    Laminar flow: there is a warning if the film Reynolds number exceeds 41.3 √(D/c).
    The bearing is rigid and the viscosity independent of pressure. Criteria give warnings if the pressure
    deforms steel by the clearance, or increases the viscosity 22 000 times; both effects matter well below
    these limits.
    A film below 0.05 µm, or below the roughness of the surfaces, is not a full film: criteria give warnings.
    At every level and for every shape, the heat balance uses power and side flow of level map for a plain,
    aligned bearing, so that temperature and viscosity do not depend on level and shape. It neglects flow
    driven by the supply pressure and the additional flow of lobes, so the temperature is overestimated.
    Vogel's law eta = a exp(b/(t + c)), t in °C, is defined by two viscosities and its offset c, 95 K after
    Cameron, or by all its constants.
    At the shear rates of a bearing a multigrade oil is thinner than its kinematic viscosity suggests.
    Whirl: the coefficients are those at the given speed. The rotor is rigid, and its mass is that whose
    weight is the load, unless rotor_mass is given.

    Errata
    ------
    Relative clearance is c/D here, as in DIN 31652; version 1 uses c/d as in its paper.
    The smallest film here is half of the clearance times 1 − eps; version 1 is too high by (D − d)/d.
    Shear is proportional to the difference of journal and sleeve speed; the couple of the load, F e
    sin(beta)/2 on each surface, is static and independent of both. Together they give the torque; DIN 31652
    uses one speed for both.

    References
    ----------
    DIN 31652:1983, ISO 7902:1998, parts 1 to 3.
    Ocvirk: NACA TN 2808, 1952.
    Holmes: Journal of Mechanical Engineering Science 2, 1960, for the short bearing's stiffness.
    Butenschön: Dissertation, Karlsruhe 1976, the tables behind the standards.
    Woloszynski, Podsiadlo, Stachowiak: Tribology Letters 58:18, 2015, for mass-conserving cavitation.
    Lund, Thomsen: ASME 1978, for the coefficients, of an elliptical bearing too; Lund: Journal of Applied
    Mechanics 87, 1965, for whirl.
    Someya: Journal-Bearing Databook, 1989, for lobes and preload.
    ASTM D341 (Walther) or Vogel: Physikalische Zeitschrift 22, 1921, p. 645 and Cameron: The Principles of
    Lubrication, 1966, for the viscosity; SAE J300 and ISO 3448 for the grades.
    """

    assumptions = (RIGID, ISOTHERMAL)
    levels = ("short_bearing", "fit", "map", "reynolds", "mass_conserving")
    default_level = "map"
    most_points = {"reynolds": 100, "mass_conserving": 20}
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
    main_results = (
        "radial_load", "speed", "maximum_pressure", "minimum_film_thickness", "power_loss",
        "total_oil_flow", "film_temperature",
    )  # fmt: skip
    criteria = CRITERIA

    grooves: tuple[tuple[float, float], ...] = table(
        "deg", "grooves", "angle from the load", "width", ge=-360, le=720
    )
    p_s: Array = given("bar", "supply pressure", default="0 bar", ge=0)
    bore: str = choice(*BORES, words="bore shape", default="plain")
    lobes: Array = given("1", "lobes", symbol="z", default="3", integer=True, single=True, ge=2, le=8)
    preload: Array = given("1", "preload", symbol="m_{p}", default="0", ge=0, le=0.95, source="Someya 1989")
    phi_l: Array = given("deg", "lobe angle", symbol=r"\varphi_{l}", default="0 deg", ge=-360, le=720)
    s_m: Array = given("um", "bell mouth depth", default="0 um", ge=0)
    l_m: Array = given("mm", "bell mouth length", default="0 mm", ge=0)
    tilt_x: Array = given("mrad", "tilt along load", symbol=r"\gamma_{x}", default="0 mrad",
                          assumed="the journal does not tilt along the load")  # fmt: skip
    tilt_y: Array = given("mrad", "tilt across load", symbol=r"\gamma_{y}", default="0 mrad",
                          assumed="the journal does not tilt across the load")  # fmt: skip
    start_line: str = choice(*START_LINES, words="start line", default="fixed")
    R_J: Array = given("um", "journal roughness", optional=True, ge=0, assumed="the journal is smooth")
    R_B: Array = given("um", "bearing roughness", optional=True, ge=0, assumed="the bore is smooth")

    @derived("1", "lobe offset", symbol=r"\alpha_{l}", ge=0, le=1)
    def alpha(self) -> Array:
        """The fraction of a lobe's arc before its least gap."""
        return middle_of_least_gap(self.bore)

    @derived("kg", "rotor mass", symbol="m", ge=0)
    def m(self) -> Array:
        """Default: the mass whose weight is the load."""
        return mass_of_weight(self.F)

    @require("grooves", remedy="give rows of angle and width")
    def grooves_fit(self) -> Truth:
        """Each groove extends over 0° to 360° of the circumference."""
        return all(0 <= width <= 2 * np.pi + 1e-9 for _, width in self.grooves)

    @require("grooves", "supply_pressure", warning="unused_input", remedy="choose level `mass_conserving`")
    def feed_is_used(self) -> Truth:
        """In a plain, aligned bearing grooves and supply pressure affect only level mass_conserving."""
        return self.level == FED or self.is_shaped or not is_fed(self.p_s, self.grooves)

    @require("preload", "bore_shape", remedy="set `bore_shape` to `lemon`, `offset` or `multi_lobe`")
    def lobes_are_asked_for(self) -> Truth:
        """A plain bore has no preload."""
        return (self.bore != "plain") | (self.preload == 0)

    @require(
        "preload", warning="unused_input", remedy="give preload, such as 0.5, or set `bore_shape` to `plain`"
    )
    def lobes_have_a_preload(self) -> Truth:
        """A lobed bore has a preload; without one it is a plain bore."""
        return (self.bore == "plain") | (self.preload > 0)

    @require("sleeve_speed", "load_speed", "preload", remedy="a lobed sleeve that turns has no static film")
    def lobes_stand_still(self) -> Truth:
        """The sleeve of a lobed bore rotates at the speed of the load, or both are stationary."""
        return (self.preload == 0) | (self.omega_B == self.omega_F)

    @require("bell_mouth_length", "bearing_width", remedy="count it from each end")
    def mouths_fit(self) -> Truth:
        """The two bell mouths fit into the width."""
        return 2 * self.l_m <= self.W

    @require("bell_mouth_depth", "bell_mouth_length", warning="unused_input", remedy="give both, or neither")
    def mouth_is_whole(self) -> Truth:
        """A bell mouth has both depth and length."""
        return (self.s_m > 0) == (self.l_m > 0)

    @require("start_line", warning="unused_input", remedy="omit it: grooves and lobes stand still")
    def start_line_counts(self) -> Truth:
        """The start line can move only if the film is fed along its widest gap."""
        return self.start_line == "fixed" or not (self.grooves or np.any(self.preload > 0))

    def ladder(self) -> tuple[str, ...]:
        """Return the levels that model bore, tilt and oil supply; fit only if requested by name."""
        levels = ladder(self.levels, self.p_s, self.grooves)
        return levels[-1:] if self.is_shaped else tuple(level for level in levels if level != "fit")

    def is_measured(self) -> bool:
        """Return whether errors were measured: plain, aligned, without grooves and supply pressure."""
        return not (self.is_shaped or (self.level == FED and is_fed(self.p_s, self.grooves)))

    def states_own_errors(self) -> bool:
        """Return whether the bearing states its own errors; plain bearings use those of the table."""
        return not self.is_measured()

    def own_error(self, output: str) -> Array:
        """Return the error due to the meshes, for a lobed or grooved bearing without measured errors."""
        error_of = MESH_ERRORS.get(output)
        bent = (self.shape.mouth > 0) | (self.shape.tilt_x != 0) | (self.shape.tilt_y != 0)
        stated = np.nan if error_of is None else error_of(self.film)
        error = np.where(bent | (self.p_s > 0), np.nan, stated)[()]
        return np.asarray(error / (np.pi / 2) if output == "attitude_angle" else error)

    @shared
    def shape(self) -> Shape:
        """Return the bore and the tilt, relative to the radial clearance."""
        return Shape(
            bore=self.bore, lobes=int(self.lobes), preload=self.preload, angle=self.phi_l, offset=self.alpha,
            mouth=np.where(self.l_m > 0, 2 * self.s_m / self.c, 0.0), mouth_length=2 * self.l_m / self.W,
            tilt_x=self.tilt_x * self.W / self.c, tilt_y=self.tilt_y * self.W / self.c,
        )  # fmt: skip

    @shared
    def is_shaped(self) -> bool:
        """Return whether the bore is not plain, or the journal is tilted."""
        return is_shaped(self.shape)

    @formula(
        "1", "width ratio", ge=0.01, le=100, remedy="another level may hold here",
        per_level={"short_bearing": limits(0.01, 100, published=(None, 0.25)), "fit": limits(0.125, 1)},
    )  # fmt: skip
    def b(self) -> Array:
        """Width over diameter."""
        return self.W / self.D

    @formula(
        "1", "shape departure", symbol="d_{s}", ge=0, remedy=TAKE_A_SOLUTION,
        per_level={"short_bearing": limits(0, 0), "fit": limits(0, 0), "map": limits(0, 0)},
    )  # fmt: skip
    def departure(self) -> Array:
        """The largest of preload, bell mouth and tilt, the last two at the end over radial clearance."""
        return departure(self.shape.preload, self.shape.mouth, self.shape.tilt_x, self.shape.tilt_y)

    @shared
    def balance(self) -> HeatBalance:
        """Return the heat balance, if one is requested."""
        return heat_balance(
            OperatingPoint(
                F=self.F, D=self.D, W=self.W, psi=self.psi, omega_m=self.omega_h, omega_s=self.omega_s,
                A=self.A, B=self.B, a=by_law(self.law, np.nan, self.a_V), b=self.b_V, offset=self.c_V,
                eta=self.as_given("eta"), rho_ref=self.rho_ref, T_ref=self.T_ref,
                heat_capacity=self.rho_c, T_supply=self.T_s, T_ambient=self.T_amb, kA=self.kA,
            )
        )  # fmt: skip

    @formula("1", "Sommerfeld number", symbol=r"S_{0}", ge=0, source=ISO)
    def S_0(self) -> Array:
        """Sommerfeld number based on the clearance of the largest cylinder that fits into the bore."""
        return self.F * self.psi**2 / (self.D * self.W * self.eta * self.omega_h)

    @formula("1", "relative supply pressure", symbol=r"\bar p_{s}")
    def P_s(self) -> Array:
        """Supply pressure in units of the film's dimensionless pressure."""
        return self.p_s * self.psi**2 / (self.eta * self.omega_h)

    @shared
    def unbounded_film(self) -> StaticFilm:
        """Return the film at this level, before its bounds are checked."""
        return journal_film_at(
            self.level, self.S_0, self.b, self.P_s, self.grooves, self.shape, self.departure
        )

    @formula("1", "relative eccentricity", ge=0, lt=1000, assumes=("b", "turbulence"), remedy=UNBORNE)
    def eps(self) -> Array:
        """Displacement of the journal at mid-width, over the radial clearance."""
        return self.unbounded_film.eps

    @shared
    def film(self) -> StaticFilm:
        """Return the film if it carries the load."""
        return self.unbounded_film.admitted(self.eps)

    @text("boundary condition")
    def boundary(self) -> str:
        return self.boundary_of_level

    @shared
    def boundary_of_level(self) -> str:
        """Return the boundary condition of the level for the pressure."""
        return BOUNDARY[self.level]

    @formula("deg", "attitude angle", symbol=r"\beta")
    def beta(self) -> Array:
        return self.film.attitude

    @formula("um", "minimum film thickness", symbol=r"h_{0}")
    def h_0(self) -> Array:
        """The smallest gap of the whole bearing."""
        return self.c * self.film.least / 2

    @formula("1", "mesh error", symbol=r"e_{h}", absent=NO_MESH)
    def mesh_error(self) -> Array:
        """Estimated error of the smallest film due to the meshes from which it was extrapolated."""
        return self.film.mesh_error

    @formula("MPa", "maximum pressure", absent="level `fit` has none; take another level")
    def p_max(self) -> Array:
        return self.film.P_max * self.eta * self.omega_h / self.psi**2

    @formula(
        "deg",
        "maximum pressure angle",
        symbol=r"\theta_{p}",
        absent="level `fit` has none; take another level",
    )
    def theta_p(self) -> Array:
        return self.film.peak

    @formula("N*m", "shear torque", symbol=r"M_{s}", source=ISO)
    def M_s(self) -> Array:
        return self.film.shear * self.eta * self.omega_s * self.W * self.D**2 / (2 * self.psi)

    @formula("N*m", "load couple", symbol=r"M_{F}")
    def M_F(self) -> Array:
        """Moment due to pressure, in addition to that due to shear; half of F e sin(beta) in a plain bore."""
        return self.film.load_couple * self.eta * self.omega_h * self.W * self.D**2 / (2 * self.psi)

    @formula("N*m", "friction torque", symbol=r"M_{f}")
    def M_f(self) -> Array:
        return self.M_s + self.M_F

    @formula("1", "friction coefficient", symbol="f", absent="there is no load to relate friction to")
    def f(self) -> Array:
        return friction_coefficient(self.M_f, self.F, self.D)

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.M_s * self.omega_s + self.M_F * self.omega_h

    @formula("N*m", "couple along load", symbol=r"M_{x}")
    def M_x(self) -> Array:
        """Moment of the film against a tilt along the load."""
        return self.film.couple_x * self.eta * self.omega_h * self.D * self.W**2 / (2 * self.psi**2)

    @formula("N*m", "couple across load", symbol=r"M_{y}")
    def M_y(self) -> Array:
        """Moment of the film against a tilt across the load."""
        return self.film.couple_y * self.eta * self.omega_h * self.D * self.W**2 / (2 * self.psi**2)

    @formula("l/min", "side flow", symbol="Q", source=ISO)
    def Q(self) -> Array:
        return self.film.side_flow * (self.D / 2) ** 3 * self.psi * self.omega_h

    @formula("l/min", "total oil flow", symbol="Q_{t}")
    def Q_t(self) -> Array:
        """Flow that the supply must deliver: all oil that leaves at the ends."""
        return self.Q

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
        """Return the stiffness, damping and threshold mass, dimensionless."""
        return linear_of(self.level, self.film, self.S_0, self.b, self.start_line, self.P_s, self.grooves)

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
