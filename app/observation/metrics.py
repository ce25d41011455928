"""Figures for Prometheus at `/metrics`: requests, jobs, commits, pools, failures, memory and processor time.

To answer costs the same however many designs there are: of the database only the jobs that have not ended
are counted, by an index.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from prometheus_client import (
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    ProcessCollector,
    generate_latest,
)

from app.observation.request_figures import RequestFigures
from app.workers import family

Census = Sequence[tuple[str, str, int]]
"""Kind, state and number of jobs."""

REGISTRY = CollectorRegistry()
ProcessCollector(registry=REGISTRY)  # memory, processor time and open files of this process
_counter, _gauge = partial(Counter, registry=REGISTRY), partial(Gauge, registry=REGISTRY)
_histogram = partial(Histogram, registry=REGISTRY)

REQUESTS = RequestFigures(REGISTRY)
IN_FLIGHT = _gauge("crankwright_requests_in_flight", "Requests that are being answered")
COMMIT = _histogram("crankwright_commit_seconds", "Time of a group of units of work [s]")
GROUP = _histogram(
    "crankwright_commit_units", "Units of work in a group", buckets=[1, 2, 4, 8, 16, 32, 64, 128, 256]
)
FAILURES = _counter("crankwright_failures_total", "What went wrong in the service itself", ["what"])
CUT = _counter("crankwright_connections_cut_total", "Connections ended by the server", ["why"])

QUEUED = _gauge("crankwright_jobs_queued", "Jobs that wait")
JOBS = _gauge("crankwright_jobs", "Jobs that have not ended", ["kind", "state"])
OLDEST = _gauge("crankwright_jobs_oldest_seconds", "Since when the oldest queued job waits [s]")
ENDED = _counter("crankwright_jobs_ended_total", "Jobs that have ended", ["kind", "state"])
LASTED = _histogram(
    "crankwright_job_seconds", "Time of a run [s]", ["kind"], buckets=[0.1, 0.3, 1, 3, 10, 30, 100, 300]
)

CHILDREN = _gauge("crankwright_children", "Processes that descend from the server")
CHILDREN_MEMORY = _gauge("crankwright_children_memory_bytes", "Their memory; what is shared counts for each")
CHILDREN_SECONDS = _gauge("crankwright_children_cpu_seconds", "Their processor time, of the ended ones too")
POOL = {
    figure: _gauge(f"crankwright_pool_{figure}", f"Of a pool of processes: {figure}", ["pool"])
    for figure in ("running", "waiting", "size")
}

BUCKET = _histogram(
    "crankwright_bucket_request_seconds", "Time of a request to the bucket [s]", ["operation", "outcome"]
)
COPIES = _counter("crankwright_local_copies_total", "Reads of a bucket's files on this machine", ["found"])
COPIED = _gauge("crankwright_database_copied", "1 if files are kept because the database has a copy")

_started: dict[str, float] = {}  # job -> when this run began
_watched: dict[str, Callable[[], Mapping[str, float]]] = {}


def committed(units: int, seconds: float, failed: bool) -> None:
    """Count a group of units of work."""
    COMMIT.observe(seconds)
    GROUP.observe(units)
    if failed:
        FAILURES.labels("commit").inc()


def bucket_asked(operation: str, outcome: str, seconds: float) -> None:
    """Count a request to the bucket of the files."""
    BUCKET.labels(operation, outcome).observe(seconds)


def copy_looked_for(is_there: bool) -> None:
    """Count a read of a bucket's file, which finds a good copy on this machine or not."""
    COPIES.labels("yes" if is_there else "no").inc()


def job_event(job: str, kind: str, name: str) -> None:
    """Count a job that is queued, begins or ends."""
    if name == "running":
        _started[job] = time.monotonic()
    else:
        begun = _started.pop(job, None)
        if name != "queued":
            ENDED.labels(kind, name).inc()
        if begun is not None:
            LASTED.labels(kind).observe(time.monotonic() - begun)


def watch(name: str, look: Callable[[], Mapping[str, float]]) -> Callable[[], object]:
    """Show the `running`, `waiting` and `size` of a pool, which `look` returns; returns what ends that."""
    _watched[name] = look
    return lambda: _watched.pop(name, None) if _watched.get(name) is look else None


def text(census: Census, oldest: float) -> bytes:
    """Return all figures; of the jobs that have not ended, how many there are and the oldest's wait [s]."""
    _show_jobs(census)
    OLDEST.set(oldest)
    for name, look in list(_watched.items()):
        for figure, value in look().items():
            POOL[figure].labels(name).set(value)
    used = family.use()
    CHILDREN.set(used.count)
    CHILDREN_MEMORY.set(used.memory)
    CHILDREN_SECONDS.set(used.seconds)
    return generate_latest(REGISTRY)


def _show_jobs(census: Census) -> None:
    """Show how many jobs there are, of which kind and state."""
    JOBS.clear()
    for kind, state, count in census:
        JOBS.labels(kind, state).set(count)
    QUEUED.set(sum(count for _, state, count in census if state == "queued"))
