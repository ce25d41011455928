"""Ids and times of stored objects.

Identities and ages come from counters in the database, not from the wall clock, which may jump either way.
On PostgreSQL identities come from a sequence: to raise a row in every unit would let one unit run at a time.
"""

import secrets
from datetime import UTC, datetime

from sqlalchemy import func, select, update
from sqlalchemy.orm import Session

from app.storage.statements import DRIVER, Statement
from app.storage.tables import Base, CounterRow

IDENTITY = "identity"
_COUNTER = Base.metadata.tables[CounterRow.__tablename__]
_RAISED = Statement(
    update(_COUNTER)
    .where(_COUNTER.c.name == IDENTITY)
    .values(value=_COUNTER.c.value + 1)
    .returning(_COUNTER.c.value)
)
_NEXT = select(func.nextval(IDENTITY))


def new_id(session: Session) -> str:
    """Return a new identity of 24 hexadecimal digits; later ones sort after earlier ones.

    It is counted up in the unit of work that uses it.
    """
    if DRIVER in session.info or session.get_bind().dialect.name == "sqlite":
        ((number,),) = _RAISED.run(session)  # a migrated database has its counters
    else:
        number = session.connection().scalar(_NEXT)
    return f"{number:014x}{secrets.token_hex(5)}"


def now() -> str:
    """Return the present time in UTC as text."""
    return f"{datetime.now(UTC).replace(tzinfo=None).isoformat(timespec='microseconds')}Z"


def as_text(moment: datetime) -> str:
    """Return a moment in UTC as ISO 8601 text of constant length: text order is time order."""
    return f"{moment.replace(tzinfo=None).isoformat(timespec='microseconds')}Z"
