"""The fields of the wizard that have no proposed value, and how their texts are read.

A number without a unit has the unit that the page shows beside its field, in SI or US units. A decimal comma
is read as a decimal point unless it may group thousands; then the reader asks which is meant, except if the
user chose the decimal comma.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from app.presentation.units import System, shown_unit, shown_value
from app.web.engine_bearings.layouts import written_order
from templates.core.errors import FaultyText
from templates.core.units.quantity import in_points, read
from templates.core.units.relation import is_relation
from templates.physics.journals.oil_grades import grades

_BARE = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9])")
_ITEM = re.compile(r"[0-9]{1,3}")
_ORDER = re.compile(r"\[?[0-9]{1,3}(?:[\s,;\-–>]+[0-9]{1,3})*\]?")
OIL_UNIT = "mPa*s"


@dataclass(frozen=True)
class Asked:
    """A quantity without a proposed value."""

    words: str
    unit: str
    example: str
    hint: str = ""


QUANTITIES: dict[str, Asked] = {
    "bore": Asked("bore", "mm", "86 mm"),
    "stroke": Asked("stroke", "mm", "86 mm"),
    "rod_length": Asked("rod length", "mm", "145 mm", "between the centres of its two eyes"),
    "piston_mass": Asked("piston mass", "kg", "0.48 kg", "with rings and pin"),
    "rod_mass": Asked("rod mass", "kg", "0.6 kg", "with bolts and shells"),
    "crank_unbalance": Asked(
        "crank unbalance of one throw", "kg*mm", "-8 kg*mm",
        "pin and webs less their counterweights, without the rod; negative if the counterweights prevail",
    ),
    "speed": Asked("speed", "rpm", "4500 rpm"),
    "permissible_film": Asked("permissible film", "um", "1 um", "smallest oil film that you permit"),
}  # fmt: skip
OIL = Asked(
    "oil", OIL_UNIT, "SAE 5W-30", "a grade, or the dynamic viscosity in the warm film, such as 10 mPa*s"
)


@dataclass(frozen=True)
class Typing:
    """How the texts are typed: the units of bare numbers, and whether a comma is always a decimal sign."""

    units: System = "si"
    has_comma: bool = False

    def quantity(self, text: str, unit: str) -> str:
        """Return a typed quantity with a decimal point and a unit; `unit` is the declared one.

        Raises
        ------
        FaultyText
            As raised by `quantity_text`.
        """
        plain = text.strip()
        if self.has_comma and not is_relation(plain):
            plain = _COMMA.sub(".", plain)
        return quantity_text(plain, unit, self.unit(unit))

    def unit(self, declared: str) -> str:
        """Return the unit of a bare number."""
        return shown_unit(declared, self.units)

    def example(self, text: str, unit: str) -> str:
        """Return an example of a quantity in the unit of a bare number."""
        if self.unit(unit) == unit:
            return text
        return f"{shown_value(float(text.split()[0]), unit, self.units):.3g} {self.unit(unit)}"


def quantity_text(text: str, unit: str, bare: str = "") -> str:
    """Return a typed quantity with a decimal point and a unit; a relation is returned as typed.

    A bare number has the unit `bare`, by default the declared `unit`.

    Raises
    ------
    FaultyText
        If the text is not a quantity of this unit; the error states a remedy.
    """
    plain = text.strip()
    if is_relation(plain):
        return plain
    plain = in_points(plain)
    if _BARE.fullmatch(plain) and unit != "1":
        plain = f"{plain} {bare or unit}"
    read(plain, unit)
    return plain


TYPING = Typing()


def firing_order(text: str, cylinders: int) -> list[int]:
    """Return a firing order typed as `1-3-4-2`, `1 3 4 2` or `[1, 3, 4, 2]`.

    Raises
    ------
    FaultyText
        If it does not name every cylinder once.
    """
    order = [int(item) for item in _ITEM.findall(text)] if _ORDER.fullmatch(text.strip()) else []
    if sorted(order) != list(range(1, cylinders + 1)):
        usual = written_order([*range(1, cylinders + 1)])
        detail = f"a firing order names each of the {cylinders} cylinders once, in a form such as {usual}"
        raise FaultyText("not_an_order", detail)
    return order


def oil_grade(text: str) -> str | None:
    """Return the grade that a text names, such as `SAE 5W-30` or `ISO VG 46`; None if it names no grade."""
    key = re.sub(r"[^a-z0-9]+", "_", text.strip().lower()).strip("_")
    names = (key, f"sae_{key}", key.replace("sae", "sae_"), f"iso_{key}")
    return next((name for name in names if name in grades()), None)


def viscosity(text: str, typing: Typing = TYPING) -> str:
    """Return the dynamic viscosity that a text states.

    Raises
    ------
    FaultyText
        If it is neither a viscosity nor a known grade.
    """
    try:
        return typing.quantity(text, OIL_UNIT)
    except FaultyText as error:
        detail = f"{error}; or name a grade, such as SAE 5W-30, SAE 40 or ISO VG 46"
        raise FaultyText("no_oil", detail) from None
