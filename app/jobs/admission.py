"""Decide which jobs the queue still takes, and when a refused client may try again."""

from __future__ import annotations

from collections import defaultdict, deque
from math import ceil

from sqlalchemy.orm import Session

from app.jobs import turns
from app.jobs.errors import QueueFull
from app.jobs.turns import Lane

_USUAL = 5.0  # how long a job takes, before any of its lane has been measured [s]
_MEASURED = 20  # jobs of a lane, over which the mean is taken
_LONGEST = 3600  # advice [s]


class Durations:
    """Durations of the latest jobs of each lane [s], by the monotonic clock."""

    def __init__(self) -> None:
        self._seconds = defaultdict[Lane, deque[float]](lambda: deque(maxlen=_MEASURED))

    def note(self, lane: Lane, seconds: float) -> None:
        """Note how long a job took [s]."""
        self._seconds[lane].append(seconds)

    def mean(self, lane: Lane) -> float:
        """Return the mean of the latest jobs [s]."""
        latest = list(self._seconds[lane])
        return sum(latest) / len(latest) if latest else _USUAL


def admit(
    session: Session, client: str, lane: Lane, threads: int, share: int, most: int, durations: Durations
) -> None:
    """Let a client queue one more job, or refuse it: its share is so many, and at most so many wait in all.

    A tenth of the queue is kept for clients of whom nothing waits yet, so whoever fills the rest refuses no
    single job of another.

    Raises
    ------
    QueueFull
        The client's share or the queue is full.
    """
    own = turns.count_queued(session, client)
    total = most - (_reserve(most) if own else 0)
    is_share_full = own >= share
    if is_share_full or turns.count_queued(session) >= total:
        seconds = _seconds_to_a_place(session, client, lane, threads, durations)
        raise QueueFull(seconds, own if is_share_full else None)


def _reserve(limit: int) -> int:
    return max(1, limit // 10) if limit > 1 else 0


def _seconds_to_a_place(session: Session, client: str, lane: Lane, threads: int, durations: Durations) -> int:
    """Return the estimated time until a job of the client has left the queue [s]."""
    rounds = turns.count_until_next(session, client, lane) / threads
    return min(_LONGEST, max(1, ceil(rounds * durations.mean(lane))))
