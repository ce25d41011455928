"""Routes of the pages for worksheets, and of their forms."""

from __future__ import annotations

import re
from collections.abc import Awaitable
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request, Response
from pydantic import JsonValue

from app.http.access import needs
from app.web.shared.forms import fields, forms_only
from app.web.shared.paths import Id, Text
from app.web.shared.responses import go
from app.web.shared.services import PageServices, Refused, ThePageServices
from app.web.worksheet.page import UnsavedText, editor_page, list_page, start_page
from app.worksheets.bodies import ReviewIn, SheetIn, SheetPatch, WithdrawIn
from templates.examples.index import examples

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

NOT_NOW, STALE, ILL_NAMED = 409, 412, 422
MISSED = (403, NOT_NOW, STALE, ILL_NAMED)
"""Errors that the page of the worksheet explains, because the user can correct them."""


@router.get("/worksheets")
async def worksheets(request: Request, services: ThePageServices, name: Text = "") -> Response:
    """Return the page with all worksheets, or the results of a search."""
    return await list_page(request, services, name.strip())


@router.get("/worksheets/new")
async def new_worksheet(request: Request, services: ThePageServices) -> Response:
    """Return the form for a new worksheet."""
    return await start_page(request, services, dict(request.query_params))


@router.get("/worksheets/{id}")
async def worksheet(
    id: Id,
    request: Request,
    services: ThePageServices,
    design: Annotated[str, Query(max_length=64, pattern=r"^[A-Za-z0-9_]*$")] = "",
) -> Response:
    """Return the editor; `design` names a design in which a draft is previewed."""
    return await editor_page(request, services, id, design=design)


@router.get("/worksheets/{id}/test")
@router.get("/worksheets/{id}/review")
@router.get("/worksheets/{id}/release")
@router.get("/worksheets/{id}/withdraw")
@router.get("/worksheets/{id}/delete")
async def after_a_form(id: Id) -> Response:
    """Return the page of the worksheet; a refused form is shown at the address to which it was sent."""
    return go(f"/worksheets/{id}")


@forms.post("/worksheets")
async def create(request: Request, services: ThePageServices) -> Response:
    """Create a draft and redirect to it; if it is refused, return the form with the faults."""
    typed = await fields(request)
    id = typed.get("id", "").strip()
    body: dict[str, JsonValue] = {"id": id, "text": await _start(services, typed.get("start", ""), typed)}
    if author := typed.get("author", "").strip():
        body["author"] = author
    try:
        await services.ask(
            services.threads.run(services.worksheets.create, services.read(SheetIn, body), services.once)
        )
    except Refused as refused:
        if refused.status not in MISSED:
            raise
        return await start_page(request, services, typed, refused.sentence, refused.status)
    return go(f"/worksheets/{id}")


async def _start(services: PageServices, start: str, typed: dict[str, str]) -> str:
    """Return the initial text of a worksheet.

    It is copied from an example or another worksheet, or consists of only the title.
    """
    group, _, name = start.partition(":")
    if group == "example" and (text := next((one.text for one in examples() if one.id == name), "")):
        return text
    if group == "copy" and name.isidentifier():
        return (await services.run(services.worksheets.newest, name)).text
    title = typed.get("title", "").strip()
    return f"# {title}\n" if title else ""


@forms.post("/worksheets/{id}")
async def save(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save the typed text; if it is refused, return the page with the text and the faults."""
    typed = await fields(request)
    text = typed.get("text", "").replace("\r\n", "\n")
    try:
        body, seen = services.read(SheetPatch, {"text": text}), typed.get("tag", "")
        await services.ask(services.threads.run(services.worksheets.change, id, body, seen, services.once))
    except Refused as refused:
        if refused.status not in MISSED:
            raise
        return await editor_page(request, services, id, unsaved=_unsaved(text, refused))
    return go(f"/worksheets/{id}")


def _unsaved(text: str, refused: Refused) -> UnsavedText:
    if refused.status == STALE:
        notice = (
            "Somebody else saved this worksheet meanwhile. Your text is kept; theirs is shown next to it."
        )
        return UnsavedText(text, notice, STALE, is_conflict=True)
    return UnsavedText(text, f"Nothing was saved: {refused.sentence}", refused.status)


@forms.post("/worksheets/{id}/test")
async def test(id: Id, request: Request, services: ThePageServices) -> Response:
    """Run the tests of the worksheet."""
    tested = services.threads.run(services.worksheets.test, id, None, services.client)
    return await _act(id, services.ask(tested), request, services)


@forms.post("/worksheets/{id}/review", dependencies=[needs("checker")])
async def review(id: Id, request: Request, services: ThePageServices) -> Response:
    """Record that a reviewer has read the text with the digest in the form."""
    typed = await fields(request)
    said = {"reviewer": typed.get("reviewer", "").strip(), "digest": typed.get("digest", "")}

    async def reviewed() -> None:
        await services.run(services.worksheets.review, id, services.read(ReviewIn, said), None)

    return await _act(id, reviewed(), request, services)


@forms.post("/worksheets/{id}/release", dependencies=[needs("checker")])
async def release(id: Id, request: Request, services: ThePageServices) -> Response:
    """Release the worksheet for designs; the release is final."""
    released = services.threads.run(services.worksheets.release, id, None, services.client)
    return await _act(id, services.ask(released), request, services)


@forms.post("/worksheets/{id}/withdraw", dependencies=[needs("checker")])
async def withdraw(id: Id, request: Request, services: ThePageServices) -> Response:
    """Withdraw a released version, and store the reason."""
    typed = await fields(request)
    version = typed.get("version", "")
    named = {"version": int(version)} if re.fullmatch("[0-9]{1,6}", version) else {}

    async def withdrawn() -> None:
        body = services.read(WithdrawIn, {"reason": typed.get("reason", "").strip(), **named})
        await services.run(services.worksheets.withdraw, id, body, None)

    return await _act(id, withdrawn(), request, services)


@forms.post("/worksheets/{id}/delete")
async def delete(id: Id, request: Request, services: ThePageServices) -> Response:
    """Delete the newest version, if it was never released; then show the previous version or the list."""
    try:
        await services.run(services.worksheets.delete, id, None)
    except Refused as refused:
        return await _explained(id, request, services, refused)
    before = await services.find(services.worksheets.newest, id)
    return go(f"/worksheets/{id}" if before else "/worksheets")


async def _act(id: str, action: Awaitable[object], request: Request, services: PageServices) -> Response:
    """Carry out one step of the life cycle, and show the page.

    After a refusal the page lists the missing conditions.
    """
    try:
        await action
    except Refused as refused:
        return await _explained(id, request, services, refused)
    return go(f"/worksheets/{id}")


async def _explained(id: str, request: Request, services: PageServices, refused: Refused) -> Response:
    if refused.status not in MISSED:
        raise refused
    return await editor_page(request, services, id, notice=refused.sentence, status=refused.status)
