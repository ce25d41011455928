"""Cost of starting the embedded service, compared with that of an earlier program in the same run.

    git clone -q . /tmp/earlier && git -C /tmp/earlier checkout -q df52034
    python -m benchmarks.start /tmp/earlier 12                    # with this environment
    python -m benchmarks.start /tmp/earlier 12 /tmp/earlier-environment/bin/python

The two programs take turns, each with a new data folder, so that other work of the machine meets both.
Processor time counts, not the clock: of the server's own process at its first answer, of it with all its
processes once these are idle, and of the first expensive calculation after that. Memory is that of all
processes at rest which holds no file: the kernel's library is shared with whoever else uses it. It prints
the medians, and the median of the ratios of pairs with the range in which it lies with 95 % confidence
(order statistics). More pairs narrow it.
"""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from app.calculations.schemas import OIL_FILM
from benchmarks.processor_time import anonymous_megabytes, environment, used
from benchmarks.service_process import free_port

HERE = Path(__file__).parents[1]
PATIENCE = 300.0  # for a server to start, also on a busy machine [s]
LOOK = 0.05  # between two questions whether it answers [s]
STILL = 2.0  # for so long a family that has come to rest uses no more than `REST` [s]
REST = 0.03  # of processor time [s]
LEVEL = 0.95
EXPENSIVE = "api/v1/templates/oil_film/versions/3/evaluate"
"""Calculated in a process of its own, by the level `mass_conserving`."""
FEWEST = 6  # pairs: all of fewer lie on one side of the median with a probability above 5 %


@dataclass(frozen=True)
class Start:
    """Processor time of one start [s], and its memory [MB]."""

    first_answer: float  # of the server's own process
    at_rest: float  # with all processes that it has started
    expensive: float  # of all processes, for the first expensive calculation
    memory: float


FIGURES: dict[str, Callable[[Start], float]] = {
    "server, to its first answer": lambda start: start.first_answer,
    "all processes, to their rest": lambda start: start.at_rest,
    "first expensive calculation": lambda start: start.expensive,
    "memory at rest, without files": lambda start: start.memory,
}


def measured(program: Path, python: str) -> Start:
    """Start a program with a new data folder, and end it."""
    port = free_port()
    with tempfile.TemporaryDirectory(prefix="crankwright-start-") as folder:
        command = [python, "-m", "app", "serve", "--port", str(port), "--data", f"{folder}/data"]
        kept = {name: text for name, text in environment().items() if not name.startswith("CRANKWRIGHT_")}
        variables = kept | {"PYTHONPATH": str(program)}
        with Path(folder, "log").open("wb") as log:
            server = subprocess.Popen(
                command, cwd=program, env=variables, stdout=log, stderr=log, start_new_session=True
            )
            try:
                _wait(server, port, Path(folder, "log"))
                own = _own(server.pid)
                rest = _at_rest(server.pid)
                memory = anonymous_megabytes(server.pid)
                return Start(own, rest, _calculated(server.pid, port), memory)
            finally:
                server.send_signal(signal.SIGTERM)
                server.wait(PATIENCE)


def _wait(server: subprocess.Popen[bytes], port: int, log: Path) -> None:
    end = time.monotonic() + PATIENCE
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    while True:
        try:
            with opener.open(f"http://127.0.0.1:{port}/healthz", timeout=10):
                return
        except OSError:
            if server.poll() is not None or time.monotonic() > end:
                raise SystemExit(f"the server does not start:\n{log.read_text()[-2000:]}") from None
            time.sleep(LOOK)


def _calculated(pid: int, port: int) -> float:
    """Processor time of all processes until an expensive calculation is answered [s]."""
    before = used(pid)
    inputs = {**OIL_FILM, "journal_roughness": "0.2 um", "bearing_roughness": "0.4 um"}
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}/{EXPENSIVE}",
        json.dumps({"inputs": inputs, "level": "mass_conserving"}).encode(),
        {"Content-Type": "application/json", "Prefer": f"wait={PATIENCE:.0f}"},
    )
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with opener.open(request, timeout=PATIENCE) as answer:
        assert answer.status == 200
    return used(pid) - before


def _own(pid: int) -> float:
    """Processor time of a process without its children [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _at_rest(pid: int) -> float:
    """Processor time of a process with its descendants, once it hardly grows any more [s]."""
    end, before = time.monotonic() + PATIENCE, used(pid)
    while time.monotonic() < end:
        time.sleep(STILL)
        now = used(pid)
        if now - before <= REST:
            return now
        before = now
    raise SystemExit("the server's processes do not come to rest")


def confidence(values: Sequence[float]) -> tuple[float, float]:
    """The range that holds the median of the values' distribution with a probability of at least `LEVEL`.

    Between the k-th smallest and the k-th largest value; the binomial distribution gives k.
    """
    ordered, count = sorted(values), len(values)
    outside, k = 0.0, 0
    while k < count // 2:
        outside += 2 * math.comb(count, k) / 2**count
        if outside > 1 - LEVEL:
            break
        k += 1
    return ordered[k - 1], ordered[-k]


def main(earlier: Path, pairs: int, python: str) -> None:
    """Compare the start of this program with that of an earlier one."""
    if pairs < FEWEST:
        raise SystemExit(f"fewer than {FEWEST} pairs bound no median with {LEVEL:.0%} confidence")
    programs = {"this program": (HERE, sys.executable), "the earlier one": (earlier, python)}
    starts: dict[str, list[Start]] = {name: [] for name in programs}
    for pair in range(pairs + 1):
        order = list(programs.items())[:: 1 if pair % 2 else -1]
        for name, (folder, interpreter) in order:
            start = measured(folder, interpreter)
            if pair:  # the first compiles modules, and warms the disk
                starts[name].append(start)
    print(f"{pairs} pairs; processor time [s], memory [MB]\n")
    print("| | this program | the earlier one | ratio | 95 % |\n|---|---|---|---|---|")
    for figure, of in FIGURES.items():
        now, then = ([of(start) for start in starts[name]] for name in programs)
        ratios = [a / b for a, b in zip(now, then, strict=True)]
        low, high = confidence(ratios)
        print(
            f"| {figure} | {median(now):.2f} | {median(then):.2f} | {median(ratios):.3f} "
            f"| {low:.3f} to {high:.3f} |"
        )


if __name__ == "__main__":
    _, where, *more = sys.argv
    main(Path(where).absolute(), int(more[0]) if more else 12, more[1] if more[1:] else sys.executable)
