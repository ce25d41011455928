"""Jobs: once committed they run to an end, whatever crashes, and nothing is written twice."""

import asyncio
import threading
import time
from dataclasses import replace

import pytest
import victims
from components import ON_POSTGRESQL
from patience import patient
from patience import until as wait_until
from sqlalchemy import select, update

from app.jobs import repository
from app.jobs.dispatcher import MAX_CRASHES
from app.jobs.errors import JobFailed, JobFinished, JobNotFound, QueueFull
from app.jobs.service import Jobs
from app.settings import Settings
from app.storage.database import Database
from app.storage.tables import BuildRow, JobRow
from app.workers.errors import JobCrashed
from app.workers.inline import Inline
from app.workers.local import LocalProcesses

KIND = "regenerate"


def describe(error):
    return {"type": type(error).__name__, "detail": str(error)}


def build(key):
    """A unit that leaves a trace of the job in the database."""
    return BuildRow(key=key, model="m", version=1, parameters={}, measurements={}, created="")


def storing(job, context):
    """A handler that stores something and names it."""

    def completion(session):
        session.add(build(job.payload["key"]))
        return f"/builds/{job.payload['key']}"

    return completion


class Failures(list):
    """A hook that remembers how jobs failed and leaves a trace in the same transaction."""

    def __call__(self, session, job, problem):
        self.append((job.id, problem))
        session.add(build(f"failure of {job.payload['key']}"))


@pytest.fixture
def failures():
    return Failures()


@pytest.fixture
def make(database):
    """Jobs that are stopped at the end of the test."""
    running = []

    def make(worker=None, **settings):
        jobs = Jobs(database, worker or Inline(), Settings(**settings), describe)
        running.append(jobs)
        return jobs

    yield make
    for jobs in running:
        jobs.stop()


@pytest.fixture
def jobs(make, failures):
    jobs = make()
    jobs.register(KIND, storing, failures)
    return jobs


@pytest.fixture
def worker():
    worker = LocalProcesses(preload=())
    yield worker
    worker.close()


def put(jobs, database, key="a", kind=KIND):
    id = database.write(lambda session: jobs.enqueue(session, kind, {"key": key}))
    jobs.wake()
    return id


def ended(jobs, id, seconds=10):
    asyncio.run(jobs.wait(id, patient(seconds)))
    return jobs.get(id)


def builds(database):
    with database.read() as session:
        return sorted(session.scalars(select(BuildRow.key)))


def until(condition):
    wait_until(condition, seconds=10)


def test_a_job_stores_its_result_with_its_end(jobs, database):
    jobs.start()
    job = ended(jobs, put(jobs, database))
    assert (job.state, job.result, job.progress, job.attempt) == ("done", "/builds/a", 1.0, 1)
    assert builds(database) == ["a"]


def test_jobs_run_in_the_order_of_their_arrival(make, database):
    jobs, order = make(), []

    def handler(job, context):
        order.append(job.payload["key"])
        return lambda session: None

    jobs.register(KIND, handler)
    ids = [put(jobs, database, key) for key in "abcde"]
    jobs.start()
    ended(jobs, ids[-1])
    assert order == list("abcde")


def test_a_job_is_rolled_back_with_its_unit(jobs, database):
    def unit(session):
        jobs.enqueue(session, KIND, {"key": "a"})
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        database.write(unit)
    assert jobs.page(10) == []


def test_a_typed_failure_is_stored_with_its_completion(make, database, failures):
    def handler(job, context):
        raise JobFailed(ValueError("bore"), lambda session: session.add(build("verdict")))

    jobs = make()
    jobs.register(KIND, handler, failures)
    jobs.start()
    job = ended(jobs, put(jobs, database))
    problem = {"type": "ValueError", "detail": "bore"}
    assert (job.state, job.problem) == ("failed", problem)
    assert jobs.problem(job.id) == problem
    assert builds(database) == ["failure of a", "verdict"]
    assert failures == [(job.id, problem)]


