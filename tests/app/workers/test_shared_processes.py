"""A job's process that is clean afterwards serves the next such job; all others end with their job."""

import os
import signal
from concurrent.futures import ThreadPoolExecutor

import pytest
import victims
from patience import patient, until

from app.pool.sources import FileSource, SheetSource
from app.solids.builds import build_in_worker
from app.workers import local
from app.workers.base import Limits, shares_process
from app.workers.errors import DeadlineExceeded, JobCrashed, MemoryExceeded
from app.workers.local import LocalProcesses

USUAL = Limits(deadline=patient(20), memory_mb=512)


@pytest.fixture
def worker():
    worker = LocalProcesses(preload=())
    yield worker
    worker.close()


def job(worker, *calls):
    """What the functions of one job return."""
    batch = worker.batch()
    try:
        return [batch.run(function, *args, limits=USUAL) for function, *args in calls]
    finally:
        batch.close()


def test_jobs_that_may_share_a_process_do(worker):
    ids = [job(worker, (victims.shared_process_id,)) for _ in range(3)]
    assert ids[0] == ids[1] == ids[2]


@pytest.mark.parametrize(
    "other",
    [(victims.process_id,), (victims.shared_process_id, False)],
    ids=["without the mark", "with other arguments"],
)
@pytest.mark.sampled(1)
def test_a_job_that_runs_anything_else_has_its_own_process(worker, other):
    (kept,) = job(worker, (victims.shared_process_id,))
    (own,) = job(worker, other)
    assert own != kept
    assert job(worker, (victims.shared_process_id,)) == [kept]
    mixed = job(worker, (victims.shared_process_id,), other)
    assert mixed == [kept, kept]
    assert job(worker, (victims.shared_process_id,)) != [kept]


def test_two_jobs_at_a_time_never_share(worker):
    one, other = worker.batch(), worker.batch()
    assert one.run(victims.shared_process_id) != other.run(victims.shared_process_id)
    one.close()
    other.close()
    assert len(worker._kept) == local.MOST_KEPT


def test_what_an_earlier_job_left_behind_fails_nothing(worker):
    answers = [job(worker, (victims.shared_second_fails,)) for _ in range(3)]
    assert answers == [[1], [1], [1]]


def test_a_process_that_was_killed_while_it_waited_is_replaced(worker):
    (kept,) = job(worker, (victims.shared_process_id,))
    os.kill(kept, signal.SIGKILL)
    assert job(worker, (victims.shared_process_id,)) != [kept]


def test_a_process_runs_a_limited_number_of_functions_of_all_jobs(worker, monkeypatch):
    monkeypatch.setattr(local, "MOST_IN_BATCH", 3)
    ids = [job(worker, (victims.shared_process_id,))[0] for _ in range(5)]
    assert [ids.index(id) for id in ids] == [0, 0, 0, 3, 3]


def test_closing_ends_the_process_that_waits():
    worker = LocalProcesses(preload=())
    (kept,) = job(worker, (victims.shared_process_id,))
    (used,) = worker._kept
    worker.close()
    assert used.process._status.closed
    assert not worker._kept
    assert kept != os.getpid()


@pytest.mark.parametrize(
    ("source", "is_shared"),
    [
        (FileSource("cad/models/plain_bearing_v1.py"), True),
        (FileSource("/team/own_v1.py", "digest", b"code"), False),
        (SheetSource("own", 1, "text", None), False),
    ],
)
def test_built_in_models_share_and_code_of_a_team_does_not(source, is_shared):
    assert shares_process(build_in_worker, (source, {})) is is_shared


@pytest.mark.parametrize(
    ("offence", "limits", "error"),
    [
        ((victims.shared_spend, 60.0), Limits(deadline=0.3, memory_mb=512), DeadlineExceeded),
        ((victims.shared_hoard, 600), USUAL, MemoryExceeded),
        ((victims.shared_end,), USUAL, JobCrashed),
    ],
    ids=["deadline", "memory", "crash"],
)
@pytest.mark.sampled(1)
def test_a_job_that_is_ended_harms_no_neighbour(worker, offence, limits, error):
    (kept,) = job(worker, (victims.shared_process_id,))
    with ThreadPoolExecutor(1) as pool:
        neighbour = pool.submit(job, worker, (victims.shared_spend, 0.6), (victims.shared_process_id,))
        until(lambda: not worker._kept)
        batch = worker.batch()
        with pytest.raises(error):
            batch.run(*offence, limits=limits)
        batch.close()
        assert neighbour.result() == [kept, kept]
    assert job(worker, (victims.shared_process_id,)) == [kept]


@pytest.mark.parametrize(
    "offence", [(victims.shared_hoard, 600), (victims.shared_end,)], ids=["memory", "crash"]
)
def test_a_used_process_is_never_to_blame_and_never_lent_again(worker, offence):
    (kept,) = job(worker, (victims.shared_process_id,))
    with pytest.raises((MemoryExceeded, JobCrashed)):
        job(worker, offence)
    assert not worker._kept
    assert job(worker, (victims.shared_process_id,)) != [kept]


@pytest.mark.slow
def test_what_an_earlier_job_keeps_takes_no_memory_of_the_next(worker):
    (kept,) = job(worker, (victims.shared_hoard, 100))
    (own,) = job(worker, (victims.shared_hoard, 450))
    assert own != kept
    assert job(worker, (victims.shared_process_id,)) not in ([kept], [own])
