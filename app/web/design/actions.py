"""Handle forms about designs: each calls a service, then shows the page with the result.

Without scripts in the browser, these forms are the only way to change a design; with scripts,
`design/design.js` saves changes directly. `app.http.guard` refuses forms of other sites, because a browser
would send them without asking the user.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from fastapi import APIRouter, Depends, Request, Response
from pydantic import JsonValue

from app.designs.bodies import DesignIn
from app.designs.gallery.gallery import GALLERY
from app.designs.labels import LabelsIn
from app.designs.routes.designs import document_of
from app.designs.schemas.designs import Design
from app.presentation.input_text import value_of
from app.reference import Reference
from app.web.design.declarations import change_of
from app.web.design.page import design_page
from app.web.new_step.routes import NewStep, address, beside, new_step, step_page, versioned
from app.web.shared.blocks import Refusal
from app.web.shared.forms import Patch, fields, forms_only, inner, kept, lines_of, patch_of
from app.web.shared.paths import Id, Number
from app.web.shared.responses import go
from app.web.shared.services import PageServices, Refused, ThePageServices

STALE = 412
ILL_NAMED = 422
NOTHING: Mapping[str, str] = {}


router = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])


@router.post("/designs")
async def create(request: Request, services: ThePageServices) -> Response:
    """Create a design from the gallery, or one with a chosen template and model.

    If a template is chosen, the user first fills in its inputs, so that example values are never saved as the
    user's.
    """
    typed = await fields(request)
    example = GALLERY.get(typed.get("example", ""))
    if example:
        return await _created(services, example.document)
    document: dict[str, JsonValue] = {
        "name": typed.get("design_name", typed.get("name", "")).strip() or "new design"
    }
    if typed.get("model"):
        id, version = versioned(typed["model"])
        document["model"] = {"id": id, "version": version}
    if not typed.get("template"):
        return await _created(services, document)
    return await _with_step(request, services, typed, document)


async def _with_step(
    request: Request, services: PageServices, typed: Mapping[str, str], document: dict[str, JsonValue]
) -> Response:
    """Create a design with one step; return the form of the step if it is empty or was refused."""
    if "design_name" not in typed:  # the form of the home page: its name is that of the design
        await new_step(services, typed)  # a template that does not exist is refused here
        return go(address("/designs/new", {**typed, "design_name": str(document["name"]), "name": ""}))
    step = await new_step(services, typed)
    try:
        return await _created(services, {**document, "steps": {step.name: step.plain()}})
    except Refused as refused:
        return _step_again(request, step, "", beside(typed), refused)


def _step_again(
    request: Request, step: NewStep, design: str, hidden: Mapping[str, str], refused: Refused
) -> Response:
    """Return the form of a step that was refused; without a design, the step is the first of a new one."""
    if refused.status != ILL_NAMED:
        raise refused
    notice = None if refused.faults else f"Nothing was saved: {refused.problem.detail}"
    refusal = Refusal(step.typed, refused.faults)
    action = f"/designs/{design}/blocks" if design else "/designs"
    return step_page(request, step, action, hidden, refusal, notice, design=design)


async def _created(services: PageServices, document: Mapping[str, JsonValue]) -> Response:
    raw, note = document_of(services.read(DesignIn, document))
    saved = await services.save(services.designs.create, raw, note, services.once)
    return go(f"/designs/{saved.design}")


@router.post("/designs/{id}")
async def save(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save a new revision; if it is refused, return the form with its entries and their faults."""
    typed = await fields(request)
    design = await services.run(services.designs.show, id)
    based = typed.get("revision", "")
    patch = patch_of(design, typed)
    try:
        if based != str(design.revision):
            raise Refused.because(STALE, f"revision {design.revision} was saved in the meantime")
        await services.change(id, based, {**patch, **lines_of(typed)}, typed.get("note", ""))
    except Refused as refused:
        return await _again(request, services, id, typed, refused)
    return go(f"/designs/{id}")


@router.post("/designs/{id}/blocks")
async def add(id: Id, request: Request, services: ThePageServices) -> Response:
    """Add, change or remove a parameter, template, model, analysis or iteration.

    For a template, the user first fills in its inputs.
    """
    typed = await fields(request)
    if typed.get("add") == "template":
        return await _add_step(id, request, services, typed)
    design = await services.run(services.designs.show, id)
    declared = change_of(design, typed)
    patch = _block(typed)
    try:
        if declared is None:
            _refuse_taken(design, patch)
        await services.change(id, typed.get("revision", ""), patch if declared is None else declared)
    except Refused as refused:
        return await _again(request, services, id, {}, refused, part=typed)
    return go(f"/designs/{id}")


