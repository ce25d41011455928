"""A plugin of pytest that writes which test runs which lines: `-p benchmarks.mutation.observer`.

It looks only at the files named in the environment, in the process of pytest: what runs in servers and jobs
of their own is not seen. Coverage measures the lines; each test is one of its contexts.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest
from coverage import Coverage

FILES = "CRANKWRIGHT_OBSERVED_FILES"
"""Environment variable with the path of the list of files to observe, one per line."""
TARGET = "CRANKWRIGHT_OBSERVED_IN"
"""Environment variable with the path of the file to write."""
WORKERS = "app.workers"
"""Text that occurs in the command of every calculation process."""


class Observer:
    """Measures one run of pytest."""

    def __init__(self, files: list[str], target: Path) -> None:
        self.root, self.target = Path.cwd(), target
        self.seconds: dict[str, float] = {}
        include = [str(self.root / file) for file in files]
        self.coverage = Coverage(data_file=None, config_file=False, include=include)
        self.has_programs = False
        sys.addaudithook(self.audited)
        self.coverage.start()

    def audited(self, event: str, arguments: tuple[Any, ...]) -> None:
        """Notice that a program is started, such as a server; the workers of one do not count."""
        if event == "subprocess.Popen" and WORKERS not in str(arguments[1]):
            self.has_programs = True

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        """Give a test its context, and take its time with that of its fixtures."""
        self.coverage.switch_context(item.nodeid)
        begin = time.monotonic()
        try:
            return (yield)
        finally:
            self.seconds[item.nodeid] = round(time.monotonic() - begin, 3)
            self.coverage.switch_context("")

    def pytest_sessionfinish(self) -> None:
        """Write what was seen."""
        self.coverage.stop()
        data = self.coverage.get_data()
        lines = {
            Path(file).relative_to(self.root).as_posix(): self.tests_of_lines(data.contexts_by_lineno(file))
            for file in data.measured_files()
        }
        others = {"programs": self.has_programs, "processes": has_had_children()}
        seen = {"seconds": self.seconds, "lines": lines, **others}
        self.target.write_text(json.dumps(seen), encoding="utf-8")

    def tests_of_lines(self, contexts: dict[int, list[str]]) -> dict[int, list[int]]:
        """Return the numbers of the tests that run each line; none for a line that only an import runs."""
        number = {test: i for i, test in enumerate(self.seconds)}
        return {
            line: sorted(number[test] for test in tests if test in number) for line, tests in contexts.items()
        }


def has_had_children() -> bool:
    """Return whether this process has started others: ended ones have used time, the rest are in the list."""
    times = os.times()
    lists = Path("/proc/self/task").glob("*/children")
    return times.children_user + times.children_system > 0 or any(file.read_text().strip() for file in lists)


def pytest_configure(config: pytest.Config) -> None:
    """Start to look, before the files are imported."""
    files = Path(os.environ[FILES]).read_text(encoding="utf-8").splitlines()
    config.pluginmanager.register(Observer(files, Path(os.environ[TARGET])))
