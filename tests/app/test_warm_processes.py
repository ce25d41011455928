"""A process that finished a request normally is reused; any other end ends only that process."""

import os
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import victims
from patience import patient
from test_workers import alive, eventually

from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded, JobCancelled, JobCrashed, MemoryExceeded
from app.workers.pool import WarmProcesses

USUAL = Limits(deadline=20, memory_mb=512)


@pytest.fixture(scope="module")
def worker():
    worker = WarmProcesses((), spares=2)
    yield worker
    worker.close()


@pytest.fixture
def single():
    worker = WarmProcesses((), spares=1, reuse=3)
    yield worker
    worker.close()


@pytest.mark.slow
def test_a_process_takes_as_many_requests_as_it_may(single):
    ids = [single.run(victims.process_id, limits=USUAL) for _ in range(7)]
    assert [ids.count(pid) for pid in dict.fromkeys(ids)] == [3, 3, 1]
    assert eventually(lambda: not alive(ids[0]))


def test_a_process_goes_on_after_an_exception(single):
    pid = single.run(victims.process_id)
    with pytest.raises(ValueError, match="no such bore"):
        single.run(victims.bad_value, "no such bore")
    assert single.run(victims.process_id) == pid


def test_progress_arrives_from_every_request(single):
    heard = []
    for _ in range(2):
        assert single.run(victims.count_to, 2, on_progress=lambda *message: heard.append(message)) == 2
    assert heard == [(0.0, "step 0"), (0.5, "step 1")] * 2


@pytest.mark.parametrize(
    ("function", "limits", "error"),
    [
        pytest.param(victims.segfault, USUAL, JobCrashed, marks=pytest.mark.slow),
        (victims.endless_sum, Limits(0.3, 512), DeadlineExceeded),
        pytest.param(victims.memory_bomb, USUAL, MemoryExceeded, marks=pytest.mark.slow),
    ],
)
def test_what_did_not_end_by_itself_ends_its_process(single, function, limits, error):
    pid = single.run(victims.process_id)
    with pytest.raises(error):
        single.run(function, limits=limits)
    assert single.run(victims.process_id) != pid
    assert eventually(lambda: not alive(pid))


def test_cancelling_ends_the_process(single, tmp_path):
    cancelled, file = threading.Event(), tmp_path / "pid"
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(single.run, victims.tell_and_sleep, file, cancelled=cancelled)
        assert eventually(lambda: file.exists() and file.read_text())
        cancelled.set()
        with pytest.raises(JobCancelled):
            future.result(patient(60))
    assert eventually(lambda: not alive(int(file.read_text())))


def test_a_process_that_keeps_memory_takes_no_other_request(single):
    pid = single.run(victims.hoard, 200, limits=USUAL)
    assert single.run(victims.process_id) != pid


@pytest.mark.slow
def test_processor_time_counts_for_each_request_anew(single):
    pid, before = single.run(victims.processor_limit, limits=Limits(1, 512))
    assert single.run(victims.spend, 1.5, limits=USUAL) == pid
    same, after = single.run(victims.processor_limit, limits=Limits(1, 512))
    assert same == pid
    assert after >= before + 1


@pytest.mark.slow
def test_neighbours_survive_crashes(worker):
    with ThreadPoolExecutor(4) as pool:
        crashes = [pool.submit(worker.run, victims.segfault) for _ in range(4)]
        innocent = [pool.submit(worker.run, victims.sleep, 0.01 * number) for number in range(20)]
    assert [future.result() for future in innocent] == [0.01 * number for number in range(20)]
    assert all(isinstance(future.exception(), JobCrashed) for future in crashes)


def test_a_process_killed_while_it_waits_is_replaced(single):
    pid = single.run(victims.process_id)
    os.kill(pid, signal.SIGKILL)
    assert eventually(lambda: not alive(pid))
    assert single.run(victims.double, 2) == 4


@pytest.mark.slow
def test_what_cannot_be_sent_is_refused_and_costs_no_process(single):
    pid = single.run(victims.process_id)
    with pytest.raises(Exception, match="pickle"):
        single.run(lambda: 1)
    assert single.run(victims.process_id) == pid


@pytest.mark.slow
def test_libraries_use_one_thread_each(worker):
    assert worker.run(victims.environment, "OPENBLAS_NUM_THREADS") == "1"


def test_closing_leaves_no_process(tmp_path):
    worker = WarmProcesses((), spares=2)
    pids = [worker.run(victims.process_id), worker._forkserver._process.pid]
    worker.close()
    assert eventually(lambda: not any(alive(pid) for pid in pids))


SERVER = """
import sys, threading, time
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import victims
from app.workers.pool import WarmProcesses
worker = WarmProcesses((), spares=2)
print(worker.run(victims.process_id), worker._forkserver._process.pid, flush=True)
threading.Thread(target=worker.run, args=(victims.with_grandchild, Path(sys.argv[2]))).start()
time.sleep(60)
"""


@pytest.mark.slow
def test_a_killed_server_leaves_no_orphans(tmp_path):
    file = tmp_path / "pids"
    command = [sys.executable, "-c", SERVER, str(Path(__file__).parent), str(file)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as server:
        pids = list(map(int, server.stdout.readline().split()))
        assert eventually(lambda: file.exists() and " " in file.read_text())
        pids += map(int, file.read_text().split())
        assert all(alive(pid) for pid in pids)
        server.kill()
    assert eventually(lambda: not any(alive(pid) for pid in pids))
