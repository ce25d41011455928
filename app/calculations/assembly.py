"""Create the pool of calculation processes and the services that use it; the application does so once."""

from __future__ import annotations

import os
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial

from app.observation import metrics
from app.pool.pool import CalculationPool
from app.pool.processes import CalculationProcesses
from app.pool.questions import CALCULATION
from app.pool.steps import Steps
from app.settings import Settings
from app.workers import prefork
from app.workers.base import Limits
from app.workers.pool import WarmProcesses

PRELOAD = ("app.calculations.warm",)


@dataclass(frozen=True)
class Calculations:
    """The pool of calculation processes, and the steps that the pool evaluates."""

    pool: CalculationPool
    steps: Steps

    @property
    def lanes(self) -> dict[str, int]:
        """Return the number of threads of the pool's job lane, for `Jobs.start`.

        A job takes over a running calculation, so the lane has one more thread than calculations that may run
        for jobs.
        """
        return {CALCULATION: self.pool.most_jobs + 1}


def assemble_calculations(
    settings: Settings,
    stack: ExitStack,
    designs: tuple[str, ...] = (),
    sheets: tuple[str, ...] = (),
) -> Calculations:
    """Create the pool; the exit stack closes it.

    All processes import `designs`, the modules with the functions of designs, and `sheets`, those that read
    worksheets.
    """
    size = settings.calculation_processes or len(os.sched_getaffinity(0))
    limits = Limits(
        settings.calculation_job_deadline, settings.calculation_memory_mb, "CRANKWRIGHT_CALCULATION_MEMORY_MB"
    )
    light, network = (*PRELOAD, *sheets), (*PRELOAD, *sheets, *designs)
    of_designs = partial(WarmProcesses, network, spares=size)
    processes = (
        CalculationProcesses(of_designs)
        if prefork.is_forked(network)
        else CalculationProcesses(partial(WarmProcesses, light, spares=size), of_designs)
    )
    stack.callback(processes.close)
    pool = CalculationPool(processes, size, settings.calculation_waiting, limits)
    stack.callback(pool.close)
    stack.callback(metrics.watch("calculations", pool.occupancy))
    return Calculations(pool, Steps(pool, settings.calculation_deadline))
