"""Commands of the shell: processor time and memory of `crankwright --version` and `crankwright evaluate`."""

from __future__ import annotations

import os
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
    """Return both commands, each in new processes; the least of several."""
    rows = []
    for name, arguments in COMMANDS.items():
        runs = [measured([sys.executable, "-m", "app", *arguments]) for _ in range(REPEATS + 1)][1:]
        spent, memory = min(run[0] for run in runs), min(run[1] for run in runs)
        rows += [
            Figure(f"`{name}`", spent, "s", 0.5, detail=f"least of {REPEATS}"),
            Figure("its most memory", memory, "MB", 60.0),
        ]
    return rows


def measured(command: list[str]) -> tuple[float, float]:
    """Return the processor time [s] and most memory [MB] of a process with its children."""
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, cwd=Path(__file__).parents[2], env=environment()
    )
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise RuntimeError(f"{' '.join(command)} ended with {status}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e6
