"""After `kill -9` at any moment, accepted changes exist once and completely, and are built or state why not.

Clients change designs and repeat, under the same Idempotency-Key, whatever was not answered. Meanwhile the
server is killed again and again. In the end every accepted change is one revision, no more and no less, and
no process is left of any server.
"""

import hashlib
import random
import signal
import time

import httpx
import pytest
from patience import until
from seeds import seeded
from serving import API, ServerProcess, alive, folder_of_models, moody, settled
from sqlalchemy import select
from writers import DESIGNS, Writer, each_accepted_change_is_one_revision, peace

from app.identity import chain
from app.storage.database import Database
from app.storage.tables import AuditRow, RevisionRow

WRITERS = 4


def battle(data, kills: int, seed: int, changes: int) -> None:
    """Writers against a server that is killed until they have made enough changes; then look what is left."""
    chance = random.Random(seed)
    environment = {
        "CRANKWRIGHT_TEMPLATE_FOLDERS": f'["{folder_of_models(data.parent)}"]',
        "CRANKWRIGHT_CLIENT_QUEUE_LIMIT": "90000",  # all writers come from one address
        "CRANKWRIGHT_QUEUE_LIMIT": "100000",  # a server that is killed all the time gets behind
    }
    server = ServerProcess(data, **environment)
    family: set[int] = set()
    writers = [Writer([server.url], number) for number in range(WRITERS)]
    try:
        server.start().ready()
        for writer in writers:
            writer.start()
        for _ in range(kills):
            time.sleep(chance.uniform(0.01, 0.6))  # a moment by chance; nothing waits for it
            family |= server.kill()
            server.start()
            if chance.random() < 0.7:  # else it is killed while it starts, or resumes
                server.ready()
        server.ready()
        accepted = lambda: sum(len(writer.accepted) for writer in writers)  # noqa: E731
        until(lambda: accepted() >= changes or any(writer.failure for writer in writers), seconds=120)
        peace(writers)
        nothing_lives(family)
        with httpx.Client(base_url=server.url, timeout=30, trust_env=False) as http:
            for writer in writers:
                each_accepted_change_is_one_revision(http, writer)
            nothing_is_half_done(http, data)
    finally:
        for writer in writers:
            writer.enough.set()
        last = server.kill()
    nothing_lives(last)
    every_revision_has_its_row_in_the_audit(data)
    assert sum(len(writer.accepted) for writer in writers) >= changes, "too few to mean anything"
    assert all(writer.unanswered for writer in writers), "no kill met a change"


def nothing_is_half_done(http, data) -> None:
    jobs = http.get(f"{API}/jobs", params={"limit": 500}).json()["items"]
    assert {job["state"] for job in jobs} <= {"done", "failed"}
    assert len(http.get(DESIGNS, params={"limit": 500}).json()["items"]) == WRITERS
    files = [file for file in (data / "artifacts").rglob("*") if file.is_file()]
    whole = [file for file in files if len(file.name) == 64]
    assert whole
    assert all(hashlib.sha256(file.read_bytes()).hexdigest() == file.name for file in whole)


def every_revision_has_its_row_in_the_audit(data) -> None:
    """No change without its row, no row without its change, and the chain is sound."""
    database = Database(f"sqlite:///{data / 'crankwright.sqlite'}")
    try:
        with database.read() as session:
            saved = session.execute(select(RevisionRow.design_id, RevisionRow.number)).all()
            noted = session.scalars(select(AuditRow.object).where(AuditRow.object.contains("/revisions/")))
            assert sorted(noted) == sorted(f"designs/{id}/revisions/{number}" for id, number in saved)
            assert chain.verify(session).fault == ""
    finally:
        database.close()


def nothing_lives(family: set[int]) -> None:
    until(lambda: {pid for pid in family if alive(pid)}, lambda left: left == set(), seconds=20)


def test_a_kill(tmp_path):
    battle(tmp_path / "data", kills=1, seed=1, changes=12)


@pytest.mark.slow
def test_a_few_kills(tmp_path):
    battle(tmp_path / "data", kills=4, seed=1, changes=20)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [seeded(2), seeded(3)])
def test_dozens_of_kills_during_200_accepted_changes(tmp_path, seed):
    battle(tmp_path / "data", kills=36, seed=seed, changes=200)


@pytest.mark.slow
def test_a_killed_servers_loop_is_ended_with_it_and_resumed(tmp_path):
    """A job that loops for ever neither outlives its server nor is forgotten by the next one."""
    environment = {
        "CRANKWRIGHT_TEMPLATE_FOLDERS": f'["{folder_of_models(tmp_path)}"]',
        "CRANKWRIGHT_JOB_DEADLINE": "2",
    }
    server = ServerProcess(tmp_path / "data", **environment).start().ready()
    with httpx.Client(base_url=server.url, timeout=30, trust_env=False) as http:
        answer = http.post(DESIGNS, json=moody(mood="loops"), headers={"Prefer": "respond-async"})
        job = answer.headers["location"]
        until(lambda: http.get(job).json()["state"], lambda state: state == "running")
        family = server.kill()
        assert family, "the forkserver and the job"
        nothing_lives(family)
        server.start().ready()
        try:
            content = settled(http, answer.json()["id"])
            assert content["problem"]["type"] == "/problems/deadline"
            assert content["revision"] == 1
        finally:
            assert server.stop() in (0, -signal.SIGTERM)  # uvicorn ends by the signal itself
