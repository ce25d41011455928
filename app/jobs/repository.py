"""All SQL about jobs. Every function runs in the transaction of its caller.

What a claimed job writes is fenced: it takes effect only while the row is running at the attempt and by the
owner that claimed it, so a job which was cancelled or claimed again cannot write any more. So these units may
run again (`repeatable`).

On a database that several servers share a claim is a lease: its owner prolongs it by `beat`, and any server
queues again by `reap` what nobody has prolonged. Its times are those of the database's clock.
"""

from collections.abc import Collection, Mapping
from typing import cast

from sqlalchemy import ColumnElement, and_, func, or_, select, update
from sqlalchemy.orm import Session

from app.identity.acting import ACTING
from app.jobs.job import Job
from app.jobs.turns import ALL_KINDS, UNFINISHED, Lane, next_turn
from app.observation import logs
from app.plain import JsonObject
from app.schemas.jobs import State
from app.storage.clock import operated, present
from app.storage.identity import new_id, now
from app.storage.locks import lock
from app.storage.tables import JobRow, canonical_json
from app.storage.units import repeatable


def add(
    session: Session,
    kind: str,
    payload: JsonObject,
    design: str | None,
    revision: int | None,
    client: str = "",
    turn: int = 0,
) -> str:
    """Queue a job of a client, in its turn, and return its id."""
    session.flush()  # the revision it belongs to comes first
    row = JobRow(
        id=new_id(session), kind=kind, state="queued", design_id=design, revision=revision, payload=payload,
        attempt=0, crashes=0, progress=0.0, log=[], created=now(), updated=now(),
        client=client, others=[], turn=turn, operated=operated(session), principal=ACTING.get().id,
        cause=f"{logs.REQUEST_ID.get()} {logs.TRACE.get()}".rstrip() or None,
    )  # fmt: skip
    session.add(row)
    session.flush()
    return row.id


def census(session: Session) -> list[tuple[str, str, int]]:
    """Return kind, state and number of the jobs that have not ended, of which there are few."""
    living = select(JobRow.kind, JobRow.state, func.count()).group_by(JobRow.kind, JobRow.state)
    living = living.where(JobRow.state.in_(["queued", "running"]))
    return [(kind, state, count) for kind, state, count in session.execute(living)]


def get(session: Session, id: str) -> Job | None:
    """Return a job, or None."""
    row = session.get(JobRow, id)
    return _job(row) if row else None


def locked(session: Session, id: str) -> Job | None:
    """Return a job as it is now, or None; no other unit changes it before the end of this one."""
    row = session.get(JobRow, id, with_for_update=True, populate_existing=True)
    return _job(row) if row else None


def page(session: Session, limit: int, before: str | None) -> list[Job]:
    """Return the newest jobs, or the newest of those older than `before`."""
    newest = select(JobRow).order_by(JobRow.id.desc()).limit(limit)
    rows = session.scalars(newest.where(JobRow.id < before) if before else newest)
    return [_job(row) for row in rows]


def find_waiting(session: Session, kind: str, payload: JsonObject) -> str | None:
    """Return the id of the job of this kind and payload that has not ended.

    Until the end of the unit no other one looks for such a job.
    """
    lock(session, f"job {kind} {canonical_json(payload)}")
    same = select(JobRow.id).where(JobRow.kind == kind, JobRow.payload == payload)
    return session.scalar(same.where(JobRow.state.in_(UNFINISHED)).limit(1))


def claim(
    session: Session,
    lane: Lane = ALL_KINDS,
    owner: str | None = None,
    lease: float = 0.0,
    kinds: Collection[str] | None = None,
) -> Job | None:
    """Make the queued job of a lane whose turn it is a running one for some time [s], and return it.

    A job that another server is just claiming is passed over, not waited for. So is one whose kind is not
    `known`, if that is given: it waits for a newer server.
    """
    repeatable(session)  # a claim that nobody knows of is reaped
    queue = select(JobRow.id).where(JobRow.state == "queued", lane.holds()).order_by(JobRow.turn, JobRow.id)
    if kinds is not None:
        queue = queue.where(JobRow.kind.in_(kinds))
    first = queue.limit(1).with_for_update(skip_locked=True)
    values = {"state": "running", "attempt": JobRow.attempt + 1, "progress": 0.0, "log": [], "updated": now(),
              "owner": owner, "lease_until": present() + lease}  # fmt: skip
    claimed = update(JobRow).where(JobRow.id == first.scalar_subquery()).values(values)
    row = session.scalar(claimed.returning(JobRow))
    return _job(row) if row else None


