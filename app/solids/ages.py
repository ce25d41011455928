"""Ages of unused builds: a build that no revision uses is deleted after a time, see `app.retention`.

Whoever wants a build renews its age in the unit of work that counts on it, or learns there that it is gone.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import lru_cache
from operator import itemgetter

from sqlalchemy import bindparam, select, update
from sqlalchemy.orm import Session

from app.storage.clock import operated
from app.storage.statements import Row, Statement
from app.storage.tables import Base, BuildRow

_BUILDS = Base.metadata.tables[BuildRow.__tablename__]
FRESH = (
    3600  # a build wanted this recently need not be renewed: it is kept for a day or longer [s of operation]
)


def is_fresh(session: Session, keys: Collection[str]) -> bool:
    """Return whether all of these builds exist, and will stay for as long as any request or job takes."""
    wanted, present = set(keys), operated(session)
    seen = _seen(session, wanted)
    return len(seen) == len(wanted) and min(map(itemgetter(1), seen), default=present) >= present - FRESH


def renew(session: Session, keys: Collection[str]) -> bool:
    """Renew the age of builds in a unit of work; return whether all of them are there.

    A build that was wanted within the last hour stays as it is, so units that share one do not wait for each
    other: none of them locks its row.
    """
    if not keys:
        return True
    wanted, present = set(keys), operated(session)
    seen = _seen(session, wanted)
    old = {key for key, age in seen if age < present - FRESH}
    if not old:
        return len(seen) == len(wanted)
    renewal = update(BuildRow).where(BuildRow.key.in_(old)).values(operated=present)
    renewed = session.scalars(renewal.returning(BuildRow.key)).all()  # what is not deleted meanwhile
    return len(seen) - len(old) + len(renewed) == len(wanted)


def _seen(session: Session, keys: Collection[str]) -> Sequence[Row]:
    """Return the key and age of those of these builds that are there."""
    ages = _ages(len(keys))
    return ages.run(session, dict(zip(ages.names, keys, strict=True)))


@lru_cache(16)
def _ages(count: int) -> Statement:
    names = [f"key{n}" for n in range(count)]
    seen = select(_BUILDS.c.key, _BUILDS.c.operated).where(_BUILDS.c.key.in_(list(map(bindparam, names))))
    return Statement(seen, *names)
