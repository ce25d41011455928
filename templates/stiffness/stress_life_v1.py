"""Fatigue life by stress: Basquin's line with mean stress by Goodman, Gerber or Morrow.

Use it for parts under constant amplitude with elastic stresses. The stress is given as the local stress (from
finite elements or measurements), or as a nominal stress with its stress concentration.
"""

from __future__ import annotations

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
    text,
)
from templates.physics.shafts.fatigue import (
    GERBER,
    GOODMAN,
    MORROW,
    NONE,
    allowable_amplitude,
    cycles_Basquin_1910,
    either_is_given,
    is_below,
    is_borne_once,
    life_in_words,
    load_safety_factor,
    mean_is_used,
    mean_share,
    ratio_or_none,
)
from templates.physics.shafts.stress_concentration import (
    BENDING,
    TORSION,
    fatigue_notch_factor_Peterson,
    is_charted,
    is_wider,
    local_stress,
    notch_is_known,
    shoulder_fillet_Pilkey_2008,
)

BASQUIN, SHIGLEY, PETERSON = "Basquin 1910", "Budynas, Nisbett 2011", "Pilkey, Pilkey 2008"
NO_NOTCH = "give `larger_diameter`, `smaller_diameter` and `fillet_radius`"
NO_NOMINAL = "give it, or the nominal stress with its stress concentration"
ENDLESS = (
    "endless: the equivalent amplitude does not exceed the endurance limit, or is so far below the fatigue "
    "strength coefficient that no number of cycles can be told"
)
NO_LIMIT = "needs endurance_limit or design_life, and some stress"


