"""The page on which a team brings a model: the form, the wait, the refusal; and which programs draw here."""

from __future__ import annotations

import re

from fastapi import APIRouter, Depends, Request, Response

from app.imported_models.routes import list_programs
from app.web.api import Api, TheApi
from app.web.design_answers import job_of
from app.web.multipart import forms_with_files, parts_of
from app.web.rendering import go, show
from app.web.routes import Text
from app.web.services import Refused

MISSED = (409, 415, 422, 429, 503)
"""Errors that the form explains, because the user can correct them."""
BINARY = {"Content-Type": "application/octet-stream"}
_JOB = re.compile(r"[A-Za-z0-9-]{1,64}")
_VERSION = re.compile(r"/api/v1/models/([a-z0-9_]+)/versions/([0-9]+)")

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_with_files)])


@router.get("/models/import")
async def model_import_form(request: Request, api: TheApi, job: Text = "", id: Text = "") -> Response:
    """Show the form for a file; while its job runs, the wait; then the model or the refusal."""
    if not _JOB.fullmatch(job):
        return await _form(request, api, id)
    work = await job_of(api, job)
    if work.state == "done" and (version := _VERSION.fullmatch(work.result or "")):
        return go(f"/models/{version[1]}/{version[2]}")
    if work.problem is not None:
        return await _form(request, api, id, work.problem.detail, work.problem.status)
    answer = show(request, "model_import.html", typed_id=id, notice="", waiting=work, programs=[])
    answer.headers["Refresh"] = "1"  # the page needs no script to wait
    return answer


@forms.post("/models/import")
async def import_model_file(request: Request, api: TheApi) -> Response:
    """Send the chosen file; where it is refused at once, the form again with the reason."""
    parts = await parts_of(request)
    id = parts["id"].text.strip() if "id" in parts else ""
    chosen = parts.get("file")
    if chosen is None or not chosen.content:
        return await _form(request, api, id, "choose a file: a .FCStd of FreeCAD, or a STEP file", 422)
    name = "".join(sign for sign in (chosen.file or "") if sign.isprintable())[-200:].strip()
    query = {"id": id, **({"file": name} if name else {})}
    try:
        answer = await api.send(
            "POST", "/models/import", content=chosen.content, params=query, headers=BINARY
        )
    except Refused as refused:
        if refused.status not in MISSED:
            raise
        said = "; ".join(refused.faults.values()) or refused.problem.detail
        return await _form(request, api, id, said, refused.status)
    return go(f"/models/import?job={answer.headers['Location'].rpartition('/')[2]}&id={id}")


async def _form(request: Request, api: Api, id: str, notice: str = "", status: int = 200) -> Response:
    programs = (await api.run(list_programs, api.model_imports)).items
    return show(
        request, "model_import.html", status, typed_id=id, notice=notice, waiting=None, programs=programs
    )
