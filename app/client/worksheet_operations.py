"""The client's calls for worksheets: each function is an exchange."""

from __future__ import annotations

import uuid

from app.client.exchange import (
    BASE,
    MERGE_PATCH,
    Exchange,
    Progress,
    Request,
    answered,
    done,
    get,
    job_of,
    listed,
    post,
    written,
)
from app.client.problem import checked
from app.worksheets.schemas.imports import SheetImport
from app.worksheets.schemas.worksheets import Sheet, SheetCheck, SheetList, SheetSummary

_PATH = "/worksheets"


def worksheets() -> Exchange[list[SheetSummary]]:
    """Return every worksheet at its newest version."""
    return listed(SheetList, _PATH)


def read_worksheet(id: str, version: int | None = None) -> Exchange[Sheet]:
    """Return a worksheet, by default at its newest version."""
    return answered(Sheet, get(f"{_PATH}/{id}" if version is None else f"{_PATH}/{id}/versions/{version}"))


def worksheet_text(id: str, version: int | None = None) -> Exchange[str]:
    """Return the text of a worksheet, unchanged."""
    query = {} if version is None else {"version": str(version)}
    return checked((yield get(f"{_PATH}/{id}/text", query))).content.decode()


def check_worksheet(text: str, id: str | None = None) -> Exchange[SheetCheck]:
    """Check a text: return all its faults, or every line typeset with the example's numbers."""
    return answered(SheetCheck, post(f"{_PATH}/check", {"text": text, **({"id": id} if id else {})}))


def create_worksheet(
    id: str, text: str, *, author: str | None = None, key: str | None = None
) -> Exchange[Sheet]:
    """Create a worksheet as a draft, and return it; two requests with the same key create one worksheet."""
    body = {"id": id, "text": text, **({"author": author} if author else {})}
    return answered(Sheet, post(_PATH, body, {"Idempotency-Key": key or uuid.uuid4().hex}))


def import_worksheet(
    id: str, content: bytes, file: str, *, key: str | None = None, on_progress: Progress | None = None
) -> Exchange[Sheet]:
    """Import a sheet of Mathcad (.mcdx, .xmcd, .xmcdz), and return its draft.

    Raises
    ------
    Problem
        If the file is refused, or the id is in use.
    """
    headers = {"Content-Type": "application/octet-stream", "Idempotency-Key": key or uuid.uuid4().hex}
    query = {"id": id, "file": file}
    response = checked((yield Request("POST", f"{BASE}{_PATH}/import", content, query, headers)))
    if job := job_of(response):
        yield from done(job, on_progress)
    return (yield from read_worksheet(id))


def read_import(id: str) -> Exchange[SheetImport]:
    """Return the result of the import for every region of the original sheet."""
    return answered(SheetImport, get(f"{_PATH}/{id}/import"))


def change_worksheet(sheet: Sheet, text: str, *, author: str | None = None) -> Exchange[Sheet]:
    """Edit a worksheet that was read before; return its draft, or the next version of a released one."""
    body = {"text": text, **({"author": author} if author else {})}
    headers = {"Content-Type": MERGE_PATCH, "Idempotency-Key": uuid.uuid4().hex, **_if_match(sheet)}
    return answered(Sheet, Request("PATCH", f"{BASE}{_PATH}/{sheet.id}", written(body), headers=headers))


def test_worksheet(sheet: Sheet) -> Exchange[Sheet]:
    """Run the tests and the golden steps of a worksheet that was read before: draft → tested."""
    return answered(Sheet, post(f"{_PATH}/{sheet.id}/test", {}, _if_match(sheet)))


def review_worksheet(sheet: Sheet, reviewer: str) -> Exchange[Sheet]:
    """Record the review of a worksheet that was read before: tested → reviewed."""
    body = {"reviewer": reviewer, "digest": sheet.digest or ""}
    return answered(Sheet, post(f"{_PATH}/{sheet.id}/review", body, _if_match(sheet)))


def release_worksheet(sheet: Sheet) -> Exchange[Sheet]:
    """Release a worksheet as a template that never changes: reviewed → released."""
    return answered(Sheet, post(f"{_PATH}/{sheet.id}/release", {}, _if_match(sheet)))


def withdraw_worksheet(id: str, reason: str, version: int | None = None) -> Exchange[Sheet]:
    """Withdraw a released version, by default the newest, and state the reason."""
    body = {"reason": reason, **({} if version is None else {"version": version})}
    return answered(Sheet, post(f"{_PATH}/{id}/withdraw", body))


def delete_worksheet(sheet: Sheet) -> Exchange[None]:
    """Delete the newest version of a worksheet that was read before, if that version was never released."""
    checked((yield Request("DELETE", f"{BASE}{_PATH}/{sheet.id}", headers=_if_match(sheet))))


def _if_match(sheet: Sheet) -> dict[str, str]:
    return {"If-Match": f'"{sheet.edit}"'}
