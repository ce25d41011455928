"""The route of the home page."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable

from fastapi import APIRouter, Request, Response

from app.catalogue.routes.faults import list_catalogue_faults
from app.catalogue.routes.templates import Search, list_templates
from app.catalogue.schemas.templates import TemplateSummary
from app.designs.gallery.gallery import offered
from app.designs.routes.designs import list_designs, show_measurements
from app.designs.routes.labels import list_tags
from app.solids.routes.models import list_models
from app.web.shared.responses import show
from app.web.shared.services import PageServices, ThePageServices

router = APIRouter(include_in_schema=False)
ON_HOME = 4  # designs with pictures; few, so that the page loads fast
TAGS_ON_HOME = 30


@router.get("/")
async def home(request: Request, services: ThePageServices, template: Search = "") -> Response:
    """Return the home page: first steps, designs, templates and models; `template` searches templates."""
    designs, tags, templates, models, faulty = await asyncio.gather(
        services.run(list_designs, services.database, limit=ON_HOME),
        services.run(list_tags, services.database),
        services.run(list_templates, services.catalogues, limit=500),
        services.run(list_models, services.catalogues, limit=500),
        services.run(list_catalogue_faults, services.catalogues, limit=500),
    )
    latest = [item for item in templates.items if item.latest]
    shown = templates
    if template.strip():
        shown = await services.run(list_templates, services.catalogues, limit=500, search=template)
    return show(
        request,
        "home/home.html",
        designs=designs,
        tags=tags.items[:TAGS_ON_HOME],
        back="/",
        pictures=dict(await asyncio.gather(*(_picture(services, item.id) for item in designs.items))),
        templates=each_once(shown.items),
        notes=shown.notes,
        search=template,
        latest=latest,
        models=[item for item in models.items if item.latest],
        gallery=offered(templates.items, models.items),
        faulty=faulty.items,
    )


def each_once(versions: Iterable[TemplateSummary]) -> list[TemplateSummary]:
    """Return one version of each template: the latest if it is among them, otherwise the last."""
    chosen: dict[str, TemplateSummary] = {}
    for item in versions:
        if item.id not in chosen or not chosen[item.id].latest:
            chosen[item.id] = item
    return list(chosen.values())


async def _picture(services: PageServices, id: str) -> tuple[str, str | None]:
    """Return a design's id, and the picture of its first part if the picture exists already."""
    parts = await services.run(show_measurements, id, services.database)
    return id, next((f"/api/v1/designs/{id}/models/{name}/model.png" for name in parts), None)
