"""A job as its handler and the API see it."""

from dataclasses import dataclass
from functools import cached_property

from app.jobs.schemas import State
from app.plain import JsonObject

FINAL: frozenset[State] = frozenset({"done", "failed", "cancelled"})


@dataclass(frozen=True)
class Job:
    """A piece of work as it was when it was read.

    `attempt` counts claims, `crashes` dead processes, `losses` dead workers and servers; `owner` runs it.
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
    cause: str = ""  # the id of the request that queued it, and the context of its trace
    event: int = 0
    """The number of its newest event."""

    @cached_property
    def topics(self) -> tuple[str, ...]:
        """Return the topics of its events: its own, and its design's."""
        own = f"job:{self.id}"
        return (own,) if self.design is None else (own, f"design:{self.design}")

    @property
    def finished(self) -> bool:
        """Return whether nothing will change any more."""
        return self.state in FINAL