async def _add_step(id: str, request: Request, services: PageServices, typed: Mapping[str, str]) -> Response:
    """Add a step; return its form if the form is empty or was refused."""
    step, design = await new_step(services, typed), await services.run(services.designs.show, id)
    patch: Patch = {"steps": {step.name: step.plain()}}
    try:
        _refuse_taken(design, patch)
    except Refused as refused:
        return await _again(request, services, id, {}, refused)
    if not step.is_filled:
        return go(address(f"/designs/{id}/steps/new", typed))
    try:
        await services.change(id, typed.get("revision", ""), patch)
    except Refused as refused:
        hidden = {**beside(typed), "add": "template", "revision": typed.get("revision", "")}
        return _step_again(request, step, id, hidden, refused)
    return go(f"/designs/{id}")


@router.post("/designs/{id}/auto-map")
async def auto_map(id: Id, request: Request, services: ThePageServices) -> Response:
    """Save the proposed links that the user chose."""
    typed = await fields(request)
    proposed = await services.calculate(None, services.designs.proposals, id)
    chosen = [item for item in proposed if typed.get(f"map.{item.target}")]
    patch: Patch = {"models": {}}
    for item in chosen:
        target = Reference.parse(item.target)
        within = inner(inner(patch["models"], target.block), "parameters")
        within[target.member] = item.relation
    if chosen:
        await services.change(id, typed.get("revision", ""), patch, "mapped as proposed")
    return go(f"/designs/{id}")


@router.post("/designs/{id}/copy")
async def copy(id: Id, services: ThePageServices) -> Response:
    """Copy the design, and redirect to the copy."""
    saved = await services.save(services.designs.copy, id, None, services.once)
    return go(f"/designs/{saved.design}")


@router.post("/designs/{id}/delete")
async def delete(id: Id, request: Request, services: ThePageServices) -> Response:
    """Remove a design from the lists, if it is as the user saw it."""
    seen = (await fields(request)).get("revision", "")
    await services.run(services.designs.delete, id, f'"{seen}"')
    return go("/#designs")


@router.post("/designs/{id}/undelete")
async def undelete(id: Id, services: ThePageServices) -> Response:
    """Return a deleted design to the lists, and show it."""
    await services.run(services.designs.undelete, id)
    return go(f"/designs/{id}")


@router.post("/designs/{id}/revisions/{number}/restore")
async def restore(id: Id, number: Number, services: ThePageServices) -> Response:
    """Save a new revision that equals an old one."""
    await services.save(services.designs.restore, id, number, None, None, services.once)
    return go(f"/designs/{id}")


@router.post("/designs/{id}/jobs/{job}/cancel")
async def cancel(id: Id, job: Id, services: ThePageServices) -> Response:
    """Cancel the regeneration; a job that has ended meanwhile stays unchanged."""
    await services.cancel(job)
    return go(f"/designs/{id}")


async def _again(
    request: Request,
    services: PageServices,
    id: str,
    typed: Mapping[str, str],
    refused: Refused,
    part: Mapping[str, str] = NOTHING,
) -> Response:
    """Return the page with a refused form; of an outdated form keep only the user's own changes."""
    if refused.status not in (STALE, ILL_NAMED):
        raise refused
    notice = (
        f"Somebody else saved this design meanwhile: {refused.problem.detail}. Your changes are kept in "
        "the fields below; check them again, then save."
        if refused.status == STALE
        else None
    )
    if not notice and not refused.faults:
        notice = f"Nothing was saved: {refused.problem.detail}"
    refusal = Refusal(kept(typed), refused.faults, part)
    return await design_page(request, services, id, refusal=refusal, notice=notice, status=refused.status)


def _refuse_taken(design: Design, patch: Patch) -> None:
    """Refuse a name that a parameter, a step or a model already has.

    Raises
    ------
    Refused
        If a name that the patch adds is in use.
    """
    for added in patch.values():
        for name, value in added.items():
            if value is not None and name in {*design.parameters, *design.steps, *design.models}:
                raise Refused.because(ILL_NAMED, f"{name} is in use: choose another name")


def _block(typed: Mapping[str, str]) -> Patch:
    """Return the merge patch that adds or removes what a form names."""
    name = typed.get("name", "").strip()
    match typed.get("add", ""):
        case "parameter":
            return {"parameters": {name: value_of(typed.get("value", ""))}}
        case "model":
            id, version = versioned(typed.get("model", ""))
            return {"models": {name or id: {"id": id, "version": version}}}
    group, _, removed = typed.get("remove", "").partition(".")
    return {group: {removed: None}}


_LIST = re.compile(r"/(designs(\?[!-~]*)?)?")
"""The address of a list of designs on this service."""


@router.post("/designs/{id}/rename")
async def rename(id: Id, request: Request, services: ThePageServices) -> Response:
    """Rename the design; its results stay unchanged."""
    typed = await fields(request)
    await services.change(id, typed.get("revision", ""), {"name": typed.get("name", "").strip()})
    return _back(typed)


@router.post("/designs/{id}/labels")
async def label(id: Id, request: Request, services: ThePageServices) -> Response:
    """Add or remove tags, or archive or restore the design."""
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
    """Redirect to the list from which the form was sent."""
    back = typed.get("back", "/")
    return go(back if _LIST.fullmatch(back) else "/")
