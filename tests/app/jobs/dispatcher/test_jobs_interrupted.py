"""Jobs whose process crashes, that are cancelled, or whose server is stopped or killed."""

import threading
import time

import pytest
import victims
from patience import patient
from sqlalchemy import update
from stored_jobs import KIND, builds, describe, ended, put, storing, until

from app.jobs import repository
from app.jobs.dispatcher import MAX_CRASHES
from app.jobs.errors import JobFinished, JobNotFound
from app.jobs.service import Jobs
from app.settings import Settings
from app.storage.database import Database
from app.storage.tables import JobRow
from app.workers.errors import JobCrashed
from app.workers.inline import Inline


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
    database.write(repository.requeue_all)
    new = database.write(repository.claim)
    assert (old.attempt, new.attempt) == (1, 2)
    assert not database.write(lambda session: repository.end(session, old, "done", []))
    assert not database.write(lambda session: repository.requeue(session, old, 1))
    assert jobs.get(id).state == "running"
    assert database.write(lambda session: repository.end(session, new, "done", []))
    assert not database.write(lambda session: repository.end(session, new, "failed", []))
    assert jobs.get(id).state == "done"


def test_a_result_that_comes_too_late_is_dropped(make, database, failures):
    """The job is claimed by another while it runs, as when its server was believed dead."""
    jobs, entered, gate = make(), threading.Event(), threading.Event()

    def handler(job, context):
        entered.set()
        assert gate.wait(patient(60))
        return storing(job, context)

    jobs.register(KIND, handler, failures)
    jobs.start()
    id = put(jobs, database)
    assert entered.wait(patient(60))
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
        pytest.param(victims.segfault, "JobCrashed", marks=pytest.mark.slow),
        pytest.param(victims.unpicklable, "RemoteError", marks=pytest.mark.slow),
    ],
)
def test_limits_of_the_settings_hold(make, database, worker, failures, victim, problem):
    jobs = make(worker, job_deadline=0.5, job_memory_mb=256)
    jobs.register(KIND, lambda job, context: context.run(victim), failures)
    jobs.start()
    job = ended(jobs, put(jobs, database))
    assert (job.state, job.problem["type"]) == ("failed", problem)
    assert len(failures) == 1


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
