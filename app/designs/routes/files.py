"""`/designs/{id}/model…`: files of the newest valid model, or of the model of one revision."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Query, Response
from fastapi.responses import FileResponse
from sqlalchemy.orm import Session
from starlette.concurrency import run_in_threadpool

from app.api.dependencies import (
    TheDatabase,
    TheHealing,
    TheJobs,
    TheModels,
    ThePress,
    TheSettings,
    TheStampKeys,
    TheStore,
)
from app.api.file_answers import UNAVAILABLE, UNCHANGED, lost
from app.api.responses import LATER, accepted, accepted_weights, finished
from app.designs import stamps, views
from app.designs.routes.designs import Id, Number, Prefer
from app.designs.routes.title_blocks import TheTitleBlock, TitleBlock
from app.http import problems
from app.http.access import TheClient
from app.http.attachments import MemoryFile, disposition, http_time, is_at_hand, tag, unchanged
from app.http.query_names import KNOWN_NAMES
from app.http.strict_requests import StrictRoute
from app.jobs.service import Jobs
from app.reports.paper import Press
from app.schemas.problems import RouteOptions, refusals
from app.signing.keys import StampKeys
from app.solids.models import File, Models
from app.solids.repair import ArtifactRepair
from app.solids.routes.models import PATIENCE, send_file
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import NotFound
from app.storage.tables import RevisionModelRow
from cad.drafting.paper import TYPESETTER
from cad.file_kinds import DRAWINGS, MEDIA_TYPES, plain_kind, with_deflection, with_part
from cad.file_names import plain_name
from cad.signed_file import SIGNED
from cad.stamp import STAMPED, Stamp, takes_stamp

router = APIRouter(prefix="/api/v1/designs", tags=["files"], route_class=StrictRoute)

FILES: RouteOptions = {
    "dependencies": [KNOWN_NAMES],
    "response_class": FileResponse,
    "responses": {
        200: {"content": {media: {} for media in MEDIA_TYPES.values()}},
        **LATER,
        **UNCHANGED,
        **UNAVAILABLE,
        **refusals(404, 429),
    },
}

PRINTED = {"drawing.pdf": "drawing.svg"}
"""Kinds that are typeset from another kind, stamp included, because a finished PDF cannot be stamped."""

Accept = Annotated[str | None, Header(description=", ".join(MEDIA_TYPES.values()))]
Deflection = Annotated[
    str | None,
    Query(
        max_length=60,
        description="for GLB, STL and 3MF, the largest distance of a facet from the true surface: 1/10 000 "
        "to 1/10 of the diagonal of the largest body's box",
        examples=["0.05 mm"],
    ),
]
PartName = Annotated[
    str | None,
    Query(
        max_length=120,
        description="of STEP, GLB, STL, 3MF, BREP and drawings, the one part of an assembly that the "
        "file holds, in its own coordinates; without it the file holds all parts at their positions",
        examples=["upper_shell"],
    ),
]
BuildSeen = Annotated[
    str | None,
    Query(
        max_length=64,
        description="has no effect; a page adds the key of the build that it shows, so that a browser "
        "fetches the file of another build again",
    ),
]
IfNoneMatch = Annotated[str | None, Header(description="ETags of the files that the client has")]


@dataclass(frozen=True)
class FileRequest:
    """A request for a file of a model, with the services that answer it."""

    database: Database
    store: Artifacts
    models: Models
    jobs: Jobs
    healing: ArtifactRepair
    press: Press
    keys: StampKeys | None
    owner: str
    client: str
    accept: str | None
    prefer: str | None
    if_none_match: str | None
    deflection: str | None
    part: str | None
    title_block: TitleBlock

    async def answer(self, find: Callable[[Session], RevisionModelRow], kind: str | None) -> Response:
        """Return a file of the model that `find` returns, of the kind in the path or the preferred kind.

        Raises
        ------
        NotFound
            If there is no such kind, or no such model.
        InvalidInputs
            If the deflection is not a length, the kind has no facets, no single part or no title block, or a
            typed text contradicts the approval.
        """
        wanted = kind or _accepted(self.accept)
        prefer = self.prefer or PATIENCE
        if wanted not in MEDIA_TYPES:
            raise NotFound(f"there is no file model.{wanted[:20]}; there are {', '.join(MEDIA_TYPES)}")
        key, stored_kind, stamp, old = await run_in_threadpool(self._lookup, find, wanted)
        answer = await lost(old.sha256, self.healing, self.jobs, prefer) if old else None
        if answer is None and (
            old is None or await run_in_threadpool(_is_outdated, self.models, key, stored_kind)
        ):
            answer = await self._unless_ready(key, stored_kind, prefer, has_older=bool(old))
        if answer:
            return answer
        file = await run_in_threadpool(lambda: self.models.file(key, stored_kind))
        assert file is not None, "a job that has done its work left its file"
        return await run_in_threadpool(self._sent, file, stamp, wanted)

    def _lookup(
        self, find: Callable[[Session], RevisionModelRow], wanted: str
    ) -> tuple[str, str, Stamp, File | None]:
        """Return the key of the model's build, the stored kind, its stamp, and the existing file if any."""
        with self.database.read() as session:
            model = find(session)
            kind = self._stored_kind(wanted)
            is_drawing = plain_kind(kind) in DRAWINGS
            stamp = stamps.signed(session, model, self.owner) if is_drawing else stamps.stamp(session, model)
            stamp = replace(self.title_block.on(stamp, wanted), part=self.part or "")
            return model.build_key or "", kind, stamp, views.file(session, model, kind)

    def _stored_kind(self, wanted: str) -> str:
        """Return the kind of stored file from which the requested kind is derived."""
        kind = PRINTED.get(wanted, wanted)
        if self.deflection is not None:
            kind = with_deflection(wanted, self.deflection)
        if self.part is not None:
            kind = with_part(kind, self.part)
        return kind

    async def _unless_ready(self, key: str, kind: str, prefer: str, *, has_older: bool) -> Response | None:
        """Return None once the file exists; before that, 202 or the reason why it cannot be created."""
        job = await run_in_threadpool(self.models.request_file, key, kind, self.client)
        if not await finished(self.jobs, job, prefer):
            return accepted(job)
        problem = await run_in_threadpool(self.jobs.problem, job)
        return problems.answer(problem) if problem and not has_older else None

    def _sent(self, file: File, stamp: Stamp, kind: str) -> Response:
        """Return a file under its name, or 304; if its kind has a stamp, the file is stamped."""
        part = "" if self.part is None else f"_{plain_name(self.part)}"
        plain, wide = f"{stamp.stem}{part}.{kind}", f"{stamp.wide_stem}{part}.{kind}"
        headers = {
            "Design-Revision": str(stamp.revision),
            "Vary": "Accept",
            "Cache-Control": "no-cache",
            "Content-Disposition": disposition(plain, wide),
        }
        plain_one = plain_kind(file.kind)
        is_own = plain_one in STAMPED or (plain_one in SIGNED and self.keys is not None)
        stored = self.store.read(file.sha256) if is_own else b""
        content = stamps.sent(stored, file.kind, file.sha256, stamp, self.keys) if is_own else None
        if content is None:
            headers["ETag"] = f'"{file.sha256}"'
        else:  # of what is typeset, that from which and with what: so a client that has it waits for nothing
            headers["ETag"] = tag(content + TYPESETTER.encode() if kind in PRINTED else content)
        if is_at_hand(self.if_none_match, headers["ETag"]):
            return unchanged(headers)
        if content is not None and kind in PRINTED:
            content = self.press.draw(content)
        if content is None:
            return send_file(self.store, file, headers)
        return MemoryFile(content, MEDIA_TYPES[kind], {**headers, "Last-Modified": http_time(stamp.date)})


