"""The title block of a drawing (ISO 7200): its fields, their positions and maximum text lengths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

WIDTH, HEIGHT = 180.0, 46.0
"""Of the title block [mm on paper]; ISO 7200 has it 180 mm wide on every sheet."""

CAPTION = 1.8  # height of the letters that name a field [mm on paper]
_INSET = 1.5  # from the left side of a field to its text

MADE_OUT = "iso-"
"""Before the names of fields that a stamp fills in; the lines of older drawings have names without it."""

OF_PART = "part-"
"""Before the names of fields that a stamp fills in with what is true of one part alone."""


@dataclass(frozen=True)
class Field:
    """A field of the title block: its position from the lower left corner, its caption and letters."""

    name: str
    caption: str
    left: float
    low: float
    width: float
    height: float
    letters: float = 2.5
    is_stamped: bool = True

    @property
    def mark(self) -> str:
        """Return the name of the field in files, by which a stamp finds it."""
        return MADE_OUT + self.name

    @property
    def part_mark(self) -> str:
        """Return its name in files on the sheet of one part, for a stamp."""
        return OF_PART + self.name

    @property
    def room(self) -> float:
        """Return the width available for the text [mm on paper]."""
        return self.width - 2 * _INSET

    @property
    def text_at(self) -> tuple[float, float]:
        """Return the start of the text, from the lower left corner of the block."""
        return self.left + _INSET, self.low + 1.7

    @property
    def caption_at(self) -> tuple[float, float]:
        """Return the start of the caption, from the lower left corner of the block."""
        return self.left + _INSET, self.low + self.height - 2.7


FIELDS = (
    Field("owner", "legal owner", 0, 36, 60, 10, 3.5),
    Field("title", "title", 60, 36, 120, 10, 3.5),
    Field("author", "created by", 0, 27, 45, 9),
    Field("checker", "checked by", 45, 27, 45, 9),
    Field("approver", "approved by", 90, 27, 45, 9),
    Field("status", "document status", 135, 27, 45, 9),
    Field("number", "identification number", 0, 18, 85, 9),
    Field("revision", "revision", 85, 18, 17, 9),
    Field("date", "date of issue", 102, 18, 28, 9),
    Field("sheet", "sheet", 130, 18, 15, 9, is_stamped=False),
    Field("language", "language", 145, 18, 15, 9, is_stamped=False),
    Field("format", "format", 160, 18, 20, 9, is_stamped=False),
    Field("material", "material", 0, 9, 105, 9),
    Field("mass", "mass", 105, 9, 30, 9),
    Field("part", "part", 135, 9, 45, 9),
    Field("model", "document type, model", 0, 0, 60, 9, is_stamped=False),
    Field("general", "general tolerances", 60, 0, 67, 9, is_stamped=False),
    Field("scale", "scale", 127, 0, 18, 9, is_stamped=False),
    Field("projection", "projection", 145, 0, 35, 9, is_stamped=False),
)

ROUNDED = Field("rounded", "", 0, 0, 206, 5)
"""The note on rounded parameters, to the left of the block; an A3 sheet has so much room for it."""

STAMPED: Mapping[str, Field] = {field.mark: field for field in (*FIELDS, ROUNDED) if field.is_stamped}
"""The fields that a stamp fills in, by their marks."""

STAMPED_OF_PART: Mapping[str, Field] = {
    field.part_mark: field for field in FIELDS if field.name in ("material", "mass")
}
"""The fields that a stamp fills in on the sheet of one part."""

GENERAL = "ISO 2768-mK"
"""General tolerances of sizes, angles and geometry of a drawing without a datum."""

SIZES = "ISO 2768-m"
"""General tolerances of sizes and angles of a drawing with one; ISO 22081 then holds for its surfaces."""

SURFACES = "ISO 22081"

_MEDIUM = ((6.0, 0.1), (30.0, 0.2), (120.0, 0.3), (400.0, 0.5), (1000.0, 0.8), (2000.0, 1.2), (4000.0, 2.0))
"""ISO 2768-1, class m: limit deviations [mm] of lengths up to so many mm."""


def general_profile(longest: float) -> float | None:
    """Return the general profile tolerance (ISO 22081) [mm] of a part by its longest side [mm].

    This is our own rule: the width of the tolerance that ISO 2768-m gives for the longest side. Above 4 m,
    where ISO 2768 gives none, it returns None.
    """
    return next((2 * deviation for most, deviation in _MEDIUM if longest <= most), None)


TEXTURE = 3.2
"""Roughness Ra [µm] of every surface for which a drawing gives none."""

_ROUGHNESS = (0.1, 0.2, 0.4, 0.8, 1.6, TEXTURE)
_SHARE = 20  # a tolerance is at least so many times the roughness of its surface


def roughness(width: float) -> float:
    """Return the greatest roughness Ra [µm] of a surface whose dimension has a tolerance of this width [mm].

    This is our own rule: the largest preferred value of at most a twentieth of the tolerance. The height from
    peak to valley, some five times Ra, then takes at most a quarter of the tolerance.
    """
    fitting = [value for value in _ROUGHNESS if value <= width * 1e3 / _SHARE]
    return max(fitting, default=_ROUGHNESS[0])
