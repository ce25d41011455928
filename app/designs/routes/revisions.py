"""`/designs/{id}/revisions`: list, show and restore revisions."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.api.dependencies import (
    ExpensiveSteps,
    TheDatabase,
    TheDesigns,
    TheJobs,
    TheOnce,
    TheThreads,
)
from app.designs import repository, views
from app.designs.bodies import RestoreIn
from app.designs.routes.designs import CHANGED, Id, IfMatch, Number, Prefer, answer_saved, seconds_waited
from app.designs.schemas.designs import Design, Revision, RevisionList
from app.http.pages import Limit, page
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(
    prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute, dependencies=[ExpensiveSteps]
)


@router.post("/{id}/revisions/{number}/restore", response_model=Design, responses=CHANGED)
async def restore_revision(
    id: Id,
    number: Number,
    designs: TheDesigns,
    threads: TheThreads,
    jobs: TheJobs,
    once: TheOnce,
    request: Request,
    body: RestoreIn | None = None,
    if_match: IfMatch = None,
    prefer: Prefer = None,
) -> Response:
    """Create a revision with the document of an old one."""
    note = body.note if body else None
    saved = await threads.run_within(
        seconds_waited(prefer), request, designs.restore, id, number, note, if_match, once
    )
    return await answer_saved(designs, jobs, saved, prefer)


@router.get("/{id}/revisions", responses=refusals(404))
def list_revisions(
    id: Id,
    database: TheDatabase,
    limit: Limit = 50,
    cursor: Annotated[int | None, Query(ge=1, le=10**9)] = None,
    steps: Annotated[bool, Query(description="include steps, models and results of each revision")] = True,
) -> RevisionList:
    """Return the revisions of a design, newest first."""
    with database.read() as session:
        repository.design(session, id)
        rows = repository.revisions(session, id, limit, cursor)
        show = partial(views.revision if steps else views.summary, session)
        return page(RevisionList, rows, limit, show, lambda row: str(row.number))


@router.get("/{id}/revisions/{number}", responses=refusals(404))
def show_revision(id: Id, number: Number, database: TheDatabase) -> Revision:
    """Return a revision; its inputs never change, and its results are added once."""
    with database.read() as session:
        return views.revision(session, repository.lean(session, id, number))
