"""Jobs on machines that die (workers, scheduler, server): each job ends once, and no process remains."""

import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import pytest
import victims
from dask_processes import Network, process_in, until_gone
from patience import patient, until
from serving import alive, descendants
from sqlalchemy import select

from app.jobs.dispatcher import MAX_LOSSES
from app.jobs.service import Jobs
from app.settings import Settings
from app.storage.database import Database
from app.storage.migrations import migrate
from app.storage.tables import BuildRow, JobRow
from app.workers.base import Limits
from app.workers.errors import WorkerLost

pytestmark = pytest.mark.slow

LONG = Limits(deadline=patient(100), memory_mb=512)
SERVER = """
import sys
from pathlib import Path
from app.settings import Settings
from app.workers.remote.engine import DaskWorker
import victims
DaskWorker.of(Settings(engine=sys.argv[1])).run(victims.tell_and_sleep, Path(sys.argv[2]))
"""


@pytest.fixture
def network(tmp_path):
    network = Network(tmp_path)
    yield network
    network.stop()


@pytest.fixture
def engine(network):
    engine = network.engine()
    yield engine
    engine.close()


@pytest.fixture
def database(tmp_path):
    url = f"sqlite:///{tmp_path / 'jobs.db'}"
    migrate(url)
    database = Database(url)
    yield database
    database.close()


def describe(error):
    return {"type": type(error).__name__, "detail": str(error)}


@pytest.fixture
def jobs(database, engine):
    """Jobs whose function runs on a machine until a file is there, and of which each may be recorded once."""
    with ExitStack() as stack:
        jobs = Jobs(database, engine, Settings(workers=2), describe)

        def handler(job, context):
            context.run(victims.wait_for, Path(job.payload["folder"]), limits=LONG)

            def completion(session):
                session.add(
                    BuildRow(key=job.id, model="m", version=1, parameters={}, measurements={}, created="")
                )
                return f"/builds/{job.id}"

            return completion

        jobs.register("regenerate", handler)
        jobs.start()
        stack.callback(jobs.stop)
        yield jobs


def put(jobs, database, folder):
    folder.mkdir()
    id = database.write(lambda session: jobs.enqueue(session, "regenerate", {"folder": str(folder)}))
    jobs.wake()
    return id


def losses(database, id):
    with database.read() as session:
        return session.scalar(select(JobRow.losses).where(JobRow.id == id))


def recorded(database):
    with database.read() as session:
        return list(session.scalars(select(BuildRow.key)))


def running_in(folder, but=()):
    """The process of a job that runs, and is none of those that ran before."""
    return until(lambda: next((pid for pid in pids(folder) if pid not in but and alive(pid)), None))


def pids(folder):
    return [int(file.name) for file in folder.iterdir() if file.name.isdecimal()]


def worker_of(network, child):
    return next(worker for worker in network.workers if child in descendants(worker.pid))


def test_the_job_of_a_killed_worker_runs_on_the_other_and_is_recorded_once(network, jobs, database, tmp_path):
    id = put(jobs, database, folder := tmp_path / "job")
    first = running_in(folder)
    killed = time.monotonic()
    worker_of(network, first).kill()
    until_gone(first)
    second = running_in(folder, [first])
    assert time.monotonic() - killed < patient(Settings().lease_seconds)
    (folder / "go").touch()
    until(lambda: jobs.get(id).state, lambda state: state == "done")
    assert (losses(database, id), jobs.get(id).crashes, recorded(database)) == (1, 0, [id])
    assert sorted(pids(folder)) == sorted([first, second])
    until_gone(second)


def test_a_killed_scheduler_costs_no_job_and_work_goes_on_when_it_is_back(network, jobs, database, tmp_path):
    id = put(jobs, database, folder := tmp_path / "job")
    first = running_in(folder)
    network.scheduler.kill()
    until_gone(first)
    until(lambda: jobs.get(id).state, lambda state: state == "queued")
    later = put(jobs, database, tmp_path / "later")  # it is accepted, and waits
    assert jobs.get(later).state == "queued"
    for each in (folder, tmp_path / "later"):
        (each / "go").touch()
    network.start_scheduler()
    for each in (id, later):
        until(lambda each=each: jobs.get(each).state, lambda state: state == "done")
    assert sorted(recorded(database)) == sorted([id, later])
    assert losses(database, id) == 1


def test_a_job_that_loses_one_machine_after_another_fails_and_says_so(
    jobs, database, engine, monkeypatch, tmp_path
):
    def lost(*_, **__):
        raise WorkerLost("the machine that ran it has disconnected")

    monkeypatch.setattr(engine._cluster, "run", lost)
    id = put(jobs, database, tmp_path / "job")
    until(lambda: jobs.get(id).state, lambda state: state == "failed")
    assert losses(database, id) == MAX_LOSSES
    assert jobs.get(id).problem["type"] == "JobLost"
    assert f"{MAX_LOSSES} times" in jobs.get(id).problem["detail"]


def test_what_a_killed_server_had_running_is_killed(network, engine, tmp_path):
    command = [sys.executable, "-c", SERVER, network.address, str(tmp_path / "pid")]
    server = subprocess.Popen(command, env={"PYTHONPATH": ":".join(filter(None, sys.path))})
    child = process_in(tmp_path / "pid")
    server.kill()
    server.wait()
    until_gone(child)
    until(lambda: engine.capacity("geometry"), lambda count: count == 2)


def test_a_worker_that_is_stopped_ends_its_processes_and_loses_its_function(network, engine, tmp_path):
    (folder := tmp_path / "job").mkdir()
    with ThreadPoolExecutor(1) as threads:
        answer = threads.submit(engine.run, victims.wait_for, folder, limits=LONG)
        worker = worker_of(network, running_in(folder))
        processes = [*descendants(worker.pid)]
        assert worker.stop(signal.SIGTERM) == 0
        with pytest.raises(WorkerLost):
            answer.result(patient(30))
    for pid in processes:
        until_gone(pid)


def test_a_worker_waits_for_its_scheduler_and_leaves_no_process_when_killed(network, engine):
    engine.run(victims.process_id)
    worker = network.workers[0]
    processes = [*descendants(worker.pid)]
    assert processes
    worker.kill()
    for pid in processes:
        until_gone(pid)
    assert engine.run(victims.double, 2) == 4
