"""Preview how an unreleased worksheet would change a design; nothing is saved."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from pydantic import JsonValue

from app.designs.preview import PreviewRequest
from app.designs.routes.designs import list_designs
from app.designs.schemas.designs import Design, DesignSummary, Preview
from app.presentation import numbers
from app.web.shared.services import PageServices, Refused
from app.worksheets.schemas.worksheets import Sheet, SheetCheck

OFFERED = 50  # designs, newest first
PATIENCE = 5.0  # longest wait for slow steps of the design [s]
REFUSED = (404, 409, 413, 422, 429)


@dataclass(frozen=True)
class DraftChange:
    """A value of a design before the change, and with the draft."""

    name: str
    old: str
    new: str


@dataclass(frozen=True)
class DraftTrial:
    """A design with the draft: the changes, or why they cannot be calculated."""

    design: str
    step: str
    is_added: bool
    changes: list[DraftChange]
    reason: str = ""


async def offered(services: PageServices, sheet: Sheet) -> list[DesignSummary]:
    """Return the designs in which a draft can be tried; those that use the worksheet come first."""
    using = await services.run(list_designs, services.database, limit=OFFERED, template=sheet.id)
    rest = await services.run(list_designs, services.database, limit=OFFERED)
    return list({item.id: item for item in (*using.items, *rest.items)}.values())[:OFFERED]


async def tried_in(services: PageServices, id: str, sheet: Sheet, checked: SheetCheck) -> DraftTrial:
    """Return a design with the draft in place of the version that it uses, or as a new step."""
    name, is_added, step = sheet.id, True, dict[str, JsonValue]()
    try:
        design = await services.run(services.designs.show, id)
        name, is_added = _place(design, sheet)
        step = _step(sheet, checked, is_added=is_added)
        change = PreviewRequest(id, {"steps": {name: step}}, worksheet=False, system="si")
        preview, _ = await services.calculate(PATIENCE, services.previews.in_parts, change, services.client)
    except Refused as refused:
        if refused.status not in REFUSED:
            raise
        return DraftTrial(id, name, is_added, [], refused.sentence)
    return DraftTrial(design.name, name, is_added, list(_changes(preview)))


def _place(design: Design, sheet: Sheet) -> tuple[str, bool]:
    """Return the step that uses the worksheet, or the name for a new step, and whether it is new."""
    using = next((name for name, step in design.steps.items() if step.template == sheet.id), None)
    if using is not None:
        return using, False
    taken = {*design.parameters, *design.steps, *design.models}
    return next(name for name in _names(sheet.id) if name not in taken), True


def _names(id: str) -> Iterator[str]:
    yield id
    count = 2
    while True:
        yield f"{id}_{count}"
        count += 1


def _step(sheet: Sheet, checked: SheetCheck, *, is_added: bool) -> dict[str, JsonValue]:
    if not is_added:
        return {"version": sheet.version}
    example = checked.template.example if checked.template else {}
    return {"template": sheet.id, "version": sheet.version, "inputs": {**example}}


def _changes(preview: Preview) -> Iterator[DraftChange]:
    """Yield outputs and model parameters that differ."""
    sides: dict[str, tuple[object, object]] = {n: (c.old, c.new) for n, c in preview.outputs.items()}
    sides |= {name: (change.old, change.new) for name, change in preview.model_parameters.items()}
    for name, (old, new) in sides.items():
        if (before := numbers.in_line(old) or "–") != (after := numbers.in_line(new) or "–"):
            yield DraftChange(name, before, after)
