"""Forms that put designs in order: rename, tag, archive; then the list from which they were sent."""

from __future__ import annotations

import re

from fastapi import APIRouter, Depends, Request, Response
from pydantic import JsonValue

from app.designs.labels import LabelsIn
from app.web.actions import forms_only
from app.web.forms import fields
from app.web.rendering import go
from app.web.routes import Id
from app.web.services import PageServices, ThePageServices

_LIST = re.compile(r"/(designs(\?[!-~]*)?)?")
"""An address of a list of designs on this service."""

router = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])


@router.post("/designs/{id}/rename")
async def rename(id: Id, request: Request, services: ThePageServices) -> Response:
    """Another name; the results stay."""
    typed = await fields(request)
    await services.change(id, typed.get("revision", ""), {"name": typed.get("name", "").strip()})
    return _back(typed)


@router.post("/designs/{id}/labels")
async def label(id: Id, request: Request, services: ThePageServices) -> Response:
    """Tags more or less, into the archive or out of it."""
    typed = await fields(request)
    await _label(services, id, typed)
    return _back(typed)


async def _label(services: PageServices, id: str, typed: dict[str, str]) -> None:
    change: dict[str, JsonValue] = {}
    for field in ("add_tags", "remove_tags"):
        if tags := [tag.strip() for tag in typed.get(field, "").split(",") if tag.strip()]:
            change[field] = [*tags]
    if "archived" in typed:
        change["archived"] = typed["archived"] == "true"
    await services.run(services.labelling.label, id, services.read(LabelsIn, change))


def _back(typed: dict[str, str]) -> Response:
    """To the list from which a form was sent."""
    back = typed.get("back", "/")
    return go(back if _LIST.fullmatch(back) else "/")
