"""Rating life of a rolling bearing by ISO 281, under a load that is constant or repeats with the crank.

Use it for the ball bearing at the end of a crankshaft, and for any bearing whose load ratings a catalogue
states.
"""

from __future__ import annotations

from templates.core.language.template import (
    Array,
    Template,
    Truth,
    choice,
    curve,
    formula,
    given,
    require,
    shared,
)
from templates.physics.rolling.rating_life import (
    equivalent_load_ISO_281_2007,
    factor_is_known,
    is_bearable,
    life_exponent,
    mean_load,
    rating_life,
    relative_axial_load,
    reliability_factor,
    safety,
    static_load_ISO_76_2006,
    time_of_turns,
)

ISO_281, ISO_76 = "ISO 281:2007", "ISO 76:2006"
UNLOADED = "a bearing without load has no rating life"


class RollingBearingLife(Template):
    """Rating life of a rolling bearing by ISO 281, under a load that is constant or repeats with the crank.

    For the ball bearing at the end of a crankshaft, and for any bearing whose capacities a catalogue states.

    Limits
    ------
    Basic rating life L10 and its reliability factor a1. The factor a_ISO for lubrication, cleanliness and
    fatigue limit is not included: a clean, well lubricated bearing lasts longer, a dirty one shorter.
    Capacities are those of the bearing's catalogue; the standard's own formulas for them are not included.
    Loads are magnitudes, constant or at equal steps over one cycle at constant speed; a periodic load is
    replaced by the mean of its power p. Its direction is ignored: the inner ring rotates relative to the
    load.
    An axial load applies to single-row deep groove ball bearings of normal clearance. X, Y and e are linear
    between the rows of the table and constant below its first row, 0.172; beyond its last, 6.89, the load is
    refused. The equivalent load is never below the radial one.
    The standard states its formulas for an equivalent load up to half the dynamic capacity.

    References
    ----------
    ISO 281:2007. Rolling bearings, dynamic load ratings and rating life.
    ISO/TR 1281-2:2008. Explanatory notes on ISO 281, part 2, for the reliability factor.
    ISO 76:2006. Rolling bearings, static load ratings.
    """

    example = {
        "radial_load": {"value": [9, 6, 3, 2, 3, 6, 9, 12, 10, 5, 2, 4], "unit": "kN"},
        "axial_load": "1 kN",
        "speed": "3000 rpm",
        "dynamic_capacity": "55.3 kN",
        "static_capacity": "31.5 kN",
        "calculation_factor": 13,
        "reliability": 0.95,
    }
    main_results = ("equivalent_load", "speed", "life_in_hours", "static_safety")
    criteria = {
        "life": {
            "require": "life_in_hours >= required_life",
            "words": "the bearing lives as long as is required, at the reliability that is required",
            "limits": {"required_life": {"unit": "h", "words": "hours that the bearing has to run"}},
        },
        "static_safety": {
            "require": "static_safety >= required_static_safety",
            "words": "the greatest load leaves the required static safety",
            "limits": {
                "required_static_safety": {
                    "unit": "1",
                    "words": "static capacity over the greatest static equivalent load",
                }
            },
        },
    }

    F_r: Array = curve("N", "radial load", constant=True, ge=0, le=1e12)
    F_a: Array = curve("N", "axial load", constant=True, default="0 N", ge=0, le=1e12,
                       assumed="there is no axial load")  # fmt: skip
    n: Array = given("rpm", "speed", gt=0, le=1e7)
    C: Array = given("kN", "dynamic capacity", gt=0, le=1e9)
    C_0: Array = given("kN", "static capacity", gt=0, le=1e9)
    f_0: Array = given("1", "calculation factor", alternative=True, ge=5, le=20,
                       remedy="f0 of the catalogue, 11 to 17")  # fmt: skip
    elements: str = choice("ball", "roller", words="rolling elements", default="ball")
    S: Array = given("1", "reliability", default="0.9", ge=0.9, le=0.9995,
                     assumed="one bearing in ten fails earlier")  # fmt: skip

    @require("calculation_factor", "axial_load", remedy="give f0 of the bearing's catalogue", missing=True)
    def factor_is_known(self) -> Truth:
        """An axial load needs the calculation factor f0."""
        return factor_is_known(self.F_a, self.f_0)

    @require("axial_load", "rolling_elements", remedy="give the equivalent load as `radial_load`")
    def axial_load_on_balls(self) -> Truth:
        """X and Y apply to deep groove ball bearings."""
        return is_bearable(self.F_a, self.elements)

    @shared
    def P(self) -> Array:
        """Return the equivalent load over the cycle [N]."""
        return equivalent_load_ISO_281_2007(self.F_r, self.F_a, self.f_0, self.C_0)

    @formula("1", "relative axial load", symbol=r"\frac{f_0 F_a}{C_0}", source=ISO_281, le=6.89,
             remedy="take a larger bearing, or one for axial loads")  # fmt: skip
    def x_a(self) -> Array:
        return relative_axial_load(self.F_a, self.f_0, self.C_0)

    @formula("1", "life exponent", symbol="p", source=ISO_281)
    def p(self) -> Array:
        return life_exponent(self.elements)

    @formula("N", "equivalent load", symbol="P_m", source=ISO_281, assumes=("x_a",))
    def P_m(self) -> Array:
        return mean_load(self.P, self.p)

    @formula("1", "load ratio", symbol=r"\frac{P}{C}", source=ISO_281, published=(None, 0.5))
    def ratio(self) -> Array:
        return self.P_m / self.C

    @formula("1", "basic rating life", symbol="L_{10}", source=ISO_281, le=1e300, absent=UNLOADED)
    def L_10(self) -> Array:
        return rating_life(self.ratio, self.p)

    @formula("h", "basic life in hours", symbol="L_{10h}", source=ISO_281, le=1e300, absent=UNLOADED)
    def L_10h(self) -> Array:
        return time_of_turns(self.L_10, self.n)

    @formula("1", "reliability factor", symbol="a_1", source="ISO/TR 1281-2:2008")
    def a_1(self) -> Array:
        return reliability_factor(self.S)

    @formula("h", "life in hours", symbol="L_{nh}", source=ISO_281, le=1e300, absent=UNLOADED)
    def L_nh(self) -> Array:
        return self.a_1 * self.L_10h

    @formula("N", "static equivalent load", symbol="P_0", source=ISO_76)
    def P_0(self) -> Array:
        return static_load_ISO_76_2006(self.F_r, self.F_a)

    @formula("1", "static safety", symbol="s_0", source=ISO_76, le=1e300, absent=UNLOADED)
    def s_0(self) -> Array:
        return safety(self.C_0, self.P_0)
