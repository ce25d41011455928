"""Servers that share a PostgreSQL: one author per revision, one change per key, one end per job."""

import json
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing

import httpx
import pytest
from patience import patient, until
from serving import API, ServerProcess, created, folder_of_models, moody, paper, serving
from sqlalchemy import func, select, text

from app.designs import repository as designs
from app.designs.errors import StaleRevision
from app.designs.labels import key_of
from app.jobs import repository
from app.settings import Settings
from app.storage.clock import new_id
from app.storage.database import Database, after_commit
from app.storage.errors import CommitUnknown
from app.storage.idempotency import Once
from app.storage.tables import DesignRow, JobRow, RevisionRow
from app.team.postgres import Cluster


@pytest.fixture(scope="module")
def both(postgres, tmp_path_factory):
    """Two servers on one database and one folder of files."""
    folder = tmp_path_factory.mktemp("team")
    shared = {"database_url": postgres, "artifacts_url": f"file://{folder}/artifacts", "poll_seconds": 0.2}
    one, other = (Settings(data=folder / name, **shared) for name in ("one", "other"))
    with serving(one) as first, serving(other) as second:
        clients = [
            httpx.Client(base_url=s.url, timeout=patient(60), trust_env=False) for s in (first, second)
        ]
        with clients[0], clients[1]:
            yield clients


def at_once(actions):
    """Run functions at the same time, as far as threads begin at the same time; their answers."""
    gate = threading.Barrier(len(actions))

    def run(action):
        gate.wait(30)
        return action()

    with ThreadPoolExecutor(len(actions)) as pool:
        return list(pool.map(run, actions))


def patching(http, design, number, **headers):
    place = f"{API}/designs/{design['id']}"
    document = {"parameters": {"scale": str(2 + number)}}
    return lambda: http.patch(place, json=document, headers={"If-Match": '"1"', **headers})


def test_eight_changes_of_one_revision_over_both_give_one_success(both):
    design = created(both[0], {"name": "raced", "parameters": {"scale": "1"}})
    answers = at_once([patching(both[n % 2], design, n) for n in range(8)])
    assert sorted(answer.status_code for answer in answers) == [200] + 7 * [412]
    for http in both:
        assert http.get(f"{API}/designs/{design['id']}").json()["revision"] == 2


def test_the_same_key_on_both_gives_one_revision(both):
    design = created(both[0], {"name": "repeated", "parameters": {"scale": "1"}})
    key = {"Idempotency-Key": "one and the same", "Crankwright-Client": "anna"}
    answers = at_once([patching(both[n % 2], design, 0, **key) for n in range(8)])
    assert {answer.status_code for answer in answers} == {200}
    assert {answer.json()["revision"] for answer in answers} == {2}
    other = patching(both[1], design, 5, **key)()
    assert (other.status_code, other.json()["type"]) == (422, "/problems/idempotency-key-reused")


def test_the_same_key_on_both_makes_one_design(both):
    key = {"Idempotency-Key": "new design", "Crankwright-Client": "anna"}
    document = {"name": "only one", "parameters": {"a": "1"}}
    answers = at_once(
        [lambda n=n: both[n % 2].post(f"{API}/designs", json=document, headers=key) for n in range(6)]
    )
    assert {answer.status_code for answer in answers} == {201}
    assert len({answer.json()["id"] for answer in answers}) == 1


def test_two_servers_add_the_same_tag_at_once(both):
    design = created(both[0], {"name": "tagged"})
    place = f"{API}/designs/{design['id']}/labels"
    tags = {"add_tags": ["V8", "main bearing"]}
    answers = at_once([lambda n=n: both[n % 2].post(place, json=tags) for n in range(8)])
    assert {answer.status_code for answer in answers} == {200}
    assert both[1].get(place).json()["tags"] == sorted(tags["add_tags"], key=key_of)


def test_a_design_of_one_server_is_regenerated_whoever_takes_its_job(both):
    design = created(both[0], paper(name="shared job"))
    place = f"{API}/designs/{design['id']}"
    assert both[1].get(place).json()["state"] == "current"


