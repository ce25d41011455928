"""The queue of jobs: its limits, and the turns in which clients alternate. All SQL for turns is here.

A client's new job takes the turn after that client's previous job, but never an earlier turn than the queue's
current one. Jobs run in the order of their turns, and by age within a turn. So a new client's job is second
in line, however many jobs of another client wait. Each lane counts its own turns. Every function runs in the
transaction of its caller.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass
from functools import lru_cache
from math import ceil

from sqlalchemy import ColumnElement, and_, bindparam, false, func, literal, select, true
from sqlalchemy.orm import Session
from sqlalchemy.sql.functions import Function

from app.jobs.errors import JobShared, QueueFull
from app.storage.tables import Base, JobRow
from app.storage.units import Statement

UNFINISHED = ("queued", "running")
MOST_OTHERS = 20  # largest number of other clients recorded as waiting for a job
LANES = 64  # lanes with cached statements; a server has only a few
_JOBS = Base.metadata.tables[JobRow.__tablename__]


@dataclass(frozen=True)
class Lane:
    """The jobs that wait for the same threads: those of certain kinds; the common lane has all others."""

    kinds: tuple[str, ...] = ()
    is_common: bool = True

    def holds(self) -> ColumnElement[bool]:
        """Return the SQL condition that a job belongs to this lane."""
        if not self.kinds:
            return true() if self.is_common else false()
        kinds = [
            literal(kind) for kind in self.kinds
        ]  # literals, so that the list is not expanded at each execution
        return _JOBS.c.kind.not_in(kinds) if self.is_common else _JOBS.c.kind.in_(kinds)


ALL_KINDS = Lane()


def next_turn(session: Session, client: str, lane: Lane) -> int:
    """Return the turn of a client's next job."""
    ((own, present),) = _turns(lane).run(session, {"by": client})
    turn: int = max(present, own)
    return turn


@lru_cache(LANES)
def _turns(lane: Lane) -> Statement:
    """Return the turn after a client's last one in a lane, and the current turn of the lane.

    The current turn is the lowest waiting one, else the highest running one.
    """
    turn, state, unfinished = _JOBS.c.turn, _JOBS.c.state, [literal(one) for one in UNFINISHED]
    own = select(func.max(turn)).where(_JOBS.c.client == bindparam("by"), state.in_(unfinished), lane.holds())
    waiting = select(turn).where(state == "queued", lane.holds()).order_by(turn).limit(1)
    running = select(turn).where(state == "running", lane.holds()).order_by(turn.desc()).limit(1)
    next_own = func.coalesce(own.scalar_subquery() + 1, -1)
    present = func.coalesce(waiting.scalar_subquery(), running.scalar_subquery(), 0)
    return Statement(select(next_own, present), "by")


def count_queued(session: Session, client: str | None = None, lane: Lane | None = None) -> int:
    """Return the number of waiting jobs, of one client or of all, in one lane or in all."""
    statement = _counted(lane, client is not None)
    return statement.scalar(session, None if client is None else {"by": client}) or 0


@lru_cache(LANES)
def _counted(lane: Lane | None, of_client: bool) -> Statement:
    waiting = select(func.count()).select_from(_JOBS).where(_JOBS.c.state == "queued")
    if lane is not None:
        waiting = waiting.where(lane.holds())
    if of_client:
        return Statement(waiting.where(_JOBS.c.client == bindparam("by")), "by")
    return Statement(waiting)


def count_until_next(session: Session, client: str, lane: Lane) -> int:
    """Return how many jobs of a lane start before the client's next job; 1 if the client has none there."""
    waiting = and_(JobRow.state == "queued", lane.holds())
    next_one = select(func.min(JobRow.turn)).where(waiting, JobRow.client == client)
    until = select(func.count()).select_from(JobRow).where(waiting, JobRow.turn <= next_one.scalar_subquery())
    return max(1, session.scalar(until) or 0)


def join(session: Session, id: str, client: str, lane: Lane, share: int) -> None:
    """Add a client to those who wait for a job that another client requested.

    If the client's own turn comes first and its share of the queue allows it, the job takes that turn and
    counts as this client's; otherwise two clients together could get more turns than each alone.
    """
    row = _locked(session, id)
    if client != row.client and client not in row.others and len(row.others) < MOST_OTHERS:
        row.others = [*row.others, client]
    turn = next_turn(session, client, lane)
    if row.state == "queued" and turn < row.turn and count_queued(session, client) < share:
        row.others = [other for other in (row.client, *row.others) if other != client]
        row.client, row.turn = client, turn
    session.flush()


def leave(session: Session, id: str, client: str) -> bool:
    """Remove a client from those who wait for a job; return whether another client still waits.

    Raises
    ------
    JobShared
        If several clients wait for it, and this client does not.
    """
    row = _locked(session, id)
    if not row.others:
        return False
    everyone = [row.client, *row.others]
    if client not in everyone:
        raise JobShared(id)
    row.client, *row.others = [other for other in everyone if other != client]
    session.flush()
    return True


def client_of(session: Session, id: str) -> str:
    """Return the client whose turn a job takes."""
    return session.get_one(JobRow, id).client


def _locked(session: Session, id: str) -> JobRow:
    """Return the present state of a job; lock it until the end of this unit."""
    return session.get_one(JobRow, id, with_for_update=True, populate_existing=True)


def oldest_queued(session: Session) -> int | None:
    """Return when the longest-waiting job was queued [s of the service's run time], or None."""
    # The sum keeps SQLite from scanning the index of ages through all jobs that ended earlier.
    since: Function[int | None] = func.min(JobRow.operated + 0)
    age: int | None = session.scalar(select(since).where(JobRow.state == "queued"))
    return age


_USUAL = 5.0  # assumed duration of a job until one in its lane was measured [s]
_MEASURED = 20  # number of jobs in the mean of a lane
_LONGEST = 3600  # longest advised waiting time [s]


class Durations:
    """Durations of the latest jobs of each lane [s], measured by the monotonic clock."""

    def __init__(self) -> None:
        self._seconds = defaultdict[Lane, deque[float]](lambda: deque(maxlen=_MEASURED))

    def note(self, lane: Lane, seconds: float) -> None:
        """Record how long a job took [s]."""
        self._seconds[lane].append(seconds)

    def mean(self, lane: Lane) -> float:
        """Return the mean of the latest jobs [s]."""
        latest = list(self._seconds[lane])
        return sum(latest) / len(latest) if latest else _USUAL


def admit(
    session: Session, client: str, lane: Lane, threads: int, share: int, most: int, durations: Durations
) -> None:
    """Let a client queue one more job, unless its share or the total limit is used up.

    A tenth of the queue is reserved for clients without waiting jobs, so that a client that fills the rest
    cannot block another's first job.

    Raises
    ------
    QueueFull
        If the client's share or the queue is full.
    """
    own = count_queued(session, client)
    total = most - (_reserve(most) if own else 0)
    is_share_full = own >= share
    if is_share_full or count_queued(session) >= total:
        seconds = _seconds_to_a_place(session, client, lane, threads, durations)
        raise QueueFull(seconds, own if is_share_full else None)


def _reserve(limit: int) -> int:
    return max(1, limit // 10) if limit > 1 else 0


def _seconds_to_a_place(session: Session, client: str, lane: Lane, threads: int, durations: Durations) -> int:
    """Return the estimated time until the client may queue another job [s]."""
    rounds = count_until_next(session, client, lane) / threads
    return min(_LONGEST, max(1, ceil(rounds * durations.mean(lane))))
