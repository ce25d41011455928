"""One mutant on a copy of the repository, and whether its related tests notice it.

A mutant counts as killed only if the test file that fails passes without it. The copy is the tree as it
stands, with what is not committed yet; the repository itself is never changed.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from threading import Lock
from uuid import uuid4

from benchmarks.mutation import ROOT
from benchmarks.mutation.places import Mutant
from benchmarks.mutation.related import related

PYTEST = ("-m", "pytest", "-x", "-q", "-n", "0", "-p", "no:cacheprovider", "--no-header", "--tb=line")
MEMORY = 12 << 20  # [KiB] of addresses, for a mutant that fills all of it
MARK = "CRANKWRIGHT_MUTANT"
_FAILED = re.compile(r"^(?:FAILED|ERROR) (tests/[\w/]+\.py)\S*", re.MULTILINE)


@dataclass(frozen=True)
class Run:
    """What pytest said of some files."""

    outcome: str  # passed, failed or hung
    by: str = ""  # the test that failed
    file: str = ""  # and its file


class Copy:
    """A copy of the repository on which one mutant at a time is tried."""

    def __init__(self, folder: Path, limit: float, nearest: int) -> None:
        self.folder = folder
        self.limit = limit
        self.nearest = nearest
        self._passing: dict[str, bool] = {}
        shutil.copytree(
            ROOT, folder, ignore=shutil.ignore_patterns(".git", ".venv", "__pycache__", ".*_cache")
        )

    def try_out(self, mutant: Mutant) -> dict[str, object]:
        """Return what became of a mutant, as a row of the record."""
        begin, tests = time.monotonic(), related(mutant.file, self.nearest)
        self._write(mutant.file, mutant.source)
        try:
            run = self._first_failure(tests)
        finally:
            self._write(mutant.file, (ROOT / mutant.file).read_text(encoding="utf-8"))
        outcome = {"passed": "survived", "failed": "killed", "hung": "killed"}.get(run.outcome, run.outcome)
        if run.outcome == "failed" and not self._passes(run.file):
            outcome = "unclear"  # the test fails without the mutant too
        seconds = round(time.monotonic() - begin, 1)
        return {**row(mutant, tests), "outcome": outcome, "by": run.by or run.outcome, "seconds": seconds}

    def _first_failure(self, tests: Sequence[str]) -> Run:
        """Run the nearest file alone, and the others only if it does not notice."""
        for part in filter(None, (tests[:1], tests[1:])):
            run = self._run(part)
            if run.outcome != "passed":
                return run
        return Run("passed")

    def _passes(self, file: str) -> bool:
        if file not in self._passing:
            self._passing[file] = self._run((file,)).outcome == "passed"
        return self._passing[file]

    def _write(self, file: str, text: str) -> None:
        target = self.folder / file
        for compiled in target.parent.glob(f"__pycache__/{target.stem}.*.pyc"):
            compiled.unlink()  # Python compares dates to the second
        target.write_text(text, encoding="utf-8")

    def _run(self, tests: Sequence[str]) -> Run:
        mark = uuid4().hex
        command = (
            "sh",
            "-c",
            f'ulimit -v {MEMORY}; exec "$@"',
            "sh",
            sys.executable,
            *PYTEST,
            *plugins(tests),
        )
        environment = {**os.environ, MARK: mark, "PYTHONPATH": str(self.folder)}
        process = subprocess.Popen(
            (*command, *tests),
            cwd=self.folder,
            env=environment,
            start_new_session=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        try:
            output, _ = process.communicate(timeout=self.limit)
        except subprocess.TimeoutExpired:
            return Run("hung")
        finally:
            end(process, mark)
        return understood(process.returncode, output, tests)


def plugins(tests: Sequence[str]) -> tuple[str, ...]:
    """Return options that leave out a plugin which takes longer to import than most tests run."""
    uses = any("schemathesis" in (ROOT / test).read_text(encoding="utf-8") for test in tests)
    return () if uses else ("-p", "no:schemathesis")


def understood(code: int, output: str, tests: Sequence[str]) -> Run:
    """Return what pytest's exit code and summary say; a crash of pytest itself is a failure too."""
    if code == 0:
        return Run("passed")
    failure = _FAILED.search(output)
    if failure:
        return Run("failed", failure[0].split(" ", 1)[1], failure[1])
    return Run("failed", output.strip().rpartition("\n")[2][:200], tests[0])


def end(process: subprocess.Popen[str], mark: str) -> None:
    """End the process and all that it started, which inherited its mark."""
    for pid in [process.pid, *marked(mark)]:
        with suppress(ProcessLookupError, PermissionError):
            os.kill(pid, signal.SIGKILL)
    process.wait()


def marked(mark: str) -> list[int]:
    """Return the processes with this mark in their environment."""
    wanted, pids = f"{MARK}={mark}".encode(), []
    for file in Path("/proc").glob("[0-9]*/environ"):
        with suppress(OSError):
            if wanted in file.read_bytes().split(b"\0"):
                pids.append(int(file.parent.name))
    return pids


def row(mutant: Mutant, tests: tuple[str, ...]) -> dict[str, object]:
    """Return what the record says of a mutant, whatever becomes of it."""
    return {
        "key": mutant.key,
        "file": mutant.file,
        "line": mutant.line,
        "text": mutant.text,
        "operator": mutant.operator,
        "diff": mutant.diff,
        "code": fingerprint((mutant.file,)),
        "tests": fingerprint(tests),
    }


@cache
def fingerprint(files: tuple[str, ...]) -> str:
    """Return a digest of files, by which a row of an older record is valid or not."""
    texts = ((ROOT / file).read_bytes() for file in files)
    return sha256(b"\0".join((*map(str.encode, files), *texts))).hexdigest()[:16]


class Copies:
    """Copies for as many threads as ask for one."""

    def __init__(self, folder: Path, limit: float, nearest: int) -> None:
        self._folder, self._limit, self._nearest = folder, limit, nearest
        self._idle: list[Copy] = []
        self._number = 0
        self._lock = Lock()

    def using(self, work: Callable[[Copy], dict[str, object]]) -> dict[str, object]:
        """Return what some work on an idle copy returns; makes a copy if none is idle."""
        with self._lock:
            self._number += not self._idle
            copy = self._idle.pop() if self._idle else self._copy()
        try:
            return work(copy)
        finally:
            self._idle.append(copy)

    def _copy(self) -> Copy:
        return Copy(self._folder / str(self._number), self._limit, self._nearest)