class TestUnits:
    """Units of work on PostgreSQL."""

    @pytest.fixture
    def database(self, own_postgres):
        database = Database(own_postgres)
        yield database
        database.close()

    @pytest.mark.slow
    def test_a_connection_lost_before_the_commit_is_made_up_for(self, database):
        runs = []

        def unit(session):
            runs.append(1)
            session.add(DesignRow(id="a", name="a", created="", head=0))
            session.flush()
            if len(runs) < 3:
                session.execute(text("select pg_terminate_backend(pg_backend_pid())"))
            after_commit(session, lambda: runs.append("after"))

        database.write(unit)
        assert runs == [1, 1, 1, "after"]
        with database.read() as session:
            assert session.scalar(select(func.count()).select_from(DesignRow)) == 1

    @pytest.mark.slow
    def test_a_deadlock_is_run_again(self, database):
        rows = [DesignRow(id=id, name=id, created="", head=0) for id in "ab"]
        database.write(lambda session: session.add_all(rows))
        met = threading.Barrier(2)

        def locking(first, second):
            runs = []

            def unit(session):
                designs.locked(session, first)
                runs.append(1)
                if len(runs) == 1:
                    met.wait(30)
                designs.locked(session, second)

            return lambda: (database.write(unit), len(runs))[1]

        assert sum(at_once([locking("a", "b"), locking("b", "a")])) > 2

    @pytest.mark.sampled(1)
    @pytest.mark.parametrize("key", [None, "key"])
    def test_a_connection_lost_during_the_commit(self, database, monkeypatch, key):
        """With a key the row decides; without one nobody knows, and the error says so."""
        from sqlalchemy.exc import OperationalError
        from sqlalchemy.orm import Session

        once, commit, lost = Once(key, "POST /x", "body", "anna"), Session.commit, []

        def losing(session):
            commit(session)
            if "watched" in session.info and not lost:
                lost.append(1)
                raise OperationalError(
                    "COMMIT", None, Exception("connection lost"), connection_invalidated=True
                )

        def unit(session):
            session.info["watched"] = True
            if before := once.begin(session):
                return before["id"]
            session.add(DesignRow(id=new_id(session), name="a", created="", head=0))
            once.keep(session, 201, {"id": "kept"})
            return "stored"

        monkeypatch.setattr(Session, "commit", losing)
        if key is None:
            with pytest.raises(CommitUnknown, match="may be stored, or not"):
                database.write(unit)
        else:
            assert database.write(unit) == "kept"
        with database.read() as session:
            assert session.scalar(select(func.count()).select_from(DesignRow)) == 1

    @pytest.mark.slow
    def test_one_of_eight_appends_wins(self, database):
        written = designs.StoredRevision({"name": "a"}, None, [], "current", None)
        id, _ = database.write(lambda session: designs.create(session, "a", written))

        def append():
            try:
                return database.write(lambda session: designs.append(session, id, 1, written))
            except StaleRevision:
                return "stale"

        assert sorted(map(str, at_once([append] * 8))) == ["2"] + 7 * ["stale"]
        with database.read() as session:
            assert session.scalar(select(func.count()).select_from(RevisionRow)) == 2


