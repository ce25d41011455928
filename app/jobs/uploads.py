"""Store files that users upload, and queue the jobs that import them as worksheets or models."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePath

from sqlalchemy.orm import Session

from app.identity.usage import note_bytes, require_room
from app.jobs.service import Jobs
from app.plain import JsonObject
from app.storage.artifacts import Artifacts
from app.storage.idempotency import Once


def last_name(file: str) -> str:
    r"""Return a file name without folders, whether `/` or `\` separates them."""
    return PurePath(file.replace("\\", "/")).name


def queue_upload(
    jobs: Jobs,
    store: Artifacts,
    kind: str,
    content: bytes | memoryview,
    about: JsonObject,
    once: Once,
    check: Callable[[Session], object] = lambda session: None,
) -> str:
    """Store a file by its hash, queue the job that imports it, and return the job.

    A repeated request returns the job of the first request.

    Parameters
    ----------
    about
        The data for the job, in addition to the file and the client.
    check
        Called in the unit of work that queues the import; raises an error to refuse it.

    Raises
    ------
    QueueFull, LimitReached
        As raised by `Jobs.enqueue`; also if the file does not fit into the principal's storage.
    """
    payload = {"file": store.put(content), **about, "client": once.client}

    def unit(session: Session) -> str:
        if before := once.begin(session):
            return str(before["job"])
        check(session)
        require_room(session, jobs.settings, len(content))
        job = jobs.enqueue(session, kind, payload, client=once.client)
        note_bytes(session, len(content))
        once.keep(session, 202, {"job": job})
        return job

    return jobs.commit(unit)
