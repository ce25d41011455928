"""`/models`, `/builds`, `/artifacts` and `/verify`."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Path, Request, Response
from fastapi.responses import FileResponse
from pydantic import ConfigDict, Field, WithJsonSchema
from pydantic.config import JsonDict
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import TheCatalogues, TheDatabase, TheHealing, TheJobs, TheModels, TheStore
from app.api.file_answers import UNAVAILABLE, UNCHANGED, StoredFile, lost
from app.api.responses import LATER, accepted, finished, later, written
from app.catalogue.routes.templates import Number, listed, versions_of
from app.catalogue.schemas.templates import TemplateList, TemplateVersions
from app.http import problems
from app.http.access import TheClient, needs
from app.http.pages import Cursor, Limit
from app.http.query_names import KNOWN_NAMES
from app.http.strict_requests import StrictRoute, require_step
from app.imported_models.views import origin
from app.schemas.bounds import Bounded
from app.schemas.problems import refusals
from app.schemas.values import Parameters
from app.solids.models import File
from app.solids.questions import what_can_be_asked
from app.solids.schemas.models import Build, Verification
from app.solids.schemas.models import CadModel as ModelAnswer
from app.storage.artifacts import Artifacts
from app.storage.errors import ArtifactDamaged, ArtifactMissing, NotFound
from cad.file_kinds import MEDIA_TYPES, SHOWN, plain_kind
from cad.imported_models import imported_description
from cad.inspect import MEASURES
from cad.regenerate import build_key
from cad.tolerances import not_stated
from templates.core.errors import Fault, InvalidInputs
from templates.core.paper.schema import describe

router = APIRouter(prefix="/api/v1", tags=["models"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64, examples=["ball_bearing"])]
PATIENCE = "wait=30"
"""Time that an answer waits for a file that is still being created, unless the client states another [s]."""
FOR_EVER = "public, max-age=31536000, immutable"


FileKind = Annotated[str, WithJsonSchema({"type": "string", "enum": list(MEDIA_TYPES)})]


class BuildIn(Bounded):
    """A request to build a model from parameters."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={
            "examples": [{"parameters": {"inner_diameter": "48 mm"}, "artifacts": ["step", "glb"]}]
        },
    )

    parameters: Parameters = Field(description='quantities by name: `"48 mm"`; the others have defaults')
    artifacts: list[FileKind] = Field(
        list(SHOWN),
        max_length=50,
        description="kinds of files to create, besides STEP; by default those that a page shows",
    )


@router.get("/models")
def list_models(catalogues: TheCatalogues, limit: Limit = 100, cursor: Cursor = None) -> TemplateList:
    """Return every version of every CAD model."""
    return listed(catalogues.models, limit, cursor)


@router.get("/models/{id}", responses=refusals(404))
def list_model_versions(id: Id, catalogues: TheCatalogues) -> TemplateVersions:
    """Return the versions of one model."""
    return versions_of(catalogues.models, id)


@router.get("/models/{id}/versions/{number}", responses=refusals(404))
def show_model(id: Id, number: Number, catalogues: TheCatalogues, database: TheDatabase) -> ModelAnswer:
    """Return one model: its parameters as JSON Schema, its measurements, and its possible analyses."""
    cls = catalogues.models.get(id, number)
    described = describe(cls)
    parameters = described.pop("inputs")
    return ModelAnswer.model_validate(
        {
            **described,
            "parameters": parameters,
            "measures": {**MEASURES, **cls.further_measures()},
            "analyses": what_can_be_asked(cls),
            "film_bore": cls.film_bore,
            "picture": f"/api/v1/models/{id}/versions/{number}/picture",
            **({"origin": origin(database, id, number)} if imported_description(cls) else {}),
        }
    )


@router.get(
    "/models/{id}/versions/{number}/picture",
    response_class=FileResponse,
    responses={
        200: {"content": {"image/png": {}}},
        **LATER,
        **UNCHANGED,
        **UNAVAILABLE,
        **refusals(404, 429),
    },
)
async def show_picture(
    id: Id,
    number: Number,
    catalogues: TheCatalogues,
    models: TheModels,
    store: TheStore,
    jobs: TheJobs,
    client: TheClient,
    prefer: Annotated[str | None, Header()] = None,
) -> Response:
    """Return a picture (PNG) of the model's example."""
    cls = catalogues.models.get(id, number)
    shape = cls.from_quantities(cls.example)
    job = await run_in_threadpool(models.request, shape, ("step", "png"), client)
    if not await finished(jobs, job, prefer):
        return accepted(job)
    if failed := await run_in_threadpool(jobs.problem, job):
        return problems.answer(failed)
    return send_file(store, await run_in_threadpool(models.file, build_key(shape), "png"))


