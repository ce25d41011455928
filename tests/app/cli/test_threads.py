"""Libraries for linear algebra use one thread in the service and its processes, unless set otherwise."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import victims

from app.workers.local import LocalProcesses
from app.workers.threads import ONE_THREAD

ROOT = Path(__file__).parents[3]
SHOWN = """
import os, sys, types
from app.__main__ import main
early = "numpy" in sys.modules
shown = lambda: print(os.environ["OPENBLAS_NUM_THREADS"], early)
sys.modules["app.cli.main"] = types.SimpleNamespace(main=shown)
main()
"""


def printed(program, **environment):
    """The output of a program that is started without these variables, or with others."""
    inherited = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
    command = [sys.executable, "-c", program]
    done = subprocess.run(
        command, cwd=ROOT, env=inherited | environment, capture_output=True, text=True, check=True
    )
    return done.stdout.split()


def test_the_command_line_sets_the_variables_before_numpy_is_imported():
    assert printed(SHOWN) == ["1", "False"]


def test_the_operator_has_the_last_word():
    assert printed(SHOWN, OPENBLAS_NUM_THREADS="3") == ["3", "False"]


@pytest.mark.usefixtures("real_fork_servers")
@pytest.mark.parametrize(("own", "expected"), [(None, "1"), ("3", "3")])
def test_job_processes_use_one_thread_unless_the_operator_sets_more(monkeypatch, own, expected):
    for name in ONE_THREAD:
        monkeypatch.delenv(name, raising=False)
    if own:
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", own)
    worker = LocalProcesses(preload=())
    try:
        assert worker.run(victims.environment, "OPENBLAS_NUM_THREADS") == expected
        assert worker.run(victims.environment, "OMP_NUM_THREADS") == "1"
    finally:
        worker.close()
