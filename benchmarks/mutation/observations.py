"""Find the tests that run a line, by one run of each test file under coverage, kept between nights.

An observation of a test file holds for a file as long as neither changes, whether the test ran the file or
not. Lines that run in other processes are not seen; a test file that starts some may run a line all the same.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from itertools import accumulate, zip_longest
from operator import itemgetter
from pathlib import Path
from threading import Lock
from typing import Any

from benchmarks.mutation import ROOT
from benchmarks.mutation.targets import targets

MOST_TESTS = 60
"""Largest number of single tests of a line that are tried before whole files."""
MOST_SECONDS = 30.0
"""Longest total time of these tests on the original [s]; the first test alone may exceed it."""
FARTHER = 0.3
"""Additional time that a test may take for each position by which its file is nearer [s]."""
_ONE_AT_A_TIME = Lock()  # several threads need the same observations
IN_SERVER = ("app/designs/", "app/jobs/", "app/storage/")
"""Folders whose code runs in the server's process, not in its calculation processes."""
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
Case = tuple[str, float]
"""A test and the time that it took [s]."""


@dataclass(frozen=True)
class Observation:
    """The result of one run of a test file."""

    seconds: dict[str, float]  # time of each test
    lines: dict[str, dict[int, list[str]]]  # for each file: the tests that ran a line
    code: dict[str, str]  # for each file that may be changed: its digest at the time of the run
    has_programs: bool  # whether the test started servers or other programs, which may run all of our code
    has_processes: bool  # whether the test started processes, which may have run templates and solids

    def may_hide(self, file: str) -> bool:
        """Return whether the file may have run in another process, where it was not seen."""
        is_of_server = file.startswith(IN_SERVER)
        return self.has_programs if is_of_server else self.has_processes

    def tests(self, file: str, lines: Iterable[int]) -> set[str]:
        """Return the tests that ran one of the lines of a file."""
        seen = self.lines.get(file, {})
        return {test for line in lines for test in seen.get(line, ())}

    def holds_for(self, file: str) -> bool:
        """Return whether the file is the one that was observed."""
        return self.code.get(file) == digest(file)


class Observations:
    """Observations in a folder, made when they are needed."""

    def __init__(self, folder: Path, observe: Callable[[str, Path], bool]) -> None:
        self.folder = folder
        self._observe = observe  # runs a test file and writes the observations; False if the run did not end
        folder.mkdir(parents=True, exist_ok=True)

    def of(self, test: str, file: str) -> Observation:
        """Return an observation of a test file that holds for a file; an empty one if no run of it ends."""
        with _ONE_AT_A_TIME:
            target = self._target(test)
            kept = self._read(target)
            if kept is None or not kept.holds_for(file):
                kept = self._observed(test, target)
        return kept

    def has(self, test: str, file: str) -> bool:
        """Return whether there is one already."""
        kept = self._read(self._target(test))
        return kept is not None and kept.holds_for(file)

    def _target(self, test: str) -> Path:
        return self.folder / f"{test.replace('/', '-')}-{digest(test)[:12]}.json"

    def _observed(self, test: str, target: Path) -> Observation:
        raw = target.with_suffix(".raw")
        if self._observe(test, raw) and raw.exists():
            target.write_text(json.dumps(with_digests(json.loads(raw.read_text()))), encoding="utf-8")
            raw.unlink()
        else:
            nothing = {"seconds": {}, "lines": {}, "programs": True, "processes": True}
            target.write_text(json.dumps(with_digests(nothing)), encoding="utf-8")
        observation = self._read(target)
        assert observation is not None
        return observation

    @staticmethod
    def _read(target: Path) -> Observation | None:
        return parsed(target, target.stat().st_mtime_ns) if target.exists() else None

    def quickest(self, file: str, line: int, tests: Sequence[str]) -> list[str]:
        """Return single tests that run a line: a quick case of each function first, then others of it."""
        groups = self._groups(file, line, tests)
        order = [case for turn in zip_longest(*groups) for case in turn if case]
        total = accumulate(seconds for _, seconds in order)
        within = [test for (test, _), time in zip(order, total, strict=True) if time <= MOST_SECONDS]
        return (within or [test for test, _ in order[:1]])[:MOST_TESTS]

    def _groups(self, file: str, line: int, tests: Sequence[str]) -> list[list[Case]]:
        """Return the tests of a line by their functions, quick ones and those of near files in front."""
        ranked: list[tuple[float, list[Case]]] = []
        for distance, test in enumerate(tests):
            seen = self.of(test, file)
            groups = by_function(seen, seen.tests(file, dependent(file, line)))
            ranked += [(group[0][1] + FARTHER * distance, group) for group in groups]
        return [group for _, group in sorted(ranked, key=itemgetter(0))]

    def others(self, file: str, line: int, tests: Sequence[str], done: Collection[str]) -> list[str]:
        """Return what else may run a line: other tests that did, and whole files with processes."""
        quick = sorted(tests, key=lambda test: sum(self.of(test, file).seconds.values()))
        return [other for test in quick for other in self._others(file, line, test) if other not in done]

    def _others(self, file: str, line: int, test: str) -> list[str]:
        seen = self.of(test, file)
        if seen.may_hide(file):
            return [test]
        return sorted(seen.tests(file, dependent(file, line)))

    def seconds(self, file: str, tests: Iterable[str]) -> float:
        """Return how long single tests took when they were observed [s]."""
        return sum(self.of(test.partition("::")[0], file).seconds[test] for test in tests)


