"""Events of a design for its subscribers: its changes, and the progress of its regeneration."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.designs import repository
from app.jobs.events import Event, Events
from app.storage import event_log


@dataclass(frozen=True)
class Standing:
    """The state of a design's regeneration, and the newest event that it includes."""

    number: int
    revision: int
    state: str
    problem: object


def note_revision(session: Session, events: Events, design: str, revision: int, state: str) -> None:
    """Note a new revision and its state, in the unit that writes it."""
    topic, data = f"design:{design}", {"revision": revision}
    events.note(session, Event(topic, "revision", data), Event(topic, state, data))


def standing(session: Session, id: str) -> Standing:
    """Return at which revision a design is, and how its regeneration stands.

    Raises
    ------
    NotFound
        If there is no such design.
    """
    head = repository.head(session, id)
    number = repository.design(session, id).event
    return Standing(number, head.number, head.state, head.problem)


def can_resume(session: Session, id: str, last: int | None) -> bool:
    """Return whether all events of a design after the one that a reader got last are kept."""
    newest = repository.design(session, id).event
    return last is not None and event_log.can_resume(session, f"design:{id}", last, newest)
