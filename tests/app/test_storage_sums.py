"""What a principal has stored is one row, right whoever wrote: this program, or one of the schema before."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from alembic import command
from alembic.config import Config
from sqlalchemy import event, func, select, text

from app.identity import usage
from app.storage import migrations
from app.storage.database import Database
from app.storage.engines import migrating_engine
from app.storage.tables import StorageRow, UsageRow

OF_0007 = text(  # as the program of that schema raises usage
    'INSERT INTO "usage" (principal_id, day, requests, jobs, seconds, bytes) '
    "VALUES (:principal, :day, 1, 0, 0.5, :bytes) "
    "ON CONFLICT (principal_id, day) DO UPDATE SET "
    'requests = "usage".requests + excluded.requests, jobs = "usage".jobs + excluded.jobs, '
    'seconds = "usage".seconds + excluded.seconds, bytes = "usage".bytes + excluded.bytes'
)


@pytest.fixture(params=["sqlite", "postgresql"])
def place(request, tmp_path):
    """The URL of an empty database that nobody has migrated."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path}/empty.sqlite"
        return
    cluster = request.getfixturevalue("cluster")
    yield cluster.create("of_0007")
    cluster.drop("of_0007")


def migrated_to(place, version):
    """Migrate as a program of that schema does."""
    config = Config()
    config.set_main_option("script_location", str(next(iter(migrations.__path__))))
    engine = migrating_engine(place)
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, version)
    engine.dispose()


def raised_by_0007(database, *amounts):
    for principal, day, bytes in amounts:
        values = {"principal": principal, "day": day, "bytes": bytes}
        database.write(lambda session, values=values: session.execute(OF_0007, values).rowcount)


def sums(database):
    """By principal: the row, and the sum of its days."""
    with database.read() as session:
        rows = {row.principal_id: row.bytes for row in session.scalars(select(StorageRow))}
        days = select(UsageRow.principal_id, func.sum(UsageRow.bytes)).group_by(UsageRow.principal_id)
        return rows, {principal: int(total) for principal, total in session.execute(days) if total}


def test_what_was_there_and_what_an_older_server_adds_are_counted(place):
    migrated_to(place, "0007")
    database = Database(place)
    raised_by_0007(database, ("ada", "2026-11-21", 100), ("ada", "2026-11-22", 20), ("ben", "2026-11-22", 3))
    database.close()
    migrated_to(place, "head")
    database = Database(place)
    assert sums(database) == ({"ada": 120, "ben": 3}, {"ada": 120, "ben": 3})
    raised_by_0007(
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
    database.close()


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
        raised_by_0007(database, ("ada", f"day {day:02}", 1))
    statements = []
    with database.read() as session:
        listen = lambda *about: statements.append(about[2])  # noqa: E731
        event.listen(session.get_bind(), "before_cursor_execute", listen)
        assert usage.used(session, "ada").bytes == 30
    assert [statement for statement in statements if "FROM storage" in statement]
    assert "sum(" not in " ".join(statements).lower()
