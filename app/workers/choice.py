"""Start the workers that the settings select: processes on this machine, or on other machines."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass

from app.settings import Settings
from app.settings.machines import LOCAL
from app.workers.base import BatchWorker, Worker
from app.workers.light import CHECKS
from app.workers.local import LocalProcesses


@dataclass(frozen=True)
class Workers:
    """The worker for jobs, and those on this machine for reports and for checks of files.

    `why_silent` returns why no process for jobs answers, if none does.
    """

    of_jobs: BatchWorker
    here: Worker
    why_silent: Callable[[], str]


def why_silent_here() -> str:
    """Return the reason why no process on this machine answers."""
    return "they are being started, or hang"


def started_workers(settings: Settings, stack: ExitStack) -> Workers:
    """Start the workers and return them; the exit stack stops them."""
    if settings.engine == LOCAL:
        local = LocalProcesses()
        stack.callback(local.close)
        return Workers(local, local, why_silent_here)
    from app.workers.remote.engine import DaskWorker  # the default needs no Dask

    here = LocalProcesses(CHECKS if settings.template_folders else ())
    stack.callback(here.close)
    of_jobs = DaskWorker.of(settings)
    stack.callback(of_jobs.close)
    return Workers(of_jobs, here, of_jobs.why_silent)
