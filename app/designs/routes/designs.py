"""`/designs`: create, list, change, delete, preview, auto-map, copy, measure and explain designs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Annotated, Literal

from fastapi import APIRouter, Body, Header, Path, Query, Request, Response
from pydantic import WithJsonSchema
from pydantic.config import JsonDict
from starlette.concurrency import run_in_threadpool

from app.api.answers import answered
from app.api.dependencies import (
    ExpensiveSteps,
    IdempotencyKey,
    TheDatabase,
    TheDesigns,
    TheExplanations,
    TheJobs,
    TheOnce,
    ThePreviews,
    TheThreads,
    Units,
    expensive_steps,
    get_once,
    services_of,
)
from app.api.responses import LATER, LONGEST, finished, later, patience, written
from app.designs import repository, views
from app.designs.bodies import LONGEST_NOTE, PATCH, CopyIn, DesignIn
from app.designs.explanation import ExplanationQuestion
from app.designs.filters import TEMPLATE, DesignFilter
from app.designs.labels import key_of, tags_of
from app.designs.preview import PreviewRequest
from app.designs.releases import released_of
from app.designs.schemas.designs import (
    Design,
    DesignList,
    DesignSummary,
    Explanation,
    MappedDesign,
    ModelMeasurements,
    Preview,
    Proposal,
    Proposals,
    State,
)
from app.designs.schemas.labels import MOST_TAGS, Tag
from app.designs.service import Designs, SaveResult
from app.http.access import TheClient, get_client, needs
from app.http.pages import Cursor, Limit, page
from app.http.strict_requests import PlainRoute, StrictRequest, StrictRoute
from app.jobs.service import Jobs
from app.plain import JsonObject
from app.schemas.problems import refusals
from app.storage.idempotency import Once
from app.storage.tables import DesignRow
from templates.core.errors import Fault, InvalidInputs

Id = Annotated[str, Path(max_length=64)]
Number = Annotated[int, Path(ge=1, le=10**9)]
Prefer = Annotated[str | None, Header(description="`wait=5` or `respond-async`")]
IfMatch = Annotated[str | None, Header(description='the ETag of the design that was read, such as `"3"`')]
Within = Annotated[
    float | None,
    Query(
        ge=0,
        le=LONGEST,
        description="longest wait [s]; longer calculations are left pending and no job is queued",
    ),
]
Returned = Literal["full", "minimal"]
ReturnWanted = Annotated[
    Returned,
    Query(alias="return", description="`minimal`: without results, for programs that save often"),
]
CHANGED = {**later(Design), **refusals(404, 429)}


def seconds_waited(prefer: str | None) -> float:
    """Return the time for which a request waits for expensive steps [s], at most its deadline."""
    return patience(prefer, math.inf)


async def answer_saved(
    designs: Designs,
    jobs: Jobs,
    saved: SaveResult,
    prefer: str | None,
    proposals: Sequence[Proposal] | None = None,
    wanted: Returned = "full",
) -> Response:
    """Return the design: 200 or 201 if its job ended in time, else 202 with the job in Location."""
    done = not saved.is_deferred and await finished(jobs, saved.job, prefer)
    status = (201 if saved.created else 200) if done else 202
    place = f"/api/v1/jobs/{saved.job}" if saved.job and not done else f"/api/v1/designs/{saved.design}"
    design = saved.answer
    if design is None:
        design = await run_in_threadpool(designs.show, saved.design, saved.revision)
    if wanted == "full":
        design = await run_in_threadpool(designs.with_results, design)
    if proposals is not None:
        design = MappedDesign(**dict(design), proposals=list(proposals))
    return shown(design, status, {"Location": place})


def shown(design: Design, status: int = 200, headers: Mapping[str, str] | None = None) -> Response:
    """Return a design as a response; its ETag is the revision."""
    return written(design, status, {**(headers or {}), "ETag": f'"{design.revision}"'})


PRINTABLE = r"^[^\x00-\x1f\x7f]*$"  # text without control characters, as in names of designs

router = APIRouter(
    prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute, dependencies=[ExpensiveSteps]
)
saves = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=PlainRoute)
"""The most frequent routes: create and PATCH."""

Explained = Annotated[str, Path(max_length=140, description="`model.width`; `film.film`, a criterion")]
NamePart = Annotated[
    str | None,
    Query(max_length=200, pattern=PRINTABLE, description="part of the name; case is ignored"),
]
InState = Annotated[State | None, Query(description="state of the newest revision")]
WithTags = Annotated[
    list[Tag],
    Query(
        alias="tag",
        max_length=MOST_TAGS,
        description="a tag that the design has; repeat the parameter for more tags",
    ),
]
Archived = Annotated[
    Literal["false", "true", "any"],
    Query(description="`false`: without archived designs; `true`: only archived designs; `any`: both"),
]
Deleted = Annotated[bool, Query(description="only deleted designs, which can be restored")]
UsedTemplate = Annotated[
    str | None,
    Query(
        description="a template or model that the newest revision uses, in any version or in a given one: "
        "`oil_film`, `oil_film/2`",
        json_schema_extra={"pattern": TEMPLATE},
    ),
]
Patch = Annotated[
    JsonObject,
    Body(
        title="DesignPatch",
        description="a merge patch of the design, with an optional `note`; null removes",
    ),
    WithJsonSchema(PATCH),
]
MERGE_PATCH: JsonDict = {"requestBody": {"content": {"application/merge-patch+json": {"schema": PATCH}}}}


@saves.post("", status_code=201, response_model=Design, responses={**later(Design), **refusals(429)})
async def create_design(
    request: StrictRequest,
    body: DesignIn,
    wanted: ReturnWanted = "full",
    prefer: Prefer = None,
    idempotency_key: IdempotencyKey = None,
) -> Response:
    """Create a design and build its models: 201 when they are ready, 202 while they are being built."""
    raw, note = document_of(body)
    create = services_of(request).designs.create
    return await _saved(request, prefer, idempotency_key, partial(create, raw, note), wanted)


@router.get("")
def list_designs(
    database: TheDatabase,
    limit: Limit = 50,
    cursor: Cursor = None,
    name: NamePart = None,
    state: InState = None,
    tag: WithTags = [],  # noqa: B006 - FastAPI copies it
    archived: Archived = "false",
    template: UsedTemplate = None,
    deleted: Deleted = False,
) -> DesignList:
    """Return designs, newest first: all, or those that match all filters."""
    tags = tuple(dict.fromkeys(map(key_of, tag)))
    wanted = DesignFilter(name, state, tags, archived, deleted, template)
    with database.read() as session:
        rows = repository.designs(session, limit, cursor, wanted)
        ids = [row.id for row in rows]
        labels, released = tags_of(session, ids), released_of(session, ids)
        newest = repository.heads(session, rows)

        def show(row: DesignRow) -> DesignSummary:
            return views.listed(row, newest[row.id], labels[row.id], released.get(row.id))

        return page(DesignList, rows, limit, show, lambda row: row.id)


@router.get("/{id}", response_model=Design, responses=refusals(404))
def show_design(id: Id, designs: TheDesigns, wanted: ReturnWanted = "full") -> Response:
    """Return a design at its newest revision, which is also the ETag, with its results."""
    design = designs.show(id)
    return shown(designs.with_results(design) if wanted == "full" else design)


@saves.patch("/{id}", response_model=Design, responses=CHANGED, openapi_extra=MERGE_PATCH)
async def change_design(
    request: StrictRequest,
    id: Id,
    body: Patch,
    wanted: ReturnWanted = "full",
    if_match: IfMatch = None,
    prefer: Prefer = None,
    idempotency_key: IdempotencyKey = None,
) -> Response:
    """Create a new revision; models are rebuilt only if one of their parameters changed.

    If only the name changes, the new revision keeps all results.
    """
    patch, note = noted(body)
    change = services_of(request).designs.change
    return await _saved(request, prefer, idempotency_key, partial(change, id, patch, note, if_match), wanted)


async def _saved(
    request: StrictRequest,
    prefer: str | None,
    key: str | None,
    save: Callable[[Once], SaveResult],
    wanted: Returned,
) -> Response:
    """Save a design in a thread that may wait for the pool, and return the response."""
    services, client = services_of(request), await get_client(request)
    once = await get_once(request, client, key)
    await expensive_steps(request, client)
    saved = await services.threads.run_within(seconds_waited(prefer), request, save, once)
    return await answer_saved(services.designs, services.jobs, saved, prefer, wanted=wanted)


@router.delete("/{id}", status_code=204, responses=refusals(404, 409))
def delete_design(id: Id, designs: TheDesigns, if_match: IfMatch = None) -> Response:
    """Delete a design from the lists; it can be restored. A design with a signature cannot be deleted."""
    designs.delete(id, if_match)
    return Response(status_code=204)


@router.post("/{id}/restore", response_model=Design, responses=refusals(404))
def restore_deleted_design(id: Id, designs: TheDesigns) -> Response:
    """Return a deleted design to the lists, with all its revisions."""
    return shown(designs.undelete(id))


@router.post(
    "/{id}/preview",
    response_model=Preview,
    responses={**later(Preview), **refusals(404, 429)},
    dependencies=[needs("viewer")],
)
async def preview_design(
    id: Id,
    body: Patch,
    previews: ThePreviews,
    threads: TheThreads,
    client: TheClient,
    request: Request,
    worksheet: Annotated[
        bool, Query(description="also return every step with its formulas written out")
    ] = False,
    units: Units = "si",
    within: Within = None,
    prefer: Prefer = None,
) -> Response:
    """Preview the effect of a change on outputs and model parameters; nothing is saved."""
    change = PreviewRequest(id, noted(body)[0], worksheet, units)
    if within is not None:
        return written(await threads.run_within(within, request, previews.at_once, change))
    return await answered(previews, change, request, client, seconds_waited(prefer))


@router.post("/{id}/auto-map", response_model=MappedDesign | Proposals, responses=CHANGED)
async def map_design(
    id: Id,
    designs: TheDesigns,
    threads: TheThreads,
    jobs: TheJobs,
    once: TheOnce,
    request: Request,
    apply: Annotated[bool, Query(description="save the proposals as a new revision")] = False,
    if_match: IfMatch = None,
    prefer: Prefer = None,
) -> Response:
    """Propose relations that link unset model parameters to quantities of the same kind and role.

    A quantity fits if it has the same kind and a name of the parameter, and belongs to the same part. Each
    proposal gives its reason. With `apply`, the service saves all proposals as a new revision.
    """
    proposals, saved = await threads.run_within(
        seconds_waited(prefer), request, designs.auto_map, id, apply, if_match, once
    )
    if not saved:
        return written(Proposals(proposals=proposals))
    return await answer_saved(designs, jobs, saved, prefer, proposals)


@router.post("/{id}/copy", status_code=201, response_model=Design, responses=CHANGED)
async def copy_design(
    id: Id,
    designs: TheDesigns,
    threads: TheThreads,
    jobs: TheJobs,
    once: TheOnce,
    request: Request,
    body: CopyIn | None = None,
    prefer: Prefer = None,
) -> Response:
    """Create a design with the newest document of this one."""
    saved = await threads.run_within(
        seconds_waited(prefer), request, designs.copy, id, body.name if body else None, once
    )
    return await answer_saved(designs, jobs, saved, prefer)


@router.get("/{id}/measurements", responses=refusals(404))
def show_measurements(id: Id, database: TheDatabase, units: Units = "si") -> dict[str, ModelMeasurements]:
    """Return measurements of the newest valid models, and the dimensions measured on their STEP files."""
    with database.read() as session:
        measured = views.measurements(session, id)
        return {name: model.in_units(units) for name, model in measured.items()}


@router.get(
    "/{id}/explain/{name}", response_model=Explanation, responses={**LATER, **refusals(404, 422, 429)}
)
async def explain_name(
    id: Id,
    name: Explained,
    explanations: TheExplanations,
    client: TheClient,
    request: Request,
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Explain where a model parameter or the verdict of a criterion comes from.

    For a parameter: dimension ← relation ← output ← formula ← inputs. For a criterion such as `film.film`:
    verdict ← value ← formula ← inputs, and limit ← its source. `sensitivities` are local slopes with respect
    to the typed quantities.
    """
    asked = ExplanationQuestion(id, name, units)
    return await answered(explanations, asked, request, client, patience(prefer, explanations.steps.deadline))


def document_of(body: DesignIn) -> tuple[JsonObject, str | None]:
    """Return the document of a new design without its note, and the note."""
    raw = body.model_dump()  # Python mode, because JSON mode turns NaN into null
    note = raw.pop("note")
    raw.pop("model")
    return raw, note


def noted(body: JsonObject) -> tuple[JsonObject, str | None]:
    """Return a patch without its note, and the note."""
    patch = {key: value for key, value in body.items() if key != "note"}
    note = body.get("note")
    if note is not None and not (isinstance(note, str) and len(note) <= LONGEST_NOTE):
        raise InvalidInputs([Fault("note", "string", f"a note may have at most {LONGEST_NOTE} characters")])
    return patch, note
