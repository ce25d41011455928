"""Only the latest progress of a job is stored, at a moderate rate, and nothing after its end."""

import threading
import time
from dataclasses import replace

import pytest
from patience import until

from app.jobs import repository
from app.jobs.events import Events
from app.jobs.progress import ProgressKeeper
from app.storage.errors import DatabaseUnavailable

INTERVAL = 0.2  # [s]
END = 400


class Counting:
    """A database that only counts what is written; it may fail at first."""

    is_shared = True

    def __init__(self, database, failures=0):
        self._database, self._failures = database, failures
        self.times = []

    def write(self, unit):
        self.times.append(time.monotonic())
        if len(self.times) <= self._failures:
            raise DatabaseUnavailable
        return self._database.write(unit)


@pytest.fixture
def job(database):
    database.write(lambda session: repository.add(session, "k", {}, None, None))
    return database.write(lambda session: repository.claim(session, owner="here", lease=1e6))


@pytest.fixture
def kept(database):
    """Makes a keeper; what it hints at is in its list."""
    keepers = []

    def make(failures=0):
        counting, events, hints = Counting(database, failures), Events(database), []
        events.tell = hints.extend
        keeper = ProgressKeeper(counting, events, INTERVAL)
        keeper.start()
        keepers.append(keeper)
        return keeper, counting, hints

    yield make
    for keeper in keepers:
        keeper.stop()


def row(database, job):
    with database.read() as session:
        return repository.get(session, job.id)


def test_many_reports_are_few_writes_and_the_latest_is_the_last(database, job, kept):
    keeper, counting, hints = kept()
    for number in range(END + 1):
        keeper.keep(job, number / END, [f"row {number}"])
        time.sleep(0.002)
    until(lambda: row(database, job).progress, lambda progress: progress == 1.0)
    assert row(database, job).log == [f"row {END}"]
    pauses = [later - earlier for earlier, later in zip(counting.times, counting.times[1:], strict=False)]
    assert pauses
    assert min(pauses) > 0.9 * INTERVAL
    assert set(hints) == {f"progress:{job.id}:"}


def test_the_first_report_is_stored_without_waiting_for_another(database, job, kept):
    kept()[0].keep(job, 0.25, ["meshing"])
    until(lambda: row(database, job).progress, lambda progress: progress == 0.25)


def test_what_fails_once_is_stored_with_the_next_report(database, job, kept):
    keeper, counting, hints = kept(failures=1)
    keeper.keep(job, 0.25, ["one"])
    until(lambda: len(counting.times), lambda count: count == 1)
    assert hints == []
    keeper.keep(job, 0.5, ["one", "two"])
    until(lambda: row(database, job).log, lambda log: log == ["one", "two"])


def test_a_job_that_has_ended_or_has_another_owner_is_left_alone_and_nobody_hears_of_it(database, job, kept):
    keeper, counting, hints = kept()
    keeper.keep(replace(job, owner="elsewhere"), 0.5, ["late"])
    until(lambda: len(counting.times), lambda count: count == 1)
    database.write(lambda session: repository.end(session, job, "done", [], progress=1.0))
    keeper.keep(job, 0.5, ["late"])
    until(lambda: len(counting.times), lambda count: count == 2)
    keeper.stop()
    assert (row(database, job).state, row(database, job).progress, row(database, job).log) == (
        "done",
        1.0,
        [],
    )
    assert hints == []


def test_it_ends_at_once_though_nothing_was_ever_reported(kept):
    keeper, _, _ = kept()
    begin = time.monotonic()
    keeper.stop()
    assert not [thread for thread in threading.enumerate() if thread is keeper._thread]
    assert time.monotonic() - begin < 4.0
