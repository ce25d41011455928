"""`/designs/{id}/variants`: the table of a design's variants, and their files, one by one or as a ZIP."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response
from fastapi.responses import StreamingResponse
from pydantic import ConfigDict, Field
from pydantic.config import JsonDict
from starlette.concurrency import run_in_threadpool

from app.api.answers import answered
from app.api.dependencies import (
    ExpensiveSteps,
    TheCatalogues,
    TheDatabase,
    TheDesigns,
    TheHealing,
    TheJobs,
    TheOnce,
    TheStampKeys,
    TheStore,
    TheThreads,
    TheVariantDetails,
    Units,
)
from app.api.file_answers import UNAVAILABLE, lost
from app.api.responses import LATER, finished, later, patience, written
from app.catalogue.catalogues import Catalogues
from app.designs import stamps
from app.designs.bodies import Note
from app.designs.document import Overrides, Word
from app.designs.routes.designs import Id, IfMatch, Number, Prefer
from app.designs.routes.files import FILES, IfNoneMatch, TheFileRequest
from app.designs.routes.sheet_types import ANSWERS, BODIES
from app.designs.schemas.variants import VariantDetail, VariantsOut
from app.designs.service import Designs, SaveResult
from app.designs.variants import views
from app.designs.variants.detail import WantedVariant
from app.designs.variants.files import STEP, Entry, entries, variant_model
from app.designs.variants.names import MOST_VARIANTS
from app.designs.variants.save import replace_variants as replaced
from app.http.access import TheClient
from app.http.archives import MEDIA_TYPE, archived, distinct
from app.http.attachments import is_at_hand, named, unchanged
from app.http.strict_requests import StrictRoute
from app.jobs.service import Jobs
from app.presentation.units import System
from app.schemas.bounds import Bounded, at_most
from app.schemas.problems import Responses, refusals
from app.signing.keys import StampKeys
from app.storage.artifacts import Artifacts
from app.storage.database import Database

router = APIRouter(
    prefix="/api/v1/designs", tags=["variants"], route_class=StrictRoute, dependencies=[ExpensiveSteps]
)

VariantName = Annotated[str, Path(max_length=64, examples=["main_2"])]
MISSING = "Variants-Missing"
"""The header that lists models without a finished solid, which are missing in the ZIP."""
Outputs = Annotated[
    list[str],
    Query(
        alias="output",
        max_length=100,
        description="name of a step output to return; repeat the parameter for more outputs",
    ),
]


class VariantsIn(Bounded):
    """The complete table of a design's variants."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={
            "examples": [{"variants": {"small": {"scale": "0.9"}, "large": {"scale": "1.1"}}, "note": "two"}]
        },
    )

    variants: Annotated[dict[Word, Overrides], Field(max_length=MOST_VARIANTS), at_most(MOST_VARIANTS)] = (
        Field(description="variants by name; variants that are not named here are removed")
    )
    note: str | None = Note


@router.get("/{id}/variants", responses={200: {"content": ANSWERS}, **refusals(404)})
@router.get("/{id}/revisions/{number}/variants", responses=refusals(404))
def show_variants(
    id: Id,
    database: TheDatabase,
    catalogues: TheCatalogues,
    response: Response,
    number: Number | None = None,
    output: Outputs = [],  # noqa: B006 - FastAPI copies it
    units: Units = "si",
) -> VariantsOut:
    """Return the variants of a design: their overrides, verdicts and models, and the governing variant.

    The ETag is the revision; `PUT` expects it as If-Match.
    """
    out = variants_of(id, number, database, catalogues, output, units)
    response.headers["ETag"] = f'"{out.revision}"'
    return out


def variants_of(
    id: str,
    number: int | None,
    database: Database,
    catalogues: Catalogues,
    outputs: Sequence[str] = (),
    units: System = "si",
) -> VariantsOut:
    """Return the variants of a revision, by default the newest, with the selected outputs of steps."""
    with database.read() as session:
        return views.variants(session, id, number, catalogues, dict.fromkeys(outputs)).in_units(units)


@router.put(
    "/{id}/variants",
    response_model=VariantsOut,
    responses={**later(VariantsOut), **refusals(404, 429)},
    openapi_extra=BODIES,
)
async def replace_variants(
    id: Id,
    body: VariantsIn,
    designs: TheDesigns,
    threads: TheThreads,
    jobs: TheJobs,
    once: TheOnce,
    request: Request,
    if_match: IfMatch = None,
    prefer: Prefer = None,
) -> Response:
    """Create a revision with this table of variants; an unchanged table creates none.

    Solids are built once for each distinct set of parameters. If the solid of a variant fails, that variant
    gives the reason and the others are not affected.
    """
    save = partial(replaced, designs, id, body.variants, body.note, if_match, once)
    saved = await threads.run_within(patience(prefer, math.inf), request, save)
    return await answer_table(designs, jobs, saved, prefer)


async def answer_table(designs: Designs, jobs: Jobs, saved: SaveResult, prefer: str | None) -> Response:
    """Return the saved table with status 200, or 202 while solids are built."""
    is_done = not saved.is_deferred and await finished(jobs, saved.job, prefer)
    return await run_in_threadpool(_table, designs, saved, is_done)


