"""Group: a bearing over a cycle, and the groove and holes that supply it with oil."""

from __future__ import annotations

import numpy as np

from templates.core.language.declare import limits
from templates.core.language.template import (
    Array,
    Template,
    Truth,
    choice,
    curve,
    derived,
    formula,
    given,
    require,
    shared,
    text,
)
from templates.physics.orbits.cyclic_film import Duty, cycle_length, largest_load, mean_speed
from templates.physics.supplied.supply_geometry import SupplyGeometry, is_back, supply_kind, within_bearing

FED = (
    "level `supplied` needs to know how oil comes in: give `groove_width`, `sleeve_hole_length` or "
    "`pin_hole_length` "
    "in mm, and `supply_pressure` in bar"
)
DESCRIBE = (
    "give `groove_width`, `sleeve_hole_length` or `pin_hole_length` in mm, or `oil_supply` as "
    "`flooded_ends`, for a film "
    "that is always full"
)
SLEEVE_BACK = (
    "give speeds in rpm with which it rests in the frame or turns by whole turns in a cycle, or a "
    "`groove_extent` of 360 deg and no hole in the sleeve"
)
WIDTHS = (
    "give `bearing_width` and `bearing_diameter` in mm in such a ratio; "
    "level `mobility_short` takes 0.01 … 100"
)
PIN_BACK = "give speeds in rpm with which it turns by whole turns in the frame in a cycle"
EXAMPLE: dict[str, object] = {
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
    "groove_width": "3 mm",
    "groove_start": "-90 deg",
    "groove_extent": "180 deg",
    "supply_pressure": "4 bar",
}  # fmt: skip
"""A big end under the loads of a petrol engine, in 24 steps of its cycle."""


