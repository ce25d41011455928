"""Clients are served in turn: the many jobs of one do not delay or refuse the job of another."""

import pytest
from components import ON_POSTGRESQL
from serving import API, created, moody, problem
from sqlalchemy import event, text

from app.jobs import repository, turns
from app.jobs.errors import JobShared, QueueFull
from app.jobs.service import Jobs
from app.jobs.turns import Lane
from app.settings import Settings
from app.storage.tables import JobRow
from app.workers.inline import Inline

KIND, SLOW = "build", "analysis"
ANNA, BEN, CARA = "name:anna", "name:ben", "name:cara"


@pytest.fixture
def make(database):
    def make(**settings):
        jobs = Jobs(database, Inline(), Settings(**settings), lambda error: {"detail": str(error)})
        jobs.register(KIND, lambda job, context: lambda session: None)
        jobs.register(SLOW, lambda job, context: lambda session: None, is_slow=True)
        return jobs

    return make


@pytest.fixture
def jobs(make):
    return make(client_queue_limit=2000, queue_limit=4000)


@pytest.fixture
def put(jobs, database):
    """Queue a job of a client that is named by its payload."""

    def put(client, name, kind=KIND, jobs=jobs):
        return database.write(lambda session: jobs.enqueue(session, kind, {"name": name}, client=client))

    return put


@pytest.fixture
def request_(jobs, database):
    """Ask for a job as `Models` does: once for all who ask for the same."""

    def request(client, name, jobs=jobs):
        return database.write(lambda session: jobs.request(session, KIND, {"name": name}, client))

    return request


@pytest.fixture
def claim(database):
    """Claim the next job, and end it unless it shall run on; the name of it."""

    def claim(*, end=True, slow=False):
        def unit(session):
            job = repository.claim(session, Lane((SLOW,), is_common=not slow))
            if job and end:
                repository.end(session, job, "done", [])
            return job and job.payload["name"]

        return database.write(unit)

    return claim


def order(claim):
    return list(iter(claim, None))


class TestTurns:
    @pytest.mark.slow
    def test_a_newcomer_behind_200_jobs_is_second(self, put, claim):
        for number in range(200):
            put(ANNA, f"anna {number}")
        for _ in range(80):
            claim()
        claim(end=False)
        put(BEN, "ben")
        assert [claim() for _ in range(2)] == ["anna 81", "ben"]

    def test_clients_alternate_in_the_order_of_their_arrival(self, put, claim):
        for client, names in ((ANNA, "abc"), (BEN, "de"), (CARA, "f")):
            for name in names:
                put(client, name)
        assert order(claim) == list("adfbec")

    def test_who_comes_later_does_not_catch_up(self, put, claim):
        for number in range(10):
            put(ANNA, f"anna {number}")
        for _ in range(6):
            claim()
        for number in range(3):
            put(BEN, f"ben {number}")
        assert order(claim)[:6] == ["anna 6", "ben 0", "anna 7", "ben 1", "anna 8", "ben 2"]

    def test_who_has_a_job_running_is_not_behind_all_of_a_newcomer(self, put, claim):
        for name in ("anna 0", "anna 1"):
            put(ANNA, name)
        claim(), claim(end=False)
        for number in range(4):
            put(BEN, f"ben {number}")
        put(ANNA, "anna 2")
        assert order(claim)[:3] == ["ben 0", "ben 1", "anna 2"]

    def test_slow_kinds_have_their_own_turns(self, put, claim):
        for number in range(20):
            put(ANNA, f"slow {number}", SLOW)
        put(BEN, "ben 0"), put(BEN, "ben 1")
        put(ANNA, "anna")
        assert [claim() for _ in range(3)] == ["ben 0", "anna", "ben 1"]
        assert claim(slow=True) == "slow 0"

    def test_a_job_that_is_given_back_keeps_its_turn(self, put, database):
        put(ANNA, "first"), put(BEN, "second")
        job = database.write(repository.claim)
        database.write(lambda session: repository.requeue(session, job, 1))
        assert database.write(repository.claim).id == job.id


