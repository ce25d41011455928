"""The page that adds a bought part to a model of a design, by writing the manifest of an assembly.

The assembly is imported like any other model, and then replaces the model in the design.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping

from fastapi import APIRouter, Depends, Request, Response
from pydantic import JsonValue, TypeAdapter

from app.catalogue.schemas.templates import TemplateSummary
from app.designs.schemas.designs import Design, DesignModel
from app.solids.routes.models import list_models, show_model
from app.web.model_import.routes import FORM, imported_version
from app.web.shared.design_answers import job_of
from app.web.shared.file_form import MISSED
from app.web.shared.forms import fields, forms_only
from app.web.shared.paths import Id
from app.web.shared.responses import go, show
from app.web.shared.services import PageServices, Refused, ThePageServices
from cad.imported_models import imported_description

PATIENCE = 15.0
"""Time that the page waits for the import, which draws imported models that are not STEP files [s]."""
GLANCE = 0.1  # [s]
PLACES = ("x", "y", "z", "turn_x", "turn_y", "turn_z")
FIELDS = ("component", "source", "design", "part", "datum", *PLACES, "may_overlap", "id")
_MANIFEST = TypeAdapter(dict[str, JsonValue])
_STALE = 412

router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, dependencies=[Depends(forms_only)])


@router.get("/designs/{id}/models/{name}/beside")
async def beside_form(request: Request, services: ThePageServices, id: Id, name: Id) -> Response:
    """Return the form to choose the part and its position."""
    design = await services.run(services.designs.show, id)
    return await _form(request, services, design, name, {})


@forms.post("/designs/{id}/models/{name}/beside")
async def put_beside(request: Request, services: ThePageServices, id: Id, name: Id) -> Response:
    """Create the assembly and use it in the design; if this is refused, return the form with the reason."""
    typed = {key: text.strip() for key, text in (await fields(request)).items() if key in FIELDS}
    design = await services.run(services.designs.show, id)
    try:
        version = await _imported(services, typed, await _manifest(services, _model(design, name), typed))
        note = f"{typed.get('component', '')[:40]} beside {name}"
        await services.change(id, str(design.revision), {"models": {name: version}}, note)
    except Refused as refused:
        if refused.status not in (*MISSED, _STALE):
            raise
        return await _form(request, services, design, name, typed, refused.sentence, refused.status)
    return go(f"/designs/{id}")


def _model(design: Design, name: str) -> DesignModel:
    if name not in design.models:
        raise Refused.because(404, f"this design has no model {name!r}")
    return design.models[name]


async def _manifest(
    services: PageServices, model: DesignModel, typed: Mapping[str, str]
) -> dict[str, JsonValue]:
    """Return the manifest of the model's assembly, including the part in the form.

    If the model is not an assembly, the manifest is new.
    """
    described = await services.run(
        show_model, model.id, model.version, services.catalogues, services.database
    )
    if described.origin is not None and described.origin.program == "assembly":
        manifest = _MANIFEST.validate_json(await services.run(services.store.read, described.origin.sha256))
    else:
        base: JsonValue = {"model": model.id, "version": model.version}
        manifest = {"program": "assembly", "title": f"Assembly {typed.get('id', '')}", "base": base}
    there = manifest.get("components", [])
    return {**manifest, "components": [*(there if isinstance(there, list) else []), _component(typed)]}


def _component(typed: Mapping[str, str]) -> dict[str, JsonValue]:
    """Return the manifest entry for the part in the form."""
    entry: dict[str, JsonValue] = {"name": typed.get("component", "")}
    if model := typed.get("source", ""):
        id, _, version = model.partition(":")
        entry |= {"model": id, "version": int(version) if version.isdecimal() and len(version) < 7 else 0}
    entry |= {key: typed[key] for key in ("design", "part", "datum", *PLACES) if typed.get(key)}
    if names := typed.get("may_overlap", "").replace(",", " ").split():
        entry["may_overlap"] = list[JsonValue](names)
    return entry


async def _imported(
    services: PageServices, typed: Mapping[str, str], manifest: Mapping[str, JsonValue]
) -> dict[str, JsonValue]:
    """Return the version of the model that a manifest creates, in the form that a design needs.

    Raises
    ------
    Refused
        If the import is refused or takes too long; the error states the reason.
    """
    id = typed.get("id", "")
    content = json.dumps(manifest, ensure_ascii=False, indent=1).encode()
    job = await FORM.begun(services, memoryview(content), id, f"{id[:64] or 'assembly'}.json")
    for _ in range(round(PATIENCE / GLANCE)):
        work = await job_of(services, job)
        if work.problem is not None:
            raise Refused(work.problem)
        if work.state == "done" and (version := imported_version(work.result or "")):
            return {"id": version[0], "version": version[1]}
        await asyncio.sleep(GLANCE)
    raise Refused.because(503, "the server is busy: the assembly has not been created; send the form again")


async def _form(
    request: Request,
    services: PageServices,
    design: Design,
    name: str,
    typed: Mapping[str, str],
    notice: str = "",
    status: int = 200,
) -> Response:
    model = _model(design, name)
    described = await services.run(
        show_model, model.id, model.version, services.catalogues, services.database
    )
    is_assembly = described.origin is not None and described.origin.program == "assembly"
    usual = {"datum": "origin", "id": model.id if is_assembly else f"{model.id[:50]}_with_parts"}
    return show(
        request,
        "second_part/second_part.html",
        status,
        design=design,
        model_name=name,
        model=described,
        typed={**dict.fromkeys(FIELDS, ""), **usual, **typed},
        notice=notice,
        bought=await _bought(services),
    )


async def _bought(services: PageServices) -> list[TemplateSummary]:
    """Return the newest version of each imported model that has a file of its own and is not an assembly."""
    items = (await services.run(list_models, services.catalogues, limit=500)).items
    models = services.catalogues.models
    return [
        item
        for item in items
        if item.latest
        and (about := imported_description(models.get(item.id, item.version))) is not None
        and about.program != "assembly"
    ]