def test_an_unexpected_failure_is_logged_and_reaches_the_hook(make, database, failures, caplog):
    jobs = make()
    jobs.register(KIND, lambda job, context: 1 / 0, failures)
    jobs.start()
    job = ended(jobs, put(jobs, database))
    assert (job.state, job.problem["type"]) == ("failed", "ZeroDivisionError")
    assert "failed unexpectedly" in caplog.text
    assert builds(database) == ["failure of a"]


def test_a_failing_completion_leaves_nothing_of_itself(make, database, failures):
    def handler(job, context):
        def completion(session):
            session.add(build("half"))
            session.flush()
            raise OSError("disk")

        return completion

    jobs = make()
    jobs.register(KIND, handler, failures)
    jobs.start()
    assert ended(jobs, put(jobs, database)).state == "failed"
    assert builds(database) == ["failure of a"]


@pytest.mark.skipif(ON_POSTGRESQL, reason="it waits for a newer server there: tests/team/test_jobs_hinted.py")
def test_an_unknown_kind_fails(jobs, database):
    jobs.start()
    assert ended(jobs, put(jobs, database, kind="unheard of")).state == "failed"


def test_the_queue_has_a_limit(make, database):
    jobs = make(queue_limit=3)
    put(jobs, database), put(jobs, database)
    with pytest.raises(QueueFull) as caught:
        put(jobs, database)
    assert caught.value.retry_after > 0
    assert len(jobs.page(10)) == 2


def test_an_unfinished_job_is_found_by_what_it_does(jobs, database):
    id = put(jobs, database)
    with database.read() as session:
        assert jobs.waiting(session, KIND, {"key": "a"}) == id
        assert jobs.waiting(session, KIND, {"key": "b"}) is None
    jobs.start()
    ended(jobs, id)
    with database.read() as session:
        assert jobs.waiting(session, KIND, {"key": "a"}) is None


def test_pages_are_complete_and_newest_first(jobs, database):
    ids = [put(jobs, database, str(number)) for number in range(5)]
    first = [job.id for job in jobs.page(3)]
    second = [job.id for job in jobs.page(3, before=first[-1])]
    assert first + second == sorted(ids, reverse=True)


def test_what_a_killed_server_left_running_runs_again(jobs, database):
    id = put(jobs, database)
    database.write(lambda session: repository.claim(session))
    assert jobs.get(id).state == "running"
    jobs.start()
    job = ended(jobs, id)
    assert (job.state, job.attempt, job.crashes) == ("done", 2, 0)


def test_only_the_newest_claim_may_write(database, jobs):
    id = put(jobs, database)
    old = database.write(repository.claim)
    database.write(repository.give_back_all)
    new = database.write(repository.claim)
    assert (old.attempt, new.attempt) == (1, 2)
    assert not database.write(lambda session: repository.end(session, old, "done", []))
    assert not database.write(lambda session: repository.give_back(session, old, 1))
    assert jobs.get(id).state == "running"
    assert database.write(lambda session: repository.end(session, new, "done", []))
    assert not database.write(lambda session: repository.end(session, new, "failed", []))
    assert jobs.get(id).state == "done"


def test_a_result_that_comes_too_late_is_dropped(make, database, failures):
    """The job is claimed by another while it runs, as when its server was believed dead."""
    jobs, entered, gate = make(), threading.Event(), threading.Event()

    def handler(job, context):
        entered.set()
        assert gate.wait(10)
        return storing(job, context)

    jobs.register(KIND, handler, failures)
    jobs.start()
    id = put(jobs, database)
    assert entered.wait(10)
    database.write(lambda session: session.execute(update(JobRow).values(attempt=7, owner="x")).rowcount)
    gate.set()
    jobs.stop()
    assert jobs.get(id).state == "running"
    assert builds(database) == []
    assert failures == []


