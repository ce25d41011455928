"""Traces by OpenTelemetry: spans of requests, units of work, jobs and runs in workers.

This module is imported only if `traces_url` is set; its packages belong to the extra `traces`. The current
span is stored in `logs.TRACE` as W3C's `traceparent`. Threads inherit it with their context, units of work
from their caller, and jobs from the `cause` of their row, so whichever server runs a job continues its trace.

A span names functions, routes, kinds and ids. It never contains paths, queries, bodies, values, keys or the
text of an error. Work in a child process or on another machine is one span, recorded by the server.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import partial
from importlib.metadata import version
from typing import Protocol, TypeVar, TypeVarTuple
from urllib.parse import urlsplit

from opentelemetry.context import Context
from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
from opentelemetry.sdk.resources import SERVICE_NAME, SERVICE_VERSION, Resource
from opentelemetry.sdk.trace import TracerProvider
from opentelemetry.sdk.trace.export import BatchSpanProcessor
from opentelemetry.trace import Span, SpanKind, Status, StatusCode, set_span_in_context
from opentelemetry.trace.propagation.tracecontext import TraceContextTextMapPropagator

from app.observation import logs
from app.settings.machines import Lane
from app.storage.units import Unit, Writer
from app.workers.base import GEOMETRY, Batch, BatchWorker, Limits
from templates.core.progress import Reporter

About = Mapping[str, str]
"""Attributes of a span."""
T = TypeVar("T")
Ts = TypeVarTuple("Ts")

SECONDS = 2.0  # longest time to send spans, also at the end [s]
PATH = "/v1/traces"  # path of OTLP over HTTP, if the setting has no path
UNIT, RUN = "unit of work", "run in a worker"
FUNCTION, TRACEPARENT = "code.function.name", "traceparent"
_CARRIER = TraceContextTextMapPropagator()


class QueuedJob(Protocol):
    """The attributes of a job in a span."""

    @property
    def id(self) -> str:
        """Return the id of the job."""

    @property
    def kind(self) -> str:
        """Return the kind of the job."""

    @property
    def attempt(self) -> int:
        """Return how many times the job was claimed."""


class Traces:
    """Sends spans to a collector in a separate thread; while the collector is unreachable, spans are lost."""

    def __init__(self, url: str) -> None:
        about = {SERVICE_NAME: "crankwright", SERVICE_VERSION: version("crankwright")}
        address = url if urlsplit(url).path.strip("/") else url.rstrip("/") + PATH
        self._provider = TracerProvider(resource=Resource.create(about), shutdown_on_exit=False)
        exporter = OTLPSpanExporter(endpoint=address, timeout=SECONDS)
        self._provider.add_span_processor(BatchSpanProcessor(exporter))
        self._tracer = self._provider.get_tracer("crankwright")

    def close(self) -> None:
        """Send the remaining spans, and wait only a short time for that."""
        ending = threading.Thread(target=self._provider.shutdown, name="traces-end", daemon=True)
        ending.start()
        ending.join(SECONDS)

    @contextmanager
    def span(self, name: str, about: About, kind: SpanKind = SpanKind.INTERNAL) -> Iterator[Span]:
        """Open a span within the current one; spans that begin inside become its children."""
        span = self._begun(name, about, kind)
        token = logs.TRACE.set(_carried(span))
        try:
            yield span
        except BaseException as error:
            _note_failure(span, error)
            raise
        finally:
            logs.TRACE.reset(token)
            span.end()

    def job(self, job: QueuedJob) -> AbstractContextManager[object]:
        """Return the span of a running job, in the trace of the request that queued it."""
        about = {"job.id": job.id, "job.kind": job.kind, "job.attempt": str(job.attempt)}
        return self.span(f"job {job.kind}", about, SpanKind.CONSUMER)

    def writer(self, writer: Writer) -> Writer:
        """Return a writer that records each unit of work as a span, if the unit is part of a trace."""
        return _TracedWriter(writer, self)

    def worker(self, worker: BatchWorker) -> BatchWorker:
        """Return a worker that records each run as a span, if the run is part of a trace."""
        return _TracedWorker(worker, self)

    def part(self, name: str, function: Callable[..., object]) -> AbstractContextManager[object]:
        """Return the span of a function within a trace; None outside a trace.

        The service's own work, such as heartbeats, belongs to no trace.
        """
        return self.span(name, {FUNCTION: _named(function)}) if logs.TRACE.get() else nullcontext()

    def submitted(self, writer: Writer, unit: Unit[T]) -> Future[T]:
        """Submit a unit of work, and record a span that ends with the unit's future."""
        if not logs.TRACE.get():
            return writer.submit(unit)
        span = self._begun(UNIT, {FUNCTION: _named(unit)}, SpanKind.INTERNAL)
        token = logs.TRACE.set(_carried(span))
        try:
            future = writer.submit(unit)
        except Exception as error:
            _note_failure(span, error)
            span.end()
            raise
        finally:
            logs.TRACE.reset(token)
        future.add_done_callback(partial(_end_with, span))
        return future

    def _begun(self, name: str, about: About, kind: SpanKind) -> Span:
        parent = _CARRIER.extract({TRACEPARENT: logs.TRACE.get()}, context=Context())
        return self._tracer.start_span(name, parent, kind, about)


