"""Names and times of stored things.

Identities and ages come from counters in the database, not from the wall clock, which may jump either way.
"""

import secrets
from datetime import UTC, datetime

from sqlalchemy import update
from sqlalchemy.orm import Session

from app.storage.tables import CounterRow


def new_id(session: Session) -> str:
    """Return a new identity of 24 hexadecimal digits; later ones sort after earlier ones.

    It is counted up in the unit of work that uses it.
    """
    return f"{_raised(session, 'identity', 1):014x}{secrets.token_hex(5)}"


def _raised(session: Session, name: str, by: int) -> int:
    """A counter, raised in the caller's unit of work."""
    raised = update(CounterRow).where(CounterRow.name == name).values(value=CounterRow.value + by)
    value: int | None = session.scalar(raised.returning(CounterRow.value))
    assert value is not None, "a migrated database has its counters"
    return value


def now() -> str:
    """Return the present time in UTC as text."""
    return as_text(datetime.now(UTC))


def as_text(moment: datetime) -> str:
    """Return a moment in UTC as ISO 8601 text of constant length: text order is time order."""
    return moment.isoformat(timespec="microseconds").replace("+00:00", "Z")
