"""Audit rows are written in the transaction of their change and sealed in an unchangeable chain."""

import pytest
from click.testing import CliRunner
from components import ON_POSTGRESQL
from patience import until
from sqlalchemy import text
from sqlalchemy.exc import DatabaseError

from app.cli.audit import audit_command
from app.identity import chain
from app.identity.audit import record
from app.identity.principal import Principal, acting_as
from app.identity.sealer import Sealer
from app.storage.engines import writing_engine
from app.storage.tables import AuditRow

ANN = Principal("p-ann", "Ann", "person", frozenset({"author"}))
NO_VALUES = ("x'ff'", "'x' where seq", ".5 where seq")  # SQLite keeps them whatever the type of the column
GUARDS = ("audit_sealed", "audit_kept")


def recorded(database, count, action="design.change"):
    with acting_as(ANN):
        for number in range(count):
            database.write(lambda session, n=number: record(session, action, f"designs/d/revisions/{n}"))


def sealed(database, count=5):
    recorded(database, count)
    assert Sealer(database).run() == count


def verified(database, exported=None):
    with database.read() as session:
        return chain.verify(session, exported)


def head(database):
    with database.read() as session:
        return chain.head(session).hash


def tamper(url, *statements):
    """Change the database as somebody with the file in hand can, who takes the guards away first."""
    if ON_POSTGRESQL and any(part in statement for statement in statements for part in NO_VALUES):
        pytest.skip("PostgreSQL keeps no such value in this column")
    engine = writing_engine(url)
    with engine.begin() as connection:
        for guard in GUARDS:
            connection.execute(text(f"drop trigger {guard}{' on audit' if ON_POSTGRESQL else ''}"))
        for statement in statements:
            connection.execute(text(statement))
    engine.dispose()


def test_rows_say_who_did_what_in_the_order_of_their_ids(database):
    sealed(database, 3)
    with database.read() as session:
        rows = session.query(AuditRow).order_by(AuditRow.id).all()
    assert [row.seq for row in rows] == [1, 2, 3]
    assert {(row.principal, row.name, row.action) for row in rows} == {("p-ann", "Ann", "design.change")}
    assert [row.previous for row in rows] == [None, rows[0].hash, rows[1].hash]


def test_sealing_goes_on_where_it_ended_and_writes_nothing_without_rows(database):
    sealed(database, 2)
    sealed(database, 3)
    assert Sealer(database).run() == 0
    result = verified(database)
    assert (result.head.seq, result.unsealed, result.fault) == (5, 0, "")


def test_one_unit_seals_a_bounded_number_of_rows_and_the_next_goes_on(database, monkeypatch):
    monkeypatch.setattr(chain, "SOME", 3)
    recorded(database, 8)
    assert [database.write(chain.seal) for _ in range(4)] == [3, 3, 2, 0]
    result = verified(database)
    assert (result.head.seq, result.unsealed, result.fault) == (8, 0, "")


def test_unsealed_rows_are_counted_and_sealed_when_the_service_stops(database):
    recorded(database, 2)
    assert verified(database).unsealed == 2
    sealer = Sealer(database)
    sealer.start()
    sealer.stop()
    assert verified(database).unsealed == 0


def test_a_fault_of_the_sealer_that_lasts_is_logged_once(database, monkeypatch, caplog):
    monkeypatch.setattr("app.identity.sealer.PAUSE", 0.005)
    tries = []

    def fails():
        tries.append(1)
        raise OSError("no space left")

    sealer = Sealer(database)  # servers of other tests have sealers of their own
    with monkeypatch.context() as patch:
        patch.setattr(sealer, "run", fails)
        sealer.start()
        until(lambda: len(tries) > 5)
    until(lambda: "sealed again" in caplog.text)
    sealer.stop()
    assert caplog.text.count("cannot be sealed") == 1


def test_a_unit_that_fails_leaves_no_row(database):
    def unit(session):
        record(session, "design.create", "designs/d")
        raise ValueError("refused")

    with pytest.raises(ValueError, match="refused"):
        database.write(unit)
    assert verified(database).unsealed == 0