def beat(session: Session, owner: str, ids: Collection[str], lease: float) -> set[tuple[str, int]]:
    """Prolong the leases of what an owner runs [s]; return id and attempt of what is still its own."""
    held = update(JobRow).where(JobRow.id.in_(ids), JobRow.owner == owner, JobRow.state == "running")
    values = {"lease_until": present() + lease}
    rows = session.execute(held.values(values).returning(JobRow.id, JobRow.attempt))
    return {(id, attempt) for id, attempt in rows}


def reap(session: Session) -> list[Job]:
    """Queue again what nobody has prolonged in time, and count the loss; return these jobs."""
    repeatable(session)
    is_late = or_(JobRow.lease_until < present(), JobRow.lease_until.is_(None))
    late = select(JobRow.id).where(JobRow.state == "running", is_late).with_for_update(skip_locked=True)
    values = {"state": "queued", "losses": JobRow.losses + 1, "updated": now(), **_FREE}
    taken = update(JobRow).where(JobRow.id.in_(late)).values(values)
    return [_job(row) for row in session.scalars(taken.returning(JobRow))]


def note_progress(session: Session, job: Job, progress: float, log: list[str]) -> bool:
    """Store how far a claimed job is; return whether it was still held."""
    return _fenced(session, job, progress=progress, log=log)


def running_elsewhere(
    session: Session, ids: Collection[str], designs: Collection[str], owner: str
) -> list[Job]:
    """Return those of these jobs, and of these designs' jobs, that run in other servers than this owner."""
    which = or_(JobRow.id.in_(ids), JobRow.design_id.in_(designs))
    running = select(JobRow).where(JobRow.state == "running", JobRow.owner != owner, which)
    return [_job(row) for row in session.scalars(running.order_by(JobRow.id))]


def end(session: Session, job: Job, state: State, log: list[str], **more: object) -> bool:
    """Give a claimed job its final state; return False, with nothing written, if it is no longer held."""
    ended = {"state": state, "log": log, "operated": operated(session), **_FREE, **more}
    return _fenced(session, job, **ended)


def set_result(session: Session, id: str, link: str | None) -> None:
    """Store the link to the result of a job."""
    _write(session, JobRow.id == id, result=link)


def give_back(session: Session, job: Job, crashes: int, **more: int) -> bool:
    """Queue a claimed job again; return whether it was still held."""
    return _fenced(session, job, state="queued", crashes=crashes, **more, **_FREE)


def rest(session: Session, job: Job, lane: Lane) -> bool:
    """Queue a claimed job again, in its client's next turn; return whether it was still held."""
    row = session.get_one(JobRow, job.id)
    turn = next_turn(session, row.client, lane)
    return _fenced(session, job, state="queued", turn=turn, **_FREE)


def give_back_all(session: Session, owner: str | None = None) -> list[Job]:
    """Queue all running jobs again, or those of an owner, when none can be alive; return them."""
    running = update(JobRow).where(JobRow.state == "running")
    which = running if owner is None else running.where(JobRow.owner == owner)
    queued = which.values(state="queued", updated=now(), **_FREE).returning(JobRow)
    return [_job(row) for row in session.scalars(queued)]


def give_up(session: Session, job: Job, problem: JsonObject) -> None:
    """Mark a job as failed that has just been reaped once too often."""
    ended = {"state": "failed", "problem": problem, "operated": operated(session)}
    _write(session, JobRow.id == job.id, **ended)


def cancel(session: Session, job: Job, problem: JsonObject) -> None:
    """Mark a job as cancelled."""
    ended = {"state": "cancelled", "problem": problem, "operated": operated(session), **_FREE}
    _write(session, JobRow.id == job.id, **ended)


_FREE: Mapping[str, object] = {"owner": None, "lease_until": None}
"""What a job has that nobody runs."""


def _fenced(session: Session, job: Job, **values: object) -> bool:
    """Update a claimed job; return whether it was still held. To do it again does no harm."""
    repeatable(session)
    mine = JobRow.attempt == job.attempt, JobRow.owner == job.owner
    return _write(session, and_(JobRow.id == job.id, JobRow.state == "running", *mine), **values) == 1


def _write(session: Session, which: ColumnElement[bool], **values: object) -> int:
    """Update the jobs that match and return how many did."""
    statement = update(JobRow).where(which).values(**values, updated=now()).returning(JobRow.id)
    return len(session.scalars(statement).all())


def _job(row: JobRow) -> Job:
    return Job(
        id=row.id, kind=row.kind, state=cast(State, row.state), design=row.design_id, revision=row.revision,
        payload=row.payload, attempt=row.attempt, crashes=row.crashes, progress=row.progress, log=row.log,
        problem=row.problem, result=row.result, created=row.created, updated=row.updated,
        principal=row.principal,
        losses=row.losses, owner=row.owner, event=row.event, cause=row.cause or "",
    )  # fmt: skip
