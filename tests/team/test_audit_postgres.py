"""The audit and signatures on PostgreSQL: two servers seal one chain, and two signers never both succeed."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest
from sqlalchemy import text
from sqlalchemy.exc import DatabaseError

from app.approvals.errors import ApprovalError
from app.approvals.schemas import ApprovalIn
from app.approvals.service import ApprovalService
from app.designs import repository
from app.designs.repository import StoredRevision
from app.identity import chain
from app.identity.audit import record
from app.identity.principal import Principal, acting_as
from app.identity.sealer import Sealer
from app.storage.database import Database
from app.storage.idempotency import Once
from app.storage.tables import ApprovalRow

ONCE = Once(None, "POST /approvals", "")
DOCUMENT = {"name": "d", "parameters": {}, "steps": {}, "models": {}, "iterations": []}


@pytest.fixture
def both(own_postgres):
    """Two servers' connections to one database."""
    databases = Database(own_postgres), Database(own_postgres)
    yield databases
    for database in databases:
        database.close()


def person(name):
    return Principal(name, name, "person", frozenset({"checker"}))


def test_two_sealers_make_one_chain(both):
    def busy(database, number):
        sealer = Sealer(database)
        for n in range(40):
            database.write(lambda session, n=n: record(session, "design.change", f"designs/{number}/{n}"))
            if n % 5 == 0:
                sealer.run()

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(busy, both, (1, 2)))
    Sealer(both[0]).run()
    with both[1].read() as session:
        result = chain.verify(session)
    assert (result.head.seq, result.unsealed, result.fault) == (80, 0, "")


@pytest.mark.parametrize(
    "statement", ["update audit set name = 'Eve' where seq = 1", "delete from audit where seq = 1"]
)
def test_the_database_refuses_changes_of_rows(both, statement):
    both[0].write(lambda session: record(session, "design.change", "designs/1"))
    Sealer(both[0]).run()
    with pytest.raises(DatabaseError, match="this row is kept as it is"):
        both[0].write(lambda session: session.execute(text(statement)))


def test_of_two_checkers_at_once_one_signs(both):
    with acting_as(person("author")):
        written = StoredRevision(DOCUMENT, {"steps": {}, "iterations": []}, [], "current", None)
        id, number = both[0].write(lambda session: repository.create(session, "d", written))
        hand_over(both[0], id, number, "calculated")
    begin = Barrier(2)

    def check(database, name):
        with acting_as(person(name)):
            begin.wait(30)
            try:
                hand_over(database, id, number, "checked")
            except ApprovalError as error:
                return type(error).__name__
        return "signed"

    with ThreadPoolExecutor(2) as pool:
        ended = sorted(pool.map(check, both, ("ann", "bob")))
    assert ended in (["OutOfOrder", "signed"], ["OtherDigest", "signed"])
    with both[0].read() as session:
        assert session.query(ApprovalRow).count() == 2
    signed = pytest.raises(DatabaseError, match="this row is kept as it is")
    with signed:
        both[0].write(lambda session: repository.attach(session, id, number, {}, []))


def hand_over(database, id, number, step):
    approving = ApprovalService(database, None)
    seen = approving.show(id, number).to_sign
    return approving.sign(id, number, ApprovalIn(step=step), f'"{seen}"', ONCE)
