"""Measure commands: processor time and memory of `crankwright --version` and `crankwright evaluate`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from app.calculations.bodies import OIL_FILM
from benchmarks.processor_time import environment
from benchmarks.speed.figures import Figure

REPEATS = 3
COMMANDS = {
    "crankwright --version": ["--version"],
    "crankwright evaluate": ["evaluate", "oil_film", "--version=1", *map("=".join, OIL_FILM.items())],
}


def figures() -> list[Figure]:
    """Return the cost of both commands, each in new processes; the smallest of several runs."""
    rows = []
    for name, arguments in COMMANDS.items():
        runs = [measured([sys.executable, "-m", "app", *arguments]) for _ in range(REPEATS + 1)][1:]
        spent, memory = min(run[0] for run in runs), min(run[1] for run in runs)
        rows += [
            Figure(f"`{name}`", spent, "s", 0.5, detail=f"least of {REPEATS}"),
            Figure("its peak memory", memory, "MB", 60.0),
        ]
    return rows


_SMALL = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
print(usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e6, status)
"""
"""Starts a command: its greatest memory includes that of its parent at the start, so the parent is small."""


def measured(command: list[str]) -> tuple[float, float]:
    """Return the processor time [s] and peak memory [MB] of a process with its children."""
    small = [sys.executable, "-S", "-c", _SMALL, *command]
    folder = Path(__file__).parents[2]
    answer = subprocess.run(small, capture_output=True, text=True, check=True, cwd=folder, env=environment())
    spent, memory, status = answer.stdout.split()
    if int(status):
        raise RuntimeError(f"{' '.join(command)} ended with {status}")
    return float(spent), float(memory)
