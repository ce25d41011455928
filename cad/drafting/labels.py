"""The text of a dimension: symbols, number, tolerance class and deviations (ISO 129-1)."""

from __future__ import annotations

import re
from dataclasses import dataclass

from cad.drafting.letter_width import width_of
from cad.drafting.measures import Measure
from cad.drafting.parameter_match import Dimension
from cad.tolerances import deviations, number_of

TEXT = 3.5  # height of letters [mm on paper]
SMALL = 0.7  # deviations are of so many times the height of the number
_EXACT = 1e-9  # [mm]
_LED = ("circle", "arc", "aligned")
_STACK = re.compile(r"(?s)(.*)\{\\H0\.7x;\\S([^^]*)\^ ([^;]*);\}(.*)")


@dataclass(frozen=True)
class Label:
    """The text of a dimension; `<>` in `text` stands for the number."""

    text: str
    number: str
    upper: str = ""
    lower: str = ""

    @property
    def mtext(self) -> str:
        """Return the text in the format of DXF, with the deviations one above the other."""
        stack = f" {{\\H{SMALL}x;\\S{self.upper}^ {self.lower};}}" if self.upper else ""
        return f"{self.text}{stack}"

    def width(self, height: float) -> float:
        """Return the width of the text for letters of a given height."""
        deviations = max(width_of(self.upper, height), width_of(self.lower, height)) * SMALL
        gap = width_of(" ", height) if self.upper else 0.0
        return width_of(self.text.replace("<>", self.number), height) + deviations + gap

    def height(self, height: float) -> float:
        """Return the height of the text for letters of a given height."""
        return 2.4 * SMALL * height if self.upper else height


def label_of(dimension: Dimension) -> Label:
    """Return the label of a dimension.

    A diameter has the prefix Ø, that of a ball SØ, a repeated size its count. A reference size stands in
    brackets.
    """
    measure = dimension.measure
    several = f"{measure.count}×" if measure.count > 1 else ""
    is_round = measure.form in ("circle", "arc")  # these have their signs from the DIMENSION
    sign = "S" * measure.is_spherical + "Ø" * (measure.sort == "diameter" and not is_round)
    own = {"circle": "Ø", "arc": "R"}.get(measure.form, "")
    number = own + number_of(measure.value, _decimals(measure))
    text = f"{several}{sign}<>{'×45°' if measure.sort == 'chamfer' else ''}"
    if dimension.is_reference:
        return Label(f"({text})", number)
    if measure.sort == "angle":
        number += "°"
    limits = dimension.limits
    if limits is None:
        return Label(text, number)
    zone = f" {limits.zone}" if limits.zone else ""
    upper, lower = deviations(limits)
    if not lower:
        return Label(f"{text}{zone} {upper}", number)
    if measure.form in _LED:  # words at a leader stand on one line
        return Label(f"{text}{zone} {upper}/{lower}", number)
    return Label(f"{text}{zone}", number, upper, lower)


def _decimals(measure: Measure) -> int:
    """Return the most decimals of a number: four for the radius of a diameter of three decimals."""
    if measure.sort == "angle":
        return 2
    is_half = abs(round(2 * measure.value, 3) - 2 * measure.value) < _EXACT
    return 4 if measure.form == "arc" and is_half else 3


def read_stack(mtext: str) -> tuple[str, str, str]:
    """Return the text of a DXF dimension without its deviations, then the upper and the lower deviation."""
    match = _STACK.fullmatch(mtext)
    return (match[1].rstrip() + match[4], match[2], match[3]) if match else (mtext, "", "")
