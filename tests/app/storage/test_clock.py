"""Ages and orders come from counters, so a jumping wall clock changes neither."""

from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import pytest
from sqlalchemy.exc import OperationalError

from app.jobs import repository
from app.retention.service import Retention
from app.settings import Settings
from app.storage.artifacts import ArtifactStore
from app.storage.clock import DAY, operated
from app.storage.database import Database
from app.storage.idempotency import Once


class Monotonic:
    """A monotonic clock that a test moves forward."""

    def __init__(self):
        self.seconds = 1000.0

    def __call__(self):
        return self.seconds


@pytest.fixture
def monotonic(monkeypatch):
    clock = Monotonic()
    monkeypatch.setattr("app.storage.clock.time", SimpleNamespace(monotonic=clock))
    return clock


@pytest.fixture
def wall(monkeypatch):
    """Set the wall clock off by some time."""

    def off(by):
        moved = SimpleNamespace(now=lambda zone: datetime.now(UTC) + by)
        monkeypatch.setattr("app.storage.clock.datetime", moved)
        monkeypatch.setattr("time.time", lambda: (datetime.now(UTC) + by).timestamp())

    return off


@pytest.fixture
def database(monotonic, url):
    """A database whose clock the test moves."""
    database = Database(url)
    yield database
    database.close()


def age(database):
    return database.write(operated)


def test_the_clock_counts_whole_seconds_of_the_monotonic_clock(database, monotonic):
    assert age(database) == 0
    monotonic.seconds += 0.75
    assert age(database) == 0
    monotonic.seconds += 0.75
    assert age(database) == 1
    monotonic.seconds += 100.5
    assert age(database) == 102, "the half seconds are not lost"


def test_time_without_the_service_does_not_count(database, monotonic, url):
    monotonic.seconds += 50
    database.close()
    monotonic.seconds += 5000
    again = Database(url)
    monotonic.seconds += 7
    assert age(again) == 57
    again.close()


def test_time_of_a_lost_transaction_is_counted_by_the_next(database, monotonic):
    def ruin(session):
        monotonic.seconds += 20  # while it runs
        session.connection().connection.driver_connection.rollback()

    monotonic.seconds += 10
    with pytest.raises(OperationalError):
        database.write(ruin)
    assert age(database) == 30


@pytest.mark.parametrize("by", [timedelta(days=-4000), timedelta(days=4000)])
def test_a_jump_of_the_wall_clock_reorders_no_jobs(database, wall, by):
    def put(name):
        return database.write(lambda session: repository.add(session, "k", {"name": name}, None, None))

    ids = [put("a"), put("b")]
    wall(by)
    ids += [put("c")]
    wall(-by)
    ids += [put("d")]
    with database.read() as session:
        assert [job.id for job in repository.page(session, 10, None)] == ids[::-1]
    assert [database.write(repository.claim).payload["name"] for _ in ids] == list("abcd")


@pytest.mark.parametrize("by", [timedelta(days=-4000), timedelta(days=4000)])
def test_a_jump_of_the_wall_clock_forgets_no_key(database, monotonic, wall, by, tmp_path):
    retention = Retention(database, ArtifactStore(tmp_path / "files"), Settings())
    once = Once("key", "POST /designs", "body", "name:anna")
    monotonic.seconds += 20 * DAY
    database.write(lambda session: once.keep(session, 201, {"design": "1"}))
    wall(by)
    monotonic.seconds += 6.9 * DAY
    assert retention.run()["keys"] == 0
    with database.read() as session:
        assert once.find(session) == {"design": "1"}
    monotonic.seconds += 0.2 * DAY
    assert retention.run()["keys"] == 1
    with database.read() as session:
        assert once.find(session) is None
