"""Read the headings of measured tables: a name with its unit, as measuring programs write it.

Examples are `pressure [bar]`, `Druck (bar(g))` and `p / bar`. Crank angles are written `°CA`, `degCA` or
`°KW`, and pressures `bara` or `bar(g)`. The unit of a sensor's volts may contain their calibration, `[20
bar/V]`. The answer states what such a unit implies, such as gauge pressure.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from templates.core.errors import FaultyText
from templates.core.units.units import Unit, unit

_CRANK = re.compile(
    r"(?:(?:°|º|deg(?:ree)?s?|grad)[ ._]?(?:c\.?a\.?|kw|ckw|cra|crank(?:[ ._]?angle)?)"
    r"|(?:ca|kw)[ ._]?(?:°|º|deg)|cad)",
    re.IGNORECASE,
)
_PRESSURE = re.compile(
    r"(?P<unit>mbar|bar|mmHg|inHg|hPa|kPa|MPa|Pa|psi)[ ._]?"
    r"(?P<open>\()?(?:(?P<absolute>absolute?|abs\.?|a)|(?P<gauge>gauge|ga|g|relativ|rel\.?|ü|ue))(?(open)\))",
    re.IGNORECASE,
)
_USUAL = {name.lower(): name for name in "mbar bar mmHg inHg hPa kPa psi V mV N kN s ms".split()}
_CALIBRATED = re.compile(
    r"(?:V[ ,;@x*·=]*)?(?P<size>[0-9]{1,6}(?:[.,][0-9]{1,6})?) ?(?P<unit>[A-Za-z]{1,6})/V"
)
_ANGLE_UNIT = re.compile(r"°|º|deg(?:ree)?s?|grad|rad", re.IGNORECASE)
_PRESSURE_UNIT = re.compile(r"mbar|bar|mmHg|inHg|hPa|kPa|MPa|Pa|psi", re.IGNORECASE)
LONGEST_UNIT = 60


@dataclass(frozen=True)
class HeadingUnit:
    """A unit of a heading: its text, the factor for the values, and the assumption that it implies.

    `is_crank` is true for units that name the crank, such as °CA.
    """

    text: str
    factor: float = 1.0
    assumed: str = ""
    is_crank: bool = False

    @property
    def scale(self) -> Unit:
        """Return the unit."""
        return unit(self.text)


def heading_unit(text: str) -> HeadingUnit:
    """Return the unit in a heading; `-` means a pure number.

    Raises
    ------
    FaultyText
        If it is not a unit.
    """
    plain = text.strip()
    if plain == "-":
        return HeadingUnit("1")
    if len(plain) > LONGEST_UNIT:
        return HeadingUnit(unit(plain).text)
    if plain == "Grad":
        return HeadingUnit("deg", assumed="Grad: degrees")
    if _CRANK.fullmatch(plain):
        return HeadingUnit("deg", assumed=plain, is_crank=True)
    if match := _PRESSURE.fullmatch(plain):
        kind = "absolute" if match["absolute"] else "gauge"
        name = _USUAL.get(match["unit"].lower(), match["unit"])
        return HeadingUnit(unit(name).text, assumed=f"{plain}: {kind} pressure, as it stands in the file")
    if match := _CALIBRATED.fullmatch(plain):
        size = float(match["size"].replace(",", "."))
        name = _USUAL.get(match["unit"].lower(), match["unit"])
        said = f"volts times {match['size']} {name}/V, the zero of the sensor as in the file"
        return HeadingUnit(unit(name).text, size, said)
    try:
        return HeadingUnit(unit(plain).text)
    except FaultyText:
        if plain.lower() in _USUAL and plain.lower() in ("bar", "mbar", "psi", "kpa", "hpa"):
            return HeadingUnit(_USUAL[plain.lower()])
        raise


def is_unit(text: str) -> bool:
    """Return whether a text is a unit of a heading."""
    try:
        heading_unit(text)
    except FaultyText:
        return False
    return True


def quantity_of(text: str) -> str:
    """Return the quantity of a heading that is only a unit, such as `pressure` for `bar(a)`; empty if none.

    Only units that are no usual symbol of a quantity count: `V` may be a volume, `s` a stroke.
    """
    plain = text.strip()
    if len(plain) > LONGEST_UNIT:
        return ""
    if _CRANK.fullmatch(plain) or _ANGLE_UNIT.fullmatch(plain):
        return "crank angle"
    return "pressure" if _PRESSURE.fullmatch(plain) or _PRESSURE_UNIT.fullmatch(plain) else ""


def parted(cell: str) -> tuple[str, str]:
    """Return the name and the unit of a heading such as `load_x [kN]` or `p / bar`; `load_x` has no unit."""
    for opening, closing in ("[]", "()"):
        start = _opening(cell, opening, closing)
        if start >= 0:
            return cell[:start].strip(), cell[start + 1 : -1].strip()
    name, slash, last = cell.rpartition(" / ")
    if slash and name.strip() and last.strip() and is_unit(last):
        return name.strip(), last.strip()
    return cell.strip(), ""


def _opening(cell: str, opening: str, closing: str) -> int:
    """Return the position of the bracket that opens a final pair of brackets; -1 if there is none."""
    if not cell.endswith(closing):
        return -1
    depth = 0
    for place in range(len(cell) - 1, -1, -1):
        depth += (cell[place] == closing) - (cell[place] == opening)
        if not depth:
            return place
    return -1