@router.post(
    "/models/{id}/versions/{number}/build",
    response_model=Build,
    responses={**later(Build), **refusals(404, 429)},
)
async def build_model(
    id: Id,
    number: Number,
    body: BuildIn,
    catalogues: TheCatalogues,
    models: TheModels,
    jobs: TheJobs,
    client: TheClient,
    prefer: Annotated[str | None, Header()] = None,
) -> Response:
    """Build a model, check it, and measure the finished STEP file. Equal parameters are built once."""
    unknown = [kind for kind in body.artifacts if kind not in MEDIA_TYPES]
    if unknown:
        offered = ", ".join(MEDIA_TYPES)
        raise InvalidInputs(
            Fault("artifacts", "unknown_name", f"{k[:40]!r} is not one of {offered}") for k in unknown
        )
    shape = catalogues.models.get(id, number).from_quantities(body.parameters)
    if faults := [*not_stated(type(shape), shape.ledger.typed)]:
        raise InvalidInputs(faults)
    kinds = tuple(dict.fromkeys(("step", *body.artifacts)))
    job = await run_in_threadpool(models.request, shape, kinds, client)
    if not await finished(jobs, job, prefer):
        return accepted(job, Build(build=build_key(shape), artifacts={}, measurements=None))
    if job and (failed := await run_in_threadpool(jobs.problem, job)):
        return problems.answer(failed)
    return written(await run_in_threadpool(models.show, build_key(shape)))


@router.get("/builds/{key}", responses=refusals(404))
def show_build(key: str, models: TheModels) -> Build:
    """Return a build with its files and measurements."""
    return models.show(key)


@router.get(
    "/builds/{key}/model.{kind}",
    dependencies=[KNOWN_NAMES],
    response_class=FileResponse,
    responses={
        200: {"content": {media: {} for media in MEDIA_TYPES.values()}},
        **LATER,
        **UNCHANGED,
        **UNAVAILABLE,
        **refusals(404, 429),
    },
)
async def read_file_of_build(
    key: str,
    kind: Id,
    models: TheModels,
    store: TheStore,
    healing: TheHealing,
    jobs: TheJobs,
    client: TheClient,
    prefer: Annotated[str | None, Header()] = None,
) -> Response:
    """Return a file of a build outside a design, so a drawing leaves the fields for a design empty.

    The file is created at the first request, and stored.
    """
    if kind not in MEDIA_TYPES:
        raise NotFound(f"there is no file model.{kind[:20]}; there are {', '.join(MEDIA_TYPES)}")
    prefer = prefer or PATIENCE
    build = await run_in_threadpool(models.show, key)
    if sha := build.artifacts.get(kind):
        if answer := await lost(sha, healing, jobs, prefer):
            return answer
    else:
        job = await run_in_threadpool(models.request_file, key, kind, client)
        if not await finished(jobs, job, prefer):
            return accepted(job)
        if failed := await run_in_threadpool(jobs.problem, job):
            return problems.answer(failed)
    assert build.model is not None, "a recorded build has its model"
    name = f"{build.model.id}_v{build.model.version}.{kind}"
    return send_file(store, await run_in_threadpool(models.file, key, kind), name=name)


@router.get(
    "/artifacts/{sha256}",
    response_class=FileResponse,
    responses={
        200: {"content": {"application/octet-stream": {}}},
        **UNCHANGED,
        **UNAVAILABLE,
        **refusals(404),
    },
)
async def read_artifact(
    sha256: str,
    store: TheStore,
    healing: TheHealing,
    jobs: TheJobs,
    prefer: Annotated[str | None, Header()] = None,
) -> Response:
    """Return the bytes with this hash, which never change. A lost file is rebuilt from its row."""
    if answer := await lost(sha256, healing, jobs, prefer, same=True):
        return answer
    headers = {"ETag": f'"{sha256}"', "Cache-Control": FOR_EVER}
    return StoredFile(store, sha256, "application/octet-stream", headers)


STEP_FILE: JsonDict = {"type": "string", "format": "binary"}
STEP_BODY: JsonDict = {"content": {"model/step": {"schema": STEP_FILE}}, "required": True}


@router.post(
    "/verify",
    dependencies=[needs("viewer")],
    response_model=Verification,
    openapi_extra={"requestBody": STEP_BODY},
    responses={**UNAVAILABLE, **refusals(404)},
)
async def verify_step(
    request: Request,
    models: TheModels,
    healing: TheHealing,
    jobs: TheJobs,
    prefer: Annotated[str | None, Header()] = None,
) -> Verification | Response:
    """Return the build of a STEP file, and the revisions that use it.

    The body is the file itself, sent as `model/step`; `application/step` and `application/p21` are synonyms.
    The header of the file, within the first 64 KiB, names the build. The stamp of a download, which names
    design and revision, is not compared. Limits, geometric tolerances, materials and other properties are
    read back and compared with those of the build, one by one.
    """
    require_step(request)
    body = await request.body()
    try:
        return await run_in_threadpool(models.verify, body)
    except (ArtifactMissing, ArtifactDamaged) as error:
        if answer := await lost(error.sha, healing, jobs, prefer):
            return answer
        return await run_in_threadpool(models.verify, body)


def send_file(
    store: Artifacts, file: File | None, headers: dict[str, str] | None = None, name: str | None = None
) -> Response:
    """Return a stored file, with its hash as ETag.

    Raises
    ------
    NotFound
        If the file's build was deleted in the meantime.
    """
    if file is None:
        raise NotFound("the build has just been deleted; send the request again to rebuild it")
    sent = {"ETag": f'"{file.sha256}"', **(headers or {})}
    return StoredFile(store, file.sha256, MEDIA_TYPES[plain_kind(file.kind)], sent, name)
