"""The page for the bearings of an engine: a form that proposes values, and creates the design."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import groupby

from fastapi import APIRouter, Depends, Request, Response
from pydantic import JsonValue

from app.designs.bodies import LONGEST_NOTE, DesignIn
from app.designs.routes.designs import document_of
from app.web.engine_bearings.fields import OIL, QUANTITIES, Typing
from app.web.engine_bearings.gas import Diagram, diagram_of
from app.web.engine_bearings.layouts import LAYOUTS
from app.web.engine_bearings.pictures import PICTURES
from app.web.engine_bearings.proposal import DIAGRAM, PETROL, Proposal, propose, proposed_values
from app.web.engine_bearings.ratios import Ratio
from app.web.shared.multipart import forms_with_files, parts_of
from app.web.shared.responses import go, has_decimal_comma, show, units_of
from app.web.shared.services import PageServices, Refused, ThePageServices
from templates.core.errors import FaultyText

PATH = "/engine-bearings"
TABLE = "diagram_table"
GASES = {
    PETROL: "Ideal cycle of a petrol engine",
    "diesel": "Ideal cycle of a charged diesel engine",
    DIAGRAM: "Indicator diagram",
}
WRONG = 422
NAME = re.compile(r"[A-Za-z_]\w*")

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_with_files)])


@router.get(PATH)
async def empty_form(request: Request, services: ThePageServices) -> Response:
    """Return the empty form."""
    return _page(request, services, dict(request.query_params), Proposal({}, {}), None)


@forms.post(PATH)
async def create(request: Request, services: ThePageServices) -> Response:
    """Create the design, or return the form with its proposals and faults."""
    parts = await parts_of(request)
    typed = {name: part.text for name, part in parts.items() if part.file is None}
    file = bytes(parts[DIAGRAM].content) if DIAGRAM in parts else b""
    typed |= {"gas": DIAGRAM} if file else {}
    diagram, fault = await services.run(_read, file, typed)
    proposal = await services.run(propose, typed, diagram, _typing(request))
    faults = {**proposal.faults, **({DIAGRAM: fault} if fault else {})}
    if typed.get("wanted") == "check":
        entered = {name for name, text in typed.items() if text.strip()} | ({DIAGRAM} if fault else set())
        begun = {name: detail for name, detail in faults.items() if name in entered}
        return _page(request, services, typed, proposal, diagram, begun)
    if faults:
        return _page(request, services, typed, proposal, diagram, faults, WRONG)
    try:
        return await _created(services, proposal.document, diagram)
    except Refused as refused:
        if refused.status != WRONG:
            raise
        return _page(request, services, typed, proposal, diagram, _by_field(proposal, refused), WRONG)


def _typing(request: Request) -> Typing:
    """Return how the user types: in the units and with the decimal sign chosen at the top of the page."""
    return Typing(units_of(request), has_decimal_comma(request))


def _read(file: bytes, typed: Mapping[str, str]) -> tuple[Diagram | None, str]:
    """Return the indicator diagram in a file or a pasted table, or why it is refused."""
    body = file or typed.get(TABLE, "").strip().encode()
    if typed.get("gas") != DIAGRAM or not body:
        return None, ""
    try:
        return diagram_of(body), ""
    except FaultyText as error:
        return None, str(error)


async def _created(
    services: PageServices, document: Mapping[str, JsonValue], diagram: Diagram | None
) -> Response:
    """Create the design, and go to its page; the note states how the diagram was read."""
    note = {"note": f"indicator diagram: {'; '.join(diagram.assumed)}"[:LONGEST_NOTE]} if diagram else {}
    raw, said = document_of(services.read(DesignIn, {**document, **note}))
    saved = await services.save(services.designs.create, raw, said, services.once)
    return go(f"/designs/{saved.design}")


def _by_field(proposal: Proposal, refused: Refused) -> dict[str, str]:
    """Return the faults of a refused design by the field that states the value."""
    return {_field_of(proposal, name): detail for name, detail in refused.faults.items()} or {
        "design": refused.problem.detail
    }


def _field_of(proposal: Proposal, name: str) -> str:
    """Return the field of an input such as `engine.rod_length`: the parameter that its relation names."""
    block, _, tail = name.rpartition(".")
    step = _inside(_inside(proposal.document.get("steps"), block), "inputs")
    names = NAME.findall(str(step.get(tail, "")))
    fields = [*QUANTITIES, *proposal.offers]
    return next((one for one in [tail, *names] if one in fields), name)


def _inside(outer: JsonValue, name: str) -> dict[str, JsonValue]:
    inner = outer.get(name) if isinstance(outer, dict) else None
    return inner if isinstance(inner, dict) else {}


def _grouped(offers: Mapping[str, Ratio]) -> dict[str, dict[str, Ratio]]:
    """Return the proposals under their headings."""
    items = sorted(offers.items(), key=lambda item: item[1].group)
    return {group: dict(inside) for group, inside in groupby(items, key=lambda item: item[1].group)}


def _page(
    request: Request,
    services: PageServices,
    typed: Mapping[str, str],
    proposal: Proposal,
    diagram: Diagram | None,
    faults: Mapping[str, str] | None = None,
    status: int = 200,
) -> Response:
    faults = faults or {}
    placed = {"layout", "gas", "oil", DIAGRAM, *QUANTITIES, *proposal.offers}
    return show(
        request,
        "engine_bearings/engine_bearings.html",
        status,
        layouts=LAYOUTS,
        quantities=QUANTITIES,
        typing=_typing(request),
        oil=OIL,
        gases=GASES,
        pictures=PICTURES,
        typed={**typed, **({TABLE: diagram.text} if diagram else {})},
        gas=typed.get("gas", PETROL),
        diagram=diagram,
        offers=_grouped(proposal.offers),
        values=proposed_values(proposal.parameters, proposal.offers, services.catalogues, units_of(request)),
        faults={name: detail for name, detail in faults.items() if name in placed},
        loose={name: detail for name, detail in faults.items() if name not in placed},
        opened={one.group for name, one in proposal.offers.items() if name in faults or typed.get(name)},
        notice="Nothing was saved. The reason is shown next to each field in red." if status == WRONG else "",
    )
