"""`crankwright worker` and `crankwright scheduler` start fast, because others wait for a replacement."""

import os
import subprocess
import sys

import pytest

BOOT = """
import sys
try:
    from app.__main__ import main
    main()
finally:
    heavy = {"cadquery", "numpy", "sqlalchemy"} & set(sys.modules)
    print("loaded:", sorted(heavy), file=sys.stderr)
"""


def run(*arguments, **environment):
    command = [sys.executable, "-c", BOOT, *arguments]
    return subprocess.run(
        command, env={**os.environ, **environment}, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("name", ["worker", "scheduler"])
def test_nothing_is_loaded_that_it_does_not_need(name):
    done = run(name, "--help")
    assert done.returncode == 0, done.stderr
    assert "Usage:" in done.stdout
    assert "loaded: []" in done.stderr


def test_a_wrong_setting_is_named():
    done = run("worker", CRANKWRIGHT_ENGINE="tcp://scheduler.example:8786")
    assert done.returncode == 1
    assert "CRANKWRIGHT_ENGINE: " in done.stderr
    assert "Traceback" not in done.stderr
