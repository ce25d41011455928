"""Response models of the import of a Mathcad sheet, region by region."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer

RegionState = Literal["verified", "differs", "unverified", "shown", "refused", "blocked"]
"""verified: the worksheet gives Mathcad's own result within 1e-9. differs: it gives another. unverified:
Mathcad stored none. shown: it calculates nothing. refused: it has what worksheets do not have. blocked: it
needs a region that was not translated."""


class RegionCounts(Answer):
    """The number of mathematical regions in each state."""

    verified: int
    differs: int
    unverified: int
    shown: int
    refused: int
    blocked: int


class SheetOrigin(Answer):
    """A summary of the origin of an imported worksheet."""

    program: str = Field(description="Mathcad Prime, or Mathcad (11 to 15)")
    file: str = Field(description="name of the file when it was sent")
    sha256: str = Field(description="SHA-256 of the file, which is kept")
    regions: RegionCounts
    unresolved: int = Field(description="number of regions that prevent a release of the present text")


class ImportedRegion(Answer):
    """One region of the sheet: the original, the lines that replace it, and the two values compared."""

    region: str = Field(description="number of the region in the sheet")
    kind: str = Field(description="math, text, plot, picture, solve block, area, page break, other")
    is_mathematical: bool
    top: float = Field(description="position on the page, in the units of the sheet")
    left: float
    state: RegionState
    is_unresolved: bool = Field(description="whether it prevents a release of the present text")
    name: str = Field(description="the name whose value is compared; empty if there is none")
    line: int | None = Field(description="line in the imported text, counted from 1")
    lines: list[str] = Field(description="lines that replace it in the imported text")
    reason: str = Field(description="the construct that worksheets do not have, or the displayed content")
    remedy: str
    blocked_by: str = Field(description="the region that it needs; empty unless it is blocked")
    mathcad: list[float] = Field(description="Mathcad's own result; empty if it stored no number")
    worksheet: list[float | None] = Field(description="the result of the worksheet; null if it has none")
    unit: str | None = Field(description="unit of both results")
    is_list: bool = Field(description="whether the result is a list")
    notes: list[str] = Field(description="further remarks for a reader")


class SheetImport(SheetOrigin):
    """Every region of an imported sheet, in the order in which Mathcad calculates them."""

    origin: int = Field(description="the index of the first item of a list in the sheet")
    counted: int = Field(description="number of regions in the file, counted independently of `items`")
    items: list[ImportedRegion]
