"""Errors of requests about designs, besides wrong inputs.

DesignError
    StaleRevision       the design has changed since the client read it
    NotConverged        a declared iteration did not converge within its limit
    DesignSigned        a design with a signature cannot be deleted
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from app.plain import Json


class DesignError(Exception):
    """Base class of the errors that the design service raises, apart from wrong inputs."""


class StaleRevision(DesignError):
    """The design has changed since the client read it."""

    def __init__(self, expected: str, head: int) -> None:
        self.head = head
        super().__init__(
            f"the design is at revision {head}, not at {expected}; read it again, then send your change "
            f'with If-Match: "{head}"'
        )


class DesignSigned(DesignError):
    """A design with a signed revision cannot be deleted."""

    def __init__(self, id: str, revision: int) -> None:
        super().__init__(
            f"revision {revision} of design {id[:80]} bears a signature, so the design cannot be deleted; "
            f'archive it instead: POST /api/v1/designs/{id[:80]}/labels {{"archived": true}}'
        )


class NotConverged(DesignError):
    """A declared iteration did not converge; `rounds` lists the assumed and measured values of each round.

    `rounded` names the rounded values in the loop.
    """

    def __init__(
        self, through: str, tolerance: float, rounds: Sequence[Mapping[str, Json]], rounded: str = ""
    ) -> None:
        self.rounds = [dict(done) for done in rounds]
        last = rounds[-1]
        super().__init__(
            f"the iteration through {through} did not converge to {tolerance:g} within {len(rounds)} rounds: "
            f"it assumed {last['assumed']:.6g} and measured {last['measured']:.6g} {last['unit']}; "
            "start nearer, allow more rounds, or weaken the feedback"
            + (f"; {rounded} may alternate between two multiples: use a smaller step" if rounded else "")
        )
