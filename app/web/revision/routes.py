"""The page of one revision of a design, and its differences from another revision.

If a template or model of the revision cannot be used now, the page shows the stored results and the reason.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Iterator
from typing import Annotated, NamedTuple

from fastapi import APIRouter, Query, Request, Response

from app.designs.routes.revisions import show_revision
from app.designs.schemas.designs import Revision, RevisionWorksheet
from app.presentation import numbers
from app.reports.worksheet import plots_of
from app.schemas.answers import Answer
from app.web.design.own_lines import rows_of
from app.web.shared.blocks import models_of, steps_of
from app.web.shared.design_answers import (
    approval_of,
    comments_of,
    described_models,
    revision_of,
    templates_of,
)
from app.web.shared.paths import Id, Number, Text
from app.web.shared.responses import show
from app.web.shared.services import PageServices, Refused, ThePageServices
from cad.file_kinds import MEDIA_TYPES

REASONS = ("/problems/quarantined", "/problems/unknown-template")
"""Types of the problems for which a version cannot be used now."""


async def revision_page(
    request: Request,
    services: PageServices,
    id: str,
    number: int,
    other: int | None,
    *,
    cursor: str = "",
    notice: str | None = None,
    status: int = 200,
) -> Response:
    """Return the page of a stored revision, with its differences from another, by default the previous."""
    design, revision = await asyncio.gather(
        services.run(services.designs.show, id), revision_of(request, services, id, number)
    )
    compared = other or (number - 1 if number > 1 else None)
    against = await revision_of(request, services, id, compared) if compared else None
    templates = await templates_of(services, _steps_of_revision(revision))
    return show(
        request,
        "revision/revision.html",
        status=status,
        notice=notice,
        approval=await approval_of(services, id, number),
        comments=await comments_of(services, id, number, 50, cursor),
        design=design,
        revision=revision,
        steps=steps_of(revision, templates),
        models=models_of(revision, await described_models(services, revision)),
        lines=rows_of(revision),
        plots=plots_of(revision),
        against=against,
        differences=differences(against, revision) if against else [],
        kinds=list(MEDIA_TYPES),
        base=f"/api/v1/designs/{id}/revisions/{number}",
    )


def _steps_of_revision(revision: RevisionWorksheet) -> dict[str, tuple[str, int]]:
    """Return the id and version of the template of every step."""
    return {name: (step.template.id, step.template.version) for name, step in revision.steps.items()}


class Difference(NamedTuple):
    """One value that differs between two revisions; empty where a revision does not have it."""

    name: str
    old: str
    new: str


def differences(old: Revision, new: Revision) -> list[Difference]:
    """Return all differing parameters, inputs, outputs and model parameters, in the newer one's order."""
    before, after = dict(_values(old)), dict(_values(new))
    names = dict.fromkeys([*after, *before])
    return [
        Difference(name, numbers.in_line(before.get(name)), numbers.in_line(after.get(name)))
        for name in names
        if before.get(name) != after.get(name)
    ]


def _values(revision: Revision) -> Iterator[tuple[str, object]]:
    yield from revision.parameters.items()
    for name, step in revision.steps.items():
        for part in (step.inputs, step.outputs):
            yield from ((f"{name}.{tail}", _comparable(value)) for tail, value in part.items())
    for line in revision.worksheet.lines if revision.worksheet else ():
        if line.name and line.value:
            yield line.name, _comparable(line.value)
    for name, model in revision.models.items():
        yield from ((f"{name}.{tail}", _comparable(value)) for tail, value in model.parameters.items())
        yield from ((f"{name}.{tail} (relation)", value) for tail, value in model.relations.items())


def _comparable(value: object) -> object:
    """Return a quantity as plain data without its origin; return any other value as its user typed it."""
    if not isinstance(value, Answer):
        return value
    return {name: part for name, part in value.plain().items() if name != "from"}


def is_unusable(refused: Refused) -> bool:
    """Return whether a service refused because a version is quarantined, or its file was removed."""
    return refused.problem.type in REASONS


async def stored_page(
    request: Request, services: PageServices, id: str, number: int | None, reason: str
) -> Response:
    """Return the page of a stored revision without calculating anything, by default of the newest one."""
    design = await services.run(services.designs.show, id)
    shown = number or design.revision
    revision = await services.run(show_revision, id, shown, services.database)
    return show(
        request,
        "revision/stored.html",
        design=design,
        revision=revision,
        reason=reason,
        kinds=list(MEDIA_TYPES),
        base=f"/api/v1/designs/{id}/revisions/{shown}",
    )


async def or_stored(
    request: Request, services: PageServices, id: str, number: int | None, page: Awaitable[Response]
) -> Response:
    """Return a page of a design; if one of its templates is quarantined, the page of the stored revision."""
    try:
        return await page
    except Refused as refused:
        if not is_unusable(refused):
            raise
        return await stored_page(request, services, id, number, refused.problem.detail)


router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/revisions/{number}")
async def revision(
    id: Id,
    number: Number,
    request: Request,
    services: ThePageServices,
    other: Annotated[int | None, Query(alias="with", ge=1, le=10**9)] = None,
    comments: Text = "",
) -> Response:
    """Return the page of a revision and its differences; `comments` is the cursor of a page of comments."""
    page = revision_page(request, services, id, number, other, cursor=comments)
    return await or_stored(request, services, id, number, page)
