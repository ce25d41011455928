"""Group: the gas cycle of cylinders, shared by the templates of one cylinder and of an engine."""

from __future__ import annotations

import numpy as np

from templates.core.language.template import (
    Array,
    Template,
    Truth,
    choice,
    curve,
    derived,
    given,
    require,
    shared,
)
from templates.physics.engine.gas_checks import (
    CYCLES,
    GAUGE,
    GIVEN_PEAK,
    POLYTROPIC,
    absolute_crankcase,
    absolute_table,
    angles_rise,
    burns_before_exhaust,
    crankcase_is_filled,
    end_of_compression,
    full_cycle,
    known_for,
    lowest_of_table,
    table_closes,
    table_is_known,
    valves_in_order,
    work_between_points,
)
from templates.physics.engine.gas_cycle import Charge, Valves
from templates.physics.engine.gas_pressure import GasCycle
from templates.physics.engine.slider_crank import steps_in


class CylinderGas(Template):
    """The gas cycle of cylinders; the mechanism defines speed, strokes, step and the cycle itself."""

    omega: Array
    strokes: Array
    step: Array
    gas: GasCycle

    gas_cycle: str = choice(*CYCLES, words="gas cycle")
    p_s: Array = given("bar", "suction pressure", alternative=True, gt=0, le=100)
    epsilon: Array = given("1", "compression ratio", symbol=r"\epsilon", alternative=True, gt=1, le=1000)
    k_c: Array = given("1", "compression exponent", default="1.4", gt=0, le=3)
    k_e: Array = given("1", "expansion exponent", default="1.4", gt=0, le=3)
    p_3: Array = given("bar", "combustion pressure", alternative=True, gt=0, le=1000)
    rho: Array = given("1", "cutoff", default="1", ge=1, le=1000,
                       remedy="volume at the end of combustion over that at its begin")  # fmt: skip
    io: Array = given("deg", "inlet opens", symbol=r"\theta_{io}", default="0 deg", ge=-90, le=810)
    ic: Array = given("deg", "inlet closes", symbol=r"\theta_{ic}", default="180 deg", gt=0, lt=360)
    eo: Array = given("deg", "exhaust opens", symbol=r"\theta_{eo}", default="540 deg", gt=360, lt=720)
    ec: Array = given("deg", "exhaust closes", symbol=r"\theta_{ec}", default="720 deg", ge=-90, le=810)
    theta_p: Array = curve("deg", "pressure angle", along="pressure_angle", symbol=r"\theta_{p}",
                           alternative=True, ge=-720, le=1440)  # fmt: skip
    p_t: Array = curve("bar", "pressure", along="pressure_angle", alternative=True, ge=-1.1, le=1000,
                       remedy="check its unit")  # fmt: skip
    p_0: Array = given("bar", "crankcase pressure", default="0 bar", ge=0, le=100, assumed=GAUGE)

    @derived("bar", "exhaust pressure", gt=0, le=100, absent="no suction pressure is given")
    def p_e(self) -> Array:
        """Default: the intake pressure."""
        return self.p_s

    @require("strokes", remedy="give 2 or 4")
    def two_or_four(self) -> Truth:
        """The engine has two or four strokes."""
        return self.strokes != 3

    @require(
        "crank_angle_step", "strokes", remedy="take a divisor of the cycle, such as 1 deg, 2 deg or 5 deg"
    )
    def step_divides(self) -> Truth:
        """The step divides the cycle evenly."""
        return abs(self.steps - np.round(self.steps)) < 1e-6

    @require("gas_cycle", "strokes", remedy="choose `otto`, `diesel` or `table` for two strokes")
    def cycle_has_its_strokes(self) -> Truth:
        """The practical four-stroke cycle needs four strokes."""
        return (self.gas_cycle != "four_stroke") | (self.strokes != 2)

    @require("suction_pressure", remedy="an absolute pressure, with that of the crankcase", missing=True)
    def suction_is_known(self) -> Truth:
        """Cycles otto, diesel and four_stroke need a suction pressure."""
        return known_for(self.gas_cycle, POLYTROPIC, self.p_s)

    @require("compression_ratio", remedy="volume at bottom over volume at top dead centre", missing=True)
    def ratio_is_known(self) -> Truth:
        """Cycles otto, diesel and four_stroke need a compression ratio."""
        return known_for(self.gas_cycle, POLYTROPIC, self.epsilon)

    @require("combustion_pressure", remedy="give the highest pressure of the cycle", missing=True)
    def peak_is_known(self) -> Truth:
        """Cycles otto and four_stroke need a combustion pressure."""
        return known_for(self.gas_cycle, GIVEN_PEAK, self.p_3)

    @require(
        "pressure",
        remedy="give it, for example in steps of 5 deg, or choose another `gas_cycle`",
        missing=True,
    )
    def table_is_known(self) -> Truth:
        """The cycle table needs the pressure over one cycle."""
        return table_is_known(self.gas_cycle, self.p_t)

    @require("pressure_angle", remedy="give one list, ascending, a value for each pressure")
    def table_rises(self) -> Truth:
        """The angles of the table are in strictly ascending order, one for each pressure."""
        return angles_rise(self.gas_cycle, self.theta_p, self.p_t)

    @require("pressure_angle", "pressure", "strokes",
             remedy="at least 8 points; the last need not repeat the first")  # fmt: skip
    def table_is_full(self) -> Truth:
        """The table covers one full cycle: 720° in four strokes, 360° in two."""
        return full_cycle(self.gas_cycle, self.strokes, self.theta_p, self.p_t)

    @require("pressure", remedy="omit the last point")
    def table_closes(self) -> Truth:
        """A last point one cycle after the first repeats its pressure."""
        return table_closes(self.gas_cycle, self.strokes, self.theta_p, self.p_t)

    @require("inlet_opens", "inlet_closes", "exhaust_opens", "exhaust_closes",
             remedy="as 710, 220, 490 and 15 deg; suction begins at 0")  # fmt: skip
    def valves_in_order(self) -> Truth:
        """Inlet opens and exhaust closes within 90° of 720°, inlet closes from 90°, exhaust opens to 630°."""
        return valves_in_order(self.io, self.ic, self.eo, self.ec)

    @require("cutoff", "compression_ratio", "exhaust_opens", remedy="burn for a shorter time")
    def burns_in_time(self) -> Truth:
        """Combustion ends before the exhaust opens."""
        return burns_before_exhaust(self.gas_cycle, lambda: self.gas)

    @require("combustion_pressure", warning="pressure_falls", remedy="check pressures, ratio and exponent")
    def pressure_rises(self) -> Truth:
        """The combustion pressure is not below the pressure at the end of compression."""
        return (self.p_3 >= self.p_2) | (self.gas_cycle not in GIVEN_PEAK)

    @require("crankcase_pressure", "suction_pressure", warning="vacuum_in_crankcase",
             remedy="about 1 bar: suction and combustion pressure are absolute")  # fmt: skip
    def crankcase_is_filled(self) -> Truth:
        """With cycles otto, diesel and four_stroke the crankcase has an absolute pressure above 0."""
        return crankcase_is_filled(self.gas_cycle, self.p_0)

    @require("pressure", "crankcase_pressure", warning="gauge_or_absolute",
             remedy="it is 0 bar beside gauge pressures, about 1 bar beside absolute ones")  # fmt: skip
    def pressures_are_of_one_kind(self) -> Truth:
        """The pressures of table and crankcase are both absolute, or both gauge."""
        is_gauge = (self.p_low < self.p_absolute) | (self.p_0 > 0)
        return is_gauge & ((self.p_low >= 0) | (self.p_0 < self.p_ambient))

    @require("pressure", warning="coarse_table",
             remedy="give more points where the pressure is high, such as every 5 deg")  # fmt: skip
    def table_shows_its_work(self) -> Truth:
        """The table misses at most 2 % of the cycle's work between its points."""
        return self.x_missed <= 0.02

    @require("speed", warning="reversed_cycle", remedy="a gas cycle then runs backwards, and takes up work")
    def runs_forwards(self) -> Truth:
        """The crank angle increases with time."""
        return (self.omega >= 0) | (self.gas_cycle == "none")

    @shared
    def steps(self) -> Array:
        """Return the number of steps in a cycle."""
        return steps_in(self.strokes, self.step)

    @shared(unit="bar")
    def p_2(self) -> Array:
        """Return the greatest pressure at the end of compression."""
        return end_of_compression(self.gas_cycle, lambda: self.gas)

    @shared(unit="bar")
    def p_low(self) -> Array:
        """Return the lowest pressure of the table."""
        return lowest_of_table(self.gas_cycle, self.p_t)

    @shared(unit="1")
    def x_missed(self) -> Array:
        """Return the estimated share of its work that the table misses between its points."""
        return work_between_points(self.gas_cycle, self.strokes, self.theta_p, self.p_t)

    @shared(unit="bar")
    def p_absolute(self) -> Array:
        """Return the pressure above which a table counts as absolute."""
        return np.asarray(absolute_table())

    @shared(unit="bar")
    def p_ambient(self) -> Array:
        """Return the pressure above which a crankcase pressure counts as absolute."""
        return np.asarray(absolute_crankcase())

    @shared
    def charge(self) -> Charge:
        """Return the pressures, volume ratios and exponents of the cycle."""
        return Charge(self.p_s, self.p_e, self.p_3, self.epsilon, self.rho, self.k_c, self.k_e)

    @shared
    def valves(self) -> Valves:
        """Return the crank angles at which the valves open and close."""
        return Valves(self.io, self.ic, self.eo, self.ec)
