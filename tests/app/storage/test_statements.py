"""A statement that is compiled once behaves in a unit of work like one of SQLAlchemy."""

import pytest
from components import ON_POSTGRESQL
from sqlalchemy import bindparam, insert, select, update
from sqlalchemy.exc import IntegrityError

from app.storage.clock import now
from app.storage.tables import Base, DesignRow, RevisionRow
from app.storage.units import DRIVER, Statement

DESIGNS, REVISIONS = Base.metadata.tables["design"], Base.metadata.tables["revision"]
NEW = Statement(insert(DESIGNS), "id", "name", "created", "head")
REVISION = Statement(insert(REVISIONS), "design_id", "number", "created", "document", "state")
RAISED = Statement(
    update(DESIGNS)
    .where(DESIGNS.c.id == bindparam("of"))
    .values(event=DESIGNS.c.event + 2)
    .returning(DESIGNS.c.event, DESIGNS.c.name),
    "of",
)
READ = Statement(
    select(REVISIONS.c.document, REVISIONS.c.results).where(REVISIONS.c.design_id == bindparam("of")), "of"
)


def row(id):
    return {"id": id, "name": f"the {id}", "created": now(), "head": 0}


def filled(session):
    NEW.run_many(session, [row("a"), row("b")])
    document = {"name": "ü", "parameters": {"a": [1, 2.5]}}
    REVISION.run(
        session, {"design_id": "a", "number": 1, "created": now(), "document": document, "state": "current"}
    )
    return [tuple(one) for one in (*RAISED.run(session, {"of": "b"}), *READ.run(session, {"of": "a"}))]


def generally(session):
    """As where no driver is at hand, such as on PostgreSQL."""
    session.info.pop(DRIVER, None)
    return filled(session)


@pytest.mark.parametrize("unit", [filled, generally])
def test_rows_with_defaults_and_json(database, unit):
    found = database.write(unit)
    assert found == [(2, "the b"), ({"name": "ü", "parameters": {"a": [1, 2.5]}}, None)]
    with database.read() as session:
        stored = session.get(DesignRow, "b")
        assert (stored.name, stored.event, stored.archived) == ("the b", 2, None)
        assert session.get(RevisionRow, ("a", 1)).document["name"] == "ü"
        assert READ.scalar(session, {"of": "a"})["name"] == "ü"
        assert READ.scalar(session, {"of": "b"}) is None


def test_errors_are_those_of_sqlalchemy(database):
    database.write(filled)
    with pytest.raises(IntegrityError):
        database.write(lambda session: NEW.run(session, row("a")))
    with pytest.raises(IntegrityError):
        database.write(lambda session: NEW.run_many(session, [row("c"), row("c")]))
    with database.read() as session:
        assert session.get(DesignRow, "c") is None


@pytest.mark.skipif(ON_POSTGRESQL, reason="there SQLAlchemy executes it")
def test_a_missing_value_is_a_fault_of_the_program(database):
    with pytest.raises(KeyError, match="head"):
        database.write(lambda session: NEW.run(session, {"id": "a", "name": "a", "created": now()}))


@pytest.mark.skipif(ON_POSTGRESQL, reason="there SQLAlchemy executes it")
def test_a_statement_that_is_completed_at_every_execution_is_refused(database):
    several = select(DESIGNS.c.id).where(DESIGNS.c.id.in_(bindparam("some", expanding=True)))
    with pytest.raises(AssertionError, match="at every execution"):
        database.write(lambda session: Statement(several, "some").run(session, {"some": ["a", "b"]}))


def test_a_unit_that_mixes_both_is_undone_whole(database):
    def mixed(session):
        NEW.run(session, row("a"))
        session.add(DesignRow(id="b", name="b", created=now(), head=0))
        session.flush()
        NEW.run(session, row("c"))
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        database.write(mixed)
    with database.read() as session:
        assert session.scalars(select(DesignRow.id)).all() == []
