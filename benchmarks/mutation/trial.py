"""One mutant on a copy of the repository, and whether its related tests notice it.

A mutant counts as killed only if the test file that fails passes without it. The copy is the tree as it
stands, with what is not committed yet; the repository itself is never changed.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum, auto
from functools import cache
from hashlib import sha256
from pathlib import Path
from threading import Lock
from types import MappingProxyType
from uuid import uuid4

from benchmarks.mutation import ROOT, forks, observer
from benchmarks.mutation.observations import Observations
from benchmarks.mutation.places import Mutant
from benchmarks.mutation.related import related
from benchmarks.mutation.targets import targets
from tests.patience import patient

PYTEST = ("-x", "-q", "-n", "0", "-p", "no:cacheprovider", "--no-header", "--tb=line")
MARK = "CRANKWRIGHT_MUTANT"
WIDE = {"COLUMNS": "500"}  # width of pytest's summary, so that it shows why a test failed
NEAR = 4  # number of test files whose single tests are tried first
STARTING = patient(60.0)  # time that pytest itself may take in a run of single tests [s]
SLOWER = 10.0  # factor of the observed time after which a test counts as hung
NOTHING_FAILED = (0, 5)  # exit codes of pytest: all passed, or all were slow tests, which are deselected
_FAILED = re.compile(r"^(?:FAILED|ERROR) ((tests/[\w/]+\.py).*)", re.MULTILINE)


Part = tuple[tuple[str, ...], float]
"""Tests of one run, and its limit [s]."""


class Reach(Enum):
    """Which of the related tests run: a pass over all mutants with few of them comes before one with more."""

    NEAREST = auto()  # runs the nearest test file
    NEAR = auto()  # runs single tests of near files that execute the line
    ALL = auto()


@dataclass(frozen=True)
class Run:
    """Pytest's report on some tests."""

    outcome: str  # passed, failed or hung
    by: str = ""  # the test that failed
    tests: tuple[str, ...] = ()  # tests that must pass without the mutant
    limit: float = 0.0  # time limit [s]


class Copy:
    """A copy of the repository on which one mutant at a time is tried."""

    def __init__(
        self, folder: Path, limit: float, nearest: int, kept: Path, instead: tuple[str, ...] = ()
    ) -> None:
        self.folder = folder
        self.instead = instead  # test files to run at once instead of the nearest one
        self.limit = limit
        self.nearest = nearest
        self._passing: set[tuple[str, ...]] = set()
        shutil.copytree(
            ROOT, folder, ignore=shutil.ignore_patterns(".git", ".venv", "__pycache__", ".*_cache")
        )
        self._list = folder / "observed.txt"
        self._list.write_text("\n".join(targets()), encoding="utf-8")
        self.observations = Observations(kept, self._observe)

    def try_out(self, mutant: Mutant, reach: Reach = Reach.ALL) -> dict[str, object] | None:
        """Return what became of a mutant, as a row of the record.

        If fewer tests than all related ones run, None if they do not kill it.
        """
        begin, tests = time.monotonic(), related(mutant.file, self.nearest)
        run = Run("passed")
        for part, limit in self._within(reach, mutant, tests):
            run = self._with(mutant, part, limit)
            if run.outcome != "passed":
                break
        if reach is not Reach.ALL and run.outcome != "failed":
            return None
        outcome, seconds = self._judged(run), round(time.monotonic() - begin, 1)
        if reach is not Reach.ALL and outcome != "killed":
            return None
        return {**row(mutant, tests), "outcome": outcome, "by": run.by or run.outcome, "seconds": seconds}

    def _within(self, reach: Reach, mutant: Mutant, tests: tuple[str, ...]) -> Iterator[Part]:
        """Yield what to run in one pass over the mutants."""
        match reach:
            case Reach.NEAREST:
                yield from self._nearest(mutant, tests)
            case Reach.NEAR:
                yield from self._single(mutant, tests[:NEAR])
            case Reach.ALL:
                yield from self._parts(mutant, tests)

    def _nearest(self, mutant: Mutant, tests: tuple[str, ...]) -> Iterator[Part]:
        """Yield the nearest file, or its single tests that run the line if it was observed."""
        if self.instead:
            yield self.instead, self.limit
        elif not self.observations.has(tests[0], mutant.file):
            yield tests[:1], STARTING
        elif single := tuple(self.observations.quickest(mutant.file, mutant.line, tests[:1])):
            yield single, STARTING

    def _parts(self, mutant: Mutant, tests: tuple[str, ...]) -> Iterator[Part]:
        """Yield what to run: single tests that run the line, of near files first; then all that may."""
        done: set[str] = set()
        for some in (tests[:NEAR], tests[NEAR:]):
            for single, limit in self._single(mutant, some):
                yield single, limit
                done.update(single)
        yield tuple(self.observations.others(mutant.file, mutant.line, tests, done)), self.limit

    def _single(self, mutant: Mutant, tests: tuple[str, ...]) -> Iterator[Part]:
        """Yield single tests of some files that run the line, if there are any."""
        if single := tuple(self.observations.quickest(mutant.file, mutant.line, tests)):
            usual = self.observations.seconds(mutant.file, single)
            yield single, min(self.limit, STARTING + SLOWER * usual)

    def _with(self, mutant: Mutant, tests: tuple[str, ...], limit: float) -> Run:
        self._write(mutant.file, mutant.source)
        try:
            return self._run(tests, limit) if tests else Run("passed")
        finally:
            self._write(mutant.file, (ROOT / mutant.file).read_text(encoding="utf-8"))

    def _judged(self, run: Run) -> str:
        """Return the outcome for the mutant: a failure or a hang counts only if the original has none."""
        if run.outcome == "passed":
            return "survived"
        is_of_time = run.outcome == "hung" or "Timeout" in run.by
        if run.tests not in self._passing or is_of_time:  # the load of the machine may have changed
            if self._run(run.tests, run.limit).outcome != "passed":
                return "unclear"
            self._passing.add(run.tests)
        return "killed"

    def _observe(self, test: str, target: Path) -> bool:
        """Run a test file on the original and write which test runs which lines."""
        names = {observer.FILES: str(self._list), observer.TARGET: str(target)}
        run = self._run((test,), self.limit, ("-p", observer.__name__, "--maxfail=1000"), names)
        return run.outcome != "hung"

    def _write(self, file: str, text: str) -> None:
        target = self.folder / file
        for compiled in target.parent.glob(f"__pycache__/{target.stem}.*.pyc"):
            compiled.unlink()  # Python compares file times to the second
        target.write_text(text, encoding="utf-8")

    def _run(
        self,
        tests: tuple[str, ...],
        limit: float,
        options: tuple[str, ...] = (),
        variables: Mapping[str, str] = MappingProxyType({}),
    ) -> Run:
        mark, output = uuid4().hex, self.folder / "output.txt"
        names = {**variables, **WIDE, MARK: mark, "PYTHONPATH": str(self.folder)}
        process = forks.start(self.folder, (*PYTEST, *plugins(tests), *options, *tests), names, output)
        try:
            process.join(limit)
            if process.exitcode is None:
                return Run("hung", "", tests, limit)
        finally:
            end(process.pid, mark)
            process.join()
        text = output.read_text(encoding="utf-8", errors="replace")
        return understood(process.exitcode, text, tests, limit)


