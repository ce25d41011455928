"""Oil film of a journal bearing under a load that repeats with every cycle of an engine, at three levels.

The orbit of the journal, the smallest film and where in the cycle it is, pressure, loss and flow.
"""

from __future__ import annotations

import numpy as np

from templates.core.language.declare import limits
from templates.core.language.template import (
    Array,
    Template,
    Truth,
    curve,
    derived,
    formula,
    given,
    profile,
    require,
    shared,
    text,
)
from templates.physics.numerics.reserve import above, below
from templates.physics.orbits.cyclic_film import (
    BOUNDARY,
    CycleFilm,
    CycleOrbit,
    Duty,
    cycle_film,
    cycle_length,
    cycle_orbit,
    largest_load,
    level_spread,
    mean_speed,
)
from templates.physics.pads.slider_film import spread

BOOKER = "Booker 1965"
UNBORNE = (
    "no orbit that repeats bears this with a film that can be told: the load may turn at the mean speed of "
    "journal and sleeve, or be too large; at level transient it may not repeat in 8 cycles"
)
UNTOLD = (
    "below, the load does not say where the journal runs (without any load it runs anywhere); above, no film "
    "is left"
)
MARCHED = "level transient is marched in time; its error is measured, see accuracy"
CYCLE = "crank_angle"


