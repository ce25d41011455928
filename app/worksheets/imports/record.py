"""The record of an import, stored with its worksheet: its regions, and which of them are unresolved.

A region that differs, is refused or is blocked prevents a release while all its imported lines are unchanged
in the text. An author resolves the region by changing or removing one of these lines. Changes of white space
do not count.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict, cast

from app.storage.tables import WorksheetVersionRow as Row
from app.worksheets.errors import UnresolvedRegions
from app.worksheets.imports.outcome import UNRESOLVED, Outcome, State
from app.worksheets.imports.regions import MATHEMATICAL, OriginalSheet

STATES: tuple[State, ...] = ("verified", "differs", "unverified", "shown", "refused", "blocked")


class RegionRecord(TypedDict):
    """The record of one region; `app.worksheets.schemas.imports.ImportedRegion` describes the members."""

    region: str
    kind: str
    is_mathematical: bool
    top: float
    left: float
    state: State
    name: str
    line: int | None
    lines: list[str]
    reason: str
    remedy: str
    blocked_by: str
    mathcad: list[float]
    worksheet: list[float | None]
    unit: str | None
    is_list: bool
    notes: list[str]


class SheetRecord(TypedDict):
    """The record of an imported sheet."""

    program: str
    origin: int
    counted: int
    regions: list[RegionRecord]


class ImportRecord(SheetRecord):
    """The record as stored with a worksheet: a sheet record with the name of the file."""

    file: str


def record_of(row: Row) -> ImportRecord | None:
    """Return the import record of a version; None for a worksheet that was typed."""
    return cast("ImportRecord | None", row.imported)


def recorded(sheet: OriginalSheet, outcomes: Sequence[Outcome], text: str) -> SheetRecord:
    """Return the record of an import as JSON."""
    lines = {_plain(line): number for number, line in reversed(list(enumerate(text.split("\n"), 1)))}
    owners = {o.name: o for o in outcomes if o.name and o.lines}
    return {
        "program": sheet.program,
        "origin": sheet.origin,
        "counted": sheet.counted.total(),
        "regions": [_region(outcome, lines, owners) for outcome in outcomes],
    }


def _region(outcome: Outcome, lines: dict[str, int], owners: dict[str, Outcome]) -> RegionRecord:
    original, cached = outcome.original, outcome.cached
    own = outcome.lines or (owners[outcome.name].lines if outcome.name in owners else [])
    first = lines.get(_plain(own[-1].split("\n")[0])) if own else None
    factor = cached.factor if cached else 1.0
    return {
        "region": original.number,
        "kind": original.kind,
        "is_mathematical": original.kind in MATHEMATICAL,
        "top": original.top,
        "left": original.left,
        "state": outcome.state,
        "name": outcome.name,
        "line": first,
        "lines": own,
        "reason": outcome.construct,
        "remedy": outcome.remedy,
        "blocked_by": outcome.blocked_by,
        "mathcad": [value / factor for value in cached.values] if cached else [],
        "worksheet": [_finite(value / factor) for value in outcome.ours],
        "unit": cached.unit if cached else None,
        "is_list": bool(cached and cached.is_list),
        "notes": outcome.notes,
    }


def _finite(value: float) -> float | None:
    return value if abs(value) < 1e308 else None


def unresolved(record: SheetRecord, text: str) -> list[RegionRecord]:
    """Return the regions of a record that prevent a release of this text."""
    present = {_plain(line) for line in text.split("\n")}
    return [region for region in record["regions"] if _stands(region, present)]


def _stands(region: RegionRecord, present: set[str]) -> bool:
    if region["state"] not in UNRESOLVED:
        return False
    lines = [_plain(part) for line in region["lines"] for part in line.split("\n")]
    return all(line in present for line in lines)


def require_resolved(row: Row) -> None:
    """Check that no imported region of a version prevents its release.

    Raises
    ------
    UnresolvedRegions
        If regions prevent the release; the error lists them.
    """
    record = record_of(row)
    if record is not None and (open_regions := unresolved(record, row.text)):
        raise UnresolvedRegions([_reason(region) for region in open_regions])


def _reason(region: RegionRecord) -> str:
    what = "its result differs from Mathcad's" if region["state"] == "differs" else region["reason"]
    return f"region {region['region']} ({region['state']}: {what})"


def counted(record: SheetRecord) -> dict[State, int]:
    """Return the number of mathematical regions in each state."""
    states = [region["state"] for region in record["regions"] if region["is_mathematical"]]
    return {state: states.count(state) for state in STATES}


def _plain(line: str) -> str:
    return " ".join(line.split())
