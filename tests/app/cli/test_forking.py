"""A process forks its fork servers before it has threads."""

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from patience import patient
from test_workers import alive, eventually

from app.workers import prefork, processes

FORKS = """
import os, sys, threading
from app.workers import pool
from app.workers import prefork
sys.path.insert(0, {tests!r})
import victims

def forked(preload):
    prefork.fork(preload, lambda: os.environ.update(PREPARED="yes"))
    assert prefork.is_forked(preload)
    worker = pool.WarmProcesses(preload)
    assert not prefork.is_forked(preload)
    return worker

workers = [forked(("victims", name)) for name in ("json", "csv")]
prefork.fork(("victims", "abc"))
unused = prefork._started["victims", "abc"]._process
assert unused.poll() is None
prefork.close()
assert unused.poll() is not None and not prefork.is_forked(("victims", "abc"))
pids = [worker._forkserver._process.pid for worker in workers]
"""
RUNS = """
assert [worker.run(victims.environment, "PREPARED") for worker in workers] == ["yes", "yes"]
assert threading.active_count() == 1
os.kill(pids[0], 9)
assert workers[0]._forkserver._process.wait(10) == -9
assert not workers[0].answers()
print(workers[0].run(victims.environment, "PREPARED"))
workers[1].close()
assert workers[1]._forkserver._process.poll() == -9
"""
IMPORTS = """
import sys
from app.workers.threads import use_one_thread
use_one_thread()
from app.cli.start import begin_serving
begin_serving()
import app.cli.serve
app.cli.serve.find_templates(()), app.cli.serve.models()
assert app.cli.serve.prefork._may_fork(), "something has started a thread"
print(*sys.modules)
"""


def run(program, tests):
    command = [sys.executable, "-c", program.format(tests=str(tests / "app"))]
    return subprocess.run(command, capture_output=True, text=True, cwd=tests.parent, timeout=patient(60))


@pytest.fixture(scope="module")
def tests(request):
    return Path(request.config.rootpath, "tests")


def test_a_forked_server_of_forks_works_is_replaced_and_ends(tests):
    done = run(FORKS + RUNS, tests)
    assert (done.returncode, done.stdout) == (0, "None\n"), done.stderr


def test_all_of_them_end_with_who_forked_them(tests):
    """Whatever ends it, and though the second one has been forked when the first one's pipe was open."""
    done = run(FORKS + "print(*pids, flush=True)\nos.kill(os.getpid(), 9)", tests)
    assert done.returncode == -signal.SIGKILL, done.stderr
    pids = [int(pid) for pid in done.stdout.split()]
    assert len(pids) == 2
    assert eventually(lambda: not any(alive(pid) for pid in pids))


def test_a_process_with_threads_forks_none():
    end = threading.Event()
    thread = threading.Thread(target=end.wait)
    thread.start()
    try:
        prefork.fork(("json",))
        assert not prefork.is_forked(("json",))
    finally:
        end.set()
        thread.join()


def test_what_is_forked_waits_as_long_as_it_may():
    if not (pid := os.fork()):
        os.execv(sys.executable, [sys.executable, "-c", "import time; time.sleep(60)"])
    process: processes.Process = prefork.ForkedProcess(pid)
    assert process.poll() is None
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(0.01)
    process.kill()
    assert process.wait() == process.poll() == -signal.SIGKILL
    process.kill()


@pytest.mark.slow
def test_property_serve_imports_no_kernel_and_nothing_that_few_requests_need(tests):
    done = run(IMPORTS, tests)
    assert done.returncode == 0, done.stderr
    modules = {name.partition(".")[0] for name in done.stdout.split()}
    assert {"app", "pint", "httpx", "sqlalchemy", "templates"} <= modules
    assert modules.isdisjoint({"openpyxl", "dask", "rich", "latex2mathml", "ngsolve", "numba", "distributed"})
