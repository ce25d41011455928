"""All SQL about jobs. Every function runs in the transaction of its caller.

What a claimed job writes is fenced: it takes effect only while the row is running at the attempt that was
claimed, so a job which was cancelled or claimed again cannot write any more.
"""

from typing import cast

from sqlalchemy import ColumnElement, and_, func, select, update
from sqlalchemy.orm import Session

from app.jobs.job import Job
from app.jobs.turns import ALL_KINDS, UNFINISHED, Lane, next_turn
from app.plain import JsonObject
from app.schemas.jobs import State
from app.storage.clock import operated
from app.storage.identity import new_id, now
from app.storage.tables import JobRow


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
        client=client, others=[], turn=turn, operated=operated(session),
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


def page(session: Session, limit: int, before: str | None) -> list[Job]:
    """Return the newest jobs, or the newest of those older than `before`."""
    newest = select(JobRow).order_by(JobRow.id.desc()).limit(limit)
    rows = session.scalars(newest.where(JobRow.id < before) if before else newest)
    return [_job(row) for row in rows]


def find_waiting(session: Session, kind: str, payload: JsonObject) -> str | None:
    """Return the id of the job of this kind and payload that has not ended."""
    same = select(JobRow.id).where(JobRow.kind == kind, JobRow.payload == payload)
    return session.scalar(same.where(JobRow.state.in_(UNFINISHED)).limit(1))


def claim(session: Session, lane: Lane = ALL_KINDS) -> Job | None:
    """Make the queued job of a lane whose turn it is a running one, and return it."""
    queue = select(JobRow.id).where(JobRow.state == "queued", lane.holds()).order_by(JobRow.turn, JobRow.id)
    claimed = update(JobRow).where(JobRow.id == queue.limit(1).scalar_subquery())
    values = {"state": "running", "attempt": JobRow.attempt + 1, "progress": 0.0, "log": [], "updated": now()}
    row = session.scalar(claimed.values(values).returning(JobRow))
    return _job(row) if row else None


def note_progress(session: Session, job: Job, progress: float, log: list[str]) -> None:
    """Store how far a claimed job is."""
    _write(session, _held(job), progress=progress, log=log)


def end(session: Session, job: Job, state: State, log: list[str], **more: object) -> bool:
    """Give a claimed job its final state; return False, with nothing written, if it is no longer held."""
    return _write(session, _held(job), state=state, log=log, operated=operated(session), **more) == 1


def set_result(session: Session, id: str, link: str | None) -> None:
    """Store the link to the result of a job."""
    _write(session, JobRow.id == id, result=link)


def give_back(session: Session, job: Job, crashes: int) -> bool:
    """Queue a claimed job again; return whether it was still held."""
    return _write(session, _held(job), state="queued", crashes=crashes) == 1


def rest(session: Session, job: Job, lane: Lane) -> bool:
    """Queue a claimed job again, in its client's next turn; return whether it was still held."""
    row = session.get_one(JobRow, job.id)
    return _write(session, _held(job), state="queued", turn=next_turn(session, row.client, lane)) == 1


def give_back_all(session: Session) -> int:
    """Queue all running jobs again, at the start, when none can be alive; return how many there were."""
    return _write(session, JobRow.state == "running", state="queued")


def cancel(session: Session, job: Job, problem: JsonObject) -> None:
    """Mark a job as cancelled."""
    _write(session, JobRow.id == job.id, state="cancelled", problem=problem, operated=operated(session))


def _held(job: Job) -> ColumnElement[bool]:
    return and_(JobRow.id == job.id, JobRow.state == "running", JobRow.attempt == job.attempt)


def _write(session: Session, which: ColumnElement[bool], **values: object) -> int:
    """Update the jobs that match and return how many did."""
    statement = update(JobRow).where(which).values(**values, updated=now()).returning(JobRow.id)
    return len(session.scalars(statement).all())


def _job(row: JobRow) -> Job:
    return Job(
        id=row.id, kind=row.kind, state=cast(State, row.state), design=row.design_id, revision=row.revision,
        payload=row.payload, attempt=row.attempt, crashes=row.crashes, progress=row.progress, log=row.log,
        problem=row.problem, result=row.result, created=row.created, updated=row.updated,
    )  # fmt: skip
