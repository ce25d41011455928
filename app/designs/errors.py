"""Errors of requests about designs, besides wrong inputs.

DesignError
    StaleRevision       the design has changed since the client read it
    NotConverged        a declared iteration did not settle within its limit
    DesignReleased      a design with a released revision cannot be deleted
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from app.plain import Json


class DesignError(Exception):
    """Anything that designs refuse, beyond wrong inputs."""


class StaleRevision(DesignError):
    """The design has changed since the client read it."""

    def __init__(self, expected: str, head: int) -> None:
        self.head = head
        super().__init__(
            f"the design is at revision {head}, not at {expected}; read it again, then send your change "
            f'with If-Match: "{head}"'
        )


class DesignReleased(DesignError):
    """A design with a released revision is not deleted."""

    def __init__(self, id: str, revision: int) -> None:
        super().__init__(
            f"revision {revision} of design {id[:80]} was released, so the design is kept; archive it "
            f'instead: POST /api/v1/designs/{id[:80]}/labels {{"archived": true}}'
        )


class NotConverged(DesignError):
    """A declared iteration did not settle within its limit; `rounds` holds what was assumed and measured."""

    def __init__(self, through: str, tolerance: float, rounds: Sequence[Mapping[str, Json]]) -> None:
        self.rounds = [dict(done) for done in rounds]
        last = rounds[-1]
        super().__init__(
            f"the iteration through {through} did not settle to {tolerance:g} within {len(rounds)} rounds: "
            f"it assumed {last['assumed']:.6g} and measured {last['measured']:.6g} {last['unit']}; "
            "start nearer, allow more rounds, or weaken the feedback"
        )
