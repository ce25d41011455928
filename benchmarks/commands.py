"""Processor time and memory of single commands of the shell.

    python -m benchmarks.commands 5                     # this program, five times each
    python -m benchmarks.commands 5 /tmp/earlier        # and an earlier one, in turns

Processor time [s] and greatest memory [MB] are those that the kernel counts for the process (`wait4`); the
medians are printed. A first run of each, which is not counted, compiles modules and warms the disk.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from statistics import median

from benchmarks.processor_time import environment

HERE = Path(__file__).parents[1]
FILM = (
    "radial_load=25 kN", "diametral_clearance=0.055 mm", "bearing_diameter=48 mm", "bearing_width=18 mm",
    "speed=5000 rpm", "oil_inlet_temperature=80 degC", "oil_outlet_temperature=87.762 degC",
)  # fmt: skip
COMMANDS = {
    "--version": ("--version",),
    "--help": ("--help",),
    "evaluate oil_film 1": ("evaluate", "oil_film", "--version", "1", *FILM),
    "evaluate oil_film 2": ("evaluate", "oil_film", "--version", "2", *FILM),
    "evaluate oil_film": ("evaluate", "oil_film", *FILM),
    "template list": ("template", "list"),
}


def measured(program: Path, arguments: tuple[str, ...]) -> tuple[float, float]:
    """Processor time [s] and greatest memory [MB] of one command.

    Raises
    ------
    SystemExit
        If the command fails.
    """
    process = subprocess.Popen(
        [sys.executable, "-m", "app", *arguments],
        cwd=program,
        env={**environment(), "PYTHONPATH": str(program)},
        stdout=subprocess.DEVNULL,
    )
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{arguments[0]} ended with exit code {process.returncode}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e6


def main(times: int, programs: list[Path]) -> None:
    """Measure all commands of each program and print the medians."""
    print("| command |" + " CPU [s] | memory [MB] |" * len(programs))
    print("|---|" + "---|---|" * len(programs))
    for name, arguments in COMMANDS.items():
        runs: dict[Path, list[tuple[float, float]]] = {program: [] for program in programs}
        for run in range(times + 1):
            for program in programs:
                figures = measured(program, arguments)
                if run:
                    runs[program].append(figures)
        cells = [
            f" {median(seconds for seconds, _ in of):.2f} | {median(memory for _, memory in of):.0f} |"
            for of in runs.values()
        ]
        print(f"| `{name}` |{''.join(cells)}", flush=True)


if __name__ == "__main__":
    count, *earlier = sys.argv[1:] or ["5"]
    main(int(count), [HERE, *(Path(folder).absolute() for folder in earlier)])
