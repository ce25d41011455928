"""`/designs/{id}/model` and its kin: the newest good model, or that of a revision, in the kind asked for."""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import APIRouter, Header, Response
from fastapi.responses import FileResponse
from starlette.concurrency import run_in_threadpool

from app.api import problems
from app.api.dependencies import TheDatabase, TheHealing, TheJobs, TheModels, TheStore
from app.api.gate.clients import TheClient
from app.api.reading import StrictRoute
from app.api.routes.designs import Id, Number, Prefer
from app.api.routes.models import send_file
from app.api.stored import UNAVAILABLE, lost
from app.api.waiting import LATER, accepted, accepted_kinds, finished
from app.designs import views
from app.schemas.problems import RouteOptions
from app.solids.models import File
from app.storage.errors import NotFound
from app.storage.tables import RevisionModelRow
from cad.export import MEDIA_TYPES

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)

FILES: RouteOptions = {
    "response_class": FileResponse,
    "responses": {200: {"content": {media: {} for media in MEDIA_TYPES.values()}}, **LATER, **UNAVAILABLE},
}

Accept = Annotated[str | None, Header(description=", ".join(MEDIA_TYPES.values()))]


@router.get("/{id}/model", **FILES)
@router.get("/{id}/model.{kind}", **FILES)
@router.get("/{id}/models/{name}/model", **FILES)
@router.get("/{id}/models/{name}/model.{kind}", **FILES)
@router.get("/{id}/revisions/{number}/model", **FILES)
@router.get("/{id}/revisions/{number}/model.{kind}", **FILES)
@router.get("/{id}/revisions/{number}/models/{name}/model", **FILES)
@router.get("/{id}/revisions/{number}/models/{name}/model.{kind}", **FILES)
async def read_model_file(
    id: Id,
    database: TheDatabase,
    store: TheStore,
    models: TheModels,
    jobs: TheJobs,
    client: TheClient,
    healing: TheHealing,
    name: Id | None = None,
    kind: Id | None = None,
    number: Number | None = None,
    accept: Accept = None,
    prefer: Prefer = None,
) -> Response:
    """A file of a model; other kinds than STEP are made when first asked for."""
    wanted = kind or _accepted(accept)
    if wanted not in MEDIA_TYPES:
        raise NotFound(f"there is no model.{wanted[:20]}; there are {', '.join(MEDIA_TYPES)}")

    def find() -> tuple[RevisionModelRow, str, File | None]:
        with database.read() as session:
            model = views.good_model(session, id, name, number)
            return model, model.build_key or "", views.file(session, model, wanted)

    model, key, file = await run_in_threadpool(find)
    if file is None:
        job = await run_in_threadpool(lambda: models.request_file(key, wanted, client))
        if not await finished(jobs, job, prefer):
            return accepted(job)
        if failed := await run_in_threadpool(lambda: jobs.get(job).problem):
            return problems.answer(failed)
        file = await run_in_threadpool(models.file, key, wanted)
    elif answer := await lost(file.sha256, healing, jobs, prefer):
        return answer
    else:
        file = await run_in_threadpool(models.file, key, wanted)
    headers = {"Design-Revision": str(model.number), "Vary": "Accept"}
    return send_file(store, file, headers, f"{model.model}_v{model.model_version}.{wanted}")


def _accepted(accept: str | None) -> str:
    """The kind that the client likes best, of those it likes equally the first; STEP by default."""
    kinds = {media: kind for kind, media in MEDIA_TYPES.items()}
    liked = [(_weight(more), kinds[media]) for media, more in accepted_kinds(accept) if media in kinds]
    return max(liked, key=lambda pair: pair[0], default=(1.0, "step"))[1]


def _weight(parameters: str) -> float:
    found = re.search(r"\bq=([01](?:\.[0-9]{0,3})?)", parameters)
    return float(found[1]) if found else 1.0
