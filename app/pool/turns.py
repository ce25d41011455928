"""Turns of calculations: clients alternate, so a client does not wait for another client's flood."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from typing import Protocol, TypeVar


class Waiter(Protocol):
    """Something that waits for its turn."""

    client: str
    turn: int


W = TypeVar("W", bound=Waiter)


class Turns:
    """Numbers of turns: each client's next is one beyond its last, and none is before those being taken.

    So a newcomer comes before the second calculation of anybody who waits, and nobody is always passed over.
    """

    def __init__(self) -> None:
        self._now = 0
        self._last: dict[str, int] = {}  # by client, of those who wait or run

    def next(self, client: str) -> int:
        """Return the turn of a client's next calculation."""
        turn = max(self._last.get(client, -1) + 1, self._now)
        self._last[client] = turn
        return turn

    def taken(self, turn: int) -> None:
        """Record that a turn has begun."""
        self._now = max(self._now, turn)

    def forget(self, present: Collection[str]) -> None:
        """Drop the clients that neither wait nor run."""
        self._last = {client: turn for client, turn in self._last.items() if client in present}


def first(waiting: Collection[W], running: Counter[str]) -> W | None:
    """Return the next to run: the lowest turn; of equal ones, the client that runs fewest.

    Of those, the first.
    """
    return min(waiting, key=lambda w: (w.turn, running[w.client]), default=None)


def last_of_the_greediest(waiting: Collection[W], newcomer: str) -> W | None:
    """Return the calculation to remove in favour of a new one.

    The latest of the client that has most waiting, if that is more.

    None if the newcomer itself has as many waiting, with this one, as anybody.
    """
    counts = Counter(w.client for w in waiting)
    client, most = max(counts.items(), key=lambda item: item[1], default=("", 0))
    if most <= counts[newcomer] + 1:
        return None
    return max((w for w in waiting if w.client == client), key=lambda w: w.turn)
