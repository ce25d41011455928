"""The result of importing a sheet of Mathcad, region by region."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer

RegionState = Literal["verified", "differs", "unverified", "shown", "refused", "blocked"]
"""verified: the worksheet gives Mathcad's own result within 1e-9. differs: it gives another. unverified:
Mathcad stored none. shown: it calculates nothing. refused: it has what worksheets do not have. blocked: it
needs a region that was not translated."""


class RegionCounts(Answer):
    """Number of mathematical regions in each state."""

    verified: int
    differs: int
    unverified: int
    shown: int
    refused: int
    blocked: int


class SheetOrigin(Answer):
    """The origin of an imported worksheet, in short."""

    program: str = Field(description="Mathcad Prime, or Mathcad (11 to 15)")
    file: str = Field(description="the name under which it was sent")
    sha256: str = Field(description="of the file, which is kept")
    regions: RegionCounts
    unresolved: int = Field(description="regions that forbid a release of the text as it is now")


class ImportedRegion(Answer):
    """One region of the sheet: its original, the lines that replace it, and both values compared."""

    region: str = Field(description="its number in the sheet")
    kind: str = Field(description="math, text, plot, picture, solve block, area, page break, other")
    is_mathematical: bool
    top: float = Field(description="its place on the page, in the units of the sheet")
    left: float
    state: RegionState
    is_unresolved: bool = Field(description="whether it forbids a release of the text as it is now")
    name: str = Field(description="the name whose value is compared; empty where there is none")
    line: int | None = Field(description="in the text as it was imported, counted from 1")
    lines: list[str] = Field(description="what stands for it in the text as it was imported")
    reason: str = Field(description="what it has that worksheets do not have, or what it shows")
    remedy: str
    blocked_by: str = Field(description="the region that it needs; empty where it is not blocked")
    mathcad: list[float] = Field(description="Mathcad's own result; empty where it stored no number")
    worksheet: list[float | None] = Field(description="the result of the worksheet; null where it has none")
    unit: str | None = Field(description="of both results")
    is_list: bool = Field(description="whether the result is a list")
    notes: list[str] = Field(description="what else a reader should know")


class SheetImport(SheetOrigin):
    """Every region of an imported sheet, in the order in which Mathcad calculates them."""

    origin: int = Field(description="the index of the first item of a list in the sheet")
    counted: int = Field(description="regions in the file, counted apart from the reading of the items")
    items: list[ImportedRegion]
