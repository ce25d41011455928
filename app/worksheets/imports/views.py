"""Imports as the REST interface shows them."""

from __future__ import annotations

from app.storage.errors import NotFound
from app.storage.tables import WorksheetVersionRow as Row
from app.worksheets.imports.record import ImportRecord, counted, record_of, unresolved
from app.worksheets.schemas.imports import SheetImport, SheetOrigin


def origin(row: Row) -> SheetOrigin | None:
    """Return the source of an imported version in short; None if it was typed."""
    record = record_of(row)
    return SheetOrigin.model_validate(_short(row, record)) if record is not None else None


def imported(row: Row) -> SheetImport:
    """Return every region of the sheet that a version was imported from.

    Raises
    ------
    NotFound
        If it was not imported.
    """
    record = record_of(row)
    if record is None:
        raise NotFound(f"worksheet {row.id} was typed, not imported")
    open_ = {id(region) for region in unresolved(record, row.text)}
    items = [{**region, "is_unresolved": id(region) in open_} for region in record["regions"]]
    return SheetImport.model_validate(
        {**_short(row, record), "origin": record["origin"], "counted": record["counted"], "items": items}
    )


def _short(row: Row, record: ImportRecord) -> dict[str, object]:
    return {
        "program": record["program"],
        "file": record["file"],
        "sha256": row.import_sha256,
        "regions": counted(record),
        "unresolved": len(unresolved(record, row.text)),
    }
