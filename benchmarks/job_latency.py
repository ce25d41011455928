"""Cost of a job beside its own work: in a process that waits for it, in a forked one, in a new one.

Run `python benchmarks/job_latency.py`; read the ratios rather than the times.
"""

import asyncio
import logging
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

from sqlalchemy.orm import Session

from app.jobs.context import JobContext
from app.jobs.job import Job
from app.jobs.service import Jobs
from app.settings import Settings
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.storage.migrations import migrate
from app.workers.isolated import JobProcess
from app.workers.local import LocalProcesses
from app.workers.messages import Request

RUNS = 30
PAUSE = 0.2  # between jobs, as between the changes of one user [s]
KERNEL = "cadquery"


class WithoutSpare(LocalProcesses):
    """Forks a process when a job comes instead of before."""

    def started(self, request: Request) -> JobProcess:
        """Fork one; it is not kept waiting."""
        process = self._forkserver.fork()
        process.start(request)
        return process


def milliseconds(action: Callable[[], object]) -> float:
    """Median time of an action [ms]; the first run is for warming up."""
    taken = []
    for _ in range(RUNS + 1):
        time.sleep(PAUSE)
        start = time.perf_counter()
        action()
        taken.append(1e3 * (time.perf_counter() - start))
    return median(taken[1:])


def cold() -> float:
    """Time of a new interpreter that imports the kernel [ms]."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", f"import {KERNEL}"], check=True)
    return 1e3 * (time.perf_counter() - start)


def in_worker(kind: type[LocalProcesses]) -> float:
    """Time of a function that does nothing, in the worker alone [ms]."""
    worker = kind(preload=(KERNEL,))
    try:
        return milliseconds(lambda: worker.run(abs, -1))
    finally:
        worker.close()


def handle(job: Job, context: JobContext) -> Callable[[Session], None]:
    """Do nothing, in a process."""
    context.run(abs, -1)
    return lambda session: None


def as_job(folder: Path) -> float:
    """Time from a request's unit of work to the end of its job: three synced commits and a process [ms]."""
    data = DataFolder(folder)
    migrate(data.database_url)
    database, worker = Database(data.database_url), LocalProcesses(preload=(KERNEL,))
    jobs = Jobs(database, worker, Settings(data=folder), lambda error: {"detail": str(error)})
    jobs.register("nothing", handle)
    jobs.start()

    def request() -> None:
        id = database.write(lambda session: jobs.enqueue(session, "nothing", {}))
        jobs.wake()
        assert asyncio.run(jobs.wait(id, 10)) == "done"

    try:
        return milliseconds(request)
    finally:
        jobs.stop()
        worker.close()
        database.close()
        data.release()


def main() -> None:
    """Print the table."""
    logging.disable()
    spare = in_worker(LocalProcesses)
    with tempfile.TemporaryDirectory() as folder:
        rows = {
            "process that waits for its job": spare,
            "process forked when the job comes": in_worker(WithoutSpare),
            "job: queued, run, recorded": as_job(Path(folder)),
            f"new interpreter that imports {KERNEL}": cold(),
        }
    for name, taken in rows.items():
        print(f"{name:45} {taken:8.1f} ms   x {taken / spare:6.1f}")


if __name__ == "__main__":
    main()
