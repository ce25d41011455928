"""Duty of a plain bush: projected pressure, sliding speed and their product, by which bushes are compared.

For a first choice of material. Says nothing of a film, nor of heat that is carried away.
"""

from templates.core.template import Array, Template, Truth, derived, formula, given, require


class BushDuty(Template):
    """Duty of a plain bush: projected pressure, sliding speed and their product.

    Limits
    ------
    A steady load, spread over the projected area of the bore.
    """

    example = {"radial_load": "2 kN", "bearing_diameter": "20 mm", "speed": "300 rpm"}

    F: Array = given("N", "radial load", ge=0)
    d: Array = given("mm", "bearing diameter", gt=0)
    omega: Array = given("rpm", "speed", ge=0)

    @derived("mm", "bearing width", gt=0)
    def b(self) -> Array:
        return self.d

    @require("bearing_width", remedy="use two bushes", warning="long_bush")
    def short_enough(self) -> Truth:
        """A bush longer than twice its bore carries on its edges."""
        return self.b <= 2 * self.d

    @formula("MPa", "projected pressure", symbol=r"\bar{p}")
    def p(self) -> Array:
        return self.F / (self.d * self.b)

    @formula("m/s", "sliding speed")
    def u(self) -> Array:
        return self.omega * self.d / 2

    @formula("MPa*m/s", "pressure times speed", symbol=r"\bar{p}u")
    def pu(self) -> Array:
        return self.p * self.u
