"""The route of the page of the audit."""

from __future__ import annotations

from typing import Annotated
from urllib.parse import urlencode

from fastapi import APIRouter, Query, Request, Response

from app.http.access import needs
from app.identity.routes.audit import list_audit, show_head
from app.web.shared.paths import Text
from app.web.shared.responses import show
from app.web.shared.services import ThePageServices

router = APIRouter(include_in_schema=False)


@router.get("/audit", dependencies=[needs("admin")])
async def audit(
    request: Request,
    services: ThePageServices,
    cursor: Text = "",
    object: Text = "",
    principal: Text = "",
    action: Annotated[str, Query(max_length=100)] = "",
) -> Response:
    """Return the page of changes: all, or those that match the filter."""
    typed = {"object": object.strip(), "principal": principal.strip(), "action": action.strip()}
    wanted = {name: text for name, text in typed.items() if text}  # a form sends empty fields too
    page = await services.run(list_audit, services.database, 50, cursor or None, **wanted)
    return show(
        request,
        "audit/audit.html",
        entries=page.items,
        head=await services.run(show_head, services.database),
        wanted=wanted,
        older=urlencode({**wanted, "cursor": page.next}) if page.next else None,
    )
