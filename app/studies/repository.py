"""All SQL statements for studies. Every function runs in the transaction of its caller."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from app.identity.usage import note_bytes
from app.jobs.turns import UNFINISHED
from app.plain import JsonObject
from app.storage.clock import new_id, now
from app.storage.errors import NotFound
from app.storage.tables import StudyChunkRow, StudyRow


@dataclass(frozen=True)
class New:
    """The content of a new study."""

    design: str
    revision: int
    method: str
    body: JsonObject
    plan: JsonObject
    seed: int
    chunk: int
    rows: int
    table: str | None
    client: str


@dataclass(frozen=True)
class Progress:
    """Number of calculated rows of a study, and of those refused, by reason."""

    rows: int
    refused: dict[str, int]


def add(session: Session, new: New) -> StudyRow:
    """Add a new study in the state `queued`, and return it."""
    row = StudyRow(
        id=new_id(session), design_id=new.design, revision=new.revision, method=new.method, state="queued",
        body=new.body, plan=new.plan, seed=new.seed, chunk=new.chunk, rows=new.rows, table_sha256=new.table,
        client=new.client, job=None, result=None, problem=None, created=now(), updated=now(),
    )  # fmt: skip
    session.add(row)
    session.flush()
    return row


def get(session: Session, id: str) -> StudyRow:
    """Return a study.

    Raises
    ------
    NotFound
        If there is none.
    """
    row = session.get(StudyRow, id)
    if row is None:
        raise NotFound(f"there is no study {id[:80]!r}")
    return row


def page(session: Session, limit: int, before: str | None, design: str | None) -> list[StudyRow]:
    """Return one page of studies, newest first, plus one study if there are more."""
    query = select(StudyRow).order_by(StudyRow.id.desc()).limit(limit + 1)
    if design is not None:
        query = query.where(StudyRow.design_id == design)
    return list(session.scalars(query.where(StudyRow.id < before) if before else query))


def chunks(session: Session, id: str) -> list[StudyChunkRow]:
    """Return the calculated chunks of a study, in order."""
    query = select(StudyChunkRow).where(StudyChunkRow.study_id == id).order_by(StudyChunkRow.number)
    return list(session.scalars(query))


def done(session: Session, id: str, until: int | None = None) -> Progress:
    """Return the progress of a study, counting only chunks with numbers below `until`."""
    which = [StudyChunkRow.study_id == id]
    if until is not None:
        which.append(StudyChunkRow.number < until)
    rows = session.scalar(select(func.sum(StudyChunkRow.rows)).where(*which)) or 0
    refused = Counter[str]()
    for reasons in session.scalars(select(StudyChunkRow.refused).where(*which, StudyChunkRow.refused != {})):
        refused.update(reasons)
    return Progress(rows, dict(refused))


def begin(session: Session, id: str) -> bool:
    """Mark a study as running; return whether it still has to run."""
    row = _locked(session, id)
    if row is None or row.state not in UNFINISHED:
        return False
    row.state, row.updated = "running", now()
    return True


def keep_chunk(session: Session, chunk: StudyChunkRow, size: int) -> bool:
    """Record a chunk of a running study and its size in bytes; return whether the study still runs.

    Recording the same chunk again changes nothing.
    """
    row = _locked(session, chunk.study_id)
    if row is None or row.state != "running":
        return False
    if session.get(StudyChunkRow, (chunk.study_id, chunk.number)) is None:
        session.add(chunk)
        note_bytes(session, size)
        row.updated = now()
        session.flush()
    return True


def end(session: Session, id: str, state: str, result: JsonObject | None, problem: JsonObject | None) -> None:
    """Set the final state of a study, unless it has ended already."""
    row = _locked(session, id)
    if row is not None and row.state in UNFINISHED:
        row.state, row.result, row.problem, row.updated = state, result, problem, now()


def remove(session: Session, id: str) -> None:
    """Delete a study and its chunks; their files stay in the store without a reference."""
    _locked(session, id)
    session.execute(delete(StudyChunkRow).where(StudyChunkRow.study_id == id))
    session.execute(delete(StudyRow).where(StudyRow.id == id))


def _locked(session: Session, id: str) -> StudyRow | None:
    """Return the present state of a study, locked until the end of the transaction."""
    return session.get(StudyRow, id, with_for_update=True, populate_existing=True)