@pytest.mark.parametrize(
    ("statement", "fault"),
    [
        (
            "update audit set name = 'Eve' where seq = 3",
            "row 3 (design.change of designs/d/revisions/2 by Eve",
        ),
        ("delete from audit where seq = 3", "row 3 is missing: after row 2 comes row 4"),
        ("delete from audit where seq = 1", "row 1 is missing: after row 0 comes row 2"),
        (
            "update audit set hash = null where seq = 2",
            "row 2 (design.change of designs/d/revisions/1 by Ann",
        ),
        ("update audit set previous = hash where seq = 4", "row 4 (design.change of designs/d/revisions/3"),
        ("update audit set seq = 'x' where seq = 5", "row x (design.change of designs/d/revisions/4"),
        ("update audit set seq = 2.5 where seq = 3", "row 2.5 (design.change of designs/d/revisions/2"),
        ("update audit set hash = x'ff' where seq = 3", "row 3 (design.change of designs/d/revisions/2"),
        ("update audit set name = x'ff' where seq = 3", "row 3 (design.change of designs/d/revisions/2 by b"),
        (
            "update audit set name = cast(x'ff' as text) where seq = 3",
            "row 3 was changed: one of its values is not text",
        ),
    ],
)
def test_a_broken_row_is_named(database, url, statement, fault):
    sealed(database)
    tamper(url, statement)
    assert fault in verified(database).fault


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ("seq = 'x'", "row x (design.change of designs/d/revisions/4"),
        ("seq = x'ff'", "(design.change of designs/d/revisions/4 by Ann"),
        ("seq = 5.5", "row 5.5 (design.change of designs/d/revisions/4"),
        (f"seq = {2**63 - 1}", f"comes row {2**63 - 1} (design.change of designs/d/revisions/4"),
        ("hash = x'ff'", "row 5 (design.change of designs/d/revisions/4"),
        ("hash = cast(x'ff' as text)", "row 5 was changed: one of its values is not text"),
        ("hash = null", "row 5 (design.change of designs/d/revisions/4"),
        ("name = cast(x'ff' as text)", "row 5 was changed: one of its values is not text"),
    ],
)
def test_a_broken_newest_row_is_named_and_does_not_stop_the_sealer(database, url, change, fault):
    sealed(database)
    tamper(url, f"update audit set {change} where seq = 5")
    sealed(database, 2)
    sealed(database, 1)
    result = verified(database)
    assert fault in result.fault
    assert result.unsealed == 0


@pytest.mark.parametrize("value", ["x'ff'", "cast(x'ff' as text)"])
def test_a_broken_row_that_waits_is_named_and_those_behind_it_are_sealed(database, url, value):
    sealed(database)
    recorded(database, 3)
    tamper(url, f"update audit set action = {value} where seq is null and object like '%/1'")
    assert Sealer(database).run() == 2
    assert Sealer(database).run() == 0
    result = verified(database)
    assert (result.head.seq, result.unsealed) == (7, 1)
    assert result.fault == "an unsealed row after row 7 has a value that is not text"


def test_a_row_that_was_put_in_is_named(database, url):
    sealed(database)
    columns = "id, at, principal, name, action, object, digest"
    tamper(
        url,
        "update audit set seq = seq + 10 where seq > 2",
        "update audit set seq = seq - 9 where seq > 10",
        f"insert into audit ({columns}, seq, previous, hash) "
        "select 'x' || id, at, principal, 'Eve', action, object, digest, 3, hash, hash from audit "
        "where seq = 2",
    )
    assert "row 3 (design.change of designs/d/revisions/1 by Eve" in verified(database).fault


def test_a_row_with_a_right_hash_in_the_place_of_another_is_named(database, url):
    sealed(database)
    with database.read() as session:
        row = session.query(AuditRow).filter_by(seq=3).one()
    row.name = "Eve"
    forged = chain.hash_of(row, 3, row.previous)
    tamper(url, f"update audit set name = 'Eve', hash = '{forged}' where seq = 3")
    assert "row 4" in verified(database).fault
    assert "was inserted, or row 3 was replaced" in verified(database).fault


def test_rows_cut_off_at_the_end_show_against_an_exported_head(database, url):
    sealed(database)
    noted = head(database)
    recorded(database, 1)
    Sealer(database).run()
    assert verified(database, noted).fault == ""  # the chain has grown since
    tamper(url, "delete from audit where seq > 4")
    assert verified(database).fault == ""
    assert noted in verified(database, noted).fault


@pytest.mark.parametrize(
    "statement",
    [
        "update audit set name = 'Eve' where seq = 1",
        "update audit set hash = 'x' where seq = 1",
        "update audit set object = 'designs/e' where seq is null",
        "delete from audit where seq = 1",
        "delete from audit where seq is null",
    ],
)
def test_the_database_refuses_changes_of_rows(database, url, statement):
    sealed(database)
    recorded(database, 1)
    engine = writing_engine(url)
    with pytest.raises(DatabaseError, match="this row is kept as it is"), engine.begin() as connection:
        connection.execute(text(statement))
    engine.dispose()
    assert verified(database).fault == ""


def test_the_command_verifies_and_lists(database, url):
    sealed(database)
    noted = head(database)
    environment = {"CRANKWRIGHT_DATABASE_URL": url}

    def run(*words):
        return CliRunner().invoke(audit_command, [*words], env=environment)

    assert run("verify", "--head", noted).output == f"5 rows are sound; head {noted}\n"
    listed = run("list", "--limit", "2", "--action", "design").output.splitlines()
    assert [line.split()[2:] for line in listed] == [
        ["design.change", f"designs/d/revisions/{n}", f"({n + 1})"] for n in (4, 3)
    ]
    tamper(url, "update audit set name = 'Eve' where seq = 2")
    broken = run("verify")
    assert broken.exit_code == 1
    assert "row 2 (design.change of designs/d/revisions/1 by Eve" in broken.output
