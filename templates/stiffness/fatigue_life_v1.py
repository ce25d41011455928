"""Life under the engine cycle: superposed tensors of unit loads, counted cycles, accumulated damage.

Use it for the fillets of a crank, and for any part whose stresses under unit loads are known from finite
elements or measurements. All stresses are elastic.
"""

from __future__ import annotations

from templates.core.language.template import (
    Array,
    Truth,
    choice,
    curve,
    formula,
    given,
    profile,
    require,
    shared,
    table,
    text,
)
from templates.groups.steel_endurance import SHIGLEY, SteelEndurance
from templates.physics.fatigue.damage import (
    ELEMENTARY,
    EXTREMES,
    FINDLEY,
    GERBER,
    GOODMAN,
    HAIBACH,
    MORROW,
    NO,
    NONE,
    ORIGINAL,
    RAINFLOW,
    SIGNED,
    YES,
    CycleCounts,
    compression_used,
    counted_cycles,
    damages,
    governing_point,
    greatest_von_mises,
    inverse_or_none,
    largest,
    largest_amplitudes,
    life_in_words,
    load_uses,
    numbers_of_points,
    one_tensor_leads,
    reversed_amplitudes,
    shares_of_leading_tensors,
)
from templates.physics.fatigue.findley import findley_coefficient
from templates.physics.fatigue.tensors import (
    COMPONENTS,
    Rows,
    changes,
    go_together,
    has_any,
    is_manageable,
    same_points,
    superposed,
)

FINDLEY_1959, MINER = "Findley 1959", "Miner 1945"
UNSTRESSED = "there is no stress"
ENDLESS = "endless: no cycle exceeds the endurance limit"
BROKEN = "it breaks within its first cycle: lower the loads"
POINTS = "points"
LOADS = "one load, or its curve over the cycle, for each table of stresses"


