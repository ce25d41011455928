"""Jobs of servers on one PostgreSQL: a client may wait, ask or cancel at any server."""

import asyncio
import threading
from contextlib import contextmanager

import pytest
from listening import NEVER
from patience import until
from sqlalchemy import text

from app.jobs.dispatcher import FAST
from app.jobs.events import events_above
from app.jobs.service import Jobs
from app.settings import Settings
from app.storage.database import Database
from app.workers.errors import JobCancelled
from app.workers.inline import Inline

pytest.importorskip("psycopg", reason="the driver of PostgreSQL is not installed")
KIND, LANE, PATIENT = "k", "lane", 60.0


@contextmanager
def server(url, handler, threads, poll=NEVER, lane=LANE):
    """A server that runs so many jobs at a time, or none."""
    lease = {"lease_seconds": 3 * NEVER, "beat_seconds": NEVER}
    database = Database(url)
    jobs = Jobs(database, Inline(), Settings(database_url=url, poll_seconds=poll, **lease), str)
    jobs.register(KIND, handler, lane=lane)
    jobs.start({lane: threads})
    try:
        yield jobs
    finally:
        jobs.stop()
        database.close()


def never(job, context):
    raise AssertionError("this server runs no jobs")


def queued(url, jobs, wake=True):
    """A job that a server queues, after all servers have begun to listen; perhaps nobody hears of it yet."""
    database = Database(url)
    query = text(
        "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND query ~ '^LISTEN'"
    )

    def listening():
        with database.read() as session:
            return session.scalar(query)

    until(listening, lambda servers: servers == 2)
    id = database.write(lambda session: jobs.enqueue(session, KIND, {}))
    database.close()
    if wake:
        jobs.wake(KIND)
    return id


@pytest.mark.slow
def test_a_job_that_another_server_runs_ends_the_wait(own_postgres):
    """Neither looks by itself within the test: it takes the hints of the queue and of the end."""
    with (
        server(own_postgres, lambda job, context: lambda session: "/found", threads=1) as there,
        server(own_postgres, never, threads=0) as here,
    ):
        id = queued(own_postgres, here)
        assert asyncio.run(here.wait(id, PATIENT)) == "done"
        assert here.get(id).result == there.get(id).result == "/found"


@pytest.mark.slow
def test_a_failure_elsewhere_ends_it_too(own_postgres):
    with server(own_postgres, never, threads=1), server(own_postgres, never, threads=0) as here:
        assert asyncio.run(here.wait(queued(own_postgres, here), PATIENT)) == "failed"


def test_a_job_is_cancelled_from_another_server(own_postgres):
    began, ended = threading.Event(), threading.Event()

    def handler(job, context):
        began.set()
        assert context.cancelled.wait(PATIENT)
        ended.set()
        return lambda session: None

    with server(own_postgres, handler, threads=1) as there, server(own_postgres, never, threads=0) as here:
        id = queued(own_postgres, here)
        assert began.wait(PATIENT)
        assert here.cancel(id).state == "cancelled"
        assert ended.wait(PATIENT)
        assert asyncio.run(there.wait(id, PATIENT)) == "cancelled"


@pytest.mark.slow
def test_without_hints_the_wait_ends_with_the_poll(own_postgres):
    def silent(job, context):
        there.events.tell = list
        return lambda session: None

    with (
        server(own_postgres, silent, threads=1) as there,
        server(own_postgres, never, threads=0, poll=0.3) as here,
    ):
        assert asyncio.run(here.wait(queued(own_postgres, here), PATIENT)) == "done"


def slowly(go_on):
    """A handler that says that it is at its second stage, and goes on when that is allowed."""

    def handler(job, context):
        context.progress(0.1, "draw")
        context.progress(0.4, "mesh")
        assert go_on.wait(PATIENT)
        return lambda session: None

    return handler


async def stages(jobs, id, go_on):
    """The progress of a job as a listener gets it, at least to "mesh"; then it may end."""
    heard = []
    async with jobs.events.subscribe(f"job:{id}") as events, asyncio.timeout(PATIENT):
        jobs.wake(KIND)
        async for event in events:
            if event.name == "progress":
                heard.append((event.data["job"], event.data["progress"], event.data["text"]))
                if event.data["text"] == "mesh":
                    go_on.set()
            if event.name == "done":
                return heard


@pytest.mark.parametrize("poll", [NEVER, 0.3])
@pytest.mark.sampled(1)
def test_progress_is_seen_at_another_server(own_postgres, poll):
    """By hints alone, or where no hint of it comes by the poll alone."""
    go_on = threading.Event()
    with (
        server(own_postgres, slowly(go_on), threads=1) as there,
        server(own_postgres, never, threads=0, poll=poll) as here,
    ):
        if poll != NEVER:
            tell = there.events.tell
            there.events.tell = lambda hints: tell([hint for hint in hints if "progress" not in hint])
        id = queued(own_postgres, here, wake=False)
        heard = asyncio.run(stages(here, id, go_on))
        assert heard[-1] == (id, 0.4, "mesh")
        assert {one[1:] for one in heard} <= {(0.1, "draw"), (0.4, "mesh")}
        assert len(heard) == len(set(heard)), "nothing is sent twice"


def test_who_asks_at_another_server_gets_stage_and_share(own_postgres):
    go_on = threading.Event()
    with (
        server(own_postgres, slowly(go_on), threads=1),
        server(own_postgres, never, threads=0) as here,
    ):
        id = queued(own_postgres, here)
        job = until(lambda: here.get(id), lambda job: job.log[-1:] == ["mesh"])
        assert (job.state, job.progress, job.log) == ("running", 0.4, ["draw", "mesh"])
        go_on.set()
        assert asyncio.run(here.wait(id, PATIENT)) == "done"
        assert here.get(id).progress == 1.0


@pytest.mark.slow
def test_what_a_stopping_server_gives_back_is_queued_for_all(own_postgres):
    began = threading.Event()

    def interrupted(job, context):
        began.set()
        assert context.cancelled.wait(PATIENT)
        raise JobCancelled

    with server(own_postgres, never, threads=0) as here:
        with server(own_postgres, interrupted, threads=1):
            id = queued(own_postgres, here)
            assert began.wait(PATIENT)
        assert here.get(id).state == "queued"
        assert names(own_postgres, id) == ["running", "queued"]


@pytest.mark.slow
def test_a_job_of_a_kind_that_only_newer_servers_know_waits_for_them(own_postgres):
    """The older server takes the one behind it. What it does not know would fail there for good."""
    with server(own_postgres, lambda job, context: lambda session: None, threads=1, lane=FAST) as older:
        database = Database(own_postgres)
        newer, own = database.write(lambda s: [older.enqueue(s, kind, {}) for kind in ("of newer", KIND)])
        database.close()
        older.wake(KIND)
        assert asyncio.run(older.wait(own, PATIENT)) == "done"
        assert (older.get(newer).state, older.get(newer).attempt) == ("queued", 0)


def names(url, id):
    """The events of a job."""
    database = Database(url)
    with database.read() as session:
        noted = [event.name for event in events_above(session, f"job:{id}", 0)]
    database.close()
    return noted
