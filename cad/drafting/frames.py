"""Frames of geometric tolerances (ISO 1101): symbol, width and datum in cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cad.drafting.letter_width import width_of
from cad.drafting.page import Page
from cad.drafting.symbols import Symbol, geometric


@dataclass(frozen=True)
class Frame:
    """A tolerance frame, twice as high as its letters [mm on paper]."""

    form: str
    amount: float  # [mm]
    datum: str
    letters: float

    @property
    def text(self) -> str:
        """Return the tolerance width as text."""
        return f"{self.amount:.6f}".rstrip("0").rstrip(".")

    @property
    def height(self) -> float:
        """Return the height of the frame [mm on paper]."""
        return 2 * self.letters

    @property
    def cells(self) -> Sequence[float]:
        """Return the widths of the cells [mm on paper]."""
        written = width_of(self.text, self.letters) + 2.0
        return [self.height, written, *([self.height] if self.datum else [])]

    @property
    def width(self) -> float:
        """Return the width of the frame [mm on paper]."""
        return sum(self.cells)

    def draw(self, page: Page, left: float, low: float) -> None:
        """Draw the frame with its lower left corner at a point on the paper."""
        high, right = low + self.height, left + self.width
        places = [left + sum(self.cells[:i]) for i in range(len(self.cells) + 1)]
        lines = [[(left, low), (right, low)], [(left, high), (right, high)]]
        lines += [[(x, low), (x, high)] for x in places]
        sign = geometric(self.form, self.height).moved(left + self.height / 2, low + self.height / 2)
        page.symbol(Symbol(lines=lines).joined(sign))
        page.write(self.text, places[1] + 1.0, low + self.letters / 2, self.letters)
        if self.datum:
            aside = (self.height - width_of(self.datum, self.letters)) / 2
            page.write(self.datum, places[2] + aside, low + self.letters / 2, self.letters)