class FedBearing(Template):
    """Load, speeds and sizes of a bearing over a cycle, and the groove and holes that supply it with oil."""

    theta: Array = curve("deg", "crank angle", symbol=r"\theta", ge=-720, le=1440)
    F_x: Array = curve("N", "load x")
    F_y: Array = curve("N", "load y")
    sense: str = choice(
        "journal_on_sleeve", "sleeve_on_journal", words="load sense", default="journal_on_sleeve"
    )
    omega_J: Array = curve("rpm", "speed", constant=True, also=("journal speed",))
    omega_B: Array = curve("rpm", "sleeve speed", constant=True, default="0 rpm")
    omega_F: Array = curve("rpm", "frame speed", constant=True, default="0 rpm")
    D: Array = given("mm", "bearing diameter", gt=0)
    W: Array = given("mm", "bearing width", gt=0)
    c: Array = given("mm", "diametral clearance", gt=0)
    W_g: Array = given("mm", "groove width", symbol="B_{g}", alternative=True, gt=0)
    phi_g: Array = given("deg", "groove start", symbol=r"\varphi_{g}", default="0 deg", ge=-360, le=360)
    ext_g: Array = given("deg", "groove extent", symbol=r"\Delta\varphi_{g}", default="360 deg", gt=0, le=360)
    l_B: Array = given("mm", "sleeve hole length", symbol="l_{B}", alternative=True, gt=0)
    phi_B: Array = given("deg", "sleeve hole angle", symbol=r"\varphi_{B}", default="0 deg", ge=-360, le=360)
    l_J: Array = given("mm", "pin hole length", symbol="l_{J}", alternative=True, gt=0)
    phi_J: Array = given("deg", "pin hole angle", symbol=r"\varphi_{J}", default="0 deg", ge=-360, le=360)
    p_s: Array = given("bar", "supply pressure", alternative=True, gt=0)
    fed_by: str = choice("groove_or_hole", "flooded_ends", words="oil supply", default="groove_or_hole")

    @derived("rpm", "crank speed", symbol=r"\Omega", gt=0, remedy="give it in rpm where the journal rests")
    def Omega(self) -> Array:
        """Speed of the crank; default: the mean speed of the journal."""
        return mean_speed(self.omega_J)

    @derived("mm", "sleeve hole arc", symbol="a_{B}", gt=0, absent="the sleeve has no hole")
    def a_B(self) -> Array:
        """Circumferential extent of the hole; default: its length."""
        return 1 * self.l_B

    @derived("mm", "pin hole arc", symbol="a_{J}", gt=0, absent="the pin has no hole")
    def a_J(self) -> Array:
        """Circumferential extent of the hole; default: its length."""
        return 1 * self.l_J

    @require("crank_angle", remedy="give 12 to 3600 angles in deg, without the first again at the end")
    def one_cycle(self) -> Truth:
        """The crank angles ascend and cover one cycle of 360° or 720° once."""
        return bool(np.isfinite(self.period))

    @require("diametral_clearance", "bearing_diameter", remedy="give bore less journal diameter, in mm")
    def clearance_within_bearing(self) -> Truth:
        """The diametral clearance is smaller than the bearing diameter."""
        return self.c < self.D

    @require("groove_width", "bearing_width", remedy="give the groove's width in mm, across the bearing")
    def groove_within_bearing(self) -> Truth:
        """The width of the groove is at most 95 % of that of the bearing."""
        return within_bearing(self.W_g, self.W, 0 * self.W_g, self.D)

    @require("sleeve_hole_length", "sleeve_hole_arc", "bearing_width", remedy="give both in mm")
    def sleeve_hole_within_bearing(self) -> Truth:
        """The sleeve's hole covers at most 95 % of the bearing's width and extends at most once around."""
        return within_bearing(self.l_B, self.W, self.a_B, self.D)

    @require("pin_hole_length", "pin_hole_arc", "bearing_width", remedy="give both in mm")
    def pin_hole_within_bearing(self) -> Truth:
        """The pin's hole covers at most 95 % of the bearing's width and extends at most once around."""
        return within_bearing(self.l_J, self.W, self.a_J, self.D)

    @require("groove_width", "sleeve_hole_length", "pin_hole_length", missing=True, remedy=DESCRIBE)
    def supply_is_described(self) -> Truth:
        """The bearing has an oil supply."""
        return (self.feeding.count > 0) | (self.fed_by == "flooded_ends")

    @require("oil_supply", warning="unused_input", remedy="omit it, or omit the groove and the holes")
    def flooded_ends_count(self) -> Truth:
        """Flooded ends apply only without groove and holes."""
        return (self.feeding.count == 0) | (self.fed_by != "flooded_ends")

    @require("supply_pressure", missing=True, remedy="give the pressure above ambient, such as 4 bar")
    def fed_under_pressure(self) -> Truth:
        """The supply pressure is given if there is a groove or hole."""
        return np.isfinite(self.p_s) | (self.feeding.count == 0)

    @require("sleeve_speed", "frame_speed", remedy=SLEEVE_BACK)
    def sleeve_comes_back(self) -> Truth:
        """A sleeve with a hole or a partial groove is back at its position in the frame after the cycle."""
        return is_back(self.motion, self.omega_B, self.feeding.sleeve_holed | self.feeding.partial())

    @require("speed", "crank_speed", "frame_speed", remedy=PIN_BACK)
    def journal_comes_back(self) -> Truth:
        """A journal with a hole is back at its position in the frame after the cycle."""
        return is_back(self.motion, self.omega_J, self.feeding.pin_holed)

    @shared
    def period(self) -> Array:
        """Return the length of the cycle [rad]; NaN if the angles do not cover a cycle."""
        return cycle_length(self.theta)

    @formula("deg", "cycle", symbol="T")
    def cycle(self) -> Array:
        """Crank angle after which the load repeats."""
        return cycle_length(self.theta)

    @formula("1", "relative clearance", symbol=r"\psi")
    def psi(self) -> Array:
        """Diametral clearance over bearing diameter."""
        return self.c / self.D

    @formula(
        "1", "width ratio", ge=0.02, le=10, remedy=WIDTHS,
        per_level={"mobility_short": limits(0.01, 100, published=(None, 0.25))},
    )  # fmt: skip
    def b(self) -> Array:
        """Width over diameter."""
        return self.W / self.D

    @shared
    def feeding(self) -> SupplyGeometry:
        """Return the groove and holes."""
        return SupplyGeometry(
            self.D, self.W, self.W_g, self.phi_g, self.ext_g,
            self.l_B, self.a_B, self.phi_B, self.l_J, self.a_J, self.phi_J,
        )  # fmt: skip

    @formula("1", "inlets", symbol="n_{F}", remedy=FED, per_level={"supplied": limits(ge=1)},
             latex=r"\text{number of groove, hole in the sleeve and hole in the pin}")  # fmt: skip
    def inlets(self) -> Array:
        """Number of inlets among groove, sleeve hole and pin hole."""
        return self.feeding.count

    @text("supply")
    def supply(self) -> str:
        """The kind of supply."""
        return supply_kind(self.feeding)

    @formula(
        "1", "land ratio", symbol="b_{g}", ge=0, absent="no groove is given",
        remedy="each land beside the groove has at least 2 % of the diameter: give a narrower `groove_width`",
        per_level={"mobility_grooved": limits(0.02, 5)},
    )  # fmt: skip
    def b_g(self) -> Array:
        """Width over diameter of each land next to the groove."""
        return (self.W - self.W_g) / (2 * self.D)

    @formula("N", "largest load", symbol=r"F_{max}")
    def F_max(self) -> Array:
        """The largest load of the cycle."""
        return largest_load(self.F_x, self.F_y)

    @shared
    def motion(self) -> Duty:
        """Return the loads and speeds of the bearing; the load is not scaled."""
        sign = 1.0 if self.sense == "journal_on_sleeve" else -1.0
        return Duty(
            self.theta, sign * self.F_x, sign * self.F_y, self.omega_J, self.omega_B, self.omega_F,
            self.Omega, np.asarray(1.0), self.b,
        )  # fmt: skip
