"""The pages of studies and of solving, and what their forms do."""

from __future__ import annotations

from fastapi import APIRouter, Depends, Request, Response

from app.studies.schemas import Study, StudyEstimate
from app.web.actions import AT_ONCE, forms_only, tag_of
from app.web.api import Api, TheApi, read
from app.web.forms import fields
from app.web.rendering import go, show
from app.web.routes import Id
from app.web.services import Refused
from app.web.solve_page import solve_page
from app.web.study_form import Typed, again, study_form
from app.web.study_page import study_page

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

ILL_NAMED, STALE, ENDED = 422, 412, 409


@router.get("/designs/{id}/solve")
async def solve(id: Id, request: Request, api: TheApi) -> Response:
    """Show which value of one parameter gives a wanted output; the question stands in the address."""
    return await solve_page(request, api, id)


@router.get("/designs/{id}/studies/new")
async def new_study(id: Id, request: Request, api: TheApi) -> Response:
    """The form of a new study."""
    return await study_form(request, api, id, Typed(dict(request.query_params)))


@router.get("/designs/{id}/studies/estimate")
@router.get("/designs/{id}/studies")
async def after_a_new_study(id: Id) -> Response:
    """The form of a new study: one that was refused is shown at the address to which it was sent."""
    return go(f"/designs/{id}/studies/new")


@router.get("/studies/{id}")
async def study(id: Id, request: Request, api: TheApi) -> Response:
    """A study: how far it is, and what it found."""
    return await study_page(request, api, id)


@router.get("/studies/{id}/choose")
@router.get("/studies/{id}/cancel")
async def after_a_form(id: Id) -> Response:
    """The study: a form that was refused is shown at the address to which it was sent."""
    return go(f"/studies/{id}")


@forms.post("/designs/{id}/studies")
async def start(id: Id, request: Request, api: TheApi) -> Response:
    """A new study, shown at once; where it is refused, the form again with what is wrong."""
    typed = await fields(request)
    try:
        response = await api.send("POST", "/studies", json=Typed(typed).body(id), headers=AT_ONCE)
    except Refused as refused:
        if refused.status != ILL_NAMED:
            raise
        return await study_form(request, api, id, again(typed, refused), ILL_NAMED)
    return go(f"/studies/{read(response, Study).id}")


@forms.post("/designs/{id}/studies/estimate")
async def estimate(id: Id, request: Request, api: TheApi, part: bool = False) -> Response:
    """Show the cost of a new study above its form; with `part` alone, for the script of the form."""
    typed = await fields(request)
    estimated, faulty, status = None, Typed(typed), 200
    try:
        estimated = await api.post("/studies/estimate", StudyEstimate, Typed(typed).body(id))
    except Refused as refused:
        if refused.status != ILL_NAMED:
            raise
        faulty, status = again(typed, refused), ILL_NAMED
    if part:
        return show(request, "study_estimate.html", estimate=estimated, typed=faulty)
    return await study_form(request, api, id, faulty, status, estimated)


@forms.post("/studies/{id}/choose")
async def choose(id: Id, request: Request, api: TheApi) -> Response:
    """The values of a row as a new revision of the design."""
    typed = await fields(request)
    headers = {**AT_ONCE, "If-Match": tag_of(typed.get("revision", ""))}
    try:
        body = {"row": int(typed["row"]) if typed.get("row", "").isdecimal() else typed.get("row", "")}
        await api.send("POST", f"/studies/{id}/choose", json=body, headers=headers)
    except Refused as refused:
        if refused.status not in (ILL_NAMED, STALE):
            raise
        return await study_page(request, api, id, f"Nothing was saved: {refused.problem.detail}")
    return go(f"/designs/{(await api.get(f'/studies/{id}', Study)).design}")


@forms.post("/studies/{id}/cancel")
async def cancel(id: Id, api: TheApi) -> Response:
    """Stop a study; one that has ended meanwhile stays as it is."""
    study = await api.get(f"/studies/{id}", Study)
    if study.job is not None:
        await _stop(api, study.job)
    return go(f"/studies/{id}")


async def _stop(api: Api, job: str) -> None:
    try:
        await api.send("DELETE", job.removeprefix("/api/v1"))
    except Refused as refused:
        if refused.status != ENDED:
            raise