class TestSharedJobs:
    def test_a_job_that_two_ask_for_takes_the_earlier_turn(self, request_, claim):
        ids = [request_(ANNA, f"anna {number}") for number in range(30)]
        assert request_(BEN, "anna 29") == ids[29]
        assert order(claim)[:3] == ["anna 0", "anna 29", "anna 1"]

    def test_it_keeps_its_turn_if_that_is_earlier(self, request_, claim):
        request_(ANNA, "shared")
        for number in range(3):
            request_(BEN, f"ben {number}")
        request_(BEN, "shared")
        assert order(claim) == ["shared", "ben 0", "ben 1", "ben 2"]

    def test_two_names_for_the_same_jobs_have_one_turn_each(self, request_, claim):
        for client in (ANNA, BEN):
            for number in range(30):
                request_(client, f"both {number}")
        request_(CARA, "cara")
        assert "cara" in order(claim)[:3]

    def test_who_has_no_room_left_takes_no_turn(self, make, request_, claim):
        jobs = make(client_queue_limit=3)
        for number in range(3):
            request_(ANNA, f"anna {number}", jobs)
        claim()
        for number in range(3):
            request_(BEN, f"ben {number}", jobs)
        request_(BEN, "anna 2", jobs)
        with pytest.raises(QueueFull):
            request_(BEN, "ben 3", jobs)

    def test_it_ends_when_the_last_cancels(self, jobs, request_):
        id = request_(ANNA, "shared")
        request_(BEN, "shared")
        with pytest.raises(JobShared):
            jobs.cancel(id, CARA)
        assert jobs.cancel(id, ANNA).state == "queued"
        assert jobs.cancel(id, BEN).state == "cancelled"

    def test_the_later_one_may_leave_too(self, jobs, request_):
        id = request_(ANNA, "shared")
        request_(BEN, "shared")
        assert jobs.cancel(id, BEN).state == "queued"
        assert jobs.cancel(id, ANNA).state == "cancelled"

    def test_a_job_of_one_is_cancelled_by_anybody(self, jobs, request_):
        assert jobs.cancel(request_(ANNA, "alone"), BEN).state == "cancelled"

    def test_the_operator_cancels_for_all(self, jobs, request_):
        id = request_(ANNA, "shared")
        request_(BEN, "shared")
        assert jobs.cancel(id).state == "cancelled"

    def test_only_so_many_are_remembered(self, jobs, request_):
        id = request_(ANNA, "shared")
        for number in range(2 * turns.MOST_OTHERS):
            request_(f"name:{number}", "shared")
        for number in range(turns.MOST_OTHERS):
            assert jobs.cancel(id, f"name:{number}").state == "queued"
        assert jobs.cancel(id, ANNA).state == "cancelled"


class TestAdmission:
    def test_a_client_has_a_share(self, make, put):
        jobs = make(client_queue_limit=3, queue_limit=100)
        for number in range(3):
            put(ANNA, str(number), jobs=jobs)
        with pytest.raises(QueueFull, match="3 jobs of yours"):
            put(ANNA, "more", jobs=jobs)
        put(BEN, "first", jobs=jobs)

    def test_what_ended_or_runs_counts_no_more(self, make, put, claim):
        jobs = make(client_queue_limit=1)
        first = put(ANNA, "first", jobs=jobs)
        claim(end=False)
        assert put(ANNA, "second", jobs=jobs) != first

    def test_one_client_cannot_fill_the_queue_whatever_the_settings(self, make, put):
        jobs = make(client_queue_limit=1000, queue_limit=20)
        for number in range(18):
            put(ANNA, str(number), jobs=jobs)
        with pytest.raises(QueueFull):
            put(ANNA, "more", jobs=jobs)
        put(BEN, "his first", jobs=jobs)
        with pytest.raises(QueueFull):
            put(BEN, "his second", jobs=jobs)
        put(CARA, "her first", jobs=jobs)
        with pytest.raises(QueueFull):
            put("name:dan", "one too many", jobs=jobs)

    def test_the_advice_follows_from_what_jobs_took(self, make, put):
        jobs = make(client_queue_limit=2, queue_limit=1000, workers=2)
        for _ in range(30):
            jobs._dispatcher.durations.note(Lane((SLOW,)), 7.0)
            jobs._dispatcher.durations.note(Lane((SLOW,), is_common=False), 100.0)
        for number in range(6):
            put(f"name:{number}", "other", jobs=jobs)
        put(ANNA, "first", jobs=jobs), put(ANNA, "second", jobs=jobs)
        with pytest.raises(QueueFull) as caught:
            put(ANNA, "third", jobs=jobs)
        assert caught.value.retry_after == 25, "7 jobs of 7 s until anna's first starts, by 2 workers"


