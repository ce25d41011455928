"""Regenerations per second in local processes and on Dask workers here, and what Dask adds to a job.

Run `python -m benchmarks.engines`; read the ratios rather than the times. It starts a scheduler and two
workers by the commands of the program. A regeneration is one plain bearing of a new size, in a process of its
own. Beside each rate stand the processor time of a regeneration, by who used it, and how much of all cores
was in use: where they are full, another worker on this machine brings nothing.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import count
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from app.calculations.sources import source_of
from app.settings import Settings
from app.solids.builds import build_in_worker
from app.team.processes import LOOPBACK, Tied, free_port
from app.workers.base import BatchWorker, Limits
from app.workers.local import LocalProcesses
from app.workers.remote.engine import DaskWorker
from benchmarks.processor_time import Cores, used
from cad.catalogue import models
from cad.regenerate import as_text

REGENERATIONS = 12
EMPTY = 20
LIMITS = Limits(deadline=300.0)
SIZES = (1, 10, 100)  # of bytes there and back [MiB]
PLACES = '{"geometry": 1}'
_widths = count(1)


def regenerate(worker: BatchWorker) -> None:
    """Build one plain bearing that nobody has built, as a job does."""
    quantities = {"inner_diameter": "45 mm", "width": f"{18 + 0.01 * next(_widths):.2f} mm"}
    shape = models().get("plain_bearing", 1).from_quantities(quantities)
    batch = worker.batch()
    batch.run(build_in_worker, source_of(type(shape)), as_text(shape), limits=LIMITS)
    batch.close()


@dataclass(frozen=True)
class Rate:
    """Regenerations per second, processor time of one by who used it [ms], share of all cores in use."""

    each_second: float
    times: dict[str, float]
    cores: float


def rate(worker: BatchWorker, threads: int, others: Mapping[str, int] | None = None) -> Rate:
    """Regenerate so many at a time; `others` are processes of a team by name, children of this one."""
    pids = {"server and processes": os.getpid(), **(others or {})}
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(regenerate, [worker] * 2 * threads))
        before, cores, start = _used(pids), Cores.now(), time.perf_counter()
        list(pool.map(regenerate, [worker] * REGENERATIONS))
        seconds, after = time.perf_counter() - start, _used(pids)
        times = {name: 1e3 * (after[name] - before[name]) / REGENERATIONS for name in pids}
        return Rate(REGENERATIONS / seconds, times, Cores.now().share_since(cores))


def _used(pids: Mapping[str, int]) -> dict[str, float]:
    """Processor time by name [s]; that of this process without that of the others, which it started."""
    times = {name: used(pid) for name, pid in pids.items()}
    own, *others = times
    return {**times, own: times[own] - sum(times[name] for name in others)}


def milliseconds(action: Callable[[], object], runs: int) -> float:
    """Median time of an action [ms]; the first run is for warming up."""
    taken = []
    for _ in range(runs + 1):
        start = time.perf_counter()
        action()
        taken.append(1e3 * (time.perf_counter() - start))
    return median(taken[1:])


def costs(worker: BatchWorker) -> list[float]:
    """An empty function in a process of its own, in one of a batch, and bytes there and back [ms]."""
    batch = worker.batch()
    try:
        alone = milliseconds(lambda: worker.run(os.getpid, limits=LIMITS), EMPTY)
        again = milliseconds(lambda: batch.run(os.getpid, limits=LIMITS), EMPTY)
        loads = [bytes(size * 2**20) for size in SIZES]
        return [
            alone,
            again,
            *(milliseconds(partial(batch.run, bytes, load, limits=LIMITS), 3) for load in loads),
        ]
    finally:
        batch.close()


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[tuple[DaskWorker, dict[str, int]]]:
    """A scheduler and so many workers with a place for geometry each, and their processes by name."""
    pids = {}
    with ExitStack() as stack:
        port = free_port()
        address = f"tcp://{LOOPBACK}:{port}"

        def start(name: str, *arguments: str) -> None:
            command = [sys.executable, "-m", "app", *arguments]
            process = Tied(name, command, folder / f"{name}.log")
            stack.callback(process.stop)
            pids[name] = process.pid

        start("scheduler", "scheduler", "--port", str(port))
        for number in range(workers):
            start(f"worker-{number}", "worker", "--scheduler", address, "--lanes", PLACES)
        engine = DaskWorker.of(Settings(engine=address))
        stack.callback(engine.close)
        while engine.capacity("geometry") < workers:
            time.sleep(0.1)
        yield engine, pids


def show(what: str, rate: Rate, first: Rate) -> None:
    """Print a rate, its ratio to the first, and where its processor time went."""
    times = ", ".join(f"{name} {time:.0f}" for name, time in rate.times.items())
    print(
        f"{what:24}{rate.each_second:8.2f}{rate.each_second / first.each_second:8.2f}"
        f"{sum(rate.times.values()):8.0f}{rate.cores:8.0%}  {times}",
        flush=True,
    )


def main() -> None:
    """Print rates and costs, and each as a ratio to that of local processes."""
    print(f"{'regenerations':24}{'1/s':>8}{'ratio':>8}{'ms CPU':>8}{'cores':>8}")
    local = LocalProcesses()
    first = rate(local, 1)
    show("local, 1 at a time", first, first)
    show("local, 2 at a time", rate(local, 2), first)
    here = costs(local)
    local.close()
    with TemporaryDirectory() as name:
        with cluster(Path(name), 1) as (engine, pids):
            show("Dask, 1 worker", rate(engine, 1, pids), first)
            there = costs(engine)
        with cluster(Path(name), 2) as (engine, pids):
            show("Dask, 2 workers", rate(engine, 2, pids), first)
    print(f"\n{'median [ms]':24}{'local':>8}{'Dask':>8}{'more':>8}")
    names = ("empty, own process", "empty, in a batch", *(f"{size} MiB there and back" for size in SIZES))
    for what, ours, theirs in zip(names, here, there, strict=True):
        print(f"{what:24}{ours:8.1f}{theirs:8.1f}{theirs - ours:8.1f}")


if __name__ == "__main__":
    main()
