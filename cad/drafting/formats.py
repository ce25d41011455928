"""Landscape sheets of ISO 5457 with the sizes of ISO 216, and the areas on each sheet [mm on paper]."""

from __future__ import annotations

from dataclasses import dataclass

from cad.drafting.room import Rectangle
from cad.drafting.title import HEIGHT, WIDTH

LEFT, EDGE = 20.0, 10.0  # margins (ISO 5457)
COLUMN = 104.0  # of the table of parameters


@dataclass(frozen=True)
class Format:
    """A sheet with its name and its size."""

    name: str
    width: float
    height: float

    @property
    def area(self) -> Rectangle:
        """Return the area for the views and their dimensions."""
        return LEFT, EDGE + HEIGHT, self.width - EDGE - COLUMN, self.height - EDGE

    @property
    def room(self) -> tuple[float, float]:
        """Return the width and height of the area for the views."""
        left, low, right, high = self.area
        return right - left, high - low

    @property
    def block(self) -> tuple[float, float]:
        """Return the lower left corner of the title block."""
        return self.width - EDGE - WIDTH, EDGE

    @property
    def column(self) -> tuple[float, float]:
        """Return the upper left corner of the table of parameters."""
        return self.width - EDGE - COLUMN, self.height - EDGE


FORMATS = (
    Format("A3", 420.0, 297.0),
    Format("A2", 594.0, 420.0),
    Format("A1", 841.0, 594.0),
    Format("A0", 1189.0, 841.0),
)
"""From small to large; a title block of 180 mm (ISO 7200) leaves no room for notes on A4."""
