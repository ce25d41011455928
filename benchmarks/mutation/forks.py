"""Runs of pytest in forks of a process that has imported the libraries: that takes longer than most tests.

Only what others wrote is imported before the fork: our own packages come from the copy that is tried.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import entry_points
from multiprocessing import get_context
from multiprocessing.context import ForkServerContext, ForkServerProcess
from pathlib import Path

from app.workers.threads import use_one_thread
from benchmarks.mutation import ROOT

OURS = {"app", "cad", "templates", "benchmarks", "tests"}
MEMORY = 12 << 30  # address space of a mutant [bytes], which stops one that would fill the memory
USED = "import sys, app.main, httpx, hypothesis, pytest, scipy.integrate, scipy.optimize; print(*sys.modules)"
"""Program that prints the modules that Crankwright and most tests import."""
REWRITTEN = ("-W", "ignore::pytest.PytestAssertRewriteWarning")
"""Options of pytest that hide the warning that the asserts of Hypothesis, already imported, are not
rewritten."""


def start(
    folder: Path, arguments: Sequence[str], variables: Mapping[str, str], output: Path
) -> ForkServerProcess:
    """Start pytest in a folder, in a session of its own, with its output in a file."""
    process = _context().Process(
        target=_run, args=(folder, (*REWRITTEN, *arguments), dict(variables), output)
    )
    process.start()
    return process


@cache
def _context() -> ForkServerContext:
    use_one_thread()  # set before the forked process imports NumPy
    context = get_context("forkserver")
    context.set_forkserver_preload(libraries())
    return context


def libraries() -> list[str]:
    """Return the modules that others wrote and the program imports; none of pytest's plugins."""
    command = [sys.executable, "-c", USED]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    plugins = {point.value.partition(":")[0].partition(".")[0] for point in entry_points(group="pytest11")}
    return [name for name in result.stdout.split() if name.partition(".")[0] not in OURS | plugins]


def _run(folder: Path, arguments: tuple[str, ...], variables: dict[str, str], output: Path) -> None:
    """Do what `python -m pytest` does in a folder, and end this process with its exit code."""
    os.setsid()
    with output.open("w") as file:
        for standard in (1, 2):
            os.dup2(file.fileno(), standard)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    os.chdir(folder)
    os.environ.update(variables)
    sys.path[:] = [str(folder), *(one for one in sys.path if one not in ("", str(ROOT)))]
    for name in [name for name in sys.modules if name.partition(".")[0] in OURS]:
        del sys.modules[name]
    sys.argv = ["pytest", *arguments]
    code = 1
    try:
        import pytest

        code = int(pytest.main(list(arguments)))
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
