"""Units of work: functions that run in one transaction, and their attributes."""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import Future
from typing import Protocol, TypeVar

from sqlalchemy import Engine
from sqlalchemy.orm import Session

logger = logging.getLogger(__name__)

T = TypeVar("T")
Unit = Callable[[Session], T]

AFTER, REPEATABLE = "after commit", "repeatable"
"""Under which a session keeps, in its `info`, what is to follow its unit, and that this may run again."""


class Writer(Protocol):
    """Runs units of work, each of which is stored whole or not at all; see `Database.write`."""

    engine: Engine

    def write(self, unit: Unit[T]) -> T:
        """Run a unit and return its result once that is durable."""
        ...

    def submit(self, unit: Unit[T]) -> Future[T]:
        """Have a unit run; its future raises as `write` does."""
        ...

    def close(self) -> None:
        """Take no more units, and wait for those that were submitted."""
        ...


def after_commit(session: Session, function: Callable[[], object]) -> None:
    """Have a function called once the unit of work of this session is durable; never, if the unit is lost.

    It is called in the thread of the writer, before the caller of the unit goes on. It may not write.
    """
    session.info.setdefault(AFTER, []).append(function)


def repeatable(session: Session) -> None:
    """Say that this unit of work does no harm if it runs again, even if it has been stored already.

    So it may be repeated when the connection is lost during its commit, and nobody knows if it is stored.
    """
    session.info[REPEATABLE] = True


def follow(functions: list[Callable[[], object]]) -> None:
    """Call what follows a unit; an error there takes nothing along."""
    for function in functions:
        try:
            function()
        except Exception:
            logger.exception("What was to follow a unit of work has failed; the unit is stored")
