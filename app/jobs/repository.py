"""All SQL for jobs. Every function runs in the transaction of its caller.

The writes of a claimed job are fenced: they take effect only while its row is still running under the same
owner and attempt, so a job that was cancelled or claimed again can no longer write. That is why these units
may run again (`repeatable`).

On a database that several servers share, a claim is a lease: its owner renews it by `beat`, and any server
requeues expired claims by `reap`. Lease times follow the database's clock.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import cast

from sqlalchemy import bindparam, func, insert, or_, select, update
from sqlalchemy.orm import Session

from app.identity.principal import ACTING
from app.jobs.schemas import State
from app.jobs.turns import ALL_KINDS, LANES, UNFINISHED, Lane, next_turn
from app.observation import logs
from app.plain import JsonObject
from app.storage.clock import new_id, now, operated, present
from app.storage.locks import lock
from app.storage.tables import Base, JobRow, canonical_json
from app.storage.units import Statement, repeatable

FINAL: frozenset[State] = frozenset({"done", "failed", "cancelled"})


@dataclass(frozen=True)
class Job:
    """A job as it was when its row was read.

    `attempt` counts claims, `crashes` dead processes, and `losses` dead workers and servers; `owner` is the
    server that runs it.
    """

    id: str
    kind: str
    state: State
    design: str | None
    revision: int | None
    payload: JsonObject
    attempt: int
    crashes: int
    progress: float
    log: list[str]
    problem: JsonObject | None
    result: str | None
    created: str
    updated: str
    principal: str | None = None
    losses: int = 0
    owner: str | None = None
    cause: str = ""  # id of the request that queued the job, and its trace context
    event: int = 0
    """Number of the job's newest event."""

    @cached_property
    def topics(self) -> tuple[str, ...]:
        """Return the topics of the job's events: its own topic and that of its design."""
        own = f"job:{self.id}"
        return (own,) if self.design is None else (own, f"design:{self.design}")

    @property
    def finished(self) -> bool:
        """Return whether the job can no longer change."""
        return self.state in FINAL


_JOBS = Base.metadata.tables[JobRow.__tablename__]
_ADDED = Statement(
    insert(_JOBS).values(state="queued", attempt=0, crashes=0, progress=0.0, log=[], others=[]),
    "id", "kind", "design_id", "revision", "payload", "created", "updated", "client", "turn", "operated",
    "principal", "cause", "question",
)  # fmt: skip
_AS_JOB = (
    _JOBS.c.id, _JOBS.c.kind, _JOBS.c.state, _JOBS.c.design_id, _JOBS.c.revision, _JOBS.c.payload,
    _JOBS.c.attempt, _JOBS.c.crashes, _JOBS.c.progress, _JOBS.c.log, _JOBS.c.problem, _JOBS.c.result,
    _JOBS.c.created, _JOBS.c.updated, _JOBS.c.principal, _JOBS.c.losses, _JOBS.c.owner,
    func.coalesce(_JOBS.c.cause, ""), _JOBS.c.event,
)  # fmt: skip
"""The columns of a `Job`, in the order of its fields."""
_OF_ID = Statement(select(*_AS_JOB).where(_JOBS.c.id == bindparam("of")), "of")


def add(
    session: Session,
    kind: str,
    payload: JsonObject,
    design: str | None,
    revision: int | None,
    client: str = "",
    turn: int = 0,
    question: str | None = None,
) -> str:
    """Queue a job in its client's turn, and return its id."""
    session.flush()  # its revision must be written first
    id, at = new_id(session), now()
    row = {
        "id": id, "kind": kind, "design_id": design, "revision": revision, "payload": payload,
        "created": at, "updated": at, "client": client, "turn": turn, "operated": operated(session),
        "principal": ACTING.get().id,
        "cause": f"{logs.REQUEST_ID.get()} {logs.TRACE.get()}".rstrip() or None,
        "question": question,
    }  # fmt: skip
    _ADDED.run(session, row)
    return id


def census(session: Session) -> list[tuple[str, str, int]]:
    """Return the number of unfinished jobs by kind and state."""
    living = select(JobRow.kind, JobRow.state, func.count()).group_by(JobRow.kind, JobRow.state)
    living = living.where(JobRow.state.in_(["queued", "running"]))
    return [(kind, state, count) for kind, state, count in session.execute(living)]