def test_a_crash_is_tried_again_and_counted(make, database, failures):
    jobs, tries = make(), []

    def handler(job, context):
        tries.append((job.attempt, job.crashes))
        raise JobCrashed(-11)

    jobs.register(KIND, handler, failures)
    jobs.start()
    job = ended(jobs, put(jobs, database))
    assert tries == [(1, 0), (2, 1)]
    assert (job.state, job.crashes) == ("failed", MAX_CRASHES)
    assert "Segmentation fault" in job.problem["detail"]
    assert builds(database) == ["failure of a"]


def test_a_job_that_crashes_once_is_done(make, database):
    jobs = make()

    def handler(job, context):
        if job.crashes == 0:
            raise JobCrashed(-11)
        return storing(job, context)

    jobs.register(KIND, handler)
    jobs.start()
    job = ended(jobs, put(jobs, database))
    assert (job.state, job.attempt, job.crashes) == ("done", 2, 1)


def test_a_queued_job_is_cancelled_at_once(jobs, database, failures):
    job = jobs.cancel(put(jobs, database))
    assert (job.state, job.problem["type"]) == ("cancelled", "JobCancelled")
    assert builds(database) == ["failure of a"]
    jobs.start()
    assert ended(jobs, put(jobs, database, "b")).state == "done"
    assert builds(database) == ["b", "failure of a"]


def test_a_running_job_is_cancelled_and_its_process_killed(make, database, worker, failures, tmp_path):
    jobs, file, ends = make(worker), tmp_path / "pid", []

    def handler(job, context):
        try:
            context.run(victims.tell_and_sleep, file)
        finally:
            ends.append(time.monotonic())

    jobs.register(KIND, handler, failures)
    jobs.start()
    id = put(jobs, database)
    until(file.exists)
    assert jobs.cancel(id).state == "cancelled"
    until(lambda: ends)
    assert [problem["type"] for _, problem in failures] == ["JobCancelled"]
    jobs.stop()
    assert jobs.get(id).state == "cancelled"


def test_what_has_ended_cannot_be_cancelled(jobs, database):
    jobs.start()
    id = put(jobs, database)
    ended(jobs, id)
    with pytest.raises(JobFinished, match="done"):
        jobs.cancel(id)
    with pytest.raises(JobNotFound):
        jobs.cancel("nobody")


def test_stopping_keeps_a_running_job_for_the_next_start(make, database, worker, failures, tmp_path):
    jobs, file = make(worker), tmp_path / "pid"
    jobs.register(KIND, lambda job, context: context.run(victims.tell_and_sleep, file), failures)
    jobs.start()
    id = put(jobs, database)
    until(file.exists)
    jobs.stop()
    job = jobs.get(id)
    assert (job.state, job.crashes) == ("queued", 0)
    assert failures == []


@pytest.mark.parametrize(
    ("victim", "problem"),
    [
        (victims.endless_sum, "DeadlineExceeded"),
        (victims.memory_bomb, "MemoryExceeded"),
        (victims.segfault, "JobCrashed"),
        (victims.unpicklable, "RemoteError"),
    ],
)
def test_limits_of_the_settings_hold(make, database, worker, failures, victim, problem):
    jobs = make(worker, job_deadline=0.5, job_memory_mb=256)
    jobs.register(KIND, lambda job, context: context.run(victim), failures)
    jobs.start()
    job = ended(jobs, put(jobs, database))
    assert (job.state, job.problem["type"]) == ("failed", problem)
    assert len(failures) == 1


def test_progress_is_reported_and_logged(make, database, worker):
    jobs = make(worker)

    def handler(job, context):
        context.run(victims.count_to, 3)
        return lambda session: None

    jobs.register(KIND, handler)

    async def watch():
        id = await database.awrite(lambda session: jobs.enqueue(session, KIND, {}))
        async with jobs.events.subscribe(f"job:{id}") as events:
            jobs.start()
            names = []
            async for event in events:
                names.append((event.name, event.data.get("text")))
                if event.name == "done":
                    return id, names

    id, names = asyncio.run(watch())
    steps = [f"step {step}" for step in range(3)]
    assert names == [("running", None), *[("progress", step) for step in steps], ("done", None)]
    assert jobs.get(id).log == steps


