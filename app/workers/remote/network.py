"""Configure Dask: the team's certificates, no web pages, no retries, no profiling of threads."""

from __future__ import annotations

import logging

import dask
from distributed import Security

from app.settings import Settings

CONFIGURATION = {
    "distributed.admin.large-graph-warning-threshold": "1GiB",  # a STEP file is sent with its task
    "distributed.scheduler.allowed-failures": 0,  # the queue of jobs decides about retries
    "distributed.scheduler.http.routes": [],
    "distributed.worker.http.routes": [],
    "distributed.worker.profile.enabled": False,
}


def configure() -> None:
    """Apply this configuration of Dask in the process, and let Dask log like the program."""
    dask.config.set(CONFIGURATION)
    logger = logging.getLogger("distributed")
    logger.handlers.clear()
    logger.setLevel(logging.WARNING)
    logger.propagate = True


def security(settings: Settings) -> Security:
    """Return the certificates of this process; both ends of each connection authenticate each other."""
    if settings.dask_ca is None:
        return Security(require_encryption=False)
    pair = {"cert": str(settings.dask_cert), "key": str(settings.dask_key)}
    own = {
        f"tls_{role}_{part}": file
        for role in ("client", "worker", "scheduler")
        for part, file in pair.items()
    }
    return Security(require_encryption=True, tls_ca_file=str(settings.dask_ca), **own)