@pytest.mark.skipif(ON_POSTGRESQL, reason="it reads the query plan of SQLite")
class TestNoScan:
    """The queue asks its questions by indexes, however many jobs have ended."""

    @pytest.fixture
    def plans(self, database):
        """How SQLite carries out all that is asked of the table of jobs meanwhile."""
        asked = []

        def trace(connection):
            connection.connection.driver_connection.set_trace_callback(asked.append)

        for engine in (database._reader, database._writer.engine):
            event.listen(engine, "begin", trace)

        def plans():
            about = [sql for sql in asked if "job" in sql and sql.startswith(("SELECT", "UPDATE"))]
            with database._writer.engine.connect() as connection:
                driver = connection.connection.driver_connection
                rows = [driver.execute(f"EXPLAIN QUERY PLAN {sql}").fetchall() for sql in about]
            return [(about[place], row[3]) for place, steps in enumerate(rows) for row in steps]

        return plans

    def test_of_the_queue(self, jobs, put, request_, claim, database, plans):
        request_(ANNA, "first"), put(BEN, "second"), request_(BEN, "first")
        claim()
        with database.read() as session:
            assert jobs.queued(session) == 1
            assert jobs.oldest_queued_age(session) >= 0
        seen = plans()
        assert len(seen) > 10
        assert [plan for plan in seen if "SCAN" in plan[1] and "CONSTANT" not in plan[1]] == []
        assert [plan for plan in seen if "ix_job_operated" in plan[1]] == []

    def test_the_check_sees_a_scan(self, database, plans):
        with database.read() as session:
            session.execute(text("SELECT count(*) FROM job WHERE crashes > 0"))
        assert any("SCAN" in plan for _, plan in plans())


class TestOverHttp:
    """Every route that makes a job says whose it is."""

    HEADERS = {"Crankwright-Client": "dora", "Prefer": "respond-async"}

    def client_of(self, served, answer):
        assert answer.status_code == 202, answer.text
        with served.app.state.services.database.read() as session:
            return session.get_one(JobRow, answer.headers["location"].rpartition("/")[2]).client

    def test_of_designs(self, http, served):
        answer = http.post(f"{API}/designs", json=moody("34.013 mm"), headers=self.HEADERS)
        assert self.client_of(served, answer) == "name:dora"

    def test_of_builds(self, http, served):
        body = {"parameters": {"size": "34.253 mm"}, "artifacts": []}
        answer = http.post(f"{API}/models/moody/versions/1/build", json=body, headers=self.HEADERS)
        assert self.client_of(served, answer) == "name:dora"

    def test_of_analyses(self, http, served):
        body = {
            "parameters": {"diameter": "20 mm", "length": "44.013 mm"},
            "outputs": ["stiffness"],
            "level": "coarse",
        }
        place = f"{API}/models/bar/versions/1/analyses/torsion"
        answer = http.post(place, json=body, headers=self.HEADERS)
        assert self.client_of(served, answer) == "name:dora"

    def test_of_files_and_reports(self, http, served):
        design = created(http, moody("34.513 mm"))
        place = f"{API}/designs/{design['id']}"
        assert self.client_of(served, http.get(f"{place}/model.stl", headers=self.HEADERS)) == "name:dora"
        assert self.client_of(served, http.get(f"{place}/report", headers=self.HEADERS)) == "name:dora"

    def test_of_cancelling(self, http):
        place, mood = f"{API}/models/moody/versions/1/build", {"size": "34.753 mm", "mood": "loops"}
        body, clients = {"parameters": mood, "artifacts": []}, ("dora", "emil", "fay")
        headers = [{"Crankwright-Client": name, "Prefer": "respond-async"} for name in clients]
        jobs = {http.post(place, json=body, headers=each).headers["location"] for each in headers[:2]}
        assert len(jobs) == 1
        job = jobs.pop()
        problem(http.delete(job, headers=headers[2]), 409, "job-shared")
        assert http.delete(job, headers=headers[0]).json()["state"] in ("queued", "running")
        assert http.delete(job, headers=headers[1]).json()["state"] == "cancelled"
