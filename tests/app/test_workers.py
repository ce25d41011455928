"""A job runs in its own process; whatever happens to it, the server and other jobs continue."""

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
import victims
from patience import GLANCE, patient

from app.workers.base import Limits
from app.workers.errors import (
    DeadlineExceeded,
    JobCancelled,
    JobCrashed,
    MemoryExceeded,
    RemoteError,
)
from app.workers.inline import Inline
from app.workers.local import LocalProcesses

QUICK = Limits(deadline=0.3, memory_mb=512)
USUAL = Limits(deadline=patient(20), memory_mb=512)


@pytest.fixture(scope="module")
def worker():
    worker = LocalProcesses(preload=())
    yield worker
    worker.close()


def alive(pid):
    """Whether a process lives; one that is dead but not yet waited for does not."""
    try:
        return "\nState:\tZ" not in Path(f"/proc/{pid}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False


def eventually(condition, seconds=60.0):
    """Whether the condition comes true within the time."""
    end = time.monotonic() + patient(seconds)
    while not (answer := condition()) and time.monotonic() < end:
        time.sleep(GLANCE)
    return answer


@pytest.mark.parametrize("inline", [False, True])
def test_result_and_progress_arrive(worker, inline):
    reports = []
    chosen = Inline() if inline else worker
    result = chosen.run(victims.count_to, 4, on_progress=lambda *message: reports.append(message))
    assert result == 4
    assert reports == [(0.0, "step 0"), (0.25, "step 1"), (0.5, "step 2"), (0.75, "step 3")]


def test_progress_is_silent_outside_a_job():
    assert victims.count_to(3) == 3


def test_every_job_has_a_fresh_process(worker):
    ids = [worker.run(victims.process_id) for _ in range(5)]
    assert len({*ids, os.getpid()}) == 6
    assert eventually(lambda: not any(alive(pid) for pid in ids))


@pytest.mark.usefixtures("real_fork_servers")
def test_the_main_module_of_the_server_is_not_imported():
    with closing(LocalProcesses(preload=())) as worker:
        assert worker.run(victims.main_module_file) is None


def test_a_large_result_arrives_whole(worker):
    assert worker.run(victims.large, 2**25) == b"x" * 2**25


def test_an_exception_arrives_as_itself(worker):
    with pytest.raises(ValueError, match="no such bore") as caught:
        worker.run(victims.bad_value, "no such bore")
    assert caught.value.args == ("no such bore",)
    assert "in bad_value" in caught.value.__notes__[0]


def test_an_exception_that_cannot_be_sent_arrives_as_text(worker):
    with pytest.raises(RemoteError, match="Awkward: this and that"):
        worker.run(victims.awkward)


def test_a_result_that_cannot_be_sent_is_an_error(worker):
    with pytest.raises(RemoteError, match="function: the result cannot be pickled"):
        worker.run(victims.unpicklable)


def test_a_function_that_cannot_be_sent_is_refused(worker):
    with pytest.raises(Exception, match="pickle"):
        worker.run(lambda: 1)
    assert worker.run(victims.double, 2) == 4


@pytest.mark.parametrize("function", [victims.endless_sum, victims.chatter_for_ever])
def test_a_deadline_ends_what_never_ends(worker, function):
    start = time.monotonic()
    with pytest.raises(DeadlineExceeded, match=r"0\.3 s"):
        worker.run(function, limits=QUICK)
    assert time.monotonic() - start >= QUICK.deadline


def test_a_memory_bomb_is_refused(worker):
    with pytest.raises(MemoryExceeded, match="512 MiB"):
        worker.run(victims.memory_bomb, limits=USUAL)


def test_a_memory_limit_of_the_operator_is_named_with_its_setting(worker):
    limits = replace(USUAL, memory_setting="CRANKWRIGHT_JOB_MEMORY_MB")
    with pytest.raises(MemoryExceeded, match=r"512 MiB .* may raise CRANKWRIGHT_JOB_MEMORY_MB"):
        worker.run(victims.memory_bomb, limits=limits)
    with pytest.raises(JobCrashed, match=r"512 MiB of memory.*CRANKWRIGHT_JOB_MEMORY_MB"):
        worker.run(victims.segfault, limits=limits)


@pytest.mark.parametrize(
    ("function", "number"), [(victims.segfault, signal.SIGSEGV), (victims.abort, signal.SIGABRT)]
)
def test_a_crash_names_its_signal(worker, function, number):
    with pytest.raises(JobCrashed, match=signal.strsignal(number)) as caught:
        worker.run(function)
    assert caught.value.exit_code == -number


def test_an_early_exit_is_a_crash(worker):
    with pytest.raises(JobCrashed, match="exit code 3"):
        worker.run(victims.leave, 3)


def test_neighbours_survive_crashes(worker):
    with ThreadPoolExecutor(4) as pool:
        crashes = [pool.submit(worker.run, victims.segfault) for _ in range(4)]
        innocent = [pool.submit(worker.run, victims.sleep, 0.01 * number) for number in range(12)]
    assert [future.result() for future in innocent] == [0.01 * number for number in range(12)]
    assert all(isinstance(future.exception(), JobCrashed) for future in crashes)


def test_cancelling_kills_the_process(worker, tmp_path):
    cancelled, file = threading.Event(), tmp_path / "pid"
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(worker.run, victims.tell_and_sleep, file, cancelled=cancelled)
        assert eventually(lambda: file.exists() and file.read_text())
        cancelled.set()
        with pytest.raises(JobCancelled):
            future.result(patient(60))
    assert eventually(lambda: not alive(int(file.read_text())))


@pytest.mark.slow
def test_a_deadline_also_kills_grandchildren(worker, tmp_path):
    file = tmp_path / "pids"
    with pytest.raises(DeadlineExceeded):
        worker.run(victims.with_grandchild, file, limits=Limits(1.0, 512))
    job, grandchild = map(int, file.read_text().split())
    assert eventually(lambda: not alive(job) and not alive(grandchild))


def test_a_killed_spare_is_replaced(worker):
    os.kill(worker._spare._pid, signal.SIGKILL)
    pid = worker._spare._pid
    assert eventually(lambda: not alive(pid))
    assert worker.run(victims.double, 2) == 4


@pytest.mark.usefixtures("real_fork_servers")
def test_a_killed_forkserver_is_replaced(worker):
    spare = worker._spare._pid
    worker._forkserver._process.kill()
    assert eventually(lambda: not alive(spare))
    assert worker.run(victims.double, 2) == 4
    assert worker.run(victims.double, 3) == 6


def test_jobs_die_with_their_forkserver(tmp_path):
    worker, file = LocalProcesses(preload=()), tmp_path / "pid"
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(worker.run, victims.tell_and_sleep, file)
        assert eventually(lambda: file.exists() and file.read_text())
        worker._forkserver._process.kill()
        with pytest.raises(JobCrashed, match="disappeared"):
            future.result(patient(60))
    assert eventually(lambda: not alive(int(file.read_text())))
    worker.close()


@pytest.mark.slow
def test_a_preloaded_package_brings_all_its_modules(worker):
    warm = LocalProcesses(preload=("wsgiref",))
    assert warm.run(victims.loaded, "wsgiref.validate")
    warm.close()
    assert not worker.run(victims.loaded, "wsgiref.validate")


@pytest.mark.slow
def test_a_module_that_is_missing_is_imported_by_no_one():
    worker = LocalProcesses(preload=("no.such.module",))
    assert worker.run(victims.double, 2) == 4
    worker.close()


def test_closing_leaves_no_process():
    worker = LocalProcesses(preload=())
    pids = [worker._spare._pid, worker._forkserver._process.pid]
    worker.close()
    assert eventually(lambda: not any(alive(pid) for pid in pids))


SERVER = """
import sys, threading, time
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import victims
from app.workers.local import LocalProcesses
worker = LocalProcesses(preload=())
threading.Thread(target=worker.run, args=(victims.with_grandchild, Path(sys.argv[2]))).start()
while not Path(sys.argv[2]).exists():
    time.sleep(0.01)
print(worker._forkserver._process.pid, flush=True)
print(worker._spare._pid, flush=True)
"""


def test_a_killed_server_leaves_no_orphans(tmp_path):
    file = tmp_path / "pids"
    command = [sys.executable, "-c", SERVER, str(Path(__file__).parent), str(file)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as server:
        pids = [int(server.stdout.readline()), int(server.stdout.readline())]
        assert eventually(lambda: file.exists() and " " in file.read_text())
        pids += map(int, file.read_text().split())
        assert all(alive(pid) for pid in pids)
        server.kill()
    assert eventually(lambda: not any(alive(pid) for pid in pids))
    assert len(set(pids)) == 4
