"""No process outlives its server, even if the server is killed; closing never waits."""

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import victims
from patience import patient
from serving import alive, descendants

from app.workers import family
from app.workers.base import Limits
from app.workers.errors import JobCancelled, JobCrashed
from app.workers.local import LocalProcesses

HERE = Path(__file__).parent
LONG = Limits(deadline=60, memory_mb=512)

SERVER = """
import sys, threading, time
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import victims
from app.workers.local import LocalProcesses
worker = LocalProcesses(preload=sys.argv[3:])
threading.Thread(target=worker.run, args=(victims.with_grandchild, Path(sys.argv[2])), daemon=True).start()
print(worker._forkserver._process.pid, flush=True)
time.sleep(600)
"""


def eventually(condition, seconds=60.0):
    end = time.monotonic() + patient(seconds)
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def started(tmp_path, *preload):
    """A server with a job of which a process is a child, and the process id of its forkserver."""
    command = [sys.executable, "-c", SERVER, str(HERE), str(tmp_path / "pids"), *preload]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    return server, int(server.stdout.readline())


def killed(server):
    server.kill()
    server.wait()
    server.stdout.close()


def is_importing(pid):
    """Whether it sleeps in its import rather than starts: only then has the interpreter's C timer a wait."""
    try:
        return "nanosleep" in Path(f"/proc/{pid}/wchan").read_text()
    except OSError:
        return False


@pytest.mark.slow
def test_a_forkserver_that_is_still_importing_dies_with_its_server(tmp_path):
    server, forkserver = started(tmp_path, "slow_import")
    assert eventually(lambda: is_importing(forkserver)), Path(f"/proc/{forkserver}/wchan").read_text()
    killed(server)
    assert eventually(lambda: not alive(forkserver))


@pytest.mark.slow
def test_a_server_killed_before_its_forkserver_has_begun(tmp_path):
    server, forkserver = started(tmp_path, "slow_import")
    killed(server)
    assert eventually(lambda: not alive(forkserver))


def test_jobs_of_a_stopped_forkserver_die_with_the_server(tmp_path):
    server, forkserver = started(tmp_path)
    pids = tmp_path / "pids"
    assert eventually(lambda: pids.exists() and " " in pids.read_text())
    os.kill(forkserver, signal.SIGSTOP)
    family = descendants(server.pid)
    assert {forkserver, *map(int, pids.read_text().split())} <= family
    killed(server)
    assert eventually(lambda: not any(alive(pid) for pid in family)), "the grandchild of a job as well"


@pytest.mark.slow
def test_a_hang_up_that_comes_before_the_end_of_the_server_kills_nobody(tmp_path):
    server, forkserver = started(tmp_path)
    pids = tmp_path / "pids"
    assert eventually(lambda: pids.exists() and " " in pids.read_text())
    job, grandchild = map(int, pids.read_text().split())
    os.kill(forkserver, signal.SIGSTOP)
    os.killpg(forkserver, signal.SIGHUP)  # as the kernel does when the group is orphaned
    os.killpg(forkserver, signal.SIGCONT)
    os.killpg(job, signal.SIGHUP)
    time.sleep(0.1)
    assert all(alive(pid) for pid in (forkserver, job, grandchild))
    killed(server)
    assert eventually(lambda: not any(alive(pid) for pid in (forkserver, job, grandchild)))


@pytest.fixture
def stopped():
    """A worker whose forkserver hangs, with a process that still waits for a job."""
    worker = LocalProcesses(preload=())
    assert worker.run(victims.double, 1) == 2
    _ = worker._spare._pid
    forkserver = worker._forkserver._process.pid
    os.kill(forkserver, signal.SIGSTOP)
    yield worker
    worker.close()
    assert not alive(forkserver)


def test_a_job_that_is_not_born_can_be_cancelled(stopped, tmp_path):
    assert stopped.run(victims.double, 2) == 4  # by the process that waited
    cancelled, file = threading.Event(), tmp_path / "pid"
    cancelled.set()
    with pytest.raises(JobCancelled):
        stopped.run(victims.tell_and_sleep, file, limits=LONG, cancelled=cancelled)
    os.kill(stopped._forkserver._process.pid, signal.SIGCONT)
    assert stopped.run(victims.double, 3) == 6  # born after the cancelled one
    assert not file.exists(), "it ran although it had been cancelled before it was born"


def test_closing_with_a_stopped_forkserver_ends_who_waits(stopped):
    assert stopped.run(victims.double, 2) == 4
    with ThreadPoolExecutor(2) as pool:
        futures = [pool.submit(stopped.run, victims.double, number, limits=LONG) for number in range(2)]
        stopped.close()
        for future in futures:
            assert isinstance(future.exception(patient(60)), JobCrashed | JobCancelled)


def test_what_is_closed_takes_no_job(stopped):
    stopped.close()
    with pytest.raises(JobCancelled):
        stopped.run(victims.double, 2)


FATHER = """
import subprocess, sys
from app.workers import family
parent = "import os, subprocess; os.setsid(); subprocess.run(['sleep', '600'])"
subprocess.Popen([sys.executable, "-c", parent])
print("ready", flush=True)
sys.stdin.readline()
family.kill()
print("killed", flush=True)
sys.stdin.readline()
"""


def test_the_whole_family_can_be_killed():
    with subprocess.Popen(
        [sys.executable, "-c", FATHER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
    ) as father:
        assert father.stdout.readline() == "ready\n"
        assert eventually(lambda: len(descendants(father.pid)) == 2)
        generations = descendants(father.pid)
        assert family.use(father.pid).count == 2
        assert family.use(father.pid).memory > 2 * 2**20
        father.stdin.write("\n")
        assert father.stdout.readline() == "killed\n"
        assert not any(alive(pid) for pid in generations)
        father.stdin.write("\n")
