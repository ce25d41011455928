"""Turns of calculations: clients alternate, so that no client waits for all calculations of another."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from typing import Protocol, TypeVar


class Waiter(Protocol):
    """A calculation that waits for its turn, with its client."""

    client: str
    turn: int


W = TypeVar("W", bound=Waiter)


class Turns:
    """Numbers of turns: a client's next turn follows its last one, but is never before the present turn.

    So a new client comes before the second calculation of every waiting client, and no client is passed over
    for ever.
    """

    def __init__(self) -> None:
        self._now = 0
        self._last: dict[str, int] = {}  # last turn of each client that waits or runs

    def next(self, client: str) -> int:
        """Return the turn of a client's next calculation."""
        turn = max(self._last.get(client, -1) + 1, self._now)
        self._last[client] = turn
        return turn

    def taken(self, turn: int) -> None:
        """Record that a turn has begun."""
        self._now = max(self._now, turn)

    def forget(self, present: Collection[str]) -> None:
        """Remove the clients that have no waiting or running calculation."""
        self._last = {client: turn for client, turn in self._last.items() if client in present}


def first(waiting: Collection[W], running: Counter[str]) -> W | None:
    """Return the next calculation to run: the one with the lowest turn.

    Among equal turns, the first calculation of the client with the fewest running calculations comes next.
    """
    return min(waiting, key=lambda w: (w.turn, running[w.client]), default=None)


def last_of_the_greediest(waiting: Collection[W], newcomer: str) -> W | None:
    """Return the calculation to remove for a new one: the latest of the client with the most waiting.

    Return None if, with the new one, its client would have as many waiting as any other.
    """
    counts = Counter(w.client for w in waiting)
    client, most = max(counts.items(), key=lambda item: item[1], default=("", 0))
    if most <= counts[newcomer] + 1:
        return None
    return max((w for w in waiting if w.client == client), key=lambda w: w.turn)
