"""`…/models/{name}/fields`: fields on the surface of a crankshaft, as GLB and as a picture."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from fastapi import APIRouter, Response
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import TheCatalogues, TheDatabase
from app.api.file_answers import UNAVAILABLE, UNCHANGED
from app.api.responses import LATER
from app.designs import views
from app.designs.routes.designs import Id, Number
from app.designs.routes.files import ThePlainFileRequest
from app.designs.schemas import solid_fields as schemas
from app.designs.solid_fields import SolidField, field_of, fields_of
from app.http.attachments import MemoryFile, disposition, is_at_hand, tag, unchanged
from app.http.strict_requests import StrictRoute
from app.schemas.problems import RouteOptions, refusals
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from cad.field_mesh import Glb
from cad.file_kinds import MEDIA_TYPES
from cad.file_names import name as wide_name
from cad.file_names import plain_name

router = APIRouter(prefix="/api/v1/designs", tags=["files"], route_class=StrictRoute)

Painted = Literal["glb", "png"]
PAINTED: RouteOptions = {
    "response_class": Response,
    "responses": {
        200: {"content": {MEDIA_TYPES[kind]: {} for kind in ("glb", "png")}},
        **LATER,
        **UNCHANGED,
        **UNAVAILABLE,
        **refusals(404),
    },
}


@router.get("/{id}/revisions/{number}/models/{name}/fields", responses=refusals(404))
def list_solid_fields(
    id: Id, number: Number, name: Id, database: TheDatabase, catalogues: TheCatalogues
) -> schemas.SolidFieldList:
    """Return the fields that can be shown on a model: utilisation of fillets, torsional mode shapes.

    The utilisation needs a `fatigue_life` step that uses the tensors of the model's `unit_loads` and computes
    `load_use`. The mode shapes need a `forced_torsion` step that uses the stiffnesses of its `chain`.
    """
    with database.read() as session:
        fields = fields_of(session, catalogues.models, id, number, name)
    base = f"/api/v1/designs/{id}/revisions/{number}/models/{name}/fields"
    return schemas.SolidFieldList(items=[_shown(one, base) for one in fields.values()])


def _shown(one: SolidField, base: str) -> schemas.SolidField:
    glb, png = (f"{base}/{one.id}.{kind}" for kind in ("glb", "png"))
    return schemas.SolidField(
        id=one.id, title=one.title, unit=one.unit, low=one.low, high=one.high, glb=glb, png=png
    )


@router.get("/{id}/revisions/{number}/models/{name}/fields/{field}.{kind}", **PAINTED)
async def read_painted_solid(
    id: Id,
    number: Number,
    name: Id,
    field: Id,
    kind: Painted,
    request: ThePlainFileRequest,
    catalogues: TheCatalogues,
) -> Response:
    """Return a model whose surface colours show a field, as a GLB file or a picture.

    The part is grey where the field has no value. The GLB file's root node and the list of fields contain the
    title of the field and the values at the two ends of the colour scale.
    """
    database, store = request.database, request.store
    chosen = await run_in_threadpool(_chosen, database, catalogues, (id, number, name), field)
    plain = replace(request, if_none_match=None)
    answer = await plain.answer(lambda session: views.good_model(session, id, name, number), "glb")
    if answer.status_code != 200:  # the file is still being created, or cannot be created
        return answer
    painted = await run_in_threadpool(_painted, database, store, (id, number, name), chosen, kind)
    called = f"{name}_r{number}_{field}.{kind}"
    headers = {
        "ETag": tag(painted),
        "Cache-Control": "no-cache",
        "Content-Disposition": disposition(plain_name(called), wide_name(called), "inline"),
    }
    if is_at_hand(request.if_none_match, headers["ETag"]):
        return unchanged(headers)
    return MemoryFile(painted, MEDIA_TYPES[kind], headers)


def _chosen(
    database: Database, catalogues: TheCatalogues, place: tuple[str, int, str], field: str
) -> SolidField:
    with database.read() as session:
        return field_of(fields_of(session, catalogues.models, *place), field)


def _painted(
    database: Database, store: Artifacts, place: tuple[str, int, str], chosen: SolidField, kind: Painted
) -> bytes:
    id, number, name = place
    with database.read() as session:
        file = views.file(session, views.good_model(session, id, name, number), "glb")
    assert file is not None, "it was answered a moment ago"
    glb = Glb(store.read(file.sha256))
    field = chosen.on(glb)
    return glb.painted(field) if kind == "glb" else glb.picture(field)