class FatigueLife(SteelEndurance):
    """Life under the engine cycle: superposed tensors of unit loads, counted cycles, accumulated damage.

    For the fillets of a crank, and for any part whose stresses under unit loads are known from finite
    elements or measurements. All stresses are elastic.

    Limits
    ------
    A table of stresses has a row for each point: the tensor xx, yy, zz, xy, yz, xz under a unit of its load,
    in axes that rotate with the part. All tables have the same points in the same order. Loads are constant,
    or curves over one cycle at the same angles, in the directions of the unit loads.
    Tensors are added, never equivalent stresses. Stresses due to inertia need a load of their own.
    Findley: the critical plane is the one with the largest sum of the radius of the smallest circle around
    the shear stress and k times the greatest normal stress. All planes are searched. Cycles are those of the
    shear along the direction of its largest range, each with the greatest normal stress of the whole cycle.
    mean_stress_correction is not used.
    Signed von Mises: refused unless one tensor accounts for 95 % of the squared stress at every point. The
    sign is that of the larger principal stress; pure shear counts as tension.
    A compressive mean stress counts as zero in every method unless compression_credit is yes; then
    yield_strength is needed, and a lowest stress below minus the yield strength is refused.
    Rainflow counting begins and ends at the highest stress of the cycle, so no half cycle is left; cycles
    below 1 % of the largest are ignored. Level extremes uses one cycle between the extremes (constant
    amplitude).
    Strength: a line from 1000 cycles to the endurance limit at the knee. Below the limit the line continues
    after Haibach once any cycle exceeds the limit, with Miner's elementary rule always, with the original
    rule never.
    Marin factors are those of the 10th edition; none is above 1. Temperature, coating and corrosion belong in
    other_factors. Residual stress is not included.
    A local stress is multiplied by K_f/K_t if stress_concentration_factor and notch_radius are given, with
    Neuber's constant for bending; otherwise it is used in full.
    Safety factor: the factor by which all loads, including constant ones, may increase until the endurance
    limit is reached.
    A life below 1000 cycles is plastic and gives a warning. Scatter of life by a factor of three and more is
    common.

    References
    ----------
    W. N. Findley: J. Eng. for Industry 81, 1959. D. F. Socie, G. B. Marquis: Multiaxial Fatigue, SAE 2000.
    ASTM E1049-85 for rainflow. M. A. Miner: J. Appl. Mech. 12, 1945. E. Haibach: Betriebsfestigkeit, 2006.
    R. G. Budynas, J. K. Nisbett: Shigley's Mechanical Engineering Design, 10th ed. 2015, chapter 6.
    """

    levels = (EXTREMES, RAINFLOW)
    default_level = RAINFLOW
    most_points = {EXTREMES: 20_000, RAINFLOW: 2_000}
    precision = 1e-7
    example = {
        "force_1": {"value": [4, 10, 46, 22, 8, 2, -6, -9, -3, 5, 7, 3], "unit": "kN"},
        "stress_of_force_1": {
            "value": [[2.4, 0.5, 7.3, 0.3, 0.5, 2.4], [0.8, 0.3, -5.2, 0, 0.3, 1]],
            "unit": "MPa/kN",
        },
        "force_2": {"value": [0, 12, 9, 14, 6, 1, -2, -8, -6, 2, 4, 1], "unit": "kN"},
        "stress_of_force_2": {
            "value": [[0.3, 0.8, 1, 0.5, 2.9, 0.5], [0.3, 0.5, 0.8, 0.3, 2.4, 0.3]],
            "unit": "MPa/kN",
        },
        "moment_1": {"value": [-20, 180, 420, 510, 250, 30, -80, -260, -210, 40, 120, 10], "unit": "N*m"},
        "stress_of_moment_1": {
            "value": [[5, 13, 29, 10, 220, 23], [8, 10, 21, 13, 240, 18]],
            "unit": "MPa/(kN*m)",
        },
        "ultimate_strength": "900 MPa",
        "yield_strength": "650 MPa",
        "surface": "ground",
        "diameter": "48 mm",
        "reliability": 0.99,
        "stress_concentration_factor": 2.1,
        "notch_radius": "3 mm",
        "cycle_time": "0.04 s",
    }
    main_results = ("greatest_von_mises", "life_in_hours", "safety_factor")
    criteria = {
        "strength": {
            "require": "greatest_von_mises <= yield_strength",
            "words": "the greatest von Mises stress of every point is within the yield strength",
            "source": SHIGLEY,
            "warning": "yields",
        },
        "life": {
            "require": "damage * required_cycles <= 1",
            "words": "every point bears the cycles that are required",
            "source": MINER,
            "limits": {"required_cycles": {"unit": "1", "words": "engine cycles that the part has to bear"}},
        },
        "safety": {
            "require": "safety_factor >= required_safety_factor",
            "words": "all loads may grow by the required factor up to the endurance limit",
            "source": SHIGLEY,
            "limits": {
                "required_safety_factor": {"unit": "1", "words": "smallest safety factor of the loads"}
            },
            "absent": {"safety_factor": {"with": "damage", "reason": UNSTRESSED}},
        },
    }

    F_1: Array = curve("kN", "force 1", constant=True, alternative=True, ge=-1e6, le=1e6)
    t_1: Rows = table("MPa/kN", "stress of force 1", *COMPONENTS, most=200, ge=-1e6, le=1e6)
    F_2: Array = curve("kN", "force 2", constant=True, alternative=True, ge=-1e6, le=1e6)
    t_2: Rows = table("MPa/kN", "stress of force 2", *COMPONENTS, most=200, ge=-1e6, le=1e6)
    M_1: Array = curve("N*m", "moment 1", constant=True, alternative=True, ge=-1e9, le=1e9)
    t_3: Rows = table("MPa/(kN*m)", "stress of moment 1", *COMPONENTS, most=200, ge=-1e6, le=1e6)
    M_2: Array = curve("N*m", "moment 2", constant=True, alternative=True, ge=-1e9, le=1e9)
    t_4: Rows = table("MPa/(kN*m)", "stress of moment 2", *COMPONENTS, most=200, ge=-1e6, le=1e6)
    M_3: Array = curve("N*m", "moment 3", constant=True, alternative=True, ge=-1e9, le=1e9)
    t_5: Rows = table("MPa/(kN*m)", "stress of moment 3", *COMPONENTS, most=200, ge=-1e6, le=1e6)

    criterion: str = choice(FINDLEY, SIGNED, words="multiaxial criterion", default=FINDLEY)
    r_f: Array = given("1", "endurance ratio", symbol="f/t", default=1.6, single=True, ge=1.05, le=1.99)
    correction: str = choice(GOODMAN, GERBER, MORROW, NONE, words="mean stress correction", default=GOODMAN)
    credit: str = choice(NO, YES, words="compression credit", default=NO)
    rule: str = choice(HAIBACH, ELEMENTARY, ORIGINAL, words="miner rule", default=HAIBACH)

    t_c: Array = given("s", "cycle time", optional=True, gt=0, le=1e6)

    @require("force_1", "stress_of_force_1", "force_2", "stress_of_force_2", "moment_1", "stress_of_moment_1",
             "moment_2", "stress_of_moment_2", "moment_3", "stress_of_moment_3", missing=True,
             remedy=LOADS)  # fmt: skip
    def loads_have_stresses(self) -> Truth:
        """Every load comes with its stresses, and every table of stresses with its load."""
        return go_together(self.loads, self.stresses)

    @require("stress_of_force_1", missing=True, remedy="give at least one table of stresses, with its load")
    def is_stressed(self) -> Truth:
        """At least one load has stresses per unit load."""
        return has_any(self.stresses)

    @require("stress_of_force_1", "stress_of_force_2", "stress_of_moment_1", "stress_of_moment_2",
             "stress_of_moment_3", remedy="a row for each point, the same points in all")  # fmt: skip
    def points_are_the_same(self) -> Truth:
        """All tables of stresses have the same number of points."""
        return same_points(self.stresses)

    @require("force_1", "moment_1", missing=True, remedy="give a load over the crank angle")
    def something_changes(self) -> Truth:
        """At least one load is a curve of two or more values."""
        return changes(self.loads)

    @require("force_1", "force_2", "moment_1", "moment_2", "moment_3", "stress_of_force_1",
             remedy="take fewer points, wider steps of the crank angle or fewer curves at once")  # fmt: skip
    def not_too_much(self) -> Truth:
        """Points, angles and curves give at most 200 000 stress tensors."""
        return is_manageable(self.loads, self.stresses)

    @require("multiaxial_criterion", remedy="choose `findley`, which needs no sign")
    def one_tensor_leads(self) -> Truth:
        """With signed von Mises one tensor accounts for 95 % of the squared stress at every point."""
        return one_tensor_leads(self.criterion, self.history)

    @require(
        "yield_strength", "compression_credit", missing=True, remedy="give it, or omit `compression_credit`"
    )
    def credit_needs_yield(self) -> Truth:
        """Credit for compressive mean stress needs the yield strength."""
        return (self.credit == NO) | (self.sigma_y > 0)

    @require("compression_credit", "mean_stress_correction", remedy="choose `goodman` or `morrow`")
    def credit_needs_a_line(self) -> Truth:
        """Gerber's parabola does not apply to compressive mean stress."""
        return (self.credit == NO) | (self.correction != GERBER)

    @shared
    def loads(self) -> tuple[Array, ...]:
        """Return the loads in the order of the tables."""
        return (self.F_1, self.F_2, self.M_1, self.M_2, self.M_3)

    @shared
    def stresses(self) -> tuple[Rows, ...]:
        """Return the tables of stresses."""
        return (self.t_1, self.t_2, self.t_3, self.t_4, self.t_5)

    @shared
    def history(self) -> Array:
        """Return the stress tensors over the cycle [point, angle, 6]."""
        return superposed(self.loads, self.stresses)

    @shared
    def counted(self) -> CycleCounts:
        """Return the cycles of every point."""
        return counted_cycles(self.history, self.criterion, self.level, self.k_F, self.credit)

    @profile("1", "points", along="points", symbol="i")
    def i(self) -> Array:
        return numbers_of_points(self.history)

    @profile("1", "leading tensor share", along=POINTS, symbol="c_1")
    def c_1(self) -> Array:
        return shares_of_leading_tensors(self.history)

    @profile("MPa", "greatest von mises", along=POINTS, symbol=r"\sigma_\mathrm{vM}", source="von Mises 1913")
    def sigma_vM(self) -> Array:
        return greatest_von_mises(self.history)

    @formula("1", "findley coefficient", symbol="k_F", source=FINDLEY_1959)
    def k_F(self) -> Array:
        return findley_coefficient(self.r_f)

    @profile("1", "compression used", along=POINTS, symbol="c_y", le=1,
             remedy="it yields in compression, and the mean stress does not last: lower loads")  # fmt: skip
    def c_y(self) -> Array:
        return compression_used(self.counted, self.credit, self.c_n, self.sigma_y)

    @shared
    def reversed(self) -> Array:
        """Return the reversed amplitudes of all cycles of all points."""
        return reversed_amplitudes(
            self.counted, self.c_n, self.correction, self.credit, self.sigma_u, self.sigma_F, self.k_F,
            self.c_y,
        )  # fmt: skip

    @profile("MPa", "equivalent amplitude", along=POINTS, symbol=r"\sigma_{ar}", remedy=BROKEN)
    def sigma_ar(self) -> Array:
        return largest_amplitudes(self.reversed)

    @profile("1", "damage of points", along=POINTS, symbol="D_i", source=MINER, le=1, remedy=BROKEN)
    def D_i(self) -> Array:
        return damages(self.reversed, self.counted, self.S_e, self.b, self.N_e, self.rule)

    @profile("1", "load use", along=POINTS, symbol="u_i")
    def u_i(self) -> Array:
        return load_uses(
            self.counted, self.reversed, self.correction, self.credit, self.S_e, self.sigma_u, self.sigma_F,
            self.c_n,
        )  # fmt: skip

    @formula("1", "governing point", symbol=r"i_\mathrm{g}")
    def i_g(self) -> Array:
        return governing_point(self.D_i, self.u_i)

    @formula("1", "damage", symbol="D", source=MINER)
    def D(self) -> Array:
        return largest(self.D_i)

    @formula("1", "cycles", symbol="N", published=(1e3, None), absent=ENDLESS, source=MINER)
    def N(self) -> Array:
        return inverse_or_none(self.D)

    @formula("h", "life in hours", symbol="L_h", absent=ENDLESS, le=1e300)
    def L_h(self) -> Array:
        return self.N * self.t_c

    @text("life")
    def life(self) -> str:
        return life_in_words(self.D)

    @formula("1", "safety factor", symbol="n", source=SHIGLEY, absent=UNSTRESSED)
    def n(self) -> Array:
        return inverse_or_none(largest(self.u_i))
