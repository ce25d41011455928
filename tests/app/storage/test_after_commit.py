"""Actions after a unit of work run once it is durable, and never otherwise."""

import sqlite3
import threading

import pytest
from sqlalchemy import event, select

from app.storage.clock import now
from app.storage.database import after_commit
from app.storage.errors import CommitFailed
from app.storage.tables import DesignRow


def adding(name, *functions):
    def unit(session):
        session.add(DesignRow(id=name, name=name, created=now(), head=0))
        for function in functions:
            after_commit(session, function)
        return name

    return unit


def names(database):
    with database.read() as session:
        return set(session.scalars(select(DesignRow.id)))


def test_it_is_called_when_the_unit_is_durable_and_before_its_caller_goes_on(database):
    seen = []
    database.write(adding("a", lambda: seen.append(names(database)), lambda: seen.append("second")))
    assert seen == [{"a"}, "second"]


def test_it_is_not_called_for_a_unit_that_raises(database):
    seen = []

    def failing(session):
        adding("a", lambda: seen.append("a"))(session)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        database.write(failing)
    assert seen == []


def test_it_is_not_called_for_a_unit_whose_commit_fails(database):
    seen = []

    @event.listens_for(database._writer.engine, "commit")
    def full(connection):
        raise sqlite3.OperationalError("database or disk is full")

    with pytest.raises(CommitFailed):
        database.write(adding("a", lambda: seen.append("a")))
    assert seen == []


def test_what_it_raises_is_logged_and_takes_nothing_along(database, caplog):
    called = threading.Event()
    assert database.write(adding("a", lambda: 1 / 0, called.set)) == "a"
    assert called.is_set()
    assert names(database) == {"a"}
    assert "ZeroDivisionError" in caplog.text
