"""Events as rows: what happened to a design or a job, numbered within its topic without a gap.

The topics are `design:<id>` and `job:<id>`. An event gets its number under the lock of its design's or job's
own row, in the unit of work that makes it true. So a reader who sees a number sees all below it as well. A
sequence does not promise that: its numbers precede the commits. All SQL of events.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from operator import attrgetter

from sqlalchemy import Table, bindparam, insert, select, update
from sqlalchemy.orm import Session

from app.storage.clock import NAME, now
from app.storage.tables import Base, CounterRow, EventRow
from app.storage.units import Statement

Data = Mapping[str, object]

PAGE = 500  # events that are read at once
_EVENTS = Base.metadata.tables["event"]
_OWNERS: dict[str, Table] = {kind: Base.metadata.tables[kind] for kind in ("design", "job")}
_OPERATED = select(CounterRow.value).where(CounterRow.name == NAME).scalar_subquery()
_RAISED = {
    kind: Statement(
        update(owner)
        .where(owner.c.id == bindparam("of"))
        .values(event=owner.c.event + bindparam("more"))
        .returning(owner.c.event),
        "of",
        "more",
    )
    for kind, owner in _OWNERS.items()
}
_NOTED = Statement(insert(_EVENTS).values(operated=_OPERATED), "topic", "number", "name", "data", "created")


@dataclass(frozen=True)
class Event:
    """An event of a topic; one without a number is stored nowhere, such as progress."""

    topic: str
    name: str
    data: Data
    number: int | None = None

    @property
    def message(self) -> dict[str, object]:
        """Return the event as its readers get it: a JSON object with its name."""
        return {"event": self.name, **self.data}


TOPIC: Callable[[Event], str] = attrgetter("topic")


def note(session: Session, topic: str, name: str, data: Data) -> int:
    """Write an event in the unit of work that makes it true; its number.

    Nobody hears of it before they read the rows: services note events by `app.jobs.events.Events.note`.
    """
    (event,) = note_all(session, Event(topic, name, data))
    assert event.number is not None
    return event.number


def note_all(session: Session, *events: Event) -> list[Event]:
    """Write events in the unit of work that makes them true; the same events with their numbers.

    The rows of jobs are locked before those of designs, as everywhere.
    """
    counts = Counter(map(TOPIC, events))
    numbers = dict[str, int]()
    session.flush()  # the rows of which these events tell
    for topic in sorted(counts, reverse=True):
        kind, _, id = topic.partition(":")
        (raised,) = _RAISED[kind].run(session, {"of": id, "more": counts[topic]})
        numbers[topic] = raised[0] - counts[topic]
    created, noted, rows = now(), list[Event](), list[dict[str, object]]()
    for event in events:
        numbers[event.topic] += 1
        number = numbers[event.topic]
        noted.append(Event(event.topic, event.name, event.data, number))
        rows.append(
            {
                "topic": event.topic, "number": number, "name": event.name,
                "data": event.data, "created": created,
            }
        )  # fmt: skip
    _NOTED.run_many(session, rows)
    return noted


def newest(session: Session, topics: Iterable[str]) -> dict[str, int]:
    """Return the number of the newest event of each topic whose design or job there is; 0 if it has none."""
    ids: dict[str, list[str]] = {kind: [] for kind in _OWNERS}
    for topic in topics:
        kind, _, id = topic.partition(":")
        ids[kind].append(id)
    return {
        f"{kind}:{id}": number
        for kind, owner in _OWNERS.items()
        if ids[kind]
        for id, number in session.execute(select(owner.c.id, owner.c.event).where(owner.c.id.in_(ids[kind])))
    }


def above(session: Session, topic: str, number: int, most: int = PAGE) -> list[Event]:
    """Return the events of a topic above a number, in their order; not more than `most`."""
    row = EventRow
    later = select(row.name, row.data, row.number).where(row.topic == topic, row.number > number)
    rows = session.execute(later.order_by(row.number).limit(most))
    return [Event(topic, name, data, its) for name, data, its in rows]


def can_resume(session: Session, topic: str, number: int, newest: int) -> bool:
    """Return whether all events of a topic above a number are kept; not if it has not come to that number."""
    if number >= newest:
        return number == newest
    return session.get(EventRow, (topic, number + 1)) is not None
