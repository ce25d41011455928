"""Responses of the REST interface about worksheets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from app.catalogue.sheets import Key
from app.storage.tables import WorksheetVersionRow as Row
from app.worksheets.imports.views import origin
from app.worksheets.schemas.worksheets import Sheet, SheetSummary, SheetVersion, State

Broken = Mapping[Key, str]
"""Broken released versions, with their reasons."""


def sheet(row: Row, versions: Sequence[Row], broken: Broken) -> Sheet:
    """Return one version with its text, and the list of all versions."""
    reason = broken.get((row.id, row.number))
    return Sheet.model_validate(
        {
            "id": row.id,
            "version": row.number,
            "edit": row.edit,
            "state": state(row, broken),
            "title": row.title,
            "text": row.text,
            "digest": row.digest,
            "language": row.language,
            "author": row.author,
            "reviewer": row.reviewer,
            "review_verified": row.reviewer_principal is not None,
            "faults": row.faults,
            "tests": row.tests,
            "withdrawn": row.withdrawn,
            **({"broken": reason} if reason else {}),
            "created": row.created,
            "updated": row.updated,
            "released": row.released,
            "versions": [_version(one, broken) for one in versions],
            "import": origin(row),
        }
    )


def summary(row: Row, broken: Broken) -> SheetSummary:
    """Return a worksheet as an entry of a list."""
    return SheetSummary(
        id=row.id,
        version=row.number,
        state=state(row, broken),
        title=row.title,
        author=row.author,
        reviewer=row.reviewer,
        review_verified=row.reviewer_principal is not None,
        faults=len(row.faults),
        updated=row.updated,
    )


def _version(row: Row, broken: Broken) -> SheetVersion:
    return SheetVersion(
        version=row.number,
        state=state(row, broken),
        digest=row.digest,
        released=row.released,
        withdrawn=row.withdrawn,
    )


def state(row: Row, broken: Broken) -> State:
    """Return the state of a version: `broken`, or as stored."""
    stored: State = row.state  # type: ignore[assignment] # only `app.worksheets.service` writes it
    return "broken" if (row.id, row.number) in broken else stored
