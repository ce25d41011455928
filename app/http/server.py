"""The web server: uvicorn with limits on connections, and a shutdown that never exceeds the drain time.

SIGTERM and SIGINT start the shutdown. Requests in flight have most of the drain time to finish; then jobs are
put back into the queue and all rows are committed. If the process still hangs, a thread kills it; if that
thread cannot run because other code holds the interpreter lock, the interpreter's own watchdog kills it. A
second signal ends the process at once. The process exits without Python's own clean-up, which would wait for
threads and run the destructors of the geometry kernel.
"""

from __future__ import annotations

import asyncio
import faulthandler
import logging
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import Empty, SimpleQueue
from types import FrameType
from typing import NoReturn

import uvicorn
from fastapi import FastAPI
from starlette.types import Receive, Scope, Send

from app.http import problems
from app.http.connections import AddressLimit, ConnectionLimits, protocol
from app.http.problem_kinds import CROWDED
from app.http.request_log import RequestLog, what_is_in_flight
from app.observation import logs
from app.settings import Settings
from app.workers import family
from app.workers.priority import answer_promptly

logger = logging.getLogger(__name__)

STARTUP_FAILURE = 3  # uvicorn's exit code
_IDLE = ("threading.py", "queue.py", "selectors.py", "thread.py", "connection.py", "_threads.py", "socket.py")


def configuration(app: FastAPI, settings: Settings, port: int | None = None) -> uvicorn.Config:
    """Return uvicorn's configuration with the service's limits; the port overrides that of the settings."""
    limits = ConnectionLimits(
        settings.connections,
        AddressLimit(settings.connections_per_address, settings.trusted_proxies),
        settings.header_seconds,
        settings.write_seconds,
        settings.slowest_rate,
    )
    return uvicorn.Config(
        app,
        host=settings.host,
        port=settings.port if port is None else port,
        http=protocol(limits, RequestLog(_busy)),
        ws="none",
        forwarded_allow_ips=list(settings.trusted_proxies),
        timeout_keep_alive=settings.keep_alive_seconds,
        timeout_graceful_shutdown=settings.drain_seconds - settings.stop_seconds,  # type: ignore[arg-type]  # fractions of a second work too
        log_config=None,
        access_log=False,
    )


async def _busy(scope: Scope, receive: Receive, send: Send) -> None:
    """Return the response to a request on a connection beyond the limit."""
    about = problems.problem(CROWDED, "too many connections are open, in all or of your address; close some")
    await problems.answer(about, {"Retry-After": "5", "Connection": "close"})(scope, receive, send)


def run(app: FastAPI, settings: Settings) -> NoReturn:
    """Run the server until a signal arrives; this function never returns."""
    flush = logs.configure(settings.log_level, settings.log_format)
    answer_promptly()
    server = Server(configuration(app, settings), settings.drain_seconds, flush)
    try:
        server.run()
    finally:  # reached only if the server could not start
        flush()
    sys.exit(0 if server.started else STARTUP_FAILURE)


class Server(uvicorn.Server):
    """uvicorn's server with a time limit on its shutdown [s]; `flush` writes the last lines of the log."""

    def __init__(self, config: uvicorn.Config, drain_seconds: float, flush: Callable[[], object]) -> None:
        super().__init__(config)
        self.drain_seconds, self.flush = drain_seconds, flush
        self._is_signalled = False
        # Not an `Event`: a second signal may arrive while the handler of the first holds its lock.
        self._signals: SimpleQueue[int] = SimpleQueue()
        # Started now, because a signal may arrive while the main thread holds the lock for starting threads.
        threading.Thread(target=self._guard, name="end", daemon=True).start()

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Begin the shutdown; a second signal ends the process at once."""
        self._is_signalled = True
        self._signals.put(sig)
        self.should_exit = True
        faulthandler.dump_traceback_later(self.drain_seconds + 1, exit=True)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Answer requests in flight, end the lifespan, and exit if a signal started the shutdown."""
        await super().shutdown(sockets)
        if self._is_signalled:
            if running := what_runs():
                logger.warning("shut down in order, but ended: %s", "; ".join(running))
            self._leave(0)

    def _guard(self) -> None:
        """Wait for a signal, then for the drain time or a second signal, and end the remaining work."""
        self._signals.get()
        start = time.monotonic()
        logger.info("stopping: requests in flight are answered within %g s", self.drain_seconds)
        hurried = True
        try:
            self._signals.get(timeout=self.drain_seconds)
        except Empty:
            hurried = False
        why = "ended at once by a second signal" if hurried else "did not stop in time, ended hard"
        running = "; ".join(what_runs()) or "nothing that is known"
        logger.error("%s after %.1f s; still ran: %s", why, time.monotonic() - start, running)
        self._leave(1)

    def _leave(self, code: int) -> NoReturn:
        """Kill the child processes, write the log, and end this process."""
        family.kill()
        writer = threading.Thread(target=self.flush, daemon=True)  # standard error may be blocked
        writer.start()
        writer.join(1.0)
        os._exit(code)


def what_runs() -> list[str]:
    """Return a description of the running requests, threads and processes."""
    count = family.use().count
    return [*what_is_in_flight(), *_busy_threads(), *([f"{count} processes"] if count else [])]


def _busy_threads() -> list[str]:
    """Return the threads that are not waiting for work, and their positions in the code."""
    frames, busy = sys._current_frames(), []
    for thread in threading.enumerate():
        frame = frames.get(thread.ident or 0)
        if frame is None or thread is threading.current_thread() or thread.name in ("MainThread", "end"):
            continue
        file = Path(frame.f_code.co_filename)
        if file.name not in _IDLE:
            busy.append(f"thread {thread.name} in {file.name}:{frame.f_lineno}")
    return busy


@contextmanager
def on_stop_signal(act: Callable[[], None]) -> Iterator[None]:
    """Call a function on SIGINT and SIGTERM before the server reacts; for use within its lifespan."""
    if threading.current_thread() is not threading.main_thread():  # a server in a thread receives no signals
        yield
        return
    loop = asyncio.get_running_loop()
    previous = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}

    def close(number: int, frame: FrameType | None) -> None:
        loop.call_soon_threadsafe(act)  # deferred, because a signal may interrupt the holder of a lock
        handler = previous[signal.Signals(number)]
        if callable(handler):
            handler(number, frame)

    for number, handler in previous.items():
        if callable(handler):
            signal.signal(number, close)
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
