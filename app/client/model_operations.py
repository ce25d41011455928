"""The client's calls for CAD models, built-in and imported: each function is an exchange."""

from __future__ import annotations

import uuid

from app.client.exchange import BASE, Exchange, Progress, Request, answered, done, get, job_of
from app.client.files import File
from app.client.problem import checked
from app.imported_models.schemas import DrawingProgram, DrawingPrograms, ModelOrigin
from app.solids.schemas.models import CadModel

_PATH = "/models"


def drawing_programs() -> Exchange[list[DrawingProgram]]:
    """Return the programs that draw imported models, and how to install missing ones."""
    return (yield from answered(DrawingPrograms, get(f"{_PATH}/import"))).items


def import_model(
    id: str, content: bytes, file: str, *, key: str | None = None, on_progress: Progress | None = None
) -> Exchange[CadModel]:
    """Import a file as a version of a model; return the version once the service has examined it.

    The file is an .FCStd document, a STEP file, or a manifest for Creo. Two requests with the same key
    create one version. A file that already exists under this id keeps its version.

    Raises
    ------
    Problem
        If the file is refused, the id is in use, or the program that draws it is missing.
    """
    headers = {"Content-Type": "application/octet-stream", "Idempotency-Key": key or uuid.uuid4().hex}
    query = {"id": id, "file": file}
    response = checked((yield Request("POST", f"{BASE}{_PATH}/import", content, query, headers)))
    job = yield from done(job_of(response) or "", on_progress)
    return (yield from answered(CadModel, get((job.result or "").removeprefix(BASE))))


def model_version(id: str, version: int) -> Exchange[CadModel]:
    """Return one version of a CAD model with its parameters, and its origin if it was imported."""
    return answered(CadModel, get(f"{_PATH}/{id}/versions/{version}"))


def model_origin(id: str, version: int) -> Exchange[ModelOrigin]:
    """Return the file from which a model was imported, its parameters, and how far to trust its solids."""
    return answered(ModelOrigin, get(f"{_PATH}/{id}/versions/{version}/origin"))


def original_model(id: str, version: int) -> Exchange[File]:
    """Return, under its own name, the unchanged file from which a model was imported."""
    return File.of(checked((yield get(f"{_PATH}/{id}/versions/{version}/original"))))
