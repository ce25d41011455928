"""Routes of pages that only show something."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable
from typing import Annotated, get_args
from urllib.parse import urlencode

from fastapi import APIRouter, Path, Query, Request, Response
from pydantic import BaseModel

from app.catalogue.routes.faults import list_catalogue_faults
from app.catalogue.routes.templates import list_template_versions, list_templates
from app.designs.routes.designs import (
    Archived,
    InState,
    NamePart,
    UsedTemplate,
    WithTags,
    list_designs,
    show_measurements,
)
from app.designs.routes.labels import list_tags
from app.designs.schemas.designs import State
from app.http.access import needs
from app.identity.routes.audit import list_audit, show_head
from app.presentation.criteria import line
from app.solids.routes.models import list_model_versions, list_models
from app.web import plotly
from app.web.compare_page import Asked, compare_page
from app.web.design_page import design_page, step_section
from app.web.gallery import offered
from app.web.model_page import model_page
from app.web.new_step import beside, new_step, step_page
from app.web.responses import go, show, units_of
from app.web.revision_page import is_unusable, revision_page, stored_page
from app.web.sensitivities import sensitivity_lines
from app.web.services import PageServices, Refused, ThePageServices
from app.web.template_page import template_page
from app.web.template_solve_page import template_solve_page
from app.web.tolerances_page import tolerances_page

router = APIRouter(include_in_schema=False)

Id = Annotated[str, Path(max_length=64, pattern=r"^[A-Za-z0-9_]+$")]
Number = Annotated[int, Path(ge=1, le=10**9)]
Text = Annotated[str, Query(max_length=200)]
ON_HOME = 4  # designs, with pictures: the first page is light
TAGS_ON_HOME = 30


class Filter(BaseModel):
    """The filter of a list of designs, as the interface takes it."""

    name: NamePart = None
    state: InState = None
    tag: WithTags = []
    archived: Archived = "false"
    template: UsedTemplate = None


@router.get("/")
async def home(request: Request, services: ThePageServices) -> Response:
    """Designs, templates, models, and where to start."""
    designs, tags, templates, models, faulty = await asyncio.gather(
        services.run(list_designs, services.database, limit=ON_HOME),
        services.run(list_tags, services.database),
        services.run(list_templates, services.catalogues, limit=500),
        services.run(list_models, services.catalogues, limit=500),
        services.run(list_catalogue_faults, services.catalogues, limit=500),
    )
    latest = [item for item in templates.items if item.latest]
    return show(
        request,
        "home.html",
        designs=designs,
        tags=tags.items[:TAGS_ON_HOME],
        back="/",
        pictures=dict(await asyncio.gather(*(_picture(services, item.id) for item in designs.items))),
        templates=templates.items,
        latest=latest,
        models=[item for item in models.items if item.latest],
        gallery=offered(templates.items, models.items),
        faulty=faulty.items,
    )


@router.get("/designs")
async def designs(
    request: Request,
    services: ThePageServices,
    cursor: Text = "",
    name: Text = "",
    state: Text = "",
    template: Text = "",
    tag: Text = "",
    archived: Text = "",
) -> Response:
    """Designs, page by page: all, or those that fit what was typed into the filter."""
    typed = {
        "name": name,
        "state": state,
        "template": template.strip(),
        "tag": tag.strip(),
        "archived": archived,
    }
    wanted = {key: text for key, text in typed.items() if text}  # a form sends empty fields too
    filtered = services.read(Filter, {**wanted, **({"tag": [wanted["tag"]]} if tag.strip() else {})})
    page, tags = await asyncio.gather(
        services.run(list_designs, services.database, 50, cursor or None, **vars(filtered)),
        services.run(list_tags, services.database),
    )
    return show(
        request,
        "designs.html",
        designs=page,
        wanted=wanted,
        states=get_args(State),
        tags=tags.items,
        back=f"/designs?{urlencode(wanted)}" if wanted else "/designs",
        older=urlencode({**wanted, "cursor": page.next}) if page.next else None,
    )


@router.get("/templates/faults")
async def faults(request: Request, services: ThePageServices, cursor: Text = "") -> Response:
    """The files of a team that have faults."""
    faulty = await services.run(list_catalogue_faults, services.catalogues, cursor=cursor or None)
    return show(request, "faults.html", faulty=faulty)


@router.get("/templates/{id}")
async def newest_template(id: Id, services: ThePageServices) -> Response:
    """The latest version."""
    return go(await _newest(services, "templates", id))


@router.get("/templates/{id}/{version}")
async def template(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """A template, with a form to try it; what is typed stands in the address."""
    return await template_page(request, services, id, version)


@router.get("/templates/{id}/{version}/solve")
async def solve_template(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """Show which values of one input give a wanted output; question and inputs stand in the address."""
    return await template_solve_page(request, services, id, version)


@router.get("/models/{id}")
async def newest_model(id: Id, services: ThePageServices) -> Response:
    """The latest version."""
    return go(await _newest(services, "models", id))


@router.get("/models/{id}/{version}")
async def model(id: Id, version: Number, request: Request, services: ThePageServices) -> Response:
    """A CAD model, with a form to build it; what is typed stands in the address."""
    return await model_page(request, services, id, version)


@router.get("/designs/new")
async def new_design(request: Request, services: ThePageServices) -> Response:
    """The empty form of a new design's first step."""
    typed = dict(request.query_params)
    step = await new_step(services, typed)
    hidden = {"design_name": "new design", **beside(typed)}
    return step_page(request, step, "/designs", hidden)


