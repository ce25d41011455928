"""The page that upgrades a design to another version of a template: a preview, and a button to save it."""

from __future__ import annotations

import re
from typing import NamedTuple

from fastapi import APIRouter, Depends, Request, Response

from app.calculations.schemas.evaluations import Output
from app.catalogue.routes.templates import show_template
from app.designs.preview import PreviewRequest
from app.designs.routes.revisions import show_revision
from app.designs.schemas.designs import Design, Preview
from app.presentation import numbers
from app.presentation.criteria import line
from app.schemas.answers import Quantity
from app.solids.schemas.analyses import AnalysisOutput
from app.web.shared.forms import Patch, fields, forms_only
from app.web.shared.paths import Id, Text
from app.web.shared.responses import go, show, units_of
from app.web.shared.services import PageServices, Refused, ThePageServices
from templates.core.errors import FaultyText
from templates.core.units.units import require_same_kind, unit

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])

ILL_NAMED, STALE, MISSING = 422, 412, 404
PATIENCE = 10  # longest wait for slow steps [s]; those that take longer are shown as pending
_ID = re.compile(r"[A-Za-z0-9_]{1,64}")
_VERSION = re.compile(r"[1-9][0-9]{0,5}")


class ValueChange(NamedTuple):
    """A value that changes, as text."""

    name: str
    old: str
    new: str


@router.get("/designs/{id}/upgrade")
async def upgrade_page(
    id: Id, request: Request, services: ThePageServices, template: Text = "", version: Text = ""
) -> Response:
    """Return the page with the effects of the upgrade; nothing is saved."""
    return await _page(request, services, id, template, version)


@forms.post("/designs/{id}/upgrade")
async def upgrade(id: Id, request: Request, services: ThePageServices) -> Response:
    """Create a revision with the new version; if it is refused, return the preview with the reason."""
    typed = await fields(request)
    template, version = typed.get("template", ""), typed.get("version", "")
    design = await services.run(services.designs.show, id)
    patch = _patch(design, template, _number(template, version))
    try:
        await services.change(id, typed.get("revision", ""), patch, f"{template} version {version}")
    except Refused as refused:
        if refused.status not in (ILL_NAMED, STALE):
            raise
        return await _page(request, services, id, template, version, refused)
    return go(f"/designs/{id}")


def _number(template: str, version: str) -> int:
    """Return the version in a form or an address.

    Raises
    ------
    Refused
        If it is missing or not a number.
    """
    if not (_ID.fullmatch(template) and _VERSION.fullmatch(version)):
        raise Refused.because(
            MISSING, "name a template and one of its versions: ?template=oil_film&version=2"
        )
    return int(version)


def _patch(design: Design, template: str, version: int) -> Patch:
    """Return the merge patch that changes the version of every step of a template but not its inputs."""
    steps = design.steps.items()
    return {"steps": {name: {"version": version} for name, step in steps if step.template == template}}


async def _page(
    request: Request,
    services: PageServices,
    id: str,
    template: str,
    version: str,
    refused: Refused | None = None,
) -> Response:
    number = _number(template, version)
    design = await services.run(services.designs.show, id)
    newer = await services.find(show_template, template, number, services.catalogues)  # not of a draft
    used = {name: step.version for name, step in design.steps.items() if step.template == template}
    if not used:
        raise Refused.because(MISSING, f"no step of the design uses {template}")
    preview = None
    try:
        change = PreviewRequest(
            id, _patch(design, template, number), worksheet=False, system=units_of(request)
        )
        preview = await services.calculate(PATIENCE, services.previews.at_once, change)
    except Refused as wrong:
        if wrong.status != ILL_NAMED:
            raise
        if newer is None:  # no version, or a draft with faults; the error states which
            await services.run(show_template, template, number, services.catalogues)
        refused = refused or wrong
    revision = await services.run(show_revision, id, design.revision, services.database)
    before = {criterion.name: criterion.verdict for criterion in revision.criteria or ()}
    return show(
        request,
        "upgrade/upgrade.html",
        status=refused.status if refused else 200,
        design=design,
        template=template,
        version=number,
        is_released=newer is not None,
        withdrawn=newer.withdrawn if newer else None,
        used=used,
        is_due=any(one != number for one in used.values()),
        preview=preview,
        criteria=[(line(one), before.get(one.name)) for one in (preview.criteria if preview else None) or ()],
        moved=_moved(preview) if preview else [],
        others=_of_one_version(preview) if preview else [],
        parameters=_parameters(preview) if preview else [],
        refusal=refused.problem if refused else None,
    )


def _moved(preview: Preview) -> list[ValueChange]:
    """Return the outputs whose values differ between the two versions."""
    both = {name: (one.old, one.new) for name, one in preview.outputs.items() if one.old and one.new}
    rows = [
        ValueChange(name, _in_unit_of(old, new), numbers.in_line(new)) for name, (old, new) in both.items()
    ]
    return [one for one in rows if one.old != one.new]


def _of_one_version(preview: Preview) -> list[ValueChange]:
    """Return the outputs that only one of the versions has."""
    outputs = preview.outputs.items()
    rows = [ValueChange(name, numbers.in_line(one.old), numbers.in_line(one.new)) for name, one in outputs]
    return [one for one in rows if not (one.old and one.new)]


def _in_unit_of(old: Output | AnalysisOutput, new: Output | AnalysisOutput) -> str:
    """Return a value as text, in the unit of another value if both have the same kind."""
    value, given, wanted = old.value, old.unit, new.unit
    if not isinstance(value, float) or not given or not wanted or given == wanted:
        return numbers.in_line(old)
    try:
        scale = require_same_kind(given, wanted)
    except FaultyText:
        return numbers.in_line(old)
    return numbers.in_line(Quantity(value=float(unit(wanted).from_si(scale.to_si(value))), unit=wanted))


def _parameters(preview: Preview) -> list[ValueChange]:
    """Return the parameters of models that change."""
    changes = preview.model_parameters.items()
    rows = [
        ValueChange(n, numbers.in_line(one.old), numbers.in_line(one.new))
        for n, one in changes
        if one.status == "ok"
    ]
    return [one for one in rows if one.old != one.new]
