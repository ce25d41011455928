"""Metrics for Prometheus at `/metrics`: requests, jobs, commits, pools, failures, memory and processor time.

The cost of a response does not depend on the number of designs: the only database query counts unfinished
jobs, by an index.
"""

from __future__ import annotations

import time
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import accumulate

from prometheus_client import (
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    ProcessCollector,
    generate_latest,
)
from prometheus_client.core import CounterMetricFamily, HistogramMetricFamily
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector

from app.workers import family

Census = Sequence[tuple[str, str, int]]
"""Kind, state and number of jobs."""

BUCKETS = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 60.0)
"""Upper limits of the duration buckets [s]."""


class _Row:
    """The responses to one route and method with one status."""

    __slots__ = ("counts", "seconds")

    def __init__(self) -> None:
        self.counts = [0] * (len(BUCKETS) + 1)  # by duration bucket
        self.seconds = 0.0


class RequestFigures(Collector):
    """The number of responses by route, method and status, and their durations by route and method.

    Only the event loop counts them, so no number needs a lock; this costs a tenth of the library's counters.
    """

    def __init__(self, registry: CollectorRegistry) -> None:
        self._rows: dict[tuple[str, str, int], _Row] = {}
        registry.register(self)

    def add(self, route: str, method: str, status: int, seconds: float) -> None:
        """Count a response with its duration [s]."""
        row = self._rows.get((route, method, status))
        if row is None:
            row = self._rows[route, method, status] = _Row()
        row.counts[bisect_left(BUCKETS, seconds)] += 1
        row.seconds += seconds

    def collect(self) -> Iterator[Metric]:
        """Yield the metrics in the types of the Prometheus library."""
        rows = list(self._rows.items())
        requests = CounterMetricFamily(
            "crankwright_requests", "Requests answered", labels=["route", "method", "status"]
        )
        for (route, method, status), row in rows:
            requests.add_metric([route, method, str(status)], sum(row.counts))
        yield requests
        times = HistogramMetricFamily(
            "crankwright_request_seconds", "Time to the first byte [s]", labels=["route", "method"]
        )
        for labels, (counts, seconds) in _by_route(rows).items():
            ends = [*map(str, BUCKETS), "+Inf"]
            times.add_metric(labels, list(zip(ends, accumulate(counts), strict=True)), seconds)
        yield times


def _by_route(
    rows: list[tuple[tuple[str, str, int], _Row]],
) -> dict[tuple[str, str], tuple[list[int], float]]:
    """Return the counts by duration bucket and the total duration [s], over all statuses."""
    groups: defaultdict[tuple[str, str], list[_Row]] = defaultdict(list)
    for (route, method, _), row in rows:
        groups[route, method].append(row)
    return {
        labels: (
            [sum(counts) for counts in zip(*(row.counts for row in group), strict=True)],
            sum(row.seconds for row in group),
        )
        for labels, group in groups.items()
    }


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
FAILURES = _counter("crankwright_failures_total", "Failures of the service itself", ["what"])
CUT = _counter("crankwright_connections_cut_total", "Connections ended by the server", ["why"])

QUEUED = _gauge("crankwright_jobs_queued", "Waiting jobs")
JOBS = _gauge("crankwright_jobs", "Jobs that have not ended", ["kind", "state"])
OLDEST = _gauge("crankwright_jobs_oldest_seconds", "Waiting time of the oldest queued job [s]")
ENDED = _counter("crankwright_jobs_ended_total", "Jobs that have ended", ["kind", "state"])
LASTED = _histogram(
    "crankwright_job_seconds", "Time of a run [s]", ["kind"], buckets=[0.1, 0.3, 1, 3, 10, 30, 100, 300]
)

CHILDREN = _gauge("crankwright_children", "Processes that descend from the server")
CHILDREN_MEMORY = _gauge(
    "crankwright_children_memory_bytes", "Memory of these processes; shared memory counts for each"
)
CHILDREN_SECONDS = _gauge(
    "crankwright_children_cpu_seconds", "Processor time of these processes, including ended ones"
)
POOL = {
    figure: _gauge(f"crankwright_pool_{figure}", f"Number in a pool of processes: {figure}", ["pool"])
    for figure in ("running", "waiting", "size")
}

BUCKET = _histogram(
    "crankwright_bucket_request_seconds", "Time of a request to the bucket [s]", ["operation", "outcome"]
)
COPIES = _counter("crankwright_local_copies_total", "Reads of a bucket's files on this machine", ["found"])
COPIED = _gauge("crankwright_database_copied", "1 if files are kept because the database has a copy")

_started: dict[str, float] = {}  # job -> start time of this run
_watched: dict[str, Callable[[], Mapping[str, float]]] = {}


def committed(units: int, seconds: float, failed: bool) -> None:
    """Count a group of committed units of work."""
    COMMIT.observe(seconds)
    GROUP.observe(units)
    if failed:
        FAILURES.labels("commit").inc()


def bucket_asked(operation: str, outcome: str, seconds: float) -> None:
    """Count a request to the bucket of files."""
    BUCKET.labels(operation, outcome).observe(seconds)


def copy_looked_for(is_there: bool) -> None:
    """Count a read of a file in the bucket, and whether this machine had a valid copy."""
    COPIES.labels("yes" if is_there else "no").inc()


def job_event(job: str, kind: str, name: str) -> None:
    """Count a job that is queued, starts or ends."""
    if name == "running":
        _started[job] = time.monotonic()
    else:
        begun = _started.pop(job, None)
        if name != "queued":
            ENDED.labels(kind, name).inc()
        if begun is not None:
            LASTED.labels(kind).observe(time.monotonic() - begun)


def watch(name: str, look: Callable[[], Mapping[str, float]]) -> Callable[[], object]:
    """Publish the `running`, `waiting` and `size` of a pool, as `look` returns them.

    Return a function that stops this.
    """
    _watched[name] = look
    return lambda: _watched.pop(name, None) if _watched.get(name) is look else None


def text(census: Census, oldest: float) -> bytes:
    """Return all metrics as text, with the number of unfinished jobs and the wait of the oldest one [s]."""
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
    """Publish the number of jobs by kind and state."""
    JOBS.clear()
    for kind, state, count in census:
        JOBS.labels(kind, state).set(count)
    QUEUED.set(sum(count for _, state, count in census if state == "queued"))
