"""A job dispatcher on a database, stopped at the end of each test."""

import pytest
from stored_jobs import KIND, Failures, describe, storing

from app.jobs.service import Jobs
from app.settings import Settings
from app.workers.inline import Inline
from app.workers.local import LocalProcesses


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
