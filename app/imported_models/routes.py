"""`/models/import` and related paths: import models, and show where they come from."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Query, Response

from app.api.dependencies import (
    TheDatabase,
    TheIdentity,
    TheModelImports,
    TheOnce,
    TheStore,
    TheThreads,
    require_room,
)
from app.api.file_answers import UNCHANGED, StoredFile
from app.api.responses import FILE_LATER, file_accepted
from app.catalogue.routes.templates import Number
from app.http.strict_requests import MODEL_TYPES, StrictRoute, require_model
from app.http.uploads import UploadRequest, UploadRoute
from app.imported_models.programs import SET_CREO
from app.imported_models.schemas import DrawingProgram, DrawingPrograms, ModelOrigin
from app.imported_models.views import origin
from app.schemas.problems import refusals
from app.solids.routes.models import Id

router = APIRouter(prefix="/api/v1/models", tags=["models"], route_class=StrictRoute)

BINARY = {"schema": {"type": "string", "format": "binary"}}
BODY = {"requestBody": {"required": True, "content": dict.fromkeys(sorted(MODEL_TYPES), BINARY)}}
uploads = APIRouter(prefix="/api/v1/models", tags=["models"], route_class=UploadRoute)
NewId = Annotated[
    str,
    Query(
        max_length=64,
        pattern=r"^[a-z][a-z0-9]*(_[a-z0-9]+)*$",
        description="of the model: small letters, digits and single _",
        examples=["main_cap"],
    ),
]
FileName = Annotated[
    str, Query(max_length=200, pattern=r"^[^\x00-\x1f\x7f]+$", description="how the file is called")
]


@router.get("/import")
def list_programs(imports: TheModelImports) -> DrawingPrograms:
    """Return the programs that draw imported models, and how to install missing ones."""
    reason, place = imports.available()
    freecad = DrawingProgram(
        name="FreeCAD",
        files=".FCStd",
        available=reason is None,
        detail=reason or f"its modules are in {place}",
    )
    fixed = DrawingProgram(
        name="STEP", files=".step, .stp", available=True, detail="a fixed part without parameters"
    )
    drives = "creo" in imports.programs.by_name
    creo = DrawingProgram(
        name="Creo",
        files=".json, a manifest",
        available=drives,
        detail="driven through CREOSON" if drives else SET_CREO,
    )
    return DrawingPrograms(items=[freecad, creo, fixed])


@uploads.post(
    "/import",
    status_code=202,
    responses={**FILE_LATER, **refusals(409, 429, 503, 507)},
    openapi_extra=BODY,
    dependencies=[Depends(require_model), Depends(require_room)],
)
async def import_model(
    request: UploadRequest,
    imports: TheModelImports,
    identity: TheIdentity,
    threads: TheThreads,
    once: TheOnce,
    id: NewId,
    file: FileName = "model",
) -> Response:
    """Import a FreeCAD file (.FCStd) or a manifest as a model, or a STEP file as a fixed part.

    Aliases of spreadsheet cells and named constraints of sketches become parameters. Macros and Python
    features never run: a file that has them is refused. The result of the job is the version of the model. A
    file with an existing id becomes its next version. The file may have up to 200 MiB
    (`CRANKWRIGHT_UPLOAD_LIMIT`).
    """
    content = memoryview(await request.file())
    job = await threads.run(imports.begin, content, id, file, once)
    return await threads.run(file_accepted, job, identity)


@router.get("/{id}/versions/{number}/origin", responses=refusals(404))
def read_origin(id: Id, number: Number, database: TheDatabase) -> ModelOrigin:
    """Return the origin of an imported model: its file, its parameters there, and its solids' checks."""
    return origin(database, id, number)


@router.get(
    "/{id}/versions/{number}/original",
    response_class=Response,
    responses={200: {"content": {"application/octet-stream": {}}}, **UNCHANGED, **refusals(404, 503)},
)
def read_original_model(id: Id, number: Number, database: TheDatabase, store: TheStore) -> Response:
    """Return the file from which a model was imported, unchanged."""
    shown = origin(database, id, number)
    headers = {"ETag": f'"{shown.sha256}"'}
    return StoredFile(store, shown.sha256, "application/octet-stream", headers, shown.file)
