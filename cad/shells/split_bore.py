"""Rules that a split bore has in a housing and in a rod: walls beside and above it, bolt holes beside it.

Each function returns one rule for the attributes of `SplitBore`, which a model declares under its own words.
The arguments are the API names of the parameters that a refusal names.
"""

from __future__ import annotations

from typing import Protocol

from templates.core.language.spec import Requirement
from templates.core.language.template import Array, Truth, require


class SplitBore(Protocol):
    """Attributes of a model with a split bore [m].

    Attributes
    ----------
    D, A
        The bore and the breadth across it.
    H_b, H_c
        The heights of both halves, from the joint.
    d_b, a_b
        The diameter and the spacing of the bolt holes.
    """

    D: Array
    A: Array
    H_b: Array
    H_c: Array
    d_b: Array
    a_b: Array


def sides_rule(breadth: str, bore: str) -> Requirement:
    """Return the rule that there are walls beside the bore."""

    @require(breadth, bore, remedy="make the breadth larger")
    def bore_has_sides(self: SplitBore) -> Truth:
        """The breadth is at least 5 % larger than the bore."""
        return self.A >= 1.05 * self.D

    return bore_has_sides


def roof_rule(height: str, cap_height: str, bore: str) -> Requirement:
    """Return the rule that there are walls above and below the bore."""

    @require(height, cap_height, bore, remedy="make both halves higher")
    def bore_has_a_roof(self: SplitBore) -> Truth:
        """The heights of both halves are each at least 55 % of the bore diameter."""
        return (self.H_b >= 0.55 * self.D) & (self.H_c >= 0.55 * self.D)

    return bore_has_a_roof


def bore_clearance_rule(bore: str) -> Requirement:
    """Return the rule that the bolt holes are clear of the bore."""

    @require("bolt_spacing", "bolt_hole_diameter", bore,
             remedy="move the bolts outwards or make their holes smaller, or 0 for none")  # fmt: skip
    def bolts_clear_bore(self: SplitBore) -> Truth:
        """The bolt holes are clear of the bore by at least 1 % of its diameter."""
        return (self.d_b <= 0) | (self.a_b - self.d_b >= 1.01 * self.D)

    return bolts_clear_bore


def breadth_rule(breadth: str) -> Requirement:
    """Return the rule that there are walls outside the bolt holes."""

    @require("bolt_spacing", "bolt_hole_diameter", breadth,
             remedy="move the bolts inwards or make their holes smaller, or 0 for none")  # fmt: skip
    def bolts_keep_within(self: SplitBore) -> Truth:
        """The bolt holes lie within 98 % of the breadth."""
        return (self.d_b <= 0) | (self.a_b + self.d_b <= 0.98 * self.A)

    return bolts_keep_within
