"""Jobs run on behalf of whoever asked for them, who is charged with the time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from app.identity import usage
from app.identity.acting import BUILT_IN, LOCAL, acting_as
from app.identity.rows import asked_by
from app.storage.database import Database


@contextmanager
def working_for(database: Database, principal: str | None) -> Iterator[None]:
    """Act for a principal by its id, and note how long that takes; LOCAL where nobody is named."""
    if principal is None or principal in BUILT_IN:
        with acting_as(LOCAL):
            yield
        return
    with database.read() as session:
        who = asked_by(session, principal)
    start = time.monotonic()
    try:
        with acting_as(who):
            yield
    finally:
        seconds = time.monotonic() - start
        database.write(lambda session: usage.note(session, who.id, seconds=seconds))
