"""The route of the list of designs."""

from __future__ import annotations

import asyncio
from typing import get_args
from urllib.parse import urlencode

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel

from app.designs.routes.designs import (
    Archived,
    Deleted,
    InState,
    NamePart,
    UsedTemplate,
    WithTags,
    list_designs,
)
from app.designs.routes.labels import list_tags
from app.designs.schemas.designs import State
from app.web.shared.paths import Text
from app.web.shared.responses import show
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


class Filter(BaseModel):
    """The filter of a list of designs, as the interface accepts it."""

    name: NamePart = None
    state: InState = None
    tag: WithTags = []
    archived: Archived = "false"
    template: UsedTemplate = None
    deleted: Deleted = False


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
    deleted: Text = "",
) -> Response:
    """Return the page of designs: all, or those that match the filter."""
    typed = {
        "name": name,
        "state": state,
        "template": template.strip(),
        "tag": tag.strip(),
        "archived": archived,
        "deleted": deleted,
    }
    wanted = {key: text for key, text in typed.items() if text}  # a form sends empty fields too
    filtered = services.read(Filter, {**wanted, **({"tag": [wanted["tag"]]} if tag.strip() else {})})
    page, tags = await asyncio.gather(
        services.run(list_designs, services.database, 50, cursor or None, **vars(filtered)),
        services.run(list_tags, services.database),
    )
    return show(
        request,
        "designs/designs.html",
        designs=page,
        wanted=wanted,
        states=get_args(State),
        tags=tags.items,
        back=f"/designs?{urlencode(wanted)}" if wanted else "/designs",
        older=urlencode({**wanted, "cursor": page.next}) if page.next else None,
    )