class _TracedWriter:
    """A writer that records spans; see `Writer`."""

    def __init__(self, writer: Writer, traces: Traces) -> None:
        self.engine, self._writer, self._traces = writer.engine, writer, traces

    def write(self, unit: Unit[T]) -> T:
        with self._traces.part(UNIT, unit):
            return self._writer.write(unit)

    def submit(self, unit: Unit[T]) -> Future[T]:
        return self._traces.submitted(self._writer, unit)

    def close(self) -> None:
        self._writer.close()


class _TracedBatch:
    """A batch that records spans; see `Batch`."""

    def __init__(self, batch: Batch, traces: Traces) -> None:
        self._batch, self._traces = batch, traces

    def run(
        self,
        function: Callable[[*Ts], T],
        *args: *Ts,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        on_progress: Reporter | None = None,
        cancelled: threading.Event | None = None,
    ) -> T:
        with self._traces.part(RUN, function):
            return self._batch.run(
                function, *args, limits=limits, on_progress=on_progress, cancelled=cancelled
            )

    def close(self) -> None:
        self._batch.close()


class _TracedWorker(_TracedBatch):
    """A worker that records spans; see `BatchWorker`."""

    def __init__(self, worker: BatchWorker, traces: Traces) -> None:
        super().__init__(worker, traces)
        self._worker = worker

    def answers(self) -> bool:
        return self._worker.answers()

    def capacity(self, lane: Lane) -> int:
        return self._worker.capacity(lane)

    def batch(self, lane: Lane = GEOMETRY) -> Batch:
        return _TracedBatch(self._worker.batch(lane), self._traces)


def _carried(span: Span) -> str:
    """Return the context of a span as a `traceparent`."""
    carrier: dict[str, str] = {}
    _CARRIER.inject(carrier, set_span_in_context(span, Context()))
    return carrier.get(TRACEPARENT, "")


def _named(function: Callable[..., object]) -> str:
    """Return the module and name of a function; for a partial function, of the function that it calls."""
    while isinstance(function, partial):
        function = function.func
    named = function if hasattr(function, "__qualname__") else type(function)
    return f"{named.__module__}.{named.__qualname__}"


def _note_failure(span: Span, error: BaseException) -> None:
    """Mark a span as failed with only the type of the error, whose text may quote what a client sent."""
    span.set_attribute("error.type", type(error).__qualname__)
    span.set_status(Status(StatusCode.ERROR))


def _end_with(span: Span, future: Future[T]) -> None:
    if not future.cancelled() and (error := future.exception()) is not None:
        _note_failure(span, error)
    span.end()