class TestClaims:
    """Leases of jobs, by the statements alone."""

    @pytest.fixture
    def database(self, own_postgres):
        database = Database(own_postgres)
        yield database
        database.close()

    @pytest.mark.parametrize("count", [90, pytest.param(900, marks=pytest.mark.slow)])
    @pytest.mark.slow
    def test_four_claimers_end_each_job_once(self, database, count):
        def queue(session):
            for number in range(count):
                repository.add(session, "k", {"n": number}, None, None, f"name:{number % 5}", number // 5)

        database.write(queue)
        ends = []

        def work(owner):
            while job := database.write(lambda session: repository.claim(session, owner=owner, lease=30.0)):
                assert database.write(lambda session, job=job: repository.end(session, job, "done", []))
                ends.append(job.id)

        at_once([lambda n=n: work(f"owner {n}") for n in range(4)])
        assert len(ends) == len(set(ends)) == count

    @pytest.mark.slow
    def test_what_nobody_prolongs_is_queued_again_and_its_owner_is_fenced(self, database):
        database.write(lambda session: repository.add(session, "k", {}, None, None))
        late = database.write(lambda session: repository.claim(session, owner="late", lease=-1.0))
        (reaped,) = database.write(repository.reap)
        assert (reaped.id, reaped.state, reaped.losses, reaped.crashes) == (late.id, "queued", 1, 0)
        again = database.write(lambda session: repository.claim(session, owner="other", lease=30.0))
        assert (again.id, again.attempt) == (late.id, 2)
        assert database.write(repository.reap) == []
        held = lambda owner: database.write(lambda s: repository.beat(s, owner, [late.id], 30.0))  # noqa: E731
        assert held("late") == set()
        assert held("other") == {(late.id, 2)}
        assert not database.write(lambda session: repository.end(session, late, "done", []))
        assert database.write(lambda session: repository.end(session, again, "done", []))

    @pytest.mark.slow
    def test_an_owner_gives_back_its_own_jobs_alone(self, database):
        for _ in range(2):
            database.write(lambda session: repository.add(session, "k", {}, None, None))
        for owner in ("one", "other"):
            database.write(lambda session, owner=owner: repository.claim(session, owner=owner, lease=30.0))
        assert len(database.write(lambda session: repository.requeue_all(session, "one"))) == 1
        with database.read() as session:
            owners = session.scalars(select(JobRow.owner).where(JobRow.state == "running")).all()
        assert owners == ["other"]


@pytest.mark.slow
def test_a_killed_server_leaves_its_job_to_the_other_one(own_postgres, tmp_path):
    """A job that never ends by itself: the other server claims it after the lease, up to the deadline."""
    folder = folder_of_models(tmp_path / "templates")
    environment = {
        "CRANKWRIGHT_DATABASE_URL": own_postgres,
        "CRANKWRIGHT_ARTIFACTS_URL": f"file://{tmp_path}/artifacts",
        "CRANKWRIGHT_TEMPLATE_FOLDERS": json.dumps([str(folder)]),
        "CRANKWRIGHT_JOB_DEADLINE": str(patient(8)),
        "CRANKWRIGHT_LEASE_SECONDS": "2",
        "CRANKWRIGHT_BEAT_SECONDS": "0.3",
        "CRANKWRIGHT_POLL_SECONDS": "0.3",
    }
    first, second = (ServerProcess(tmp_path / name, **environment) for name in ("first", "second"))
    with closing(Database(own_postgres)) as database:

        def job():
            with database.read() as session:
                row = session.scalars(select(JobRow)).one()
                return row.state, row.attempt, row.losses, row.owner

        with first, httpx.Client(base_url=first.url, timeout=patient(60)) as http:
            document = moody(mood="loops")
            http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=0"}).raise_for_status()
            owner = until(job, lambda job: job[0] == "running", seconds=30)[3]
            first.kill()
        with second:
            taken = until(job, lambda job: job[0] == "running" and job[3] != owner, seconds=30)
            assert taken[1:3] == (2, 1)
            assert until(job, lambda job: job[0] == "failed", seconds=60)[1:3] == (2, 1)


@pytest.mark.slow
def test_a_database_that_is_down_answers_503_and_is_found_again(tmp_path):
    cluster = Cluster()
    try:
        url = cluster.create("team")
        settings = Settings(
            data=tmp_path / "data", database_url=url, artifacts_url=f"file://{tmp_path}/files"
        )
        with serving(settings) as server, httpx.Client(base_url=server.url, timeout=patient(60)) as http:
            design = created(http, {"name": "any"})
            cluster.stop()
            for answer in (
                http.get(f"{API}/designs/{design['id']}"),
                http.post(f"{API}/designs", json={"name": "more"}),
            ):
                assert (answer.status_code, answer.json()["type"]) == (503, "/problems/storage")
                assert int(answer.headers["Retry-After"]) > 0
            cluster.start()
            assert http.get(f"{API}/designs/{design['id']}").status_code == 200
            assert http.post(f"{API}/designs", json={"name": "more"}).status_code == 201
    finally:
        cluster.close()
