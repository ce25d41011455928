"""Find the test files about a file, the nearest first.

Tests of a whole server that the table in `.ci/changed.py` names for a file come after the nearest ones.

The distance is the number of imports between test and file; a template's version is found by its name in the
text of the test, as it is not imported. A word in common, as of `tests/app/test_jobs.py` and
`app/jobs/turns.py`, counts as nearer, because tests of the whole server reach every file of it equally far.
"""

from __future__ import annotations

import importlib.util
import re
from fnmatch import fnmatch
from functools import cache
from pathlib import Path
from types import ModuleType

from benchmarks.mutation import ROOT

NEAREST = 24
"""Number of test files that are run for a mutated file."""
VALUES = "tests/test_values.py"
"""A test about all modules, which it finds by their folders."""
_NAME_IN_COMMON = 1.5  # a word in common counts as much as this number of imports
_NOT_REACHED = 9  # number of imports assumed if no import leads there: migrations are found by their folder
_OF_NO_USE = {"tests", "test", "app", "templates", "v1", "v2", "py", "and", "of"}


def _changed() -> ModuleType:
    spec = importlib.util.spec_from_file_location("changed", ROOT / ".ci" / "changed.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


changed = _changed()


@cache
def related(file: str, nearest: int = NEAREST) -> tuple[str, ...]:
    """Return the `nearest` test files about a file, nearest first; of templates also the golden records."""
    far = {test: steps(file, test) for test in tests()}
    near = sorted((nearness(file, test, n), test) for test, n in far.items() if n)
    chosen = [test for _, test in near[:nearest]]
    golden = [changed.CATALOGUE] if file.startswith("templates/") else []
    return tuple(dict.fromkeys([*chosen, VALUES, *golden, *named(file)]))


def named(file: str) -> list[str]:
    """Return the tests of a whole server that the table names for a file; not those of the pages."""
    return [test for test in tests() if any(fnmatch(file, one) for one in changed.ABOUT.get(test, ()))]


def nearness(file: str, test: str, steps: int) -> tuple[float, int]:
    """Return the order of test files: of two equally far, the one that reaches less is more about it."""
    return steps - _NAME_IN_COMMON * in_common(file, test), len(distances(test))


def steps(file: str, test: str) -> int | None:
    """Return how many imports lead from a test to a file; many, if only a word says that it is about it."""
    return distances(test).get(file) or (_NOT_REACHED if in_common(file, test) else None)


@cache
def tests() -> tuple[str, ...]:
    """Return all test files but those of the pages, which need a browser."""
    files = (file.relative_to(ROOT).as_posix() for file in (ROOT / "tests").rglob("test_*.py"))
    return tuple(sorted(file for file in files if not file.startswith("tests/app/web/")))


@cache
def distances(test: str) -> dict[str, int]:
    """Return how many imports lead from a test to each of our files that it reaches."""
    far, ahead = {test: 0}, [test]
    for file in ahead:
        for other in neighbours(file, of_test=file == test):
            if other not in far:
                far[other] = far[file] + 1
                ahead.append(other)
    return far


def neighbours(file: str, *, of_test: bool) -> tuple[str, ...]:
    """Return the files that a file imports; with a test, also the versions that it names."""
    imported = changed.imports(file)
    return (*imported, *(v for v in versions() if names(file, v))) if of_test else imported


@cache
def versions() -> tuple[str, ...]:
    """Return the files of all versions of templates and models."""
    files = (
        file.relative_to(ROOT).as_posix()
        for part in ("templates", "cad")
        for file in (ROOT / part).rglob("*.py")
    )
    return tuple(sorted(file for file in files if changed.VERSION.search(file)))


def names(test: str, version: str) -> bool:
    """Return whether a test names a version, or is about the whole catalogue."""
    return changed.is_named(version, test, ()) or f"cad_{Path(changed.CATALOGUE).name}" in test


def in_common(file: str, test: str) -> int:
    """Return how many words the paths of a file and of a test share; jobs and job are one word."""
    return len(words(file) & words(test))


def words(path: str) -> set[str]:
    """Return the words of a path that say what it is about, without a plural's s."""
    return {word.removesuffix("s") for word in re.split(r"[/_.]", path) if word not in _OF_NO_USE}
