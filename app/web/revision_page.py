"""The page of one revision of a design."""

from __future__ import annotations

import asyncio

from fastapi import Request, Response

from app.designs.schemas.designs import RevisionWorksheet
from app.web.approvals import approval_of, comments_of
from app.web.blocks import models_of, steps_of
from app.web.design_answers import described_models, revision_of, templates_of
from app.web.differences import differences
from app.web.rendering import show
from app.web.services import PageServices
from cad.export import MEDIA_TYPES


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
    """Show a stored revision, and how it differs from another: the one before, if none is named."""
    design, revision = await asyncio.gather(
        services.run(services.designs.show, id), revision_of(request, services, id, number)
    )
    compared = other or (number - 1 if number > 1 else None)
    against = await revision_of(request, services, id, compared) if compared else None
    templates = await templates_of(services, _steps_of_revision(revision))
    return show(
        request,
        "revision.html",
        status=status,
        notice=notice,
        approval=await approval_of(services, id, number),
        comments=await comments_of(services, id, number, 50, cursor),
        design=design,
        revision=revision,
        steps=steps_of(revision, templates),
        models=models_of(revision, await described_models(services, revision)),
        against=against,
        differences=differences(against, revision) if against else [],
        kinds=list(MEDIA_TYPES),
        base=f"/api/v1/designs/{id}/revisions/{number}",
    )


def _steps_of_revision(revision: RevisionWorksheet) -> dict[str, tuple[str, int]]:
    """Id and version of the template of every step."""
    return {name: (step.template.id, step.template.version) for name, step in revision.steps.items()}