def _table(designs: Designs, saved: SaveResult, is_done: bool) -> Response:
    with designs.database.read() as session:
        out = views.variants(session, saved.design, saved.revision, designs.catalogues)
    place = (
        f"/api/v1/jobs/{saved.job}"
        if saved.job and not is_done
        else f"/api/v1/designs/{saved.design}/variants"
    )
    headers = {"ETag": f'"{saved.revision}"', "Location": place}
    return written(out, 200 if is_done else 202, headers)


@router.get(
    "/{id}/variants/{variant}", response_model=VariantDetail, responses={**LATER, **refusals(404, 422, 429)}
)
@router.get(
    "/{id}/revisions/{number}/variants/{variant}",
    response_model=VariantDetail,
    responses={**LATER, **refusals(404, 422, 429)},
)
async def show_variant(
    id: Id,
    variant: VariantName,
    details: TheVariantDetails,
    client: TheClient,
    request: Request,
    number: Number | None = None,
    output: Outputs = [],  # noqa: B006 - FastAPI copies it
    units: Units = "si",
    prefer: Prefer = None,
) -> Response:
    """Return one variant with its outputs, curves included; `base` is the design itself."""
    wanted = WantedVariant(id, variant, tuple(dict.fromkeys(output)), number, units)
    return await answered(details, wanted, request, client, patience(prefer, details.steps.deadline))


@router.get("/{id}/variants/{variant}/model", **FILES)
@router.get("/{id}/variants/{variant}/model.{kind}", **FILES)
@router.get("/{id}/variants/{variant}/models/{name}/model", **FILES)
@router.get("/{id}/variants/{variant}/models/{name}/model.{kind}", **FILES)
@router.get("/{id}/revisions/{number}/variants/{variant}/model", **FILES)
@router.get("/{id}/revisions/{number}/variants/{variant}/model.{kind}", **FILES)
@router.get("/{id}/revisions/{number}/variants/{variant}/models/{name}/model", **FILES)
@router.get("/{id}/revisions/{number}/variants/{variant}/models/{name}/model.{kind}", **FILES)
async def read_variant_file(
    id: Id,
    variant: VariantName,
    request: TheFileRequest,
    name: Id | None = None,
    kind: Id | None = None,
    number: Number | None = None,
) -> Response:
    """Return a file of a variant's model, named after its design, variant and revision.

    Without a revision number, the file comes from the newest revision in which the variant's solid is
    finished.
    """
    return await request.answer(lambda session: variant_model(session, id, variant, name, number), kind)


ZIP_FILE: JsonDict = {"type": "string", "format": "binary"}
ZIPPED: Responses = {
    200: {
        "content": {MEDIA_TYPE: {"schema": ZIP_FILE}},
        "headers": {
            MISSING: {"description": "models without a finished solid", "schema": {"type": "string"}}
        },
    },
    304: {"description": "unchanged since the ETag in If-None-Match"},
    **UNAVAILABLE,
    **refusals(404),
}


@router.get("/{id}/variants.zip", response_class=StreamingResponse, responses=ZIPPED)
@router.get("/{id}/revisions/{number}/variants.zip", response_class=StreamingResponse, responses=ZIPPED)
async def read_variants_file(
    id: Id,
    database: TheDatabase,
    store: TheStore,
    jobs: TheJobs,
    healing: TheHealing,
    keys: TheStampKeys,
    number: Number | None = None,
    prefer: Prefer = None,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Return the STEP files of all variants in a ZIP, each named after its design, variant and revision.

    Equal files give a ZIP of equal bytes. Models without a finished solid are left out, and are named in the
    header `Variants-Missing`.
    """

    def find() -> tuple[int, list[Entry], list[str], str]:
        with database.read() as session:
            revision, ready, missing = entries(session, id, number)
            return revision, ready, missing, ready[0].stamp.design

    revision, ready, missing, design = await run_in_threadpool(find)
    names = distinct(entry.name for entry in ready)
    headers = {
        "ETag": _tag(names, ready, keys),
        "Cache-Control": "no-cache",
        "Design-Revision": str(revision),
        "Content-Disposition": named(f"{design} variants", revision, "zip", "attachment"),
        **({MISSING: ", ".join(missing)} if missing else {}),
    }
    if is_at_hand(if_none_match, headers["ETag"]):
        return unchanged(headers)
    for sha in dict.fromkeys(entry.sha256 for entry in ready):
        if answer := await lost(sha, healing, jobs, prefer):
            return answer
    return StreamingResponse(_zip(store, names, ready, keys), media_type=MEDIA_TYPE, headers=headers)


def _zip(
    store: Artifacts, names: Sequence[str], ready: Sequence[Entry], keys: StampKeys | None
) -> Iterator[bytes]:
    pairs = zip(names, ready, strict=True)
    return archived((name, partial(_file, store, entry, keys)) for name, entry in pairs)


def _file(store: Artifacts, entry: Entry, keys: StampKeys | None) -> bytes:
    return stamps.sent(store.read(entry.sha256), STEP, entry.sha256, entry.stamp, keys)


def _tag(names: Sequence[str], ready: Sequence[Entry], keys: StampKeys | None) -> str:
    """Return a strong ETag for the ZIP, which depends only on these values."""
    parts = [
        f"{name}\0{entry.sha256}\0{entry.stamp.date}\0{entry.stamp.material}\n"
        for name, entry in zip(names, ready, strict=True)
    ]
    key = keys.current.id if keys else ""
    return f'"{hashlib.sha256("".join([key, *parts]).encode()).hexdigest()}"'
