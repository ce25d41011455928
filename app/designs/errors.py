"""What can be wrong with a request about designs, beyond wrong inputs.

DesignError
    NotFound            no such design, revision, model or artifact
    StaleRevision       the design has changed since the client read it
    KeyReused           an Idempotency-Key came again with another request
    NotConverged        a declared iteration did not settle within its limit
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


class DesignError(Exception):
    """Anything that designs refuse, beyond wrong inputs."""


class NotFound(DesignError):
    """No such design, revision, model or artifact."""


class StaleRevision(DesignError):
    """The design has changed since the client read it."""

    def __init__(self, expected: str, head: int) -> None:
        self.head = head
        super().__init__(
            f"the design is at revision {head}, not at {expected}; read it again, then send your change "
            f'with If-Match: "{head}"'
        )


class KeyReused(DesignError):
    """An Idempotency-Key came again with another request."""

    def __init__(self, key: str) -> None:
        super().__init__(f"the Idempotency-Key {key[:80]!r} was used for a different request; take a new one")


class NotConverged(DesignError):
    """A declared iteration did not settle within its limit; `rounds` tells what was assumed and measured."""

    def __init__(self, through: str, tolerance: float, rounds: Sequence[Mapping[str, Any]]) -> None:
        self.rounds = [dict(done) for done in rounds]
        last = rounds[-1]
        super().__init__(
            f"the iteration through {through} did not settle to {tolerance:g} within {len(rounds)} rounds: "
            f"it assumed {last['assumed']:.6g} and measured {last['measured']:.6g} {last['unit']}; "
            "start nearer, allow more rounds, or weaken the feedback"
        )