@router.get("/designs/{id}/steps/new")
async def another_step(id: Id, request: Request, services: ThePageServices) -> Response:
    """The empty form of one more step of a design."""
    typed = dict(request.query_params)
    step, design = await new_step(services, typed), await services.run(services.designs.show, id)
    hidden = {**beside(typed), "add": "template", "revision": str(design.revision)}
    return step_page(request, step, f"/designs/{id}/blocks", hidden)


@router.get("/designs/{id}")
async def design(id: Id, request: Request, services: ThePageServices) -> Response:
    """A design at its newest revision, to be changed; only to be read while its template is quarantined."""
    return await _or_stored(request, services, id, None, design_page(request, services, id))


@router.get("/designs/{id}/step")
async def step(id: Id, request: Request, services: ThePageServices, name: Text = "") -> Response:
    """One step of the newest revision of a design; the page of a long design fetches it when it is opened."""
    return await step_section(request, services, id, name)


@router.get("/designs/{id}/revisions/{number}")
async def revision(
    id: Id,
    number: Number,
    request: Request,
    services: ThePageServices,
    other: Annotated[int | None, Query(alias="with", ge=1, le=10**9)] = None,
    comments: Text = "",
) -> Response:
    """A revision, and what differs from another; `comments` is where a page of comments begins."""
    page = revision_page(request, services, id, number, other, cursor=comments)
    return await _or_stored(request, services, id, number, page)


@router.get("/designs/{id}/compare")
async def compared(
    id: Id,
    request: Request,
    services: ThePageServices,
    revision: Text = "",
    number: Annotated[str, Query(alias="with", max_length=200)] = "",
    design: Text = "",
    of: Text = "",
) -> Response:
    """Two revisions, of this design or of this and another one."""
    return await compare_page(request, services, id, Asked(revision, number, design, of))


@router.get("/designs/{id}/tolerances")
async def tolerances(
    id: Id,
    request: Request,
    services: ThePageServices,
    job: Annotated[str | None, Query(max_length=64, pattern=r"^[A-Za-z0-9_-]+$")] = None,
    part: Annotated[str, Query(max_length=1)] = "",
) -> Response:
    """Show the effects of a design's tolerances; `part` is the part that the design page takes in."""
    return await tolerances_page(request, services, id, job, is_part=bool(part))