async def plain_file_request(
    database: TheDatabase,
    store: TheStore,
    models: TheModels,
    jobs: TheJobs,
    healing: TheHealing,
    press: ThePress,
    keys: TheStampKeys,
    settings: TheSettings,
    client: TheClient,
    accept: Accept = None,
    prefer: Prefer = None,
    if_none_match: IfNoneMatch = None,
) -> FileRequest:
    """Return the parts that all requests for files share."""
    return FileRequest(
        database,
        store,
        models,
        jobs,
        healing,
        press,
        keys,
        settings.owner,
        client,
        accept,
        prefer,
        if_none_match,
        deflection=None,
        part=None,
        title_block=TitleBlock({}),
    )


ThePlainFileRequest = Annotated[FileRequest, Depends(plain_file_request)]


async def file_request(
    plain: ThePlainFileRequest,
    title_block: TheTitleBlock,
    deflection: Deflection = None,
    part: PartName = None,
    build: BuildSeen = None,
) -> FileRequest:
    """Return the request with the options of a mesh and of a drawing."""
    return replace(plain, deflection=deflection, part=part, title_block=title_block)


TheFileRequest = Annotated[FileRequest, Depends(file_request)]


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
    request: TheFileRequest,
    name: Id | None = None,
    kind: Id | None = None,
    number: Number | None = None,
) -> Response:
    """Return a file of a model, named after its design, model and revision.

    STEP files exist at once; other kinds are created at the first request. If that takes longer than the
    client waits, the answer is 202. STEP files and drawings also contain the name of the design, and drawings
    contain the signatures. The stamp of STEP and GLB files is signed by the service (`/stamp-keys`).
    """
    return await request.answer(lambda session: views.good_model(session, id, name, number), kind)


def _is_outdated(models: Models, key: str, kind: str) -> bool:
    """Return whether a drawing from an older program lacks the lines for a stamp and must be drawn again."""
    file = models.file(key, kind) if kind in DRAWINGS else None
    return file is not None and not takes_stamp(models.store.read(file.sha256), kind)


def _accepted(accept: str | None) -> str:
    """Return the kind that the client prefers, the first of equal ones; STEP by default."""
    kinds = {media: kind for kind, media in MEDIA_TYPES.items()}
    liked = [(weight, kinds[media]) for media, weight in accepted_weights(accept).items() if media in kinds]
    return max(liked, key=lambda pair: pair[0], default=(1.0, "step"))[1]
