"""Plane slider bearing: a pad with a fixed incline, without side leakage or of finite width (MEC 315).

The pad is stationary; the runner beneath it slides from inlet to outlet and drags the oil into the converging
film. The flow is isothermal, incompressible and laminar, the faces are rigid, and the oil around the pad is
at ambient pressure.
"""

from __future__ import annotations

from templates.core.language.declare import limits
from templates.core.language.template import (
    Array,
    Template,
    Truth,
    derived,
    formula,
    given,
    profile,
    require,
    shared,
)
from templates.groups.film_assumptions import ISOTHERMAL
from templates.groups.film_criteria import ISOVISCOUS, film_exists
from templates.physics.pads.slider import reduced_Reynolds_number, squeeze_number
from templates.physics.pads.slider_film import (
    HEIGHTS,
    NARROWEST,
    STATIONS,
    STEEPEST,
    WIDEST,
    PadFilm,
    pad_film,
    spread,
    velocity_profile,
)

RAYLEIGH = "Rayleigh 1918"
COURSE = "MEC 315"
VALID = ("K", "R_x", "Re")
NOTHING = "the pad bears nothing: its film is parallel or diverges"
SMALL = 0.1  # what "much less than 1" is taken to mean


class SliderBearing(Template):
    """Plane slider bearing: a pad with a fixed incline, without side leakage or of finite width (MEC 315).

    The pad is stationary; the runner beneath it slides from inlet to outlet and drags the oil into the
    converging film. Isothermal, incompressible, laminar, rigid faces, oil at ambient pressure around the pad.

    Limits
    ------
    Level `infinite` neglects side leakage and uses closed forms: at b = l and h_i = 2 h_o it gives 2.3 times
    the load of level `finite`.
    Level `finite` solves the Reynolds equation with ambient pressure at all four edges, for b/l from 0.01 to
    100 and h_i/h_o up to 1000.
    A parallel film carries no load. A diverging film would be in tension; it ruptures and carries no load,
    and only the part h_i/h that the inlet's oil still fills is sheared.
    The Reynolds equation applies if the reduced Reynolds numbers and the squeeze number are much less than 1,
    here below 0.1; with velocities from continuity, v = u b/l and w = u h/l, all three Reynolds numbers equal
    R_x. Both numbers are based on the outlet film.
    The squeeze number uses the time in which oil passes the pad, l/U, unless another time is given; it then
    equals R_x.
    The film is laminar up to rho U h/eta of about 1000.
    The faces are rigid and the viscosity independent of pressure: criteria give warnings if the pressure
    deforms steel by the film's thickness, or increases the viscosity 22 000 times.
    Pressure and velocity are those at mid-width; the stations of the pressure are equally spaced in x.

    Errata
    ------
    The course's solution for the velocity omits z in its last two terms; the form here satisfies u = 0 at the
    pad and u = U at the runner.
    The course prints l² and b² for h² in the squeeze number.

    References
    ----------
    Course MEC 315, hydrodynamic lubrication.
    Lord Rayleigh: Philosophical Magazine 35, 1918, p. 1.
    Michell: Zeitschrift für Mathematik und Physik 52, 1905, p. 123, for the finite width.
    """

    assumptions = (ISOTHERMAL, "pad and runner are rigid and smooth")
    levels = ("infinite", "finite")
    default_level = "finite"
    most_points = {"finite": 100_000}
    precision = 1e-8

    example = {
        "length": "50 mm",
        "width": "50 mm",
        "inlet_film": "60 um",
        "outlet_film": "30 um",
        "sliding_speed": "10 m/s",
        "dynamic_viscosity": "30 mPa*s",
        "density": "860 kg/m**3",
        "place": "40 mm",
    }
    main_results = ("load", "sliding_speed", "maximum_pressure", "outlet_film", "power_loss", "inlet_flow")
    criteria = {
        "film": {
            "require": "min(inlet_film, outlet_film) >= smallest_permissible_film",
            "words": "the smallest film is not thinner than the smallest permissible one",
            "limits": {
                "smallest_permissible_film": {
                    "unit": "um",
                    "words": "smallest film that the bearing may have",
                }
            },
        },
        "film_exists": film_exists("min(inlet_film, outlet_film)"),
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
            "require": "maximum_pressure <= 231 GPa * min(inlet_film, outlet_film) / length",
            "words": "the pressure deforms the steel by less than the film is thick",
            "source": "elasticity: steel deforms by about p l/E' with E' = 210 GPa/(1 - 0.3**2) = 231 GPa",
            "warning": "pressure_deforms_bearing",
        },
        "isoviscous": ISOVISCOUS,
        "specific_load": {
            "require": "load / (length * width) <= permissible_specific_load",
            "words": "the load over length times width is within what the bearing material bears",
            "limits": {
                "permissible_specific_load": {
                    "unit": "MPa",
                    "words": "largest load over length times width that the bearing material bears",
                    "from": "bearing_material",
                }
            },
        },
        "laminar": {
            "require": "film_reynolds_number <= 1000",
            "words": "the flow in the film is laminar",
            "source": "MEC 315",
            "warning": "turbulent_flow",
        },
    }

    l: Array = given("mm", "length", gt=0)  # noqa: E741, the course's symbol
    b: Array = given("mm", "width", gt=0)
    h_i: Array = given("um", "inlet film", gt=0)
    h_o: Array = given("um", "outlet film", gt=0)
    U: Array = given("m/s", "sliding speed", gt=0)
    eta: Array = given("mPa*s", "dynamic viscosity", gt=0)
    rho: Array = given("kg/m**3", "density", optional=True, gt=0)
    x: Array = given("mm", "place", optional=True, ge=0)

    @derived("s", "film change time", symbol="t_0", gt=0)
    def t_0(self) -> Array:
        return self.l / self.U

    @require("place", "length", remedy="count the place from the inlet")
    def place_under_the_pad(self) -> Truth:
        """The position lies under the pad."""
        return self.x <= self.l

    @formula("1", "film ratio", remedy="level `infinite` has no such limit", gt=0,
             per_level={"finite": limits(1 / STEEPEST, STEEPEST)})  # fmt: skip
    def a(self) -> Array:
        return self.h_i / self.h_o

    @formula("1", "width ratio", symbol=r"\lambda", remedy="level `infinite` has no such limit", gt=0,
             per_level={"finite": limits(NARROWEST, WIDEST)})  # fmt: skip
    def ratio(self) -> Array:
        return self.b / self.l

    @formula(
        "1", "convergence", published=(0, None), remedy="a film that diverges ruptures, and bears nothing"
    )
    def K(self) -> Array:
        return (self.h_i - self.h_o) / self.h_o

    @shared
    def film(self) -> PadFilm:
        """Return the film, dimensionless."""
        return pad_film(self.level, self.a, self.ratio)

    @formula("N", "load", source=RAYLEIGH, assumes=VALID)
    def W(self) -> Array:
        return 6 * self.eta * self.U * self.l**2 * self.b / self.h_o**2 * self.film.load

    @formula("MPa", "maximum pressure", symbol=r"p_\mathrm{max}", source=RAYLEIGH, assumes=VALID)
    def p_max(self) -> Array:
        return 6 * self.eta * self.U * self.l / self.h_o**2 * self.film.P_max

    @formula("mm", "centre of pressure", source=RAYLEIGH, assumes=VALID, absent=NOTHING)
    def x_c(self) -> Array:
        return self.l * self.film.centre

    @formula("mm", "place of maximum pressure", symbol=r"x_\mathrm{max}", source=RAYLEIGH, assumes=VALID,
             absent=NOTHING)  # fmt: skip
    def x_max(self) -> Array:
        return self.l * self.film.peak

    @formula("N", "friction force moving", symbol=r"F_\mathrm{m}", source=RAYLEIGH, assumes=VALID)
    def F_m(self) -> Array:
        return self.eta * self.U * self.l * self.b / self.h_o * self.film.friction_moving

    @formula("N", "friction force fixed", symbol=r"F_\mathrm{f}", source=RAYLEIGH, assumes=VALID)
    def F_f(self) -> Array:
        return self.eta * self.U * self.l * self.b / self.h_o * self.film.friction_fixed

    @formula("W", "power loss", symbol="P")
    def P(self) -> Array:
        return self.F_m * self.U

    @formula("1", "friction coefficient", symbol="f", absent=NOTHING)
    def f(self) -> Array:
        return self.h_o / self.l * self.film.friction_coefficient

    @formula("cm**3/s", "inlet flow", symbol=r"Q_\mathrm{i}", assumes=VALID)
    def Q_i(self) -> Array:
        return self.U * self.h_o * self.b * self.film.inlet_flow

    @formula("cm**3/s", "side flow", symbol=r"Q_\mathrm{s}", assumes=VALID)
    def Q_s(self) -> Array:
        return self.U * self.h_o * self.b * self.film.side_flow

    @profile("mm", "place along pad", along="place_along_pad", symbol=r"x_k", latex=r"l\,\xi_k")
    def x_k(self) -> Array:
        return spread(self.l, STATIONS)

    @profile("MPa", "pressure", along="place_along_pad", symbol="p", source=RAYLEIGH, assumes=VALID,
             latex=r"\frac{6\,\eta\,U\,l}{h_{o}^{2}}\,P\left(\xi_k\right)")  # fmt: skip
    def p(self) -> Array:
        return spread(6 * self.eta * self.U * self.l / self.h_o**2, self.film.pressure(STATIONS))

    @formula("um", "film at the place", name="local_film")
    def h(self) -> Array:
        return self.h_i - (self.h_i - self.h_o) * self.x / self.l

    @shared
    def slope(self) -> Array:
        """Return the pressure gradient at the position, dimensionless."""
        return self.film.gradient(self.x / self.l)

    @formula("MPa/mm", "pressure gradient", symbol="p'", assumes=VALID)
    def dp(self) -> Array:
        return self.eta * self.U / self.h_o**2 * self.slope

    @profile("um", "height above pad", along="height_above_pad", symbol="z", latex=r"h\,\zeta_k")
    def z(self) -> Array:
        return spread(self.h, HEIGHTS)

    @profile("m/s", "velocity", along="height_above_pad", symbol="u", source=COURSE,
             latex=r"\frac{p'}{2\,\eta}\left(z^{2}-z\,h\right)+U\,\frac{z}{h}")  # fmt: skip
    def u(self) -> Array:
        return velocity_profile(self.h, self.dp, self.eta, self.U)

    @formula("1", "Reynolds number x", source=COURSE, published=(None, SMALL))
    def R_x(self) -> Array:
        return reduced_Reynolds_number(self.rho, self.U, self.h_o, self.eta, self.l)

    @formula("1", "squeeze number", symbol=r"\sigma_s", source=COURSE, published=(None, SMALL))
    def sigma(self) -> Array:
        return squeeze_number(self.rho, self.h_o, self.eta, self.t_0)

    @formula("1", "film Reynolds number", symbol=r"\mathrm{Re}", published=(None, 1000))
    def Re(self) -> Array:
        return self.rho * self.U * self.h_i / self.eta
