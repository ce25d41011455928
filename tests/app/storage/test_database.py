"""One writer and many readers: durable, isolated by unit of work, committed in groups."""

import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from patience import patient, until
from sqlalchemy import delete, event, func, select
from sqlalchemy.exc import IntegrityError, OperationalError
from unsynced import DURABLE

from app.storage import engines
from app.storage.clock import new_id, now
from app.storage.database import Database
from app.storage.errors import CommitFailed, DatabaseClosed
from app.storage.tables import DesignRow, RevisionRow


def design(name="bearing"):
    return DesignRow(id=name, name=name, created=now(), head=0)


def adding(name):
    return lambda session: session.add(design(name))


def names(database):
    with database.read() as session:
        return set(session.scalars(select(DesignRow.id)))


@pytest.fixture
def commits(database):
    """How many transactions the writer has committed."""
    seen = []
    event.listen(database._writer.engine, "commit", seen.append)
    return seen


@pytest.fixture
def together(database):
    """Run units in one group: they queue up while the writer is busy with another."""

    def run(*units):
        busy, gate = threading.Event(), threading.Event()
        with ThreadPoolExecutor(len(units) + 1) as pool:
            pool.submit(database.write, lambda session: (busy.set(), gate.wait(patient(60))))
            assert busy.wait(patient(60))
            futures = [pool.submit(database.write, unit) for unit in units]
            until(lambda: database._writer._waiting.qsize() >= len(units))
            gate.set()
        return futures

    return run


def test_a_write_returns_the_result_of_its_unit(database):
    def unit(session):
        session.add(design("a"))
        session.flush()
        return session.scalar(select(func.count()).select_from(DesignRow))

    assert database.write(unit) == 1
    assert names(database) == {"a"}


def test_waiting_units_share_a_commit(database, together, commits):
    together(*[adding(str(number)) for number in range(20)])
    assert len(commits) == 2  # the one that kept the writer busy, and one for all others
    assert len(names(database)) == 20


def test_a_raising_unit_is_undone_alone(database, together):
    def failing(session):
        session.add(design("b"))
        session.flush()
        raise ZeroDivisionError

    first, second, third = together(adding("a"), failing, adding("c"))
    with pytest.raises(ZeroDivisionError):
        second.result()
    assert first.result() is third.result() is None
    assert names(database) == {"a", "c"}


def test_a_violated_constraint_reaches_its_caller(database):
    def orphan(session):
        session.add(RevisionRow(design_id="nobody", number=1, created=now(), document={}, state="current"))

    with pytest.raises(IntegrityError):
        database.write(orphan)
    assert database.write(adding("a")) is None


def test_parents_are_stored_before_children(database):
    def unit(session):
        session.add(RevisionRow(design_id="a", number=1, created=now(), document={}, state="current"))
        session.add(design("a"))

    database.write(unit)
    assert names(database) == {"a"}


def test_a_unit_that_hides_a_failed_statement_stores_nothing(database):
    def hiding(session):
        session.add(design("b"))
        session.flush()
        session.add(design("a"))
        try:
            session.flush()
        except IntegrityError:
            return

    database.write(adding("a"))
    with pytest.raises(Exception, match="rolled back"):
        database.write(hiding)
    assert names(database) == {"a"}


def test_a_failed_commit_fails_the_whole_group(database, together):
    @event.listens_for(database._writer.engine, "commit")
    def full(connection):
        if connection.scalar(select(func.count()).select_from(DesignRow)):
            raise sqlite3.OperationalError("database or disk is full")

    for future in together(adding("a"), adding("b")):
        with pytest.raises(CommitFailed):
            future.result()
    assert names(database) == set()


def test_units_after_a_lost_transaction_store_nothing(database, together):
    def losing(session):
        session.connection().connection.driver_connection.execute(
            "ROLLBACK"
        )  # as SQLite does when out of disk
        raise sqlite3.OperationalError("database or disk is full")

    first, second, third = together(adding("a"), losing, adding("c"))
    for future, error in ((first, CommitFailed), (second, Exception), (third, OperationalError)):
        with pytest.raises(error):
            future.result()
    assert names(database) == set()
    assert database.write(adding("d")) is None
    assert names(database) == {"d"}


