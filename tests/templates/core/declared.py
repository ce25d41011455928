"""A template for tests of the language."""

import numpy as np

from templates.core.language.template import (
    Template,
    Truth,
    choice,
    curve,
    derived,
    formula,
    given,
    require,
    units,
)


@units("m", returns="m", latex=r"f\left({0}\right)")
def rounded_up(x):
    return np.ceil(x / 1e-3) * 1e-3


@units("m", "1", returns="m**2", latex=r"2\,{0}^2\,{1}-{1}")
def swept(a, x):
    return 2 * np.square(a) * np.asarray(x)


def doubled(x):
    return 2 * x


def branched(x):
    if np.any(x > 0):
        return x
    return -x


class Shaft(Template):
    """A shaft. It turns.

    Limits
    ------
    For shafts only.

    Errata
    ------
    The first is said in one line.
    The second takes
    two lines.

    References
    ----------
    Nobody 1900.
    """

    example = {"bore": "50 mm", "load": {"value": [1, 3, 2], "unit": "kN"}}

    d = given("mm", "bore", gt=1, le=100, also=("inner diameter",))
    n = given("1", "balls", default=8, integer=True, ge=3)
    m = given("kg", "rod mass", default="1 kg", published=(0.5, 2), source="Nobody 1900")
    load = curve("N", "load")
    shape = choice("round", "square_cut", words="web shape", default="round")

    @derived("mm", "outer diameter", gt=0)
    def D(self):
        return 2 * self.d

    @require("outer_diameter", "bore", remedy="make the outside larger")
    def has_wall(self) -> Truth:
        """The outside is larger than the bore."""
        return self.D > self.d

    @formula("mm", "wall", symbol="t")
    def t(self):
        return (self.D - self.d) / 2

    @formula("N", "largest load", symbol=r"F_\max")
    def F(self):
        return np.max(self.load, axis=-1)

    @formula("MPa", "pressure", ge=0, lt=1000, remedy="lower the load")
    def p(self):
        return self.F / (self.d * rounded_up(doubled(self.t)))

    @formula("kg/mm", "mass per width", name="linear_mass")
    def q(self):
        return branched(self.m) / self.t


def codes(refusal):
    return {(name, fault.code) for fault in refusal.value.faults for name in fault.names}