def by_function(seen: Observation, tests: Iterable[str]) -> list[list[Case]]:
    """Return tests with their times, by their functions; the quickest case of each is the first."""
    groups: dict[str, list[Case]] = {}
    for test in sorted(tests, key=lambda test: (seen.seconds[test], test)):
        groups.setdefault(test.partition("[")[0], []).append((test, seen.seconds[test]))
    return list(groups.values())


def with_digests(raw: dict[str, Any]) -> dict[str, Any]:
    """Return an observation with the digests of all files that a test may run: some it ran, others not."""
    return {**raw, "code": {file: digest(file) for file in targets()}}


@cache
def parsed(target: Path, _date: int) -> Observation:
    """Return an observation as it is in a file of a certain date."""
    raw = json.loads(target.read_text(encoding="utf-8"))
    names = list(raw["seconds"])
    lines = {
        file: {int(line): [names[i] for i in tests] for line, tests in of_file.items()}
        for file, of_file in raw["lines"].items()
    }
    return Observation(raw["seconds"], lines, raw.get("code", {}), raw["programs"], raw["processes"])


@cache
def dependent(file: str, line: int) -> range:
    """Return the lines that show whether a test depends on one: those of its statement in a function.

    A line of a function's head stands for the function; one that an import runs, for the whole file.
    """
    functions = [node for node in ast.walk(_tree(file)) if isinstance(node, FUNCTIONS) and line in span(node)]
    if not functions:
        return range(1, len((ROOT / file).read_text(encoding="utf-8").splitlines()) + 1)
    function = min(functions, key=lambda node: len(span(node)))
    heads = [head for head in map(before_body, inner(function)) if line in head]
    return min(heads, key=len) if heads else span(function)


def span(node: ast.stmt) -> range:
    """Return the lines of a statement with its decorators."""
    decorators = getattr(node, "decorator_list", [])
    begin = min([node.lineno, *(one.lineno for one in decorators)])
    return range(begin, (node.end_lineno or begin) + 1)


def inner(function: ast.stmt) -> list[ast.stmt]:
    """Return the statements within a function."""
    return [node for node in ast.walk(function) if isinstance(node, ast.stmt) and node is not function]


def before_body(node: ast.stmt) -> range:
    """Return the lines of a statement before its body, if it has one."""
    first = next((one.lineno for one in getattr(node, "body", ())), None)
    end = span(node).stop if first is None else max(first, node.lineno + 1)
    return range(span(node).start, end)


@cache
def _tree(file: str) -> ast.Module:
    return ast.parse((ROOT / file).read_text(encoding="utf-8"))


@cache
def digest(file: str) -> str:
    """Return a digest of a file of ours."""
    return sha256((ROOT / file).read_bytes()).hexdigest()