@router.get("/designs/{id}/explain/{name}")
async def explanation(
    id: Id, name: Annotated[str, Path(max_length=140)], request: Request, services: ThePageServices
) -> Response:
    """Show where a model parameter, or the verdict of a criterion, comes from."""
    design, chain = await asyncio.gather(
        services.run(services.designs.show, id),
        services.calculate(None, services.designs.explanation, id, name, units_of(request)),
    )
    judged = line(chain.criterion) if chain.criterion else None
    slopes = sensitivity_lines(chain.sensitivities or [])
    return show(request, "explain.html", design=design, chain=chain, judged=judged, sensitivities=slopes)


@router.get("/designs/{id}/report")
async def report(id: Id, request: Request) -> Response:
    """The report, as the interface answers it to be read."""
    return go(f"/api/v1/designs/{id}/report.html?units={units_of(request)}")


@router.get("/designs/{id}/blocks")
@router.get("/designs/{id}/auto-map")
@router.get("/designs/{id}/copy")
@router.get("/designs/{id}/delete")
@router.get("/designs/{id}/rename")
@router.get("/designs/{id}/variants")
@router.get("/designs/{id}/variants/pasted")
@router.get("/designs/{id}/variants/file")
@router.get("/designs/{id}/labels")
@router.get("/designs/{id}/revisions/{_}/restore")
@router.get("/designs/{id}/jobs/{_}/cancel")
async def after_a_form(id: Id, request: Request) -> Response:
    """The design: a form that was refused is shown at the address to which it was sent."""
    query = f"?{request.url.query}" if request.url.query else ""
    return go(f"/designs/{id}{query}")


@router.get("/static/plotly.min.js")
async def plotly_script(request: Request) -> Response:
    """Plotly's browser file, compressed; the same until its package changes."""
    headers = {"ETag": plotly.tag(), "Cache-Control": "public, max-age=3600", "Content-Encoding": "gzip"}
    if request.headers.get("if-none-match") == plotly.tag():
        return Response(status_code=304, headers={"ETag": plotly.tag()})
    return Response(plotly.script(), media_type="text/javascript", headers=headers)


async def _or_stored(
    request: Request, services: PageServices, id: str, number: int | None, page: Awaitable[Response]
) -> Response:
    """Return a page of a design; what is stored of it, if one of its templates is quarantined."""
    try:
        return await page
    except Refused as refused:
        if not is_unusable(refused):
            raise
        return await stored_page(request, services, id, number, refused.problem.detail)


async def _picture(services: PageServices, id: str) -> tuple[str, str | None]:
    """Return a design's id, and the picture of the first of its parts, if it has one by now."""
    parts = await services.run(show_measurements, id, services.database)
    return id, next((f"/api/v1/designs/{id}/models/{name}/model.png" for name in parts), None)


async def _newest(services: ThePageServices, group: str, id: str) -> str:
    list_versions = {"templates": list_template_versions, "models": list_model_versions}[group]
    versions = await services.run(list_versions, id, services.catalogues)
    return f"/{group}/{id}/{next(item.version for item in versions.items if item.latest)}"


@router.get("/audit", dependencies=[needs("admin")])
async def audit(
    request: Request,
    services: ThePageServices,
    cursor: Text = "",
    object: Text = "",
    principal: Text = "",
    action: Annotated[str, Query(max_length=100)] = "",
) -> Response:
    """Changes, page by page: all, or those that fit what was typed into the filter."""
    typed = {"object": object.strip(), "principal": principal.strip(), "action": action.strip()}
    wanted = {name: text for name, text in typed.items() if text}  # a form sends empty fields too
    page = await services.run(list_audit, services.database, 50, cursor or None, **wanted)
    return show(
        request,
        "audit.html",
        entries=page.items,
        head=await services.run(show_head, services.database),
        wanted=wanted,
        older=urlencode({**wanted, "cursor": page.next}) if page.next else None,
    )
