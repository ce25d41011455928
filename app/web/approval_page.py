"""Actions of the forms of approval and comments, on the pages of designs and revisions."""

from __future__ import annotations

from typing import NamedTuple

from fastapi import APIRouter, Depends, Request, Response

from app.web.actions import forms_only
from app.web.api import Api, TheApi
from app.web.design_page import design_page
from app.web.forms import fields
from app.web.rendering import go
from app.web.revision_page import revision_page
from app.web.routes import Id, Number
from app.web.services import Refused

router = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

SHOWN = (403, 404, 409, 412, 422)
"""Refusals that the page itself says."""


class Place(NamedTuple):
    """The page from which a form was sent."""

    id: str
    number: int
    is_design: bool

    @property
    def path(self) -> str:
        """Its address."""
        return f"/designs/{self.id}" if self.is_design else f"/designs/{self.id}/revisions/{self.number}"


@router.post("/designs/{id}/revisions/{number}/approvals")
async def sign(id: Id, number: Number, request: Request, api: TheApi) -> Response:
    """Take a step of the approval."""
    typed = await fields(request)
    body = {"step": typed.get("step", "")}
    if typed.get("reason", "").strip():
        body["reason"] = typed["reason"]
    headers = {"If-Match": f'"{typed.get("seen", "")}"'}
    path = f"/designs/{id}/revisions/{number}/approvals"
    return await _sent(request, api, _place(id, number, typed), path, "Not signed", body, headers)


@router.post("/designs/{id}/revisions/{number}/comments")
async def comment(id: Id, number: Number, request: Request, api: TheApi) -> Response:
    """Write a comment."""
    typed = await fields(request)
    body = {"text": typed.get("text", "").replace("\r\n", "\n"), "subject": typed.get("subject", "").strip()}
    path = f"/designs/{id}/revisions/{number}/comments"
    said = {name: text for name, text in body.items() if text}
    return await _sent(request, api, _place(id, number, typed), path, "Not commented", said)


@router.post("/designs/{id}/revisions/{number}/comments/{comment}/resolve")
async def resolve(id: Id, number: Number, comment: Id, request: Request, api: TheApi) -> Response:
    """Say that a comment is dealt with."""
    place = _place(id, number, await fields(request))
    path = f"/designs/{id}/revisions/{number}/comments/{comment}/resolve"
    return await _sent(request, api, place, path, "Not resolved", {})


def _place(id: str, number: int, typed: dict[str, str]) -> Place:
    return Place(id, number, is_design=typed.get("page") == "design")


async def _sent(
    request: Request,
    api: Api,
    place: Place,
    path: str,
    failure: str,
    body: dict[str, str],
    headers: dict[str, str] | None = None,
) -> Response:
    """Send what a form says; then its page, which says why if it was refused."""
    try:
        await api.send("POST", path, json=body, headers=headers)
    except Refused as refused:
        if refused.status not in SHOWN:
            raise
        notice = f"{failure}: {refused.problem.detail}"
        if place.is_design:
            return await design_page(request, api, place.id, notice=notice, status=refused.status)
        return await revision_page(
            request, api, place.id, place.number, None, notice=notice, status=refused.status
        )
    return go(f"{place.path}#{'comments' if 'comments' in path else 'approval'}")
