"""Handle the forms for approvals and comments on the pages of designs and revisions."""

from __future__ import annotations

from collections.abc import Awaitable
from typing import NamedTuple

from fastapi import APIRouter, Depends, Request, Response

from app.approvals.schemas import ApprovalIn, CommentIn
from app.web.design.page import design_page
from app.web.revision.routes import revision_page
from app.web.shared.forms import fields, forms_only
from app.web.shared.paths import Id, Number
from app.web.shared.responses import go
from app.web.shared.services import PageServices, Refused, ThePageServices

router = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

SHOWN = (403, 404, 409, 412, 422)
"""Status codes of refusals that the page itself shows."""


class Place(NamedTuple):
    """The page from which a form was sent."""

    id: str
    number: int
    is_design: bool

    @property
    def path(self) -> str:
        """Return the address of the page."""
        return f"/designs/{self.id}" if self.is_design else f"/designs/{self.id}/revisions/{self.number}"


@router.post("/designs/{id}/revisions/{number}/approvals")
async def sign(id: Id, number: Number, request: Request, services: ThePageServices) -> Response:
    """Take one step of the approval, and return the changed part of the page."""
    typed = await fields(request)
    said = {"step": typed.get("step", "")}
    said |= {name: typed[name] for name in ("reason", "acknowledged") if typed.get(name, "").strip()}
    seen = f'"{typed.get("seen", "")}"'

    async def signed() -> None:
        body = services.read(ApprovalIn, said)
        await services.run(services.approving.sign, id, number, body, seen, services.once)

    return await _sent(request, services, _place(id, number, typed), signed(), "Not signed", "approval")


@router.post("/designs/{id}/revisions/{number}/comments")
async def comment(id: Id, number: Number, request: Request, services: ThePageServices) -> Response:
    """Add a comment, and return the changed part of the page."""
    typed = await fields(request)
    body = {"text": typed.get("text", "").replace("\r\n", "\n"), "subject": typed.get("subject", "").strip()}
    said = {name: text for name, text in body.items() if text}

    async def commented() -> None:
        await services.run(services.comments.add, id, number, services.read(CommentIn, said), services.once)

    return await _sent(request, services, _place(id, number, typed), commented(), "Not commented", "comments")


@router.post("/designs/{id}/revisions/{number}/comments/{comment}/resolve")
async def resolve(
    id: Id, number: Number, comment: Id, request: Request, services: ThePageServices
) -> Response:
    """Mark a comment as resolved, and return the changed part of the page."""
    place = _place(id, number, await fields(request))
    resolved = services.run(services.comments.resolve, id, number, comment)
    return await _sent(request, services, place, resolved, "Not resolved", "comments")


def _place(id: str, number: int, typed: dict[str, str]) -> Place:
    return Place(id, number, is_design=typed.get("page") == "design")


async def _sent(
    request: Request,
    services: PageServices,
    place: Place,
    action: Awaitable[object],
    failure: str,
    part: str,
) -> Response:
    """Carry out the action of a form, and return the changed part of the page, with any refusal's reason."""
    try:
        await action
    except Refused as refused:
        if refused.status not in SHOWN:
            raise
        notice = f"{failure}: {refused.problem.detail}"
        if place.is_design:
            return await design_page(request, services, place.id, notice=notice, status=refused.status)
        return await revision_page(
            request, services, place.id, place.number, None, notice=notice, status=refused.status
        )
    return go(f"{place.path}#{part}")
