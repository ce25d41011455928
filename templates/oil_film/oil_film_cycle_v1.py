"""Oil film of a journal bearing under a periodic load, fed by grooves and holes, at five levels.

Results are the orbit of the journal, the smallest film and its crank angle, pressure, power loss and flow.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from templates.core.language.template import (
    Array,
    Truth,
    formula,
    given,
    profile,
    require,
    shared,
    text,
)
from templates.groups.fed_bearing import EXAMPLE, FedBearing
from templates.groups.film_assumptions import FULL, ISOTHERMAL, PARALLEL, RIGID, SMOOTH
from templates.groups.film_criteria import ISOVISCOUS, film_exists
from templates.physics.elastic.elastic_journal import deflection_in_steel
from templates.physics.numerics.reserve import above, below
from templates.physics.orbits.cyclic_film import CycleFilm, Duty, LoadCourse, load_course
from templates.physics.pads.slider_film import spread
from templates.physics.supplied.fed_cycle import (
    BOUNDARY,
    FedDuty,
    FedOrbit,
    fed_duty,
    fed_film,
    fed_orbit,
)
from templates.physics.supplied.supply_geometry import feed_under_load, sleeve_motion, supply_kind

BOOKER = "Booker 1965"
ORBIT = "Booker 1965; supplied: Woloszynski et al. 2015"
ISO = "ISO 7902-1:1998"
STARVED = (
    "no film repeats at this point. Starved: the oil's inlet stays under the load, see `feed_under_load`, "
    "and the film thins from cycle to cycle: move the groove or the hole. Unsettled: no orbit was found"
)
UNBORNE = (
    "no orbit that repeats bears this load with a film thicker than 2e-6 of the clearance: give less load in "
    "kN, or more `dynamic_viscosity` in mPa*s, speed in rpm or `bearing_width` in mm; no film bears a load "
    "that turns at the mean speed of journal and sleeve; at level `flooded` it may not repeat in 8 cycles"
)
OUTSIDE = (
    "below, the load does not hold the journal in an orbit: give more load in kN or a larger "
    "`diametral_clearance` in mm; above, no film is left: give less load, or more `dynamic_viscosity` in "
    "mPa*s"
)
SUPPLIED_ONLY = "level `supplied` alone follows the oil that is fed; a starved film has no flow that repeats"
MARCHED_ONLY = "levels `flooded` and `supplied` alone are marched in time"
UNKNOWN_STEP = (
    "no film repeats, or none on a coarser ring of crank angles from which to read an error; that of level "
    "flooded is not known"
)
MARCH_IT = "choose level `supplied`"
NO_FEED = "no groove and no hole is given"
CYCLE = "crank_angle"


class OilFilmCycle(FedBearing):
    """Oil film of a journal bearing under a periodic load, fed by grooves and holes, at five levels.

    The orbit of the journal is calculated by the mobility method, with or without a groove, or by a
    mass-conserving film with the real oil supply. Results are the smallest film and its crank angle,
    pressure, power loss and flow. Each answer states its level.

    Limits
    ------
    Rigid, aligned bearing with a plain bore; laminar, isothermal film of one viscosity; massless journal.
    The load is the force of the journal on the sleeve. bearing_load returns the opposite force, of the sleeve
    on the journal (rod on crank, frame on crank): set load_sense to sleeve_on_journal for it. The wrong sense
    puts grooves and holes on the wrong side.
    Axes rotate at frame_speed; x turns to y with a positive speed. All speeds are relative to the engine
    block. Load and speeds are linear between the angles.
    At crank angle 0 the axes of frame, sleeve and journal coincide, as in bearing_load: x, the rod's axis and
    the throw all point to the cylinder head. Angles of a groove or hole in the sleeve are measured from the
    sleeve's (the rod's) axis, those of a hole in the pin from the throw, all in the sense x to y.
    The angles ascend and cover one cycle of 360° or 720°; equal steps are not needed. Time follows from the
    crank speed, which is the mean speed of the journal unless crank_speed is given.
    The oil supply must be given: by a groove or holes, or by oil_supply flooded_ends, which means a film that
    is always full.
    Groove, holes and slots are axially centred and contain oil at the supply pressure, which is above
    ambient.
    Level mobility_short: Booker's closed form, which is a fit: its mobility has errors of up to 2.6 % to eps
    0.5 and 7.5 % to 0.9 relative to the half film of the short bearing, which carries too much load where B/D
    exceeds 1/4.
    Level mobility: the mobility of the finite bearing, B/D 0.02 … 10. Both levels treat the film as always
    full of oil and ignore grooves; they overestimate the film of a half-grooved bearing about twofold.
    Level mobility_grooved, the default if a groove is given: where the load passes the groove, two lands
    carry it. The mobility is (1 − s) M(b) + s M(b (1 − g)/2)/(1 − g), where g is the groove's fraction of the
    width, and s the fraction of the 90° around the load's direction that the groove covers.
    The load that the supply pressure supports at rest is subtracted: p_s W D/2 · (1 + g) · sin(extent/2),
    acting from the middle of the groove. In the groove the pressure is p_s, and over its lands it falls
    linearly.
    Both formulas are this template's own. The first is exact for a full-circle groove; for other grooves they
    were compared with level supplied. The film is always full of oil; holes are ignored.
    Level flooded: mass-conserving cavities, oil fed at ambient pressure along the widest gap and nowhere
    else; groove, holes and supply pressure are ignored. Where the load changes side the film starves, and the
    journal crosses the empty space instantly. It accepts one point at a time and takes ten seconds or more.
    It marches at most 8 cycles, and refuses a case whose last two cycles differ by more than 2 % of the gap,
    as with light loads.
    Level supplied: mass-conserving, with oil entering only through groove and holes. It takes about a second
    per point. A film that starves or does not converge is refused with that verdict.
    If every hole is under the load for more than 60 % of the cycle, the march continues on finer meshes: the
    film then depends on the inflow at the edges of the holes.
    Its verdict is repeating; wandering (by 3 % at most, included in numerical_error); or starved or
    unsettled, which have no film.
    Boundary conditions differ between the levels and from those of oil_film 2: see boundary_condition.
    Largest pressure, loss and flow are calculated from the film under the load along the orbit. Power loss is
    the shear of the oil by the difference of journal and sleeve speed plus the work of the load on the film.
    The shear is that of a full film; levels flooded and supplied use only the oil that is present.
    Side flow is the oil that the motion of the journal displaces from the ends, plus the oil that the supply
    pressure drives: at level supplied against the film's own pressure; at the mobility levels from a groove
    over its two lands, with the gap along the orbit, as in ISO 7902-1 for a steady load.
    The bearing is rigid and the viscosity independent of pressure. Criteria give warnings if the bore deforms
    by more than half of the smallest film, if the pressure increases the viscosity 22 000 times, and if the
    film is below 0.05 µm. bore_deflection is an estimate: an axial mean pressure of 2/3 of the largest and a
    squared cosine around the circumference, on the bore of an infinite steel body. A real housing deforms
    more.
    A load number below 1e-4 is refused: with a mean speed of half the crank's, a journal in a four-stroke
    engine may then whirl in an orbit of any size.
    Two errors are stated. numerical_error, an output, bounds the error of the smallest film due to the step,
    from orbits on successively refined rings of crank angles. At level supplied it bounds the error due to
    mesh, step and cycle, from the change between the last two meshes and from cycle to cycle. At level
    flooded it is null.
    The error in the answer is that relative to the rigid film of level supplied. Level supplied states its
    numerical errors. For the mobility levels it is a one-sided bound from random duties with the same kind of
    supply and a sleeve that is fixed or swings, as a power law of the duty. It is null if fewer than 59
    duties support it, outside their range, if it failed on other duties, if no inlet or several are given,
    for a hole that is under the load for more than a tenth of the cycle, for pressures, curves and side flow,
    and at level flooded.

    References
    ----------
    Booker: Journal of Basic Engineering 87, 1965, p. 537; Journal of Lubrication Technology 93, 1971, p. 168.
    ISO 7902-1:1998 for the load number, there the Sommerfeld number.
    Campbell, Love, Martin, Rafique: Proc. Inst. Mech. Eng. 182 (3A), 1967, p. 51, bearings for engines.
    Woloszynski, Podsiadlo, Stachowiak: Tribology Letters 58:18, 2015, for mass-conserving cavitation.
    """

    assumptions = (RIGID, PARALLEL, SMOOTH, ISOTHERMAL, FULL)
    levels = ("mobility_short", "mobility", "mobility_grooved", "flooded", "supplied")
    default_level = "mobility"
    most_points = {
        "mobility_short": 20_000, "mobility": 20_000, "mobility_grooved": 20_000, "flooded": 1,
        "supplied": 100,
    }  # fmt: skip
    precision = 1e-7
    level_precision = {"supplied": 1e-6}  # its numerical_error is a small difference of films
    example = {
        "crank_angle": {"value": [15.0 * k for k in range(24)], "unit": "deg"},
        **EXAMPLE,
        "dynamic_viscosity": "10 mPa*s",
    }  # fmt: skip
    main_results = (
        "largest_load", "speed", "maximum_pressure", "minimum_film_thickness", "power_loss",
        "total_oil_flow",
    )  # fmt: skip
    criteria = {
        "film": {
            "require": "minimum_film_thickness >= permissible_film",
            "words": "the smallest film of the cycle is not thinner than the permissible one",
        },
        "film_exists": film_exists(),
        "pressure": {
            "require": "maximum_pressure <= permissible_pressure",
            "words": "the largest pressure of the cycle is within the permissible one",
        },
        "rigid": {
            "require": "bore_deflection <= minimum_film_thickness / 2",
            "words": "the bore, taken as rigid, gives way by less than half of the smallest film",
            "source": "an estimate of the deflection at the largest pressure; see the limits",
            "warning": "elasticity_left_out",
        },
        "isoviscous": ISOVISCOUS,
        "specific_load": {
            "require": "largest_load / (bearing_diameter * bearing_width) <= permissible_specific_load",
            "words": "the largest load over bore times width is within the static limit of the material",
            "limits": {
                "permissible_specific_load": {
                    "unit": "MPa",
                    "words": "largest load over bore times width that the bearing material bears; the static "
                    "values of ISO 7902-3 say nothing of fatigue under a load that repeats",
                    "from": "bearing_material",
                }
            },
        },
        "hole_leaves_the_load": {
            "require": "feed_under_load <= 0.6",
            "words": "the oil's only inlet is not under the load for most of the cycle",
            "source": "300 marched duties: no hole starved that was under the load for less, see the docs",
            "warning": "feed_under_load",
        },
    }

    eta: Array = given("mPa*s", "dynamic viscosity", gt=0)
    h_lim: Array = given("um", "permissible film", symbol=r"h_{lim}", alternative=True, ge=0)
    p_max_lim: Array = given("MPa", "permissible pressure", symbol=r"p_{max,lim}", alternative=True, gt=0)

    @require("groove_width", warning="unused_input", remedy="choose level `mobility_grooved` or `supplied`")
    def groove_counts(self) -> Truth:
        """A groove affects the film only at levels mobility_grooved and supplied."""
        return self.level in ("mobility_grooved", "supplied") or ~self.feeding.grooved

    @require("sleeve_hole_length", warning="unused_input", remedy=MARCH_IT)
    def sleeve_hole_counts(self) -> Truth:
        """A hole in the sleeve feeds the film only at level supplied."""
        return (self.level == "supplied") | ~self.feeding.sleeve_holed

    @require("pin_hole_length", warning="unused_input", remedy=MARCH_IT)
    def pin_hole_counts(self) -> Truth:
        """A hole in the pin feeds the film only at level supplied."""
        return (self.level == "supplied") | ~self.feeding.pin_holed

    @require("supply_pressure", warning="unused_input", remedy="omit it, or follow the other warnings")
    def pressure_counts(self) -> Truth:
        """The supply pressure affects only level supplied, and with a groove the mobility levels."""
        counts = self.feeding.grooved if self.level.startswith("mobility") else self.level == "supplied"
        return counts | np.isnan(self.p_s)

    @require("permissible_film", warning="below_permissible_film", remedy="see `minimum_film_angle`")
    def film_is_permitted(self) -> Truth:
        """The smallest film is not below the permissible one."""
        return above(self.h_lim, lambda: self.h_0)

    @require(
        "permissible_pressure", warning="above_permissible_pressure", remedy="see `maximum_pressure_angle`"
    )
    def pressure_is_permitted(self) -> Truth:
        """The largest pressure is at most the permissible pressure of the bearing material."""
        return below(self.p_max_lim, lambda: self.p_max)

    def ladder(self) -> tuple[str, ...]:
        """Return the levels that model the oil supply; level supplied only if there is a groove or hole."""
        grooved = bool(np.any(np.isfinite(self.W_g)))
        holed = bool(np.any(np.isfinite(self.l_B)) or np.any(np.isfinite(self.l_J)))
        cheap = ("mobility_grooved",) if grooved else ("mobility_short", "mobility")
        return (*cheap, "supplied") if grooved or holed else cheap

    def starting_level(self) -> str:
        """Return the inexpensive level that models the groove, if there is one."""
        return next(level for level in ("mobility", "mobility_grooved") if level in self.ladder())

    def own_error(self, output: str) -> Array:
        """Return the error due to mesh, step and cycle that level supplied states for each answer."""
        if output == "minimum_film_thickness":
            return self.numerical_error
        if output == "maximum_eccentricity":
            return self.numerical_error * (1 - self.eps_max) / self.eps_max
        return self.orbit.march_error(output)

    def measured_case(self) -> str:
        """Return the kind of supply and the motion of the sleeve; empty outside the range of the duties."""
        kind, motion = supply_kind(self.feeding), sleeve_motion(self.motion)
        marched = np.all((self.P_s >= 0.02) & (self.P_s <= 1)) and motion
        placed = kind.endswith("groove") or np.all(self.under_load <= 0.1)
        return f"{kind}, {motion}" if marched and placed else ""

    @shared
    def course(self) -> LoadCourse:
        """Return the measures of how the load varies over the cycle."""
        return load_course(self.theta, self.F_x, self.F_y)

    @shared
    def peak(self) -> Array:
        """Return the ratio of largest to mean load, on which the errors of the mobility levels depend."""
        return self.course.peak

    @shared
    def turns(self) -> Array:
        """Return the variation of the load's direction, from 0.05 (constant) to 1.05; errors depend on it."""
        return 1.05 - self.course.steadiness

    @shared
    def whirls(self) -> Array:
        """Return the fraction of the cycle in which the load rotates at about half crank speed, plus 0.05.

        The errors of the mobility levels depend on it.
        """
        return 0.05 + self.course.at_half_speed

    @shared
    def wide(self) -> Array:
        """Return B/D over 0.5, or 1 for a narrower bearing; errors depend on this ratio."""
        return np.maximum(self.b / 0.5, 1.0)

    @formula("1/N", "load scale", symbol="s")
    def s(self) -> Array:
        """The load number divided by the load."""
        return self.psi**2 / (self.D * self.W * self.eta * self.Omega)

    @formula("1", "load number", symbol=r"S_{max}", ge=1e-4, le=1e6, remedy=OUTSIDE, source=ISO)
    def S_max(self) -> Array:
        """Load number of the largest load, based on the speed of the crank."""
        return self.F_max * self.s

    @formula("1", "relative supply pressure", symbol=r"\bar p_{s}", absent="no supply pressure is given")
    def P_s(self) -> Array:
        """Supply pressure over the specific load at which the load number is 1."""
        return self.p_s * self.psi**2 / (self.eta * self.Omega)

    @shared
    def duty(self) -> Duty:
        """Return the loads and speeds of the bearing, if the load number is within its limits."""
        return replace(self.motion, scale=self.S_max / self.F_max)

    @formula("1", "feed under load", symbol=r"\tau_{F}", absent=NO_FEED,
             latex=r"\text{share of the cycle in which all inlets lie within 60° of the load}")  # fmt: skip
    def under_load(self) -> Array:
        """Fraction of the whole cycle; a groove or slot longer than 120° is never fully under load."""
        return feed_under_load(self.motion, self.feeding)

    @shared
    def fed(self) -> FedDuty:
        """Return the duty with its oil supply, and the load that the pressure in a groove supports."""
        return fed_duty(self.level, self.duty, self.feeding, self.P_s)

    @shared
    def any_orbit(self) -> FedOrbit:
        """Return the orbit at this level, before its bounds are checked."""
        return fed_orbit(self.level, self.fed)

    @shared
    def film_orbit(self) -> FedOrbit:
        """Return the orbit if the film repeats; if it does not, a single point is refused."""
        return self.any_orbit.required()

    @formula(
        "1", "maximum eccentricity", symbol=r"\epsilon_{max}", lt=1, absent=STARVED, remedy=UNBORNE,
        source=ORBIT, assumes=("b", "b_g", "inlets"),
    )  # fmt: skip
    def eps_max(self) -> Array:
        """Largest relative eccentricity, also between the crank angles."""
        return self.film_orbit.eps_max

    @shared
    def orbit(self) -> FedOrbit:
        """Return the orbit if its film carries the load."""
        return self.any_orbit.admitted(self.eps_max)

    @shared
    def film(self) -> CycleFilm:
        """Return the pressure, loss and flow along the orbit."""
        return fed_film(self.level, self.fed, self.orbit)

    @text("boundary condition")
    def boundary(self) -> str:
        """Boundary condition of the level for the pressure."""
        return self.boundary_of_level

    @shared
    def boundary_of_level(self) -> str:
        """Return the boundary condition of the level for the pressure."""
        return BOUNDARY[self.level]

    @formula("um", "minimum film thickness", symbol=r"h_{0}", absent=STARVED)
    def h_0(self) -> Array:
        """Smallest film of the cycle, also between the crank angles."""
        return self.c * (1 - self.eps_max) / 2

    @formula("deg", "minimum film angle", symbol=r"\theta_{h}", absent=STARVED)
    def theta_h(self) -> Array:
        """Crank angle of the smallest film."""
        return self.orbit.angle

    @profile("um", "film thickness", along=CYCLE, symbol="h", absent=STARVED,
             latex=r"\frac{c}{2}\left(1-\epsilon\right)")  # fmt: skip
    def h(self) -> Array:
        """Smallest film around the bearing, at each crank angle."""
        return spread(self.c / 2, self.orbit.gap)

    @profile("1", "eccentricity x", along=CYCLE, symbol=r"\epsilon_{x}", source=ORBIT, absent=STARVED)
    def eps_x(self) -> Array:
        """Position of the journal's centre over the radial clearance, along the axis x of the frame."""
        return self.orbit.eps_x

    @profile("1", "eccentricity y", along=CYCLE, symbol=r"\epsilon_{y}", source=ORBIT, absent=STARVED)
    def eps_y(self) -> Array:
        """Position of the journal's centre over the radial clearance, along the axis y of the frame."""
        return self.orbit.eps_y

    @profile("MPa", "peak pressure", along=CYCLE, symbol=r"\hat{p}", absent=STARVED,
             latex=r"\frac{\eta\,\Omega}{\psi^{2}}\,\bar p\left(\theta\right)")  # fmt: skip
    def p(self) -> Array:
        """Largest pressure in the film at each crank angle; the symbol with a bar is dimensionless."""
        return spread(self.eta * self.Omega / self.psi**2, self.film.P)

    @formula("MPa", "maximum pressure", symbol=r"p_{max}", absent=STARVED,
             latex=r"\max\hat{p}\left(\theta\right)")  # fmt: skip
    def p_max(self) -> Array:
        """Largest pressure of the cycle at the given angles."""
        return self.film.P_max * self.eta * self.Omega / self.psi**2

    @formula("um", "bore deflection", symbol="u", absent=STARVED, source="Michell 1899")
    def u(self) -> Array:
        """Least deflection of the bore under the largest pressure, estimated for an infinite steel body."""
        return deflection_in_steel(self.p_max, self.F_max, self.D / 2, self.W)

    @formula("deg", "maximum pressure angle", symbol=r"\theta_{p}", absent=STARVED)
    def theta_p(self) -> Array:
        """Crank angle of the largest pressure."""
        return self.film.P_angle

    @formula("W", "power loss", symbol="P", absent=STARVED,
             latex=r"\frac{1}{T}\int_{T}\left(\frac{\pi\,\eta\,W\,D^{3}\left(\omega_{J}-\omega_{B}\right)^{2}}{"
             r"2\,c\,\sqrt{1-\epsilon^{2}}}+\vec{F}\cdot\vec{v}\right)d\theta")  # fmt: skip
    def P(self) -> Array:
        """Mean over the cycle; v is the velocity of the centre in axes that rotate at the mean speed."""
        return self.film.loss * self.W * self.D**2 * self.eta * self.Omega**2 / (2 * self.psi)

    @formula("l/min", "side flow", symbol="Q", absent=STARVED,
             latex=r"\frac{W\,D\,c\,\Omega}{2}\,\left(\bar{q}+\bar{q}_{p}\right)")  # fmt: skip
    def Q(self) -> Array:
        """Flow out of both ends with the supplied oil, mean over the cycle; bars: dimensionless values."""
        return (self.film.side_flow + self.film.feed_flow) * self.W * self.D * self.c * self.Omega / 2

    @formula("l/min", "total oil flow", symbol="Q_{t}", absent=STARVED)
    def Q_t(self) -> Array:
        """Flow that the supply must deliver: all oil that leaves at the ends."""
        return self.Q

    @formula("1", "numerical error", symbol=r"\delta_{n}", absent=UNKNOWN_STEP,
             latex=r"\text{from rings of angles; supplied: mesh, step and last cycles}")  # fmt: skip
    def numerical_error(self) -> Array:
        """Relative numerical error of the smallest film, without the error of the model."""
        return self.orbit.numerical_error

    @text("verdict", absent=SUPPLIED_ONLY)
    def verdict(self) -> str:
        """Outcome of the march of level `supplied`."""
        return self.any_orbit.verdict

    @text("verdict reason", absent="a film repeats, or the level does not follow the oil that is fed")
    def why(self) -> str:
        """Reason why the orbit does not repeat."""
        return self.any_orbit.reason

    @formula("1", "cycles run", symbol="n_{c}", absent=MARCHED_ONLY)
    def cycles(self) -> Array:
        """Number of cycles calculated on all meshes."""
        return self.any_orbit.cycles

    @formula("1", "mass balance", symbol=r"\delta_{m}", absent=SUPPLIED_ONLY)
    def mass_balance(self) -> Array:
        """Oil fed minus oil lost and stored in the last cycle, over the oil lost."""
        return self.any_orbit.mass_balance

    @formula("l/min", "supply flow", symbol="Q_{s}", absent=SUPPLIED_ONLY,
             latex=r"\frac{W\,D\,c\,\Omega}{2}\,\bar{q}_{s}")  # fmt: skip
    def Q_s(self) -> Array:
        """Flow through groove and holes, mean over the cycle."""
        return self.any_orbit.feed * self.W * self.D * self.c * self.Omega / 2