def test_a_reader_keeps_its_snapshot(database):
    count = select(func.count()).select_from(DesignRow)
    with database.read() as session:
        before = session.scalar(count)
        database.write(adding("a"))
        assert session.scalar(count) == before == 0
    assert names(database) == {"a"}


def test_a_reader_cannot_write(database):
    with database.read() as session, pytest.raises(OperationalError, match="readonly"):
        session.execute(delete(DesignRow))


def test_rows_stay_readable_after_their_session(database):
    def unit(session):
        session.add(row := design("a"))
        return row

    assert database.write(unit).name == "a"


def test_a_write_may_be_waited_for_later(database):
    assert database.submit(adding("a")).result(timeout=10) is None
    assert names(database) == {"a"}


def test_a_unit_may_not_wait_for_another(database):
    with pytest.raises(RuntimeError, match="use the session of the running unit"):
        database.write(lambda session: database.write(adding("a")))


def test_a_closed_database_refuses_work(url):
    database = Database(url)
    database.close()
    database.close()
    with pytest.raises(DatabaseClosed):
        database.write(adding("a"))


def test_closing_commits_what_waits(url, tmp_path):
    database = Database(url)
    future = database.submit(adding("a"))
    database.close()
    assert future.done()
    reopened = Database(url)
    assert names(reopened) == {"a"}
    reopened.close()


def test_the_writer_syncs_every_commit_and_keeps_foreign_keys(url, monkeypatch):
    monkeypatch.setattr(engines, "_WRITER", DURABLE)
    database = Database(url)

    def pragmas(session):
        connection = session.connection()
        names = ("journal_mode", "synchronous", "foreign_keys")
        return [connection.exec_driver_sql(f"PRAGMA {name}").scalar() for name in names]

    assert database.write(pragmas) == ["wal", 2, 1]  # 2 is FULL: a power cut cannot be tried here
    database.close()


def test_identities_grow_whatever_the_clock_says(database, monkeypatch):
    identities = [database.write(new_id)]
    for seconds in (-1e9, 1e9, 0.0):
        monkeypatch.setattr(time, "time", lambda seconds=seconds: seconds)
        monkeypatch.setattr(time, "time_ns", lambda seconds=seconds: int(seconds * 1e9))
        identities.append(database.write(new_id))
    assert identities == sorted(identities)
    assert len({identity[:14] for identity in identities}) == 4
    assert {len(identity) for identity in identities} == {24}


WRITE_FOR_EVER = """
import sys, threading
from app.storage.database import Database
from app.storage.clock import now
from app.storage.tables import DesignRow
database = Database(sys.argv[1])
def loop(thread):
    for number in range(10**6):
        name = f"{thread}-{number}"
        database.write(lambda session: session.add(DesignRow(id=name, name=name, created=now(), head=0)))
        sys.stdout.write(name + "\\n")
        sys.stdout.flush()
for thread in range(4):
    threading.Thread(target=loop, args=(thread,)).start()
"""


def test_every_acknowledged_write_survives_a_kill(url):
    command = [sys.executable, "-c", WRITE_FOR_EVER, url]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        acknowledged = [process.stdout.readline().strip() for _ in range(200)]
        os.kill(process.pid, signal.SIGKILL)
        rest = process.stdout.read()
        acknowledged += [line for line in rest.split("\n")[:-1] if line]
    database = Database(url)
    with database.read() as session:
        stored = list(session.scalars(select(DesignRow.name)))
        assert session.connection().exec_driver_sql("PRAGMA integrity_check").scalar() == "ok"
    assert set(acknowledged) <= set(stored)
    assert len(stored) == len(set(stored))
    assert len(stored) <= len(acknowledged) + 4  # at most one write of each thread was not acknowledged
    database.close()
