"""The storage of a principal is one row, right for writes of this program and of plain SQL."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from sqlalchemy import event, func, select, text

from app.identity import usage
from app.storage.tables import StorageRow, UsageRow

RAISE_USAGE = text(  # a writer that knows nothing of the sums
    'INSERT INTO "usage" (principal_id, day, requests, jobs, seconds, bytes) '
    "VALUES (:principal, :day, 1, 0, 0.5, :bytes) "
    "ON CONFLICT (principal_id, day) DO UPDATE SET "
    'requests = "usage".requests + excluded.requests, jobs = "usage".jobs + excluded.jobs, '
    'seconds = "usage".seconds + excluded.seconds, bytes = "usage".bytes + excluded.bytes'
)


def raised(database, *amounts):
    for principal, day, bytes in amounts:
        values = {"principal": principal, "day": day, "bytes": bytes}
        database.write(lambda session, values=values: session.execute(RAISE_USAGE, values).rowcount)


def sums(database):
    """By principal: the row, and the sum of its days."""
    with database.read() as session:
        rows = {row.principal_id: row.bytes for row in session.scalars(select(StorageRow))}
        days = select(UsageRow.principal_id, func.sum(UsageRow.bytes)).group_by(UsageRow.principal_id)
        return rows, {principal: int(total) for principal, total in session.execute(days) if total}


def test_whatever_raises_usage_is_counted(database):
    raised(database, ("ada", "2026-11-21", 100), ("ada", "2026-11-22", 20), ("ben", "2026-11-22", 3))
    assert sums(database) == ({"ada": 120, "ben": 3}, {"ada": 120, "ben": 3})
    raised(
        database,
        ("ada", "2026-11-22", 5),  # a day that there is
        ("ada", "2026-11-23", 7),  # a new one
        ("ada", "2026-11-23", 0),  # a request that stores nothing
        ("cid", "2026-11-23", 0),
        ("dan", "2026-11-23", 11),  # somebody new
    )
    assert sums(database) == ({"ada": 132, "ben": 3, "dan": 11}, {"ada": 132, "ben": 3, "dan": 11})
    database.write(lambda session: usage.note(session, "ada", bytes=1000))
    assert sums(database)[0]["ada"] == 1132
    with database.read() as session:
        assert usage.used(session, "ada").bytes == 1132
        assert usage.used(session, "cid").bytes == usage.used(session, "nobody").bytes == 0


def test_a_unit_that_fails_adds_nothing(database):
    def unit(session):
        usage.note(session, "ada", bytes=10)
        raise RuntimeError("in the unit")

    database.write(lambda session: usage.note(session, "ada", bytes=1))
    with pytest.raises(RuntimeError):
        database.write(unit)
    assert sums(database)[0] == {"ada": 1}


def test_simultaneous_units_lose_nothing(database):
    def add(number):
        database.write(lambda session: usage.note(session, f"p{number % 2}", bytes=number, requests=1))

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(add, range(40)))
    assert sums(database)[0] == {"p0": sum(range(0, 40, 2)), "p1": sum(range(1, 40, 2))}


def test_a_request_reads_one_row_however_many_days_were_used(database):
    for day in range(30):
        raised(database, ("ada", f"day {day:02}", 1))
    statements = []
    with database.read() as session:
        listen = lambda *about: statements.append(about[2])  # noqa: E731
        event.listen(session.get_bind(), "before_cursor_execute", listen)
        assert usage.used(session, "ada").bytes == 30
    assert [statement for statement in statements if "FROM storage" in statement]
    assert "sum(" not in " ".join(statements).lower()
