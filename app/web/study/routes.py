"""The routes of the pages of studies and of their forms."""

from __future__ import annotations

from fastapi import APIRouter, Depends, Request, Response

from app.studies.bodies import ChooseIn, StudyIn
from app.studies.routes.studies import begun, estimate_study, show_study
from app.web.shared.forms import fields, forms_only
from app.web.shared.paths import Id
from app.web.shared.responses import go, show
from app.web.shared.services import Refused, ThePageServices, tag_of
from app.web.study.form import StudyForm, again, study_form
from app.web.study.page import study_page

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

ILL_NAMED, STALE = 422, 412


@router.get("/designs/{id}/studies/new")
async def new_study(id: Id, request: Request, services: ThePageServices) -> Response:
    """Return the form for a new study."""
    return await study_form(request, services, id, StudyForm(dict(request.query_params)))


@router.get("/designs/{id}/studies/estimate")
@router.get("/designs/{id}/studies")
async def after_a_new_study(id: Id) -> Response:
    """Return the form for a new study; a refused form is shown at the address to which it was sent."""
    return go(f"/designs/{id}/studies/new")


@router.get("/studies/{id}")
async def study(id: Id, request: Request, services: ThePageServices) -> Response:
    """Return the page of a study: its progress and results."""
    return await study_page(request, services, id)


@router.get("/studies/{id}/choose")
@router.get("/studies/{id}/cancel")
async def after_a_form(id: Id) -> Response:
    """Return the page of the study; a refused form is shown at the address to which it was sent."""
    return go(f"/studies/{id}")


@forms.post("/designs/{id}/studies")
async def start(id: Id, request: Request, services: ThePageServices) -> Response:
    """Start a study and redirect to it; if it is refused, return the form with the faults."""
    typed = await fields(request)
    try:
        body = services.read(StudyIn, StudyForm(typed).body(id))
        study = await services.ask(begun(request, services.client, services.studies, body, services.once))
    except Refused as refused:
        if refused.status != ILL_NAMED:
            raise
        return await study_form(request, services, id, again(typed, refused), ILL_NAMED)
    return go(f"/studies/{study}")


@forms.post("/designs/{id}/studies/estimate")
async def estimate(id: Id, request: Request, services: ThePageServices, part: bool = False) -> Response:
    """Return the form for a new study with its estimated cost.

    With `part`, return only the estimate, for the script of the form.
    """
    typed = await fields(request)
    estimated, faulty, status = None, StudyForm(typed), 200
    try:
        body = services.read(StudyIn, StudyForm(typed).body(id))
        estimated = await services.ask(estimate_study(body, services.studies, services.client, request))
    except Refused as refused:
        if refused.status != ILL_NAMED:
            raise
        faulty, status = again(typed, refused), ILL_NAMED
    if part:
        return show(request, "study/study_estimate.html", estimate=estimated, typed=faulty)
    return await study_form(request, services, id, faulty, status, estimated)


@forms.post("/studies/{id}/choose")
async def choose(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save the values of a row as a new revision of the design."""
    typed = await fields(request)
    seen = tag_of(typed.get("revision", ""))
    try:
        row = int(typed["row"]) if typed.get("row", "").isdecimal() else typed.get("row", "")
        body = services.read(ChooseIn, {"row": row})
        await services.save(services.studies.choose, id, body.row, body.note, seen, services.once)
    except Refused as refused:
        if refused.status not in (ILL_NAMED, STALE):
            raise
        return await study_page(request, services, id, f"Nothing was saved: {refused.problem.detail}")
    return go(f"/designs/{(await services.run(show_study, id, services.studies)).design}")


@forms.post("/studies/{id}/cancel")
async def cancel(id: Id, services: ThePageServices) -> Response:
    """Cancel a study; one that has already ended stays unchanged."""
    study = await services.run(show_study, id, services.studies)
    if study.job is not None:
        await services.cancel(study.job.removeprefix("/api/v1/jobs/"))
    return go(f"/studies/{id}")
