"""Which tests run a line, by one run of each test file under coverage, kept from night to night.

An observation holds for a test file and the files that it ran, as long as neither changes. Lines that run
in other processes (servers, jobs) are not seen, so what was not seen to run a line may run it all the same.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from itertools import accumulate, chain, zip_longest
from operator import itemgetter
from pathlib import Path
from threading import Lock
from typing import Any

from benchmarks.mutation import ROOT

MOST_TESTS = 60
"""Single tests of a line that are tried before whole files."""
MOST_SECONDS = 30.0
"""Time that these tests may take on the original [s], of which the first may take more."""
FARTHER = 0.3
"""Time that a test may take longer if its file is one place nearer [s]."""
_ONE_AT_A_TIME = Lock()  # several threads need the same observations
Case = tuple[str, float]
"""A test and the time that it took [s]."""


@dataclass(frozen=True)
class Observation:
    """What one run of a test file showed."""

    seconds: dict[str, float]  # of each test
    lines: dict[str, dict[int, list[str]]]  # of each file: the tests that ran a line
    code: dict[str, str]  # of each file: its digest then

    def tests(self, file: str, lines: Iterable[int]) -> set[str]:
        """Return the tests that ran one of the lines of a file."""
        seen = self.lines.get(file, {})
        return {test for line in lines for test in seen.get(line, ())}

    def holds_for(self, file: str) -> bool:
        """Whether the file is the one that was observed."""
        return self.code.get(file, digest(file)) == digest(file)


class Observations:
    """Observations in a folder, made when they are needed."""

    def __init__(self, folder: Path, observe: Callable[[str, Path], bool]) -> None:
        self.folder = folder
        self._observe = observe  # runs a test file and writes what was seen; False if it did not end
        folder.mkdir(parents=True, exist_ok=True)

    def of(self, test: str, file: str) -> Observation | None:
        """Return what is known of a test file that holds for a file; None if a run of it does not end."""
        target = self.folder / f"{test.replace('/', '-')}-{digest(test)[:12]}.json"
        with _ONE_AT_A_TIME:
            kept = self._read(target)
            if kept is None or not kept.holds_for(file):
                kept = self._made(test, target)
        return kept if kept.seconds else None

    def _made(self, test: str, target: Path) -> Observation:
        raw = target.with_suffix(".raw")
        if self._observe(test, raw) and raw.exists():
            target.write_text(json.dumps(with_digests(json.loads(raw.read_text()))), encoding="utf-8")
            raw.unlink()
        else:
            target.write_text(json.dumps({"seconds": {}, "lines": {}, "code": {}}), encoding="utf-8")
        made = self._read(target)
        assert made is not None
        return made

    @staticmethod
    def _read(target: Path) -> Observation | None:
        return parsed(target, target.stat().st_mtime_ns) if target.exists() else None

    def quickest(self, file: str, line: int, tests: Sequence[str]) -> list[str]:
        """Return single tests that run a line: a quick case of each function first, then others of it."""
        groups = self._groups(file, tests, statement(file, line))
        if not groups:  # an import ran the line: any test that uses the file may depend on it
            groups = self._groups(file, tests, None)
        order = [case for turn in zip_longest(*groups) for case in turn if case]
        total = accumulate(seconds for _, seconds in order)
        within = [test for (test, _), time in zip(order, total, strict=True) if time <= MOST_SECONDS]
        return (within or [test for test, _ in order[:1]])[:MOST_TESTS]

    def _groups(self, file: str, tests: Sequence[str], lines: Iterable[int] | None) -> list[list[Case]]:
        """Return the tests of lines by their functions, quick ones and those of near files in front."""
        ranked: list[tuple[float, list[Case]]] = []
        for distance, test in enumerate(tests):
            if seen := self.of(test, file):
                running = seen.tests(file, seen.lines.get(file, ()) if lines is None else lines)
                groups = by_function(seen, running)
                ranked += [(group[0][1] + FARTHER * distance, group) for group in groups]
        return [group for _, group in sorted(ranked, key=itemgetter(0))]

    def may_reach(self, file: str, line: int, test: str) -> bool:
        """Whether a test file may run a line: it did, or nobody knows because it has other processes."""
        seen = self.of(test, file)
        if seen is None or test.startswith("tests/app/"):
            return True
        return any(number in seen.lines.get(file, {}) for number in statement(file, line))

    def seconds(self, file: str, tests: Iterable[str]) -> float:
        """Return how long single tests took when they were observed [s]."""
        return sum(
            seen.seconds.get(test, 0.0) for test in tests if (seen := self.of(test.partition("::")[0], file))
        )


def by_function(seen: Observation, tests: Iterable[str]) -> list[list[Case]]:
    """Return tests with their times, by their functions; the quickest case of each is the first."""
    groups: dict[str, list[Case]] = {}
    for test in sorted(tests, key=lambda test: (seen.seconds[test], test)):
        groups.setdefault(test.partition("[")[0], []).append((test, seen.seconds[test]))
    return list(groups.values())


def with_digests(raw: dict[str, Any]) -> dict[str, Any]:
    """Return an observation with the digests of the files that it is about."""
    return {**raw, "code": {file: digest(file) for file in raw["lines"]}}


@cache
def parsed(target: Path, _date: int) -> Observation:
    """Return an observation as it is in a file of a certain date."""
    raw = json.loads(target.read_text(encoding="utf-8"))
    names = list(raw["seconds"])
    lines = {
        file: {int(line): [names[i] for i in tests] for line, tests in of_file.items()}
        for file, of_file in raw["lines"].items()
    }
    return Observation(raw["seconds"], lines, raw["code"])


@cache
def statement(file: str, line: int) -> range:
    """Return the lines of the smallest statement that has a line; of a compound one only its head."""
    nodes = (node for node in ast.walk(_tree(file)) if isinstance(node, ast.stmt))
    spans = [head(node) for node in nodes]
    return min((span for span in spans if line in span), key=len, default=range(line, line + 1))


def head(node: ast.stmt) -> range:
    """Return the lines of a statement before its body."""
    decorators = getattr(node, "decorator_list", [])
    begin = min([node.lineno, *(one.lineno for one in decorators)])
    body = getattr(node, "body", None)
    inside = chain(body or (), getattr(node, "cases", ()))
    first = next((getattr(one, "lineno", None) or one.pattern.lineno for one in inside), None)
    end = node.end_lineno or node.lineno
    return range(begin, max(begin, (first or end + 1) - 1) + 1)


@cache
def _tree(file: str) -> ast.Module:
    return ast.parse((ROOT / file).read_text(encoding="utf-8"))


@cache
def digest(file: str) -> str:
    """Return a digest of a file of ours."""
    return sha256((ROOT / file).read_bytes()).hexdigest()
