"""Responses of the REST interface about imports."""

from __future__ import annotations

from app.storage.errors import NotFound
from app.storage.tables import WorksheetVersionRow as Row
from app.worksheets.imports.record import ImportRecord, counted, record_of, unresolved
from app.worksheets.schemas.imports import SheetImport, SheetOrigin


def origin(row: Row) -> SheetOrigin | None:
    """Return a summary of the source of an imported version; None if the text was typed."""
    record = record_of(row)
    return SheetOrigin.model_validate(_short(row, record)) if record is not None else None


def imported(row: Row) -> SheetImport:
    """Return every region of the sheet from which a version was imported.

    Raises
    ------
    NotFound
        If the version was not imported.
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
