"""A job as its handler and the API see it."""

from dataclasses import dataclass

from app.plain import JsonObject
from app.schemas.jobs import State

FINAL: frozenset[State] = frozenset({"done", "failed", "cancelled"})


@dataclass(frozen=True)
class Job:
    """A piece of work as it was when it was read. `attempt` counts claims, `crashes` dead processes."""

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

    @property
    def finished(self) -> bool:
        """Whether nothing will change any more."""
        return self.state in FINAL
