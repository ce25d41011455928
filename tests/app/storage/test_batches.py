"""Functions of one job share a process; if one ends the process, only it fails."""

import hashlib
import os
import signal
import threading

import pytest
import victims
from bare_shells import BUSH
from patience import patient

from app.pool.sources import source_of
from app.solids.builds import build_in_worker
from app.workers import local
from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded, JobCancelled, JobCrashed, MemoryExceeded
from app.workers.inline import Inline
from app.workers.local import LocalProcesses
from cad.catalogue import models
from cad.regenerate import as_text, build_key

USUAL = Limits(deadline=patient(20), memory_mb=512)


@pytest.fixture(scope="module")
def worker():
    worker = LocalProcesses(preload=())
    yield worker
    worker.close()


@pytest.fixture
def batch(worker):
    batch = worker.batch()
    yield batch
    batch.close()


def test_functions_of_a_batch_share_a_process(worker, batch):
    ids = {batch.run(victims.process_id, limits=USUAL) for _ in range(4)}
    other = worker.batch()
    assert len({*ids, other.run(victims.process_id), os.getpid()}) == 3
    other.close()


def test_progress_and_limits_are_those_of_each_function(batch):
    heard = []
    assert batch.run(victims.count_to, 2, on_progress=lambda *message: heard.append(message)) == 2
    with pytest.raises(DeadlineExceeded):
        batch.run(victims.endless_sum, limits=Limits(0.3, 512))
    assert batch.run(victims.count_to, 1, on_progress=lambda *message: heard.append(message)) == 1
    assert heard == [(0.0, "step 0"), (0.5, "step 1"), (0.0, "step 0")]


@pytest.mark.parametrize(
    ("function", "args", "error"),
    [
        (victims.segfault, (), JobCrashed),
        (victims.leave, (3,), JobCrashed),
        (victims.memory_bomb, (), MemoryExceeded),
        (victims.bad_value, ("no such bore",), ValueError),
    ],
    ids=["signal", "exit", "memory", "exception"],
)
def test_what_fails_fails_alone_and_the_rest_goes_on_in_a_new_process(batch, function, args, error):
    before = batch.run(victims.process_id, limits=USUAL)
    with pytest.raises(error):
        batch.run(function, *args, limits=USUAL)
    after = [batch.run(victims.process_id, limits=USUAL) for _ in range(2)]
    assert after[0] == after[1] != before


def test_a_cancelled_batch_ends_its_process(batch, tmp_path):
    cancelled = threading.Event()
    before = batch.run(victims.process_id)
    cancelled.set()
    with pytest.raises(JobCancelled):
        batch.run(victims.sleep, 60.0, cancelled=cancelled)
    assert batch.run(victims.process_id) != before


def test_a_process_that_was_killed_while_it_waited_is_replaced(batch):
    before = batch.run(victims.process_id)
    os.kill(before, signal.SIGKILL)
    assert batch.run(victims.process_id) != before


def test_what_a_predecessor_left_behind_fails_nothing(batch):
    """A function that fails in a used process answers from a fresh one."""
    assert batch.run(victims.second_fails) == 1
    assert batch.run(victims.second_fails) == 1


def test_a_process_runs_a_limited_number_of_functions(worker, monkeypatch):
    monkeypatch.setattr(local, "MOST_IN_BATCH", 3)
    batch = worker.batch()
    ids = [batch.run(victims.process_id) for _ in range(7)]
    assert [ids.index(id) for id in ids] == [0, 0, 0, 3, 3, 3, 6]
    batch.close()


def test_inline_runs_a_batch_where_it_is_asked_for():
    assert Inline().batch().run(victims.process_id) == os.getpid()


def test_solids_built_in_one_process_have_the_bytes_of_solids_built_apart():
    ring, ball = models().get("plain_bearing", 1), models().get("ball_bearing", 1)
    shapes = [ring.from_quantities({**BUSH, "inner_diameter": f"{d} mm"}) for d in (40, 45, 50)]
    shapes.insert(1, ball.from_quantities({"inner_diameter": "30 mm"}))
    worker = LocalProcesses()
    batch = worker.batch()
    try:
        together = [batch.run(build_in_worker, source_of(type(s)), as_text(s)) for s in (*shapes, shapes[0])]
        assert batch.run(os.getpid) == batch.run(os.getpid)
        apart = [worker.run(build_in_worker, source_of(type(s)), as_text(s)) for s in shapes]
    finally:
        batch.close()
        worker.close()
    assert together == [*apart, apart[0]]
    assert [build.key for build in apart] == [build_key(shape) for shape in shapes]
    assert len({hashlib.sha256(build.step).digest() for build in apart}) == len(shapes)
