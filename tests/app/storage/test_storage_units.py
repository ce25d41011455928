"""Counters, errors and damage marks of the storage are correct, tested separately."""

import pickle
import sqlite3
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy.exc import DBAPIError, OperationalError

from app.storage import clock, errors
from app.storage.database import Database
from app.storage.integrity import is_damage
from app.storage.migrations import migrate
from app.storage.tables import CounterRow


@pytest.fixture
def database(tmp_path):
    url = f"sqlite:///{tmp_path}/test.sqlite"
    migrate(url)
    opened = Database(url)
    yield opened
    opened.close()


def counters(database):
    with database.read() as session:
        return {row.name: row.value for row in session.query(CounterRow)}


def test_an_identity_raises_its_own_counter_by_one(database):
    database.write(lambda session: session.add_all([CounterRow(name=n, value=7) for n in ("a", "zebra")]))
    before = counters(database)
    ids = [database.write(clock.new_id) for _ in range(3)]
    assert ids == sorted(set(ids))
    assert all(len(id) == 24 and int(id, 16) >= 0 for id in ids)
    assert [int(id[:14], 16) for id in ids] == [before["identity"] + n for n in (1, 2, 3)]
    after = counters(database)
    assert after.pop("identity") == before.pop("identity") + 3
    assert (after["a"], after["zebra"]) == (before["a"], before["zebra"]) == (7, 7)


def test_a_moment_is_a_text_of_constant_length_whose_order_is_that_of_time():
    begin = datetime(2026, 1, 1, tzinfo=UTC)
    moments = [begin + timedelta(microseconds=n) for n in (0, 1, 999_999, 1_000_000, 86_400_000_000)]
    texts = [clock.as_text(moment) for moment in moments]
    assert texts[0] == "2026-01-01T00:00:00.000000Z"
    assert texts == sorted(texts)
    assert {len(text) for text in texts} == {27}


def corrupt(code, text="broken"):
    error = sqlite3.DatabaseError(text)
    error.sqlite_errorcode = code
    return error


@pytest.mark.parametrize(
    ("error", "damaged"),
    [
        (corrupt(sqlite3.SQLITE_CORRUPT), True),
        (corrupt(sqlite3.SQLITE_CORRUPT | 1 << 8), True),  # an extended code
        (corrupt(sqlite3.SQLITE_NOTADB), True),
        (corrupt(sqlite3.SQLITE_BUSY), False),
        (corrupt(sqlite3.SQLITE_FULL), False),
        (sqlite3.OperationalError("Could not decode to UTF-8 column 'name'"), True),
        (sqlite3.OperationalError("no such table"), False),
        (errors.DatabaseDamaged("file", ["page 3"]), True),
        (errors.CommitFailed(), False),
        (ValueError("Could not decode to UTF-8"), False),
    ],
    ids=str,
)
def test_damage_is_no_other_error(error, damaged):
    assert is_damage(error) is damaged
    wrapped = OperationalError("select 1", {}, error)
    assert isinstance(wrapped, DBAPIError)
    assert is_damage(wrapped) is (damaged and isinstance(error, sqlite3.Error | errors.StorageError))


@pytest.mark.parametrize(
    ("error", "names"),
    [
        (errors.DataFolderInUse("/data", "42"), ["/data", "process 42", "CRANKWRIGHT_DATA"]),
        (errors.DataFolderInUse("/data", ""), ["/data", "process unknown"]),
        (errors.DatabaseNewer("9999"), ["9999", "Upgrade"]),
        (errors.DatabaseBeforeRelease("0009"), ["0009", "new data folder"]),
        (
            errors.DatabaseDamaged("file.sqlite", ["page 3", "page 5"]),
            ["file.sqlite", "page 3; page 5", "restore"],
        ),
        (errors.ArtifactMissing("abc"), ["abc"]),
        (errors.ArtifactDamaged("abc", "its 3 bytes"), ["abc", "its 3 bytes", "set aside"]),
    ],
    ids=lambda value: type(value).__name__,
)
def test_errors_say_what_they_are_about_in_another_process_too(error, names):
    for one in (error, pickle.loads(pickle.dumps(error))):
        assert all(name in str(one) for name in names)
        assert vars(one) == vars(error)


def test_a_fresh_database_has_counted_nothing(database):
    assert counters(database) == {"identity": 0, "operation": 0}
