"""All SQL for retention; every function runs in its caller's transaction.

Ages are in seconds of the service's run time.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from itertools import chain

from sqlalchemy import ColumnElement, CursorResult, Result, Text, and_, cast, delete, exists, select
from sqlalchemy.orm import Session

from app.jobs.turns import UNFINISHED
from app.storage.clock import operated
from app.storage.tables import (
    AnalysisRow,
    ArtifactRow,
    BuildRow,
    EventRow,
    IdempotencyRow,
    ImportedModelRow,
    JobRow,
    RevisionModelRow,
    StudyChunkRow,
    StudyRow,
    WorksheetVersionRow,
)

_SHA256 = re.compile(r"(?<![0-9a-f])[0-9a-f]{64}(?![0-9a-f])")


def delete_keys(session: Session, kept: float, most: int) -> int:
    """Delete some of the idempotency keys older than an age [s]; return their number."""
    row = IdempotencyRow
    old = select(row.key, row.scope, row.client).where(row.operated < operated(session) - kept)
    some = session.execute(old.order_by(row.operated).limit(most)).all()
    for key, scope, client in some:
        same = and_(row.key == key, row.scope == scope, row.client == client)
        session.execute(delete(row).where(same))
    return len(some)


def delete_jobs(session: Session, kept: float, most: int) -> int:
    """Delete some of the jobs that ended longer ago than an age [s]; return their number."""
    # Not "state in (…)": SQLite would collect and sort all ended jobs instead of using the index of ages.
    old = select(JobRow.id).where(JobRow.operated < operated(session) - kept, JobRow.state.not_in(UNFINISHED))
    some = old.order_by(JobRow.operated).limit(most)
    return _count(session.execute(delete(JobRow).where(JobRow.id.in_(some))))


def delete_events(session: Session, kept: float, most: int) -> int:
    """Delete some of the events older than an age [s], from the start of a topic; return their number."""
    row = EventRow
    old = select(row.topic, row.number).where(row.operated < operated(session) - kept)
    some = session.execute(old.order_by(row.operated, row.topic, row.number).limit(most)).all()
    for topic, number in some:
        session.execute(delete(row).where(row.topic == topic, row.number == number))
    return len(some)


def unwanted_builds(session: Session, kept: float, after: str, most: int) -> list[str]:
    """Return the keys of some builds that no revision uses and nobody has requested for a time [s]."""
    unwanted = select(BuildRow.key).where(BuildRow.key > after, _is_unwanted(session, kept))
    return list(session.scalars(unwanted.order_by(BuildRow.key).limit(most)))


def delete_builds(session: Session, keys: Collection[str], kept: float) -> int:
    """Delete the builds that are still unwanted, with their analyses; return their number.

    Their files stay in the store until a sweep finds that no row names them.
    """
    still = select(BuildRow.key).where(BuildRow.key.in_(keys), _is_unwanted(session, kept))
    gone = set(session.scalars(still)) - _awaited(session)
    for table in (AnalysisRow, ArtifactRow):
        session.execute(delete(table).where(table.build_key.in_(gone)))
    session.execute(delete(BuildRow).where(BuildRow.key.in_(gone)))
    return len(gone)


def referenced_files(session: Session) -> set[str]:
    """Return the SHA-256 of every file that a row names, and some other hashes, such as keys of builds.

    Files belong to artifacts, outputs of analyses, inputs and results of jobs, given and calculated rows of
    studies, and the original files of imported worksheets and models. Add any further column that names
    files here.
    """
    files = set(session.scalars(select(ArtifactRow.sha256)))
    files.update(session.scalars(select(StudyChunkRow.sha256)))
    uploads = (
        StudyRow.table_sha256,
        WorksheetVersionRow.import_sha256,
        ImportedModelRow.file_sha256,
        ImportedModelRow.sent_sha256,
    )
    for given in uploads:
        files.update(sha for sha in session.scalars(select(given)) if sha)
    for column in (AnalysisRow.found, JobRow.payload, JobRow.result):
        text = cast(column, Text)
        for part in session.execute(select(text).where(text.like("%" + 64 * "_" + "%"))).scalars():
            files.update(_SHA256.findall(part))
    return files


def _is_unwanted(session: Session, kept: float) -> ColumnElement[bool]:
    used = exists().where(RevisionModelRow.build_key == BuildRow.key)
    return and_(BuildRow.operated < operated(session) - kept, ~used)


def _awaited(session: Session) -> set[str]:
    """Return the builds for which unfinished jobs create further files."""
    payloads = session.scalars(select(JobRow.payload).where(JobRow.state.in_(UNFINISHED)))
    named = ([payload["build"]] if "build" in payload else payload.get("builds", ()) for payload in payloads)
    return set(chain.from_iterable(named))


def _count(result: Result[tuple[()]]) -> int:
    assert isinstance(result, CursorResult)
    return result.rowcount