def test_the_latest_progress_is_stored_while_the_job_goes_on_silently(make, database):
    jobs, seen = make(), []

    def handler(job, context):
        for number in range(1, 4):
            context.progress(number / 4, f"part {number}")
        wait_until(lambda: jobs.get(job.id).log, lambda log: len(log) == 3)
        seen.append(jobs.get(job.id))
        return lambda session: None

    jobs.register(KIND, handler)
    jobs.start()
    ended(jobs, put(jobs, database), 60)
    assert [(job.progress, job.log[-1]) for job in seen] == [(0.75, "part 3")]


def test_two_jobs_run_at_the_same_time(make, database):
    jobs, meeting = make(workers=2), threading.Barrier(2, timeout=10)

    def handler(job, context):
        meeting.wait()
        return lambda session: None

    jobs.register(KIND, handler)
    jobs.start()
    ids = [put(jobs, database, key) for key in "ab"]
    assert [ended(jobs, id).state for id in ids] == ["done", "done"]


def test_a_slow_job_holds_up_its_like_only(make, database):
    jobs, gate = make(workers=1), threading.Event()

    def slow(job, context):
        assert gate.wait(10)
        return lambda session: None

    jobs.register("slow", slow, is_slow=True)
    jobs.register(KIND, lambda job, context: lambda session: None)
    jobs.start()
    first, second = (put(jobs, database, key, "slow") for key in "ab")
    assert ended(jobs, put(jobs, database)).state == "done"
    assert [jobs.get(id).state for id in (first, second)] == ["running", "queued"]
    gate.set()
    assert [ended(jobs, id).state for id in (first, second)] == ["done", "done"]


def test_waiting_ends_with_the_time_or_the_job(jobs, database):
    id = put(jobs, database)
    start = time.monotonic()
    assert asyncio.run(jobs.wait(id, 0.2)) == "queued"
    assert time.monotonic() - start >= 0.2
    jobs.start()
    assert asyncio.run(jobs.wait(id, patient(10))) == "done"
    assert asyncio.run(jobs.wait(id, patient(10))) == "done"
    with pytest.raises(JobNotFound):
        asyncio.run(jobs.wait("nobody", 1))


def test_work_goes_on_after_the_database_has_failed(jobs, database, monkeypatch, caplog):
    monkeypatch.setattr("app.jobs.dispatcher._PAUSE", 0.01)
    claim = repository.claim
    failing = iter([True, True])

    def flaky(session, *kinds, **lane):
        if next(failing, False):
            raise OSError("disk is full")
        return claim(session, *kinds, **lane)

    monkeypatch.setattr("app.jobs.repository.claim", flaky)
    jobs.start()
    assert ended(jobs, put(jobs, database)).state == "done"
    assert "could not be read or written" in caplog.text


def test_a_job_is_a_snapshot(jobs, database):
    job = jobs.get(put(jobs, database))
    assert not job.finished
    assert replace(job, state="failed").finished


def test_a_restarted_server_finds_its_queue(url, failures):
    database = Database(url)
    id = put(Jobs(database, Inline(), Settings(), describe), database)
    database.close()
    reopened = Database(url)
    jobs = Jobs(reopened, Inline(), Settings(), describe)
    jobs.register(KIND, storing, failures)
    jobs.start()
    assert ended(jobs, id).state == "done"
    jobs.stop()
    reopened.close()


def test_a_job_that_has_ended_is_no_longer_held(make, database, failures):
    """Nobody can interrupt it, and the dispatcher keeps nothing of it."""
    jobs = make()
    jobs.register(KIND, storing, failures)
    jobs.start()
    ids = [put(jobs, database, key) for key in "abc"]
    assert [ended(jobs, id).state for id in ids] == ["done"] * 3
    until(lambda: not jobs._dispatcher._running)
