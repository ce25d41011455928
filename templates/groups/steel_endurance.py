"""Group: the fatigue strength of steel, from its ultimate strength, Marin factors and notch sensitivity."""

from __future__ import annotations

from templates.core.language.template import Array, Template, Truth, choice, derived, formula, given, require
from templates.physics.fatigue.endurance import (
    AXIAL,
    BENDING,
    SURFACES,
    both_or_none,
    loading_factor,
    neuber_length,
    notch_sensitivity_Neuber,
    notch_support,
    reliability_factor,
    share_at_1000_cycles,
    size_factor,
    slope_of_line,
    specimen_limit,
    strength_coefficient,
    surface_factor,
)

SHIGLEY = "Budynas, Nisbett 2015"
NEUBER = "Neuber 1937, by Budynas, Nisbett 2015"


class SteelEndurance(Template):
    """Fatigue strength of steel from its ultimate strength and Marin factors, and the effect of a notch."""

    sigma_u: Array = given("MPa", "ultimate strength", symbol="S_u", ge=50, le=5000)
    sigma_y: Array = given("MPa", "yield strength", symbol="S_y", alternative=True, gt=0, le=5000)
    surface: str = choice(*SURFACES, words="surface", default="machined", assumed="the surface is machined")
    d: Array = given("mm", "diameter", alternative=True, gt=0, le=1e4)
    loading: str = choice(BENDING, AXIAL, words="loading", default=BENDING)
    R: Array = given("1", "reliability", default=0.5, ge=0.5, le=0.999999,
                     assumed="half of the parts fail earlier")  # fmt: skip
    k_m: Array = given("1", "other factors", symbol="k_m", default=1, gt=0, le=1,
                       assumed="nothing else lowers the strength")  # fmt: skip
    N_e: Array = given("1", "knee cycles", symbol="N_e", default=1e6, ge=1e5, le=1e8)
    K_t: Array = given("1", "stress concentration factor", symbol="K_t", alternative=True, ge=1, le=20)
    r: Array = given("mm", "notch radius", alternative=True, gt=0, le=1e4)

    @require("notch_radius", "stress_concentration_factor", missing=True,
             remedy="give its radius; beyond 1750 MPa its `notch_sensitivity`")  # fmt: skip
    def notch_is_known(self) -> Truth:
        """A stress concentration factor is given with the data of its notch sensitivity."""
        return both_or_none(self.K_t, self.q)

    @formula("MPa", "specimen limit", symbol="S_e'", source=SHIGLEY)
    def S_0(self) -> Array:
        """Endurance limit of a polished specimen."""
        return specimen_limit(self.sigma_u)

    @formula("1", "surface factor", symbol="k_a", source=SHIGLEY)
    def k_a(self) -> Array:
        """Marin factor for the surface."""
        return surface_factor(self.surface, self.sigma_u)

    @formula("1", "size factor", symbol="k_b", source=SHIGLEY)
    def k_b(self) -> Array:
        """Marin factor for the size."""
        return size_factor(self.d)

    @formula("1", "loading factor", symbol="k_c", source=SHIGLEY)
    def k_c(self) -> Array:
        """Marin factor for the loading."""
        return loading_factor(self.loading)

    @formula("1", "reliability factor", symbol="k_e", source=SHIGLEY)
    def k_e(self) -> Array:
        """Marin factor for the reliability."""
        return reliability_factor(self.R)

    @derived("MPa", "endurance limit", symbol="S_e", shown=True, gt=0, le=5000, source="Marin 1962")
    def S_e(self) -> Array:
        """Default: the limit of a specimen times the Marin factors."""
        return self.k_a * self.k_b * self.k_c * self.k_e * self.k_m * self.S_0

    @formula("1", "strength share", symbol="f", source=SHIGLEY)
    def f(self) -> Array:
        """Strength at 1000 cycles over the ultimate strength."""
        return share_at_1000_cycles(self.sigma_u)

    @derived("MPa", "strength at 1000 cycles", symbol="S_3", shown=True, gt=0, le=5000, source=SHIGLEY)
    def S_3(self) -> Array:
        """Fatigue strength at 1000 cycles."""
        return self.f * self.sigma_u

    @derived("MPa", "fatigue strength coefficient", symbol=r"\sigma_F'", gt=0, le=10_000)
    def sigma_F(self) -> Array:
        """Default: 345 MPa above the ultimate strength, for steel up to 500 HB."""
        return strength_coefficient(self.sigma_u)

    @require("endurance_limit", "strength_at_1000_cycles", remedy="check their units")
    def line_falls(self) -> Truth:
        """The endurance limit is at most 0.95 of the strength at 1000 cycles."""
        return self.S_e <= 0.95 * self.S_3

    @formula("1", "slope", symbol="b", source=SHIGLEY)
    def b(self) -> Array:
        """Slope of the S-N line in log-log axes."""
        return slope_of_line(self.S_3, self.S_e, self.N_e)

    @derived("1", "notch sensitivity", symbol="q", shown=True, ge=0, le=1, source=NEUBER,
             absent="give `notch_radius`; beyond 1750 MPa the sensitivity")  # fmt: skip
    def q(self) -> Array:
        """Default: notch sensitivity by Neuber."""
        return notch_sensitivity_Neuber(neuber_length(self.sigma_u), self.r)

    @formula("1", "notch support", symbol=r"\frac{K_f}{K_t}", source=NEUBER)
    def c_n(self) -> Array:
        """Fraction of the local stress that is effective in fatigue, K_f/K_t."""
        return notch_support(self.K_t, self.q)
