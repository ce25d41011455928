"""Spigot joint: the pressure of a press fit, from hand calculation or from the thick-walled cylinder."""

import numpy as np

from templates.core.declare import limits
from templates.core.errors import Fault, InvalidInputs
from templates.core.template import (
    Array,
    Template,
    choice,
    derived,
    formula,
    given,
    require,
    shared,
    text,
    units,
)

FACTORS = {"dry": 0.15, "oiled": 0.1}


@units("1", "1", returns="1")
def thick_walled(inner: Array, outer: Array) -> Array:
    """Compliance of a ring between two radii, over that of a solid shaft [-]."""
    return (outer**2 + inner**2) / (outer**2 - inner**2)


def refuse(reason: str) -> InvalidInputs:
    """What a script of the team raises for a joint that it knows to be bad."""
    return InvalidInputs([Fault("interference", "team_rule", reason)])


class SpigotJoint(Template):
    """Spigot joint, a press fit of a solid shaft in a hub.

    Limits
    ------
    Elastic, equal materials.
    """

    levels = ("thin", "thick")
    default_level = "thick"
    example = {"diameter": "40 mm", "interference": "30 um", "surface": "dry"}

    d: Array = given("mm", "diameter", gt=0, also=("bore",))
    u: Array = given("um", "interference", ge=0)
    E: Array = given("GPa", "modulus", default="210 GPa", gt=0)
    surface: str = choice("dry", "oiled", words="surface")
    q: Array = given("bar", "service pressure", optional=True, ge=0)

    @derived("mm", "hub diameter", symbol="D", gt=0)
    def D(self) -> Array:
        return 2 * self.d

    @require("hub_diameter", "diameter", remedy="make the hub wider")
    def hub_is_wider(self) -> Array:
        """The hub is wider than its bore."""
        return self.D > self.d

    @shared
    def wall(self) -> Array:
        """Compliance of the hub at this level."""
        return thick_walled(self.d, self.D) if self.level == "thick" else self.d / (self.D - self.d)

    @formula("MPa", "joint pressure", per_level={"thin": limits(0, 500)})
    def p(self) -> Array:
        return self.u * self.E / (self.d * (self.wall + 1))

    @formula("MPa", "reserve", absent="no service pressure is given")
    def reserve(self) -> Array:
        return self.p - np.abs(self.q)

    @text("advice")
    def advice(self) -> str:
        return friction_of(self.surface)


@units(None, returns="1")
def friction_of(surface: str) -> str:
    """The friction to reckon with, in words."""
    return f"reckon with a friction coefficient of {FACTORS[surface]}"