class StressLife(Template):
    """Fatigue life by stress: Basquin's line with mean stress by Goodman, Gerber or Morrow.

    For parts under constant amplitude with elastic stresses. The stress is given as the local stress (from
    finite elements or measurements), or as a nominal stress with its stress concentration.

    Limits
    ------
    A stress from finite elements is used without change: in a design, `stress_amplitude` may be the relation
    `= throw.torsion.maximum_stress`, scaled to the alternating torque.
    A nominal stress, amplitude and mean alike, is multiplied by the fatigue notch factor, which is valid if
    the notch does not yield; in torsion it is a shear stress, and its von Mises stress is used.
    If both are given, the local stress is used.
    Life is infinite up to the endurance limit, if there is one; otherwise Basquin's line continues, which few
    tests confirm beyond 1e8 cycles.
    Goodman and Gerber treat a compressive mean stress as zero, with a warning; with Morrow it increases life.
    `safety_factor` is that of the load: amplitude and mean increase together, up to the line for infinite
    life or for `design_life`. For `amplitude_safety_factor` only the amplitude increases.
    A largest stress at or above the ultimate strength is refused; one above the yield strength gives a
    warning. A compressive mean stress is not refused however large it is, and Morrow's life is then
    unbounded: the criterion on strength compares |mean| + amplitude with the ultimate strength, and gives a
    warning.
    There is no safety factor if amplitude and mean may increase together without limit: without stress, or if
    compression outweighs the amplitude (Morrow).
    Below 1000 cycles strains are plastic and Basquin's line no longer applies, which gives a warning.

    References
    ----------
    O. H. Basquin: The exponential law of endurance tests. Proc. ASTM 10, 1910.
    J. Goodman 1899, W. Gerber 1874, J. Morrow (SAE Fatigue Design Handbook) 1968 for the mean stress.
    R. G. Budynas, J. K. Nisbett: Shigley's Mechanical Engineering Design, 9th ed. 2011, chapter 6.
    N. E. Dowling: Mechanical Behavior of Materials, 4th ed. 2013, chapter 9.
    W. D. Pilkey, D. F. Pilkey: Peterson's Stress Concentration Factors, 3rd ed. 2008, chapter 3.
    """

    example = {
        "nominal_stress_amplitude": "70 MPa",
        "nominal_mean_stress": "20 MPa",
        "loading": "torsion",
        "larger_diameter": "60 mm",
        "smaller_diameter": "48 mm",
        "fillet_radius": "3 mm",
        "notch_sensitivity": 0.9,
        "ultimate_strength": "800 MPa",
        "yield_strength": "600 MPa",
        "fatigue_strength_coefficient": "1150 MPa",
        "fatigue_strength_exponent": -0.09,
        "endurance_limit": "130 MPa",
        "design_life": 1e7,
    }
    main_results = ("stress_amplitude", "cycles", "safety_factor")
    criteria = {
        "strength": {
            "require": "abs(mean_stress) + stress_amplitude <= ultimate_strength",
            "words": "the largest stress, in tension or compression, is within the ultimate strength",
            "source": "compression is held against the strength in tension, as of ductile steels",
            "warning": "static_overload",
        },
        "yield": {
            "require": "abs(mean_stress) + stress_amplitude <= yield_strength",
            "words": "the largest stress, in tension or compression, is within the yield strength",
            "source": "Budynas, Nisbett 2011",
            "warning": "yields",
        },
        "life": {
            "require": "equivalent_amplitude <= allowable_amplitude",
            "words": "the stress is borne for the design life, or for ever",
            "source": "Basquin 1910",
        },
        "safety": {
            "require": "safety_factor >= required_safety_factor",
            "words": "amplitude and mean may grow together by the required factor",
            "source": "Budynas, Nisbett 2011",
            "limits": {
                "required_safety_factor": {"unit": "1", "words": "smallest safety factor of the load"}
            },
            "absent": {
                "safety_factor": {
                    "with": "allowable_amplitude",
                    "reason": "amplitude and mean may grow without end: there is no stress, or compression"
                    " outweighs the amplitude",
                }
            },
        },
    }

    S_a: Array = given("MPa", "nominal stress amplitude", alternative=True, ge=0)
    S_m: Array = given("MPa", "nominal mean stress", alternative=True)
    loading: str = choice(BENDING, TORSION, words="loading", default=BENDING)
    D: Array = given("mm", "larger diameter", alternative=True, gt=0)
    d: Array = given("mm", "smaller diameter", alternative=True, gt=0)
    r: Array = given("mm", "fillet radius", alternative=True, gt=0)
    q: Array = given("1", "notch sensitivity", default=1, ge=0, le=1)
    sigma_u: Array = given("MPa", "ultimate strength", symbol=r"\sigma_{u}", gt=0)
    sigma_y: Array = given("MPa", "yield strength", symbol=r"\sigma_{y}", optional=True, gt=0)
    sigma_f: Array = given("MPa", "fatigue strength coefficient", symbol=r"\sigma_{f}'", gt=0)
    b: Array = given("1", "fatigue strength exponent", ge=-1, lt=0)
    S_e: Array = given("MPa", "endurance limit", alternative=True, gt=0)
    N_d: Array = given("1", "design life", alternative=True, ge=0.5)
    correction: str = choice(GOODMAN, GERBER, MORROW, NONE, words="mean stress correction", default=GOODMAN)

    @formula("1", "shoulder over fillet", symbol="h_r", le=40, absent=NO_NOTCH, source=PETERSON)
    def h_r(self) -> Array:
        return (self.D - self.d) / (2 * self.r)

    @derived("1", "stress concentration factor", symbol="K_t", shown=True, ge=1, source=PETERSON,
             absent=NO_NOTCH, remedy="the chart does not reach so far: give the factor itself")  # fmt: skip
    def K_t(self) -> Array:
        return shoulder_fillet_Pilkey_2008(self.loading, self.D, self.d, self.r)

    @formula("1", "fatigue notch factor", symbol="K_f", source="Peterson 1974", absent=NO_NOTCH)
    def K_f(self) -> Array:
        return fatigue_notch_factor_Peterson(self.K_t, self.q)

    @derived("MPa", "stress amplitude", symbol=r"\sigma_{a}", shown=True, ge=0, absent=NO_NOMINAL)
    def sigma_a(self) -> Array:
        return local_stress(self.loading, self.S_a, self.K_f)

    @derived("MPa", "mean stress", symbol=r"\sigma_{m}", shown=True, absent=NO_NOMINAL)
    def sigma_m(self) -> Array:
        return local_stress(self.loading, self.S_m, self.K_f)

    @require("stress_amplitude", "nominal_stress_amplitude", missing=True, remedy="give one of them")
    def amplitude_is_known(self) -> Truth:
        """The stress amplitude is given as a local or a nominal stress."""
        return either_is_given(self.as_given_amplitude, self.S_a)

    @require("mean_stress", "nominal_mean_stress", missing=True, remedy="0 MPa if the stress is reversed")
    def mean_is_known(self) -> Truth:
        """The mean stress is given as a local or a nominal stress."""
        return either_is_given(self.as_given_mean, self.S_m)

    @require("stress_concentration_factor", "fillet_radius", missing=True,
             remedy="give it, or `larger_diameter`, `smaller_diameter` and `fillet_radius`")  # fmt: skip
    def nominal_stress_has_a_notch(self) -> Truth:
        """A nominal stress comes with its stress concentration."""
        return notch_is_known(
            self.as_given_factor, self.h_r, self.as_given_amplitude, self.S_a, self.as_given_mean, self.S_m
        )

    @require("larger_diameter", "smaller_diameter", remedy="swap the two")
    def is_a_shoulder(self) -> Truth:
        """The larger diameter is larger than the smaller one."""
        return is_wider(self.D, self.d)

    @require("stress_amplitude", "mean_stress", "ultimate_strength",
             remedy="it breaks at the first load: take a stronger material, or lower the stress")  # fmt: skip
    def is_borne_once(self) -> Truth:
        """The largest stress, amplitude plus mean, is below the ultimate strength."""
        return is_borne_once(self.sigma_a, self.sigma_m, self.sigma_u)

    @require("endurance_limit", "fatigue_strength_coefficient", remedy="check their units")
    def limit_is_below_coefficient(self) -> Truth:
        """The endurance limit is below the fatigue strength coefficient."""
        return is_below(self.S_e, self.sigma_f)

    @require("fillet_radius", warning="outside_published_range", remedy="beyond, it is extrapolated")
    def is_in_the_chart(self) -> Truth:
        """Shoulder height over fillet is within the chart: 0.25 to 4 in torsion, 0.1 to 20 in bending."""
        return is_charted(self.loading, self.h_r, self.as_given_factor)

    @require("mean_stress", warning="compressive_mean", remedy="with `morrow` it lengthens the life")
    def mean_is_tensile(self) -> Truth:
        """The mean stress is tensile; Goodman and Gerber treat a compressive one as zero."""
        return mean_is_used(self.correction, self.sigma_m)

    @shared
    def as_given_amplitude(self) -> Array:
        """Return the local amplitude, if it was given."""
        return self.as_given("sigma_a")

    @shared
    def as_given_mean(self) -> Array:
        """Return the local mean stress, if it was given."""
        return self.as_given("sigma_m")

    @shared
    def as_given_factor(self) -> Array:
        """Return the stress concentration factor, if it was given."""
        return self.as_given("K_t")

    @formula("1", "mean stress share", symbol="c_m", lt=1, source="Goodman 1899, Gerber 1874, Morrow 1968",
             remedy="the mean stress reaches the strength that bounds it")  # fmt: skip
    def c_m(self) -> Array:
        return mean_share(self.correction, self.sigma_m, self.sigma_u, self.sigma_f)

    @formula("MPa", "equivalent amplitude", symbol=r"\sigma_{ar}", ge=0)
    def sigma_ar(self) -> Array:
        return self.sigma_a / (1 - self.c_m)

    @formula("1", "cycles", symbol="N", ge=0.5, published=(1e3, None), source=BASQUIN, absent=ENDLESS,
             assumes=("n_y",), remedy="it breaks within the first cycle: lower the stress")  # fmt: skip
    def N(self) -> Array:
        return cycles_Basquin_1910(self.sigma_ar, self.sigma_f, self.b, self.S_e)

    @text("life")
    def life(self) -> str:
        return life_in_words(self.N, self.sigma_ar)

    @formula("MPa", "allowable amplitude", symbol="S", absent="needs endurance_limit or design_life")
    def S(self) -> Array:
        return allowable_amplitude(self.S_e, self.sigma_f, self.b, self.N_d)

    @formula("1", "safety factor", symbol="n", source=SHIGLEY, absent=NO_LIMIT)
    def n(self) -> Array:
        return load_safety_factor(self.correction, self.sigma_a, self.S, self.c_m)

    @formula("1", "amplitude safety factor", symbol="n_a", absent=NO_LIMIT)
    def n_a(self) -> Array:
        return ratio_or_none(self.S, self.sigma_ar)

    @formula("1", "yield safety factor", symbol="n_y", source=SHIGLEY, absent="there is no stress")
    def n_y(self) -> Array:
        return ratio_or_none(self.sigma_y, self.sigma_a + abs(self.sigma_m))