class OilFilmCycle(Template):
    """Oil film of a journal bearing under a load that repeats with every cycle of an engine, at three levels.

    The orbit of the journal by the mobility method, or by a mass-conserving film in time; the smallest film
    and where in the cycle it is, pressure, loss and flow. Each answer says by which level.

    Limits
    ------
    Rigid, aligned, laminar, isothermal film at one viscosity; a journal without mass; plain bore.
    The load acts on the journal, in a frame that turns with frame_speed; x turns to y with a positive speed.
    With the force of the sleeve on the journal for it (bearing_load: rod on crank, frame on crank) the orbit
    is turned by 180°, and the film the same.
    All speeds are those seen from the engine's block. Load and speeds are linear between the angles.
    The angles rise and cover one cycle of 360° or 720°; equal steps are not needed. Time runs with the crank,
    whose speed is that of the journal, in the mean, unless crank_speed says otherwise.
    Level mobility_short: Booker's closed form, itself a fit: its mobility errs by up to 2.6 % to eps 0.5 and
    7.5 % to 0.9 against the short bearing's half film, which bears too much where B/D exceeds 1/4.
    Level mobility: the finite bearing's mobility, B/D 0.02 … 10. Both take the film as always full of oil.
    Level transient: mass-conserving cavities, oil fed at ambient pressure along the widest gap and nowhere
    else; where the load changes side the film starves, and the journal, without mass, crosses what is empty
    at once. It takes ten seconds or more, marches 8 cycles at most, and is refused where they do not repeat
    to 2 % of the gap, as with light loads.
    Boundary conditions differ between the levels and from those of oil_film 2: see boundary_condition.
    Under a constant load the journal settles where oil_film 2 has it only as far as these agree.
    Largest pressure, loss and flow follow from the film under the load along the orbit. Power loss is the
    shear of a full film by the difference of journal and sleeve speed (transient: by the oil there is), and
    the work of the load on the film. Side flow is what the motion of the journal displaces from the ends;
    flow driven by a supply pressure is left out.
    Rigid and isoviscous: criteria with warnings say where the pressure deforms steel by the clearance, or
    makes the oil 22 000 times as thick, and where the film is below 0.05 µm.
    A load number below 1e-4 is refused: with a mean speed of half the crank's, a journal in a four-stroke
    engine may then whirl as it likes.
    No error against the true film is stated: differences between the levels on two duties bounded those of 91
    of 100 others only.
    The output step_error is an estimate, from the change of the lowest node at half the step. It bounds the
    error of the smallest film by the step in six of ten random duties (benchmarks.step_bound).

    References
    ----------
    Booker: Journal of Basic Engineering 87, 1965, p. 537; Journal of Lubrication Technology 93, 1971, p. 168.
    Campbell, Love, Martin, Rafique: Proc. Inst. Mech. Eng. 182 (3A), 1967, p. 51, bearings for engines.
    Woloszynski, Podsiadlo, Stachowiak: Tribology Letters 58:18, 2015, for mass-conserving cavitation.
    """

    levels = ("mobility_short", "mobility", "transient")
    default_level = "mobility"
    most_points = {"mobility_short": 20_000, "mobility": 20_000, "transient": 1}
    precision = 1e-7
    example = {
        "crank_angle": {"value": [15.0 * k for k in range(24)], "unit": "deg"},
        "load_x": {
            "value": [
                -8.5, -14.4, -13.3, -9.9, -6.9, -5.0, -3.6, -2.2, -0.6, 1.1, 2.5, 3.4,
                3.7, 3.4, 2.5, 1.1, -0.6, -2.2, -3.4, -4.0, -4.3, -4.4, -4.5, -5.6,
            ],
            "unit": "kN",
        },
        "load_y": {
            "value": [
                0.0, 1.9, 2.9, 3.0, 2.5, 2.1, 1.9, 1.8, 1.7, 1.4, 1.0, 0.5,
                0.0, -0.5, -1.0, -1.4, -1.7, -1.8, -1.8, -1.6, -1.3, -0.9, -0.5, -0.2,
            ],
            "unit": "kN",
        },
        "speed": "3000 rpm",
        "bearing_diameter": "48 mm",
        "bearing_width": "18 mm",
        "diametral_clearance": "0.055 mm",
        "dynamic_viscosity": "10 mPa*s",
    }  # fmt: skip
    criteria = {
        "film": {
            "require": "minimum_film_thickness >= permissible_film",
            "words": "the smallest film of the cycle is not thinner than the permissible one",
        },
        "film_exists": {
            "require": "minimum_film_thickness >= 0.05 um",
            "words": "the film is not thinner than the finest surfaces are rough",
            "source": "ISO 1302:1992, grade N2: Ra 0.05 um, lapped or superfinished",
            "warning": "film_too_thin",
        },
        "pressure": {
            "require": "maximum_pressure <= permissible_pressure",
            "words": "the largest pressure of the cycle is within the permissible one",
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
            "require": "largest_load / (bearing_diameter * bearing_width) <= permissible_specific_load",
            "words": "the largest load over bore times width is within what the bearing material bears",
            "limits": {
                "permissible_specific_load": {
                    "unit": "MPa",
                    "words": "largest load over bore times width that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
    }

    theta: Array = curve("deg", "crank angle", symbol=r"\theta", ge=-720, le=1440)
    F_x: Array = curve("N", "load x", also=("crankpin load x", "main load x"))
    F_y: Array = curve("N", "load y", also=("crankpin load y", "main load y"))
    omega_J: Array = curve("rpm", "speed", constant=True, also=("journal speed",))
    omega_B: Array = curve("rpm", "sleeve speed", constant=True, default="0 rpm")
    omega_F: Array = curve("rpm", "frame speed", constant=True, default="0 rpm")
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    c: Array = given("mm", "diametral clearance", gt=0)
    eta: Array = given("mPa*s", "dynamic viscosity", gt=0)
    h_lim: Array = given("um", "permissible film", symbol=r"h_{lim}", alternative=True, ge=0)
    p_lim: Array = given("MPa", "permissible pressure", symbol=r"p_{lim}", alternative=True, gt=0)

    @derived("rpm", "crank speed", symbol=r"\Omega", gt=0, remedy="give it where the journal does not turn")
    def Omega(self) -> Array:
        return mean_speed(self.omega_J)

    @require("crank_angle", remedy="12 to 3600 angles, the last point not repeated, no gap in between")
    def one_cycle(self) -> Truth:
        """The crank angles rise and cover one cycle of 360° or 720° once."""
        return bool(np.isfinite(self.T))

    @require("diametral_clearance", "bearing_diameter", remedy="give the clearance as bore minus journal")
    def clearance_within_bearing(self) -> Truth:
        """The diametral clearance is smaller than the bearing diameter."""
        return self.c < self.D

    @require("permissible_film", warning="below_permissible_film", remedy="see minimum_film_angle")
    def film_is_permitted(self) -> Truth:
        """The smallest film is not below the permissible one."""
        return above(self.h_lim, lambda: self.h_0)

    @require(
        "permissible_pressure", warning="above_permissible_pressure", remedy="see maximum_pressure_angle"
    )
    def pressure_is_permitted(self) -> Truth:
        """The largest pressure is not above what the bearing's material permits."""
        return below(self.p_lim, lambda: self.p_max)

    @shared
    def T(self) -> Array:
        """The cycle [rad]; NaN where the angles are none."""
        return cycle_length(self.theta)

    @formula("deg", "cycle", symbol="T")
    def cycle(self) -> Array:
        return cycle_length(self.theta)

    @formula("1", "relative clearance", symbol=r"\psi")
    def psi(self) -> Array:
        return self.c / self.D

    @formula(
        "1", "width ratio", ge=0.02, le=10, remedy="level mobility_short takes 0.01 … 100",
        per_level={"mobility_short": limits(0.01, 100, published=(None, 0.25))},
    )  # fmt: skip
    def b(self) -> Array:
        return self.W / self.D

    @formula("N", "largest load", symbol=r"F_{max}")
    def F_max(self) -> Array:
        return largest_load(self.F_x, self.F_y)

    @formula("1/N", "load scale", symbol="s")
    def s(self) -> Array:
        return self.psi**2 / (self.D * self.W * self.eta * self.Omega)

    @formula("1", "load number", symbol=r"S_{max}", ge=1e-4, le=1e6, remedy=UNTOLD, source=BOOKER)
    def S_max(self) -> Array:
        return self.F_max * self.s

    @shared
    def duty(self) -> Duty:
        """What the bearing has to do."""
        return Duty(
            self.theta, self.F_x, self.F_y, self.omega_J, self.omega_B, self.omega_F,
            self.Omega, self.S_max / self.F_max, self.b,
        )  # fmt: skip

    @shared
    def any_orbit(self) -> CycleOrbit:
        """The orbit at this level, wherever it leads."""
        return cycle_orbit(self.level, self.duty)

    @formula(
        "1", "maximum eccentricity", symbol=r"\epsilon_{max}", lt=1, assumes=("b", "S_max"), remedy=UNBORNE
    )
    def eps_max(self) -> Array:
        return self.any_orbit.eps_max

    @shared
    def orbit(self) -> CycleOrbit:
        """The orbit, where it bears the load."""
        return self.any_orbit.admitted(self.eps_max)

    @shared
    def film(self) -> CycleFilm:
        """Pressure, loss and flow along the orbit."""
        return cycle_film(self.level, self.duty, self.orbit)

    @text("boundary condition")
    def boundary(self) -> str:
        return self.boundary_of_level

    @shared
    def boundary_of_level(self) -> str:
        """What the level takes for the pressure at the film's borders."""
        return BOUNDARY[self.level]

    @formula("um", "minimum film thickness", symbol=r"h_{0}", source=BOOKER)
    def h_0(self) -> Array:
        return self.c * (1 - self.eps_max) / 2

    @formula("deg", "minimum film angle", symbol=r"\theta_{h}")
    def theta_h(self) -> Array:
        return self.orbit.angle

    @profile("um", "film thickness", along=CYCLE, symbol="h", latex=r"\frac{c}{2}\left(1-\epsilon\right)")
    def h(self) -> Array:
        return spread(self.c / 2, self.orbit.gap)

    @profile("1", "eccentricity x", along=CYCLE, symbol=r"\epsilon_{x}", source=BOOKER)
    def eps_x(self) -> Array:
        return self.orbit.eps_x

    @profile("1", "eccentricity y", along=CYCLE, symbol=r"\epsilon_{y}", source=BOOKER)
    def eps_y(self) -> Array:
        return self.orbit.eps_y

    @profile("MPa", "peak pressure", along=CYCLE, symbol=r"\hat{p}",
             latex=r"\frac{\eta\,\Omega}{\psi^{2}}\,P\left(\theta\right)")  # fmt: skip
    def p(self) -> Array:
        return spread(self.eta * self.Omega / self.psi**2, self.film.P)

    @formula("MPa", "maximum pressure", symbol=r"p_{max}")
    def p_max(self) -> Array:
        return self.film.P_max * self.eta * self.Omega / self.psi**2

    @formula("deg", "maximum pressure angle", symbol=r"\theta_{p}")
    def theta_p(self) -> Array:
        return self.film.P_angle

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.film.loss * self.W * self.D**2 * self.eta * self.Omega**2 / (2 * self.psi)

    @formula("l/min", "side flow", symbol="Q")
    def Q(self) -> Array:
        return self.film.side_flow * self.W * self.D * self.c * self.Omega / 2

    @formula("1", "step error", symbol=r"\delta_{h}", absent=MARCHED)
    def step_error(self) -> Array:
        return self.orbit.step_error

    @formula(
        "1", "level spread", symbol=r"\delta_{l}", absent="level mobility has no film here", source=BOOKER
    )
    def spread_of_levels(self) -> Array:
        return level_spread(self.level, self.duty, self.eps_max)
