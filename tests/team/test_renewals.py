"""Units of work that share a build do not wait for each other on PostgreSQL."""

import pytest
from sqlalchemy import select, text, update
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

from app.solids.rows import FRESH, renew
from app.storage.clock import operated
from app.storage.database import Database
from app.storage.engines import writing_engine
from app.storage.tables import BuildRow, CounterRow

AGED = 1_000_000  # so that the service has been running for long [s]


@pytest.fixture
def database(own_postgres):
    database = Database(own_postgres)
    yield database
    database.close()


@pytest.fixture
def engine(database, own_postgres):
    def unit(session):
        session.execute(update(CounterRow).where(CounterRow.name == "operation").values(value=AGED))
        present = operated(session)
        for key, age in (("fresh", 0), ("old", FRESH + 1000)):
            session.add(
                BuildRow(
                    key=key,
                    model="m",
                    version=1,
                    parameters={},
                    measurements={},
                    created="",
                    operated=present - age,
                )
            )

    database.write(unit)
    engine = writing_engine(own_postgres, pool=2)
    yield engine
    engine.dispose()


def without_waiting(session):
    session.execute(text("SET LOCAL lock_timeout = '50ms'"))
    return session


def test_two_units_count_on_a_build_that_was_wanted_recently(engine):
    with Session(engine) as one, Session(engine) as other:
        assert renew(one, ["fresh"])
        assert renew(without_waiting(other), ["fresh"])


def test_an_old_build_is_renewed_once(engine):
    with Session(engine) as one, Session(engine) as other:
        assert renew(one, ["old", "fresh"])
        with pytest.raises(OperationalError, match="lock timeout"):
            renew(without_waiting(other), ["old"])
        other.rollback()
        one.commit()
        assert renew(without_waiting(other), ["old", "fresh"])
        ages = other.execute(select(BuildRow.key, operated(other) - BuildRow.operated)).all()
        assert all(age < FRESH for _, age in ages)


def test_one_that_is_gone_is_missed(engine):
    with Session(engine) as session:
        assert not renew(session, ["fresh", "gone"])
        assert not renew(session, ["old", "gone"])
        assert renew(session, [])