def plugins(tests: Sequence[str]) -> tuple[str, ...]:
    """Return options that leave out a plugin which takes longer to import than most tests run."""
    files = {test.partition("::")[0] for test in tests}
    uses = any("schemathesis" in (ROOT / file).read_text(encoding="utf-8") for file in files)
    return () if uses else ("-p", "no:schemathesis")


def understood(code: int, output: str, tests: tuple[str, ...], limit: float) -> Run:
    """Return what pytest's exit code and summary say; a crash of pytest itself is a failure too."""
    if code in NOTHING_FAILED:
        return Run("passed")
    failure = _FAILED.search(output)
    if failure is None:
        return Run("failed", output.strip().rpartition("\n")[2][:200], tests, limit)
    name = failure[1].partition(" - ")[0]
    again = (name,) if name in tests else (failure[2],)
    return Run("failed", failure[1][:200], again, limit)


def end(pid: int | None, mark: str) -> None:
    """End a process, its session, and all that it started, which inherited its mark."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(pid or 0, signal.SIGKILL)
    for one in marked(mark):
        with suppress(ProcessLookupError, PermissionError):
            os.kill(one, signal.SIGKILL)


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

    def __init__(
        self,
        folder: Path,
        limit: float,
        nearest: int,
        kept: Path | None = None,
        instead: tuple[str, ...] = (),
    ) -> None:
        self._folder, self._limit, self._nearest, self._instead = folder, limit, nearest, instead
        self._kept = kept or folder / "observations"
        self._idle: list[Copy] = []
        self._number = 0
        self._lock = Lock()

    def using(self, work: Callable[[Copy], dict[str, object] | None]) -> dict[str, object] | None:
        """Return what some work on an idle copy returns; makes a copy if none is idle."""
        with self._lock:
            self._number += not self._idle
            copy = self._idle.pop() if self._idle else self._copy()
        try:
            return work(copy)
        finally:
            self._idle.append(copy)

    def _copy(self) -> Copy:
        folder = self._folder / str(self._number)
        return Copy(folder, self._limit, self._nearest, self._kept, self._instead)