def get(session: Session, id: str) -> Job | None:
    """Return a job, or None."""
    for row in _OF_ID.run(session, {"of": id}):
        return Job(*row)
    return None


def locked(session: Session, id: str) -> Job | None:
    """Return the present state of a job, or None; its row stays locked until the end of this unit of work."""
    row = session.get(JobRow, id, with_for_update=True, populate_existing=True)
    return _job(row) if row else None


def page(session: Session, limit: int, before: str | None) -> list[Job]:
    """Return the newest jobs, or the newest of those older than `before`."""
    newest = select(JobRow).order_by(JobRow.id.desc()).limit(limit)
    rows = session.scalars(newest.where(JobRow.id < before) if before else newest)
    return [_job(row) for row in rows]


def find_waiting(session: Session, kind: str, payload: JsonObject) -> str | None:
    """Return the id of an unfinished job with this kind and payload.

    A lock keeps other units of work from searching for such a job until the end of this one.
    """
    lock(session, f"job {kind} {canonical_json(payload)}")
    same = select(JobRow.id).where(JobRow.kind == kind, JobRow.payload == payload)
    return session.scalar(same.where(JobRow.state.in_(UNFINISHED)).limit(1))


def asked(session: Session, question: str, states: Collection[State]) -> Job | None:
    """Return the newest job with this request key in one of these states."""
    equal = select(JobRow).where(JobRow.question == question, JobRow.state.in_(states))
    row = session.scalar(equal.order_by(JobRow.id.desc()).limit(1))
    return _job(row) if row else None


def claim(
    session: Session,
    lane: Lane = ALL_KINDS,
    owner: str | None = None,
    lease: float = 0.0,
    kinds: Collection[str] | None = None,
) -> Job | None:
    """Claim the next queued job of a lane for some time [s], and return it.

    A job that another server is claiming is skipped, without waiting. A job whose kind is not `known` is
    skipped too: it waits for a newer server.
    """
    repeatable(session)  # an unknown claim expires
    claimed = _claimed(lane, None if kinds is None else tuple(kinds))
    for row in claimed.run(session, {"at": now(), "by": owner, "lease": lease}):
        return Job(*row)
    return None


@lru_cache(LANES)
def _claimed(lane: Lane, kinds: tuple[str, ...] | None) -> Statement:
    job = _JOBS.c
    queue = select(job.id).where(job.state == "queued", lane.holds()).order_by(job.turn, job.id)
    if kinds is not None:
        queue = queue.where(job.kind.in_(kinds))
    first = queue.limit(1).with_for_update(skip_locked=True)
    until = present() + bindparam("lease")
    claimed = update(_JOBS).where(job.id == first.scalar_subquery())
    claimed = claimed.values(
        state="running", attempt=job.attempt + 1, progress=0.0, log=[],
        updated=bindparam("at"), owner=bindparam("by"), lease_until=until,
    )  # fmt: skip
    return Statement(claimed.returning(*_AS_JOB), "at", "by", "lease")


def beat(session: Session, owner: str, ids: Collection[str], lease: float) -> set[tuple[str, int]]:
    """Renew the leases [s] of an owner's jobs; return the id and attempt of each job that it still owns."""
    held = update(JobRow).where(JobRow.id.in_(ids), JobRow.owner == owner, JobRow.state == "running")
    values = {"lease_until": present() + lease}
    rows = session.execute(held.values(values).returning(JobRow.id, JobRow.attempt))
    return {(id, attempt) for id, attempt in rows}


def reap(session: Session) -> list[Job]:
    """Queue again jobs with expired leases, count the losses, and return these jobs."""
    repeatable(session)
    is_late = or_(JobRow.lease_until < present(), JobRow.lease_until.is_(None))
    late = select(JobRow.id).where(JobRow.state == "running", is_late).with_for_update(skip_locked=True)
    values = {"state": "queued", "losses": JobRow.losses + 1, "updated": now(), **_FREE}
    taken = update(JobRow).where(JobRow.id.in_(late)).values(values)
    return [_job(row) for row in session.scalars(taken.returning(JobRow))]


