"""A design whose template or model cannot be used now: what is stored of it, and why that is all."""

from __future__ import annotations

from fastapi import Request, Response

from app.designs.routes.revisions import show_revision
from app.web.rendering import show
from app.web.services import PageServices, Refused
from cad.export import MEDIA_TYPES

REASONS = ("/problems/quarantined", "/problems/unknown-template")


def is_unusable(refused: Refused) -> bool:
    """Return whether the interface refused because a version is quarantined, or its file was taken away."""
    return refused.problem.type in REASONS


async def stored_page(
    request: Request, services: PageServices, id: str, number: int | None, reason: str
) -> Response:
    """One revision, the newest if none is named, as it is stored."""
    design = await services.run(services.designs.show, id)
    shown = number or design.revision
    revision = await services.run(show_revision, id, shown, services.database)
    return show(
        request,
        "stored.html",
        design=design,
        revision=revision,
        reason=reason,
        kinds=list(MEDIA_TYPES),
        base=f"/api/v1/designs/{id}/revisions/{shown}",
    )
