"""A committed job runs to its end, and nothing is written twice."""

import asyncio
import threading
import time
from dataclasses import replace

import pytest
import victims
from components import ON_POSTGRESQL
from patience import patient
from patience import until as wait_until
from stored_jobs import KIND, build, builds, ended, put, storing, until

from app.jobs.errors import JobFailed, JobNotFound, QueueFull


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


def test_progress_is_reported_and_logged(make, database, worker):
    jobs = make(worker)

    def handler(job, context):
        context.run(victims.count_to, 3)
        return lambda session: None

    jobs.register(KIND, handler)

    async def watch():
        id = await asyncio.wrap_future(database.submit(lambda session: jobs.enqueue(session, KIND, {})))
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
    jobs, meeting = make(workers=2), threading.Barrier(2, timeout=patient(60))

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
        assert gate.wait(patient(60))
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
    assert asyncio.run(jobs.wait(id, patient(60))) == "done"
    assert asyncio.run(jobs.wait(id, patient(60))) == "done"
    with pytest.raises(JobNotFound):
        asyncio.run(jobs.wait("nobody", 1))


def test_a_job_is_a_snapshot(jobs, database):
    job = jobs.get(put(jobs, database))
    assert not job.finished
    assert replace(job, state="failed").finished


def test_a_job_that_has_ended_is_no_longer_held(make, database, failures):
    """Nobody can interrupt it, and the dispatcher keeps nothing of it."""
    jobs = make()
    jobs.register(KIND, storing, failures)
    jobs.start()
    ids = [put(jobs, database, key) for key in "abc"]
    assert [ended(jobs, id).state for id in ids] == ["done"] * 3
    until(lambda: not jobs._dispatcher._running)
