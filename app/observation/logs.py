"""Structured logs on standard error, as text or JSON lines, each with the id of its request.

Bodies, queries, cookies and keys are never logged. A separate thread writes the lines, so a blocked terminal
delays no request. Lines beyond the capacity of the queue are dropped and counted.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import logging
import queue
import re
import secrets
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import UTC, datetime
from logging.handlers import QueueListener
from typing import Literal, TextIO

from app.observation.secrets import holds_key, without_keys

Format = Literal["json", "text"]
Level = Literal["debug", "info", "warning", "error"]

REQUEST_ID: ContextVar[str] = ContextVar("request_id", default="")
TRACE: ContextVar[str] = ContextVar("trace", default="")
"""The context of the current trace as W3C's `traceparent`, empty without traces; see `traces`."""
FIELDS = ("request_id", "client", "method", "route", "path", "status", "ms", "job")

_ROOM = 10_000  # largest number of lines waiting to be written
_HARMLESS = re.compile(rb"[A-Za-z0-9._-]{1,64}")
# Control characters, line and paragraph separators, and characters that change the writing direction.
_CONTROLS = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")

_process, _numbers = secrets.token_hex(5), itertools.count(1)


def request_id(headers: Iterable[tuple[bytes, bytes]]) -> str:
    """Return the id that a client has given its request, if it is safe to log, otherwise a new id."""
    for name, value in headers:
        if name == b"x-request-id" and _HARMLESS.fullmatch(value) and not holds_key(text := value.decode()):
            return text
    return new_id()


def new_id() -> str:
    """Return a globally unique id."""
    return f"{_process}-{next(_numbers):06x}"


def without_secret(client: str) -> str:
    """Return a client's name for the log.

    The id of a session is hashed, because it would authenticate the client.
    """
    kind, _, name = client.partition(":")
    return f"session:{hashlib.sha256(name.encode()).hexdigest()[:12]}" if kind == "session" else client


@contextmanager
def caused(cause: str) -> Iterator[None]:
    """Add the id of the request that queued a job to log lines; the job's row stores this id as its cause."""
    request, _, trace = cause.partition(" ")
    tokens = REQUEST_ID.set(request), TRACE.set(trace)
    try:
        yield
    finally:
        REQUEST_ID.reset(tokens[0])
        TRACE.reset(tokens[1])


def escaped(text: str) -> str:
    """Return a text without characters that move the cursor, start a line or change the writing direction."""
    return _CONTROLS.sub(lambda control: ascii(control[0])[1:-1], text)


class TextFormatter(logging.Formatter):
    """Formats a record as one line `time LEVEL logger [request] message`; an indented traceback follows."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the record as a line of text."""
        request = f" [{id}]" if (id := getattr(record, "request_id", "")) else ""
        line = f"{_time(record)} {record.levelname} {record.name}{request} {escaped(record.getMessage())}"
        trace = "".join(f"\n  | {escaped(part)}" for part in _traceback(self, record).splitlines())
        return without_keys(line + trace)


class JsonFormatter(logging.Formatter):
    """Formats a record as one JSON object: time, level, logger, message, and the known ones of `FIELDS`."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the record as a line of JSON."""
        about: dict[str, object] = {
            "time": _time(record),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        about |= {name: value for name in FIELDS if (value := getattr(record, name, None)) not in (None, "")}
        if trace := _traceback(self, record):
            about["exception"] = trace
        return without_keys(json.dumps(about, default=str))  # `dumps` escapes non-ASCII characters


class QueueHandler(logging.Handler):
    """Passes records to the writing thread, with the id of the present request."""

    def __init__(self) -> None:
        super().__init__()
        self.queue: queue.Queue[logging.LogRecord | None] = queue.Queue(_ROOM)
        self.dropped = 0

    def emit(self, record: logging.LogRecord) -> None:
        """Queue a line without waiting."""
        if not hasattr(record, "request_id"):
            record.request_id = REQUEST_ID.get()
        try:
            self.queue.put_nowait(record)
        except queue.Full:
            self.dropped += 1


def configure(level: Level, form: Format, stream: TextIO | None = None) -> Callable[[], None]:
    """Write the program's logs to standard error or a stream; return a function that ends this.

    `level` applies to this program and its web server; other libraries log only warnings and errors.
    """
    handler, writer = QueueHandler(), logging.StreamHandler(stream or sys.stderr)
    writer.setFormatter(JsonFormatter() if form == "json" else TextFormatter())
    logging.root.handlers = [handler]
    logging.root.setLevel(logging.WARNING)
    for name in ("app", "uvicorn"):
        logging.getLogger(name).setLevel(level.upper())
    listener = QueueListener(handler.queue, writer)
    listener.start()
    return listener.stop


def _time(record: logging.LogRecord) -> str:
    moment = datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds")
    return moment.replace("+00:00", "Z")


def _traceback(formatter: logging.Formatter, record: logging.LogRecord) -> str:
    return formatter.formatException(record.exc_info) if record.exc_info else ""
