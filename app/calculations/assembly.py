"""Makes the pool of calculation processes and what uses it; called once by the application."""

from __future__ import annotations

import os
from contextlib import ExitStack

from fastapi import FastAPI

from app import metrics
from app.calculations.answering import Answering
from app.calculations.jobs import CALCULATION, CalculationJobs
from app.calculations.pool import CalculationPool
from app.calculations.sources import source_of
from app.calculations.steps import Steps, Threads
from app.jobs.service import Jobs
from app.settings import Settings
from app.storage.artifacts import ArtifactStore
from app.storage.database import Database
from app.workers.base import Limits
from app.workers.pool import WarmProcesses
from templates.core.catalogue.finding import Catalogue
from templates.core.language.template import Template

PRELOAD = ("app.calculations.warm",)


def assemble_calculations(
    app: FastAPI,
    settings: Settings,
    stack: ExitStack,
    catalogue: Catalogue[Template],
    database: Database,
    store: ArtifactStore,
    jobs: Jobs,
) -> dict[str, int]:
    """Make what the routes depend on, and register the job; return the lane of such jobs for `Jobs.start`.

    A job of the lane is adopted while it runs, so there is a thread more than calculations that run for jobs.
    """
    size = settings.calculation_processes or len(os.sched_getaffinity(0))
    limits = Limits(settings.calculation_job_deadline, settings.calculation_memory_mb)
    processes = WarmProcesses(PRELOAD, spares=size)
    stack.callback(processes.close)
    pool = CalculationPool(processes, size, settings.calculation_waiting, limits)
    stack.callback(pool.close)
    stack.callback(metrics.watch("calculations", pool.occupancy))
    sources = {cls: source_of(cls) for cls in catalogue}
    handler = CalculationJobs(pool, catalogue, sources, database, store, jobs)
    jobs.register(CALCULATION, handler, handler.failed, lane=CALCULATION)
    app.state.steps = Steps(pool, sources, settings.calculation_deadline)
    app.state.calculations, app.state.threads = pool, Threads()
    app.state.answering = Answering(pool, handler, settings.calculation_deadline)
    return {CALCULATION: pool.most_jobs + 1}
