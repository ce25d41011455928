"""The page of a model import: the form, its progress, a refusal, and the available programs."""

from __future__ import annotations

import re

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel

from app.imported_models.routes import FileName, NewId, list_programs
from app.web.shared.design_answers import job_of
from app.web.shared.multipart import forms_with_files, parts_of
from app.web.shared.paths import Text
from app.web.shared.responses import go, show
from app.web.shared.services import PageServices, Refused, ThePageServices

MISSED = (409, 415, 422, 429, 503)
"""Errors that the form explains, because the user can correct them."""
_JOB = re.compile(r"[A-Za-z0-9-]{1,64}")
_VERSION = re.compile(r"/api/v1/models/([a-z0-9_]+)/versions/([0-9]+)")


class NewModel(BaseModel):
    """The id of a model to be imported, and the name of its file."""

    id: NewId
    file: FileName = "model"


router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_with_files)])


@router.get("/models/import")
async def model_import_form(
    request: Request, services: ThePageServices, job: Text = "", id: Text = ""
) -> Response:
    """Show the form for a file; while its job runs, the wait; then the model or the refusal."""
    if not _JOB.fullmatch(job):
        return await _form(request, services, id)
    work = await job_of(services, job)
    if work.state == "done" and (version := _VERSION.fullmatch(work.result or "")):
        return go(f"/models/{version[1]}/{version[2]}")
    if work.problem is not None:
        return await _form(request, services, id, work.problem.detail, work.problem.status)
    answer = show(
        request, "model_import/model_import.html", typed_id=id, notice="", waiting=work, programs=[]
    )
    answer.headers["Refresh"] = "1"  # the page needs no script to wait
    return answer


@forms.post("/models/import")
async def import_model_file(request: Request, services: ThePageServices) -> Response:
    """Send the chosen file; where it is refused at once, the form again with the reason."""
    parts = await parts_of(request)
    id = parts["id"].text.strip() if "id" in parts else ""
    chosen = parts.get("file")
    if chosen is None or not chosen.content:
        return await _form(request, services, id, "choose a file: a .FCStd of FreeCAD, or a STEP file", 422)
    name = "".join(sign for sign in (chosen.file or "") if sign.isprintable())[-200:].strip()
    try:
        job = await begun_import(services, chosen.content, id, name)
    except Refused as refused:
        if refused.status not in MISSED:
            raise
        said = "; ".join(refused.faults.values()) or refused.problem.detail
        return await _form(request, services, id, said, refused.status)
    return go(f"/models/import?job={job}&id={id}")


async def begun_import(services: PageServices, content: bytes, id: str, name: str) -> str:
    """Begin the import of a file, and return its job.

    Raises
    ------
    Refused
        If the file is refused at once.
    """
    given = services.read(NewModel, {"id": id, **({"file": name} if name else {})})
    return await services.ask(
        services.threads.run(services.model_imports.begin, content, given.id, given.file, services.once)
    )


async def _form(
    request: Request, services: PageServices, id: str, notice: str = "", status: int = 200
) -> Response:
    programs = (await services.run(list_programs, services.model_imports)).items
    return show(
        request,
        "model_import/model_import.html",
        status,
        typed_id=id,
        notice=notice,
        waiting=None,
        programs=programs,
    )
