"""Times and identities of stored objects, and the clock of operation, from which ages are computed.

Identities and ages come from counters in the database, not from the wall clock, which may jump either way. On
PostgreSQL identities come from a sequence: if every unit updated a counter row, only one unit could run at a
time.

The clock of operation counts the seconds for which the service has run, over all its starts. The age of a
stored object is the difference of two readings. So nothing ages while no server runs or when a machine's
clock jumps.

SQLite has one server, whose writer advances the counter by the monotonic clock of its process. If a server is
killed, the time since its last write is lost.

PostgreSQL may have several servers. Each advances the counter every few seconds under the lock of a row, and
stores the time in `TICKED`, by the clock of the database. A reader adds the time since then, at most
`LONGEST`. So each second counts once, however many servers run. A jump of the database's clock counts as
`LONGEST` at most.
"""

from __future__ import annotations

import logging
import secrets
import threading
import time
from datetime import UTC, datetime

from sqlalchemy import BigInteger, Connection, Double, cast, func, select, update
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.orm import Session
from sqlalchemy.sql.compiler import SQLCompiler
from sqlalchemy.sql.functions import GenericFunction

from app.storage.tables import Base, CounterRow
from app.storage.units import DRIVER, Statement, Writer

logger = logging.getLogger(__name__)

NAME, TICKED = "operation", "ticked"
DAY = 86_400  # s
TICK = 5.0  # interval at which a server advances the counter [s]
LONGEST = 15  # largest time that counts if no server advances the counter [s]


_ADVANCED = "UPDATE counter SET value = value + ? WHERE name = ?"


class present(GenericFunction[float]):  # noqa: N801 - it is written as a function
    """Return an SQL expression for the present time by the clock of the database [s since 1970].

    The clocks of servers may differ. The time advances within a transaction.
    """

    type = Double()
    inherit_cache = True


@compiles(present, "postgresql")
def _on_postgresql(element: present, compiler: SQLCompiler, **options: object) -> str:
    return "extract(epoch from clock_timestamp())::float8"


@compiles(present, "sqlite")
def _on_sqlite(element: present, compiler: SQLCompiler, **options: object) -> str:
    return "((julianday('now') - 2440587.5) * 86400.0)"


class OperationClock:
    """Raises the counter by the whole seconds that have passed; the writer thread of SQLite uses it."""

    def __init__(self) -> None:
        self._counted = time.monotonic()  # the counter includes all time up to this moment

    @property
    def elapsed(self) -> int:
        """Return the number of whole seconds that have passed but are not yet added to the counter."""
        return int(time.monotonic() - self._counted)

    def advance(self, connection: Connection) -> int:
        """Raise the counter in the caller's transaction, and return the number of seconds added."""
        seconds = self.elapsed
        if seconds:
            connection.exec_driver_sql(_ADVANCED, (seconds, NAME))
        return seconds

    def commit(self, seconds: int) -> None:
        """Record that the increase is durable; if its transaction is lost, the next one includes it."""
        self._counted += seconds

    def close(self) -> None:
        """Do nothing, because the writer stores the remaining seconds when it is closed."""


class SharedClock:
    """Advances the counter of a shared database periodically in its own thread."""

    elapsed = 0
    """Whole seconds that `operated` does not include: none."""

    def __init__(self, writer: Writer) -> None:
        self._writer = writer
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._work, name="operation-clock", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Advance the counter a last time, and end the thread. A second call does nothing."""
        self._stopping.set()
        self._thread.join()

    def _work(self) -> None:
        is_last = False
        while not is_last:
            is_last = self._stopping.wait(TICK)
            try:
                self._writer.write(tick)
            except Exception as error:
                logger.warning("The clock of operation could not be advanced; trying again: %s", error)


def tick(session: Session) -> None:
    """Advance the counter of a shared database to the present, in a unit of work."""
    query = select(CounterRow.value, func.floor(present())).where(CounterRow.name == TICKED)
    then, now = session.execute(query.with_for_update()).one()
    seconds = min(max(int(now) - then, 0), LONGEST)
    for name, value in ((TICKED, int(now)), (NAME, CounterRow.value + seconds)):
        session.execute(update(CounterRow).where(CounterRow.name == name).values(value=value))


def operated(session: Session) -> int:
    """Return the time of operation [s].

    On SQLite it is exact to a second within a unit of work; otherwise it is the time of the last write. On
    PostgreSQL it is always exact.
    """
    if DRIVER in session.info or session.get_bind().dialect.name == "sqlite":
        counted = _COUNTED.run(session)
        return int(counted[0][0]) if counted else 0
    return session.scalar(_OPERATED) or 0


_COUNTER = Base.metadata.tables[CounterRow.__tablename__]
_COUNTED = Statement(select(_COUNTER.c.value).where(_COUNTER.c.name == NAME))
_THEN = select(CounterRow.value).where(CounterRow.name == TICKED).scalar_subquery()
_SINCE = func.least(func.greatest(func.floor(present()) - _THEN, 0), LONGEST)
_OPERATED = select(cast(CounterRow.value + _SINCE, BigInteger)).where(CounterRow.name == NAME)


IDENTITY = "identity"
_RAISED = Statement(
    update(_COUNTER)
    .where(_COUNTER.c.name == IDENTITY)
    .values(value=_COUNTER.c.value + 1)
    .returning(_COUNTER.c.value)
)
_NEXT = select(func.nextval(IDENTITY))


def new_id(session: Session) -> str:
    """Return a new identity of 24 hexadecimal digits; later ones sort after earlier ones.

    The counter increases in the unit of work that uses the identity.
    """
    if DRIVER in session.info or session.get_bind().dialect.name == "sqlite":
        ((number,),) = _RAISED.run(session)  # a migrated database has its counters
    else:
        number = session.connection().scalar(_NEXT)
    return f"{number:014x}{secrets.token_hex(5)}"


def now() -> str:
    """Return the present time in UTC as text."""
    return as_text(datetime.now(UTC))


def as_text(moment: datetime) -> str:
    """Return a moment in UTC as ISO 8601 text of constant length, so that text order is time order."""
    return f"{moment.replace(tzinfo=None).isoformat(timespec='microseconds')}Z"
