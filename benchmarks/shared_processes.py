"""Processor time of jobs that build one solid each: with a process of their own, and with one that is kept.

`python -m benchmarks.shared_processes`; half a minute on two idle cores. All processes below this one count:
the forkserver, the process of the job, and the one that rehearses for the next.
"""

from __future__ import annotations

import os
import time

from app.calculations.sources import source_of
from app.solids.builds import build_in_worker
from app.workers import local
from app.workers.local import LocalProcesses
from benchmarks.processor_time import used
from cad.catalogue import models
from cad.regenerate import as_text

JOBS = 6
SETTLING = 1.2  # after a job: another process may rehearse [s]


def main() -> None:
    """Print the cost of each job, without and with a process that is kept."""
    for kept in (0, 1):
        local.MOST_KEPT = kept
        spent = ", ".join(f"{1e3 * seconds:.0f}" for seconds in jobs())
        print(f"{kept} processes kept: {spent} ms for each of {JOBS} jobs")


def jobs() -> list[float]:
    """Processor time of each job, one after another [s]."""
    ball, costs = models().get("ball_bearing", 1), []
    worker = LocalProcesses()
    try:
        while not worker.answers():
            time.sleep(0.1)
        time.sleep(SETTLING)
        for number in range(JOBS):
            shape = ball.from_quantities({"inner_diameter": f"{30 + 0.37 * number} mm"})
            before = used(os.getpid())
            batch = worker.batch()
            batch.run(build_in_worker, source_of(type(shape)), as_text(shape))
            batch.close()
            time.sleep(SETTLING)
            costs.append(used(os.getpid()) - before)
    finally:
        worker.close()
    return costs


if __name__ == "__main__":
    main()
