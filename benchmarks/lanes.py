"""Measure the processor time of tests by file and by test, to show where the quick suite spends its time.

Run with: python -m benchmarks.lanes [files, folders and options of pytest, such as tests/physics -n 2]

It is a plugin of pytest: before and after each test it reads the processor time of the worker, of its living
descendants and of the children that it has waited for. Unlike durations it hardly depends on what else the
machine does. Left out are the reading itself, some milliseconds a test, a process that outlives its parent,
imports and the collection, which each worker does.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.processor_time import used

FILE = "CRANKWRIGHT_TEST_COSTS"  # names the file to which workers append costs


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Append the processor time of a test with its fixtures [s]."""
    before, reading = read()
    yield
    after, reading_again = read()
    cost = after - before - (reading + reading_again) / 2
    with open(os.environ[FILE], "a", encoding="utf-8") as costs:
        costs.write(f"{cost:.2f}\t{item.nodeid.partition('@')[0]!r}\n")


def read() -> tuple[float, float]:
    """Return the processor time of this process and its descendants, and the time to read it [s]."""
    begin = time.process_time()
    family = used(os.getpid())
    return family, time.process_time() - begin


def main(arguments: list[str]) -> int:
    """Run pytest and print the times of its tests, the slowest files first."""
    with tempfile.TemporaryDirectory() as folder:
        costs = Path(folder, "costs")
        costs.touch()
        command = [sys.executable, "-m", "pytest", "-p", "benchmarks.lanes", "-q", *arguments]
        done = subprocess.run(command, env={**os.environ, FILE: str(costs)}, check=False)
        report(costs.read_text(encoding="utf-8").splitlines())
    return done.returncode


def report(lines: list[str]) -> None:
    """Print the sum of each file, its tests of half a second or more, and the sum of all [s]."""
    files: dict[str, list[tuple[float, str]]] = defaultdict(list)
    for line in lines:
        cost, _, name = line.partition("\t")
        file, _, test = name.strip("'\"").partition("::")
        files[file].append((float(cost), test))
    sums = {file: sum(cost for cost, _ in tests) for file, tests in files.items()}
    for file in sorted(files, key=sums.__getitem__, reverse=True):
        print(f"{sums[file]:8.1f} s  {file} ({len(files[file])})")
        for seconds, test in sorted(files[file], reverse=True):
            if seconds >= 0.5:
                print(f"          {seconds:8.1f} s  {test}")
    print(f"{sum(sums.values()):8.1f} s  all tests")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
