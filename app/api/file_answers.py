"""Responses with stored files: verified while they are sent, rebuilt when they are missing or damaged."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping

from anyio import to_thread
from fastapi import Response
from fastapi.responses import FileResponse
from starlette.datastructures import Headers
from starlette.types import Message, Receive, Scope, Send

from app.api.responses import finished
from app.http import problems
from app.http.attachments import is_at_hand, unchanged
from app.http.problem_kinds import REBUILDING
from app.jobs.service import Jobs
from app.schemas.problems import Responses, refusals
from app.solids.repair import ArtifactRepair, other_bytes
from app.storage.artifacts import Artifacts
from app.storage.errors import ArtifactDamaged, ArtifactMissing
from app.storage.verification import OpenFile, stamp_of

RETRY_AFTER = 2  # s
GONE = 410

UNAVAILABLE = refusals(410, 503)
"""Declared answers of a route that serves stored files."""
UNCHANGED: Responses = {304: {"description": "as it was when the ETag of If-None-Match was sent"}}
"""Further declared answers of a route whose answers have an ETag."""


async def lost(
    sha: str, healing: ArtifactRepair, jobs: Jobs, prefer: str | None, *, same: bool = False
) -> Response | None:
    """Return None if an artifact is intact, else the response to send: 503 during its rebuild, or a problem.

    With `same`, only the original bytes are accepted; otherwise a row that now names other bytes is accepted
    too.
    """
    if await to_thread.run_sync(healing.is_good, sha):
        return None
    if answer := await _unless_healed(sha, healing, jobs, prefer):
        return answer
    if await to_thread.run_sync(healing.is_good, sha):
        return None
    # A job that was already running may have checked the file before it was lost; the next job has not.
    try:
        if answer := await _unless_healed(sha, healing, jobs, prefer):
            return answer
    except ArtifactMissing:
        pass  # the row now names other bytes
    if same and not await to_thread.run_sync(healing.is_good, sha):
        return problems.answer(problems.describe(other_bytes(sha)))
    return None


async def _unless_healed(
    sha: str, healing: ArtifactRepair, jobs: Jobs, prefer: str | None
) -> Response | None:
    """Return None once the job that rebuilds an artifact has succeeded, else the response to send."""
    if refused := healing.refused(sha):
        return problems.answer(refused)
    job = await to_thread.run_sync(healing.request, sha)
    if not await finished(jobs, job, prefer):
        return rebuilding(sha, job)
    if problem := await to_thread.run_sync(jobs.problem, job):
        if problem["status"] == GONE:
            healing.refuse(sha, problem)
        return problems.answer(problem)
    return None


def rebuilding(sha: str, job: str) -> Response:
    """Return 503 for an artifact that a job is rebuilding."""
    about = problems.problem(REBUILDING, f"artifact {sha} was missing or damaged and is being rebuilt")
    place = f"/api/v1/jobs/{job}"
    return problems.answer({**about, "job": place}, {"Retry-After": str(RETRY_AFTER), "Location": place})


class StoredFile(FileResponse):
    """A response with a verified artifact; it sends the open file that was verified, and watches for changes.

    A client that already has the file receives 304. Starlette handles Range and If-Range.
    """

    def __init__(
        self,
        store: Artifacts,
        sha: str,
        media_type: str,
        headers: Mapping[str, str],
        filename: str | None = None,
    ) -> None:
        super().__init__(sha, media_type=media_type, headers=headers, filename=filename)
        self._store, self._sha, self._given = store, sha, headers

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the file; abort the response if the bytes change meanwhile."""
        if is_at_hand(Headers(scope=scope).get("if-none-match"), self._given["ETag"]):
            await unchanged(self._given)(scope, receive, send)
            return
        opened = await to_thread.run_sync(self._store.open, self._sha)
        with opened:
            descriptor = opened.file.fileno()
            self.path = f"/dev/fd/{descriptor}"  # this open file, even if its name is reused
            self.stat_result = os.fstat(descriptor)
            self.set_stat_headers(self.stat_result)
            await super().__call__(scope, receive, self._watched(opened, send))

    def _watched(self, opened: OpenFile, send: Send) -> Send:
        async def watched(message: Message) -> None:
            nonlocal opened
            if not opened.is_unchanged():
                opened = await to_thread.run_sync(self._verified_again, opened)
            await send(message)

        return watched

    def _verified_again(self, opened: OpenFile) -> OpenFile:
        """Verify the changed file again, and return it if its bytes are the same, as after a new time stamp.

        Raises
        ------
        ArtifactDamaged
            If the bytes have changed.
        """
        stamp = stamp_of(opened.file)
        opened.file.seek(0)
        if hashlib.file_digest(opened.file, "sha256").hexdigest() != self._sha:
            self._store.exists(self._sha)  # moves the file aside, if it still has its name
            raise ArtifactDamaged(self._sha, "it changed while it was being sent")
        return OpenFile(opened.file, stamp)