def note_progress(session: Session, job: Job, progress: float, log: list[str]) -> bool:
    """Store the progress of a claimed job; return whether the claim was still valid."""
    return _fenced(session, job, progress=progress, log=log)


def running_elsewhere(
    session: Session, ids: Collection[str], designs: Collection[str], owner: str
) -> list[Job]:
    """Return those of these jobs, and of these designs' jobs, that run on other servers."""
    which = or_(JobRow.id.in_(ids), JobRow.design_id.in_(designs))
    running = select(JobRow).where(JobRow.state == "running", JobRow.owner != owner, which)
    return [_job(row) for row in session.scalars(running.order_by(JobRow.id))]


def end(session: Session, job: Job, state: State, log: list[str], **more: object) -> bool:
    """Give a claimed job its final state; write nothing and return False if the claim is no longer valid."""
    ended = {"state": state, "log": log, "operated": operated(session), **_FREE, **more}
    return _fenced(session, job, **ended)


def set_result(session: Session, id: str, link: str | None) -> None:
    """Store the link to the result of a job."""
    _write(session, id, result=link)


def requeue(session: Session, job: Job, crashes: int, **more: int) -> bool:
    """Queue a claimed job again; return whether the claim was still valid."""
    return _fenced(session, job, state="queued", crashes=crashes, **more, **_FREE)


def rest(session: Session, job: Job, lane: Lane) -> bool:
    """Queue a claimed job again, in its client's next turn; return whether the claim was still valid."""
    row = session.get_one(JobRow, job.id)
    turn = next_turn(session, row.client, lane)
    return _fenced(session, job, state="queued", turn=turn, **_FREE)


def requeue_all(session: Session, owner: str | None = None) -> list[Job]:
    """Queue again all running jobs, or those of an owner, and return them; none may still be alive."""
    running = update(JobRow).where(JobRow.state == "running")
    which = running if owner is None else running.where(JobRow.owner == owner)
    queued = which.values(state="queued", updated=now(), **_FREE).returning(JobRow)
    return [_job(row) for row in session.scalars(queued)]


def give_up(session: Session, job: Job, problem: JsonObject) -> None:
    """Mark an expired job as failed after too many losses."""
    ended = {"state": "failed", "problem": problem, "operated": operated(session)}
    _write(session, job.id, **ended)


def cancel(session: Session, job: Job, problem: JsonObject) -> None:
    """Mark a job as cancelled."""
    ended = {"state": "cancelled", "problem": problem, "operated": operated(session), **_FREE}
    _write(session, job.id, **ended)


_FREE: Mapping[str, object] = {"owner": None, "lease_until": None}
"""Column values of a job that no server runs."""


def _fenced(session: Session, job: Job, **values: object) -> bool:
    """Update a claimed job; return whether the claim was still valid. Repeating the update is harmless."""
    repeatable(session)
    claim = {"at_attempt": job.attempt, "of_owner": job.owner}
    given = {"of_id": job.id, **claim, **values, "updated": now()}
    return len(_written(tuple(given), is_fenced=True).run(session, given)) == 1


def _write(session: Session, id: str, **values: object) -> None:
    given = {"of_id": id, **values, "updated": now()}
    _written(tuple(given), is_fenced=False).run(session, given)


@lru_cache(LANES)
def _written(names: tuple[str, ...], is_fenced: bool) -> Statement:
    """Set columns of a job by name; for a fenced job only while its claim is valid."""
    job = _JOBS.c
    changed = update(_JOBS).where(job.id == bindparam("of_id"))
    if is_fenced:
        is_held = (
            job.attempt == bindparam("at_attempt"),
            job.owner.is_not_distinct_from(bindparam("of_owner")),
        )
        changed = changed.where(job.state == "running", *is_held)
    return Statement(changed.returning(job.id), *names)


def _job(row: JobRow) -> Job:
    return Job(
        id=row.id, kind=row.kind, state=cast(State, row.state), design=row.design_id, revision=row.revision,
        payload=row.payload, attempt=row.attempt, crashes=row.crashes, progress=row.progress, log=row.log,
        problem=row.problem, result=row.result, created=row.created, updated=row.updated,
        principal=row.principal,
        losses=row.losses, owner=row.owner, event=row.event, cause=row.cause or "",
    )  # fmt: skip
