"""The server's side of job processes: the fork server, and one process for each job."""

import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Protocol

from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded, JobCancelled, JobCrashed
from app.workers.lifeline import Lifeline
from app.workers.messages import ErrorMessage, Outcome, Progress, Request, ResultMessage, pack, receive, send
from templates.core.progress import Reporter

_BOOT = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
    "from app.workers.forkserver import main; main(int(sys.argv[2]), int(sys.argv[3]), sys.argv[4:])"
)
_GLANCE = 0.05  # time between two checks whether the job was cancelled [s]
_PATIENCE = 1.0  # longest time for the fork server to end [s]


class JobProcess:
    """A process that waits for a job, runs it, and ends, unless it is `reusable`."""

    def __init__(self, connection: Connection, status: Connection) -> None:
        self._connection = connection
        self._status = status
        self.reusable = False

    def start(self, request: Request) -> None:
        """Send the process its job.

        Raises
        ------
        OSError
            If the process died while it was waiting.
        """
        self.reusable = False
        send(self._connection, pack(request))

    def finish(
        self, limits: Limits, on_progress: Reporter | None, cancelled: threading.Event | None
    ) -> Outcome:
        """Wait for the end of the job, and return its outcome, which may be the function's own exception.

        Raises
        ------
        DeadlineExceeded, JobCancelled, JobCrashed
            If the process exceeded its deadline, was cancelled, or ended by itself.
        """
        cancelled = cancelled or threading.Event()
        try:
            self._await_birth(cancelled)
            return self._converse(limits, on_progress, cancelled)
        finally:
            if not self.reusable:
                self.kill()

    def kill(self) -> None:
        """End the process and its children; a process that is not forked yet ends itself later."""
        if self._status.closed:
            return
        with suppress(ProcessLookupError, JobCrashed):
            if self.is_born():
                os.killpg(self._pid, signal.SIGKILL)
        self._connection.close()
        self._status.close()

    def _await_birth(self, cancelled: threading.Event) -> None:
        """Wait until the process exists; its time counts from then on, not while the fork server imports."""
        while not ("_pid" in vars(self) or self._status.poll(_GLANCE)):
            if cancelled.is_set():
                raise JobCancelled
        _ = self._pid

    def is_born(self) -> bool:
        """Return whether the fork server has forked the process.

        This reads nothing, so the owner may use the connection meanwhile.
        """
        try:
            return "_pid" in self.__dict__ or self._status.poll()
        except OSError:  # it has received a job and ended
            return False

    @cached_property
    def _pid(self) -> int:
        try:
            return int(self._status.recv())
        except EOFError:
            raise JobCrashed(None) from None

    def _converse(self, limits: Limits, on_progress: Reporter | None, cancelled: threading.Event) -> Outcome:
        end = time.monotonic() + limits.deadline
        messages = select.poll()  # one for all; `Connection.poll` creates a selector each time
        messages.register(self._connection.fileno(), select.POLLIN)
        while True:
            _await_message(messages, end, limits, cancelled)
            match self._receive(limits):
                case Progress(fraction, text):
                    if on_progress is not None:
                        on_progress(fraction, text)
                case ResultMessage() | ErrorMessage() as outcome:
                    self.reusable = outcome.reusable
                    return outcome

    def _receive(self, limits: Limits) -> object:
        try:
            return receive(self._connection).unpacked()
        except (EOFError, ConnectionResetError):
            raise JobCrashed(self._exit_code(), limits.memory) from None

    def _exit_code(self) -> int | None:
        try:
            return int(self._status.recv())
        except EOFError:
            return None


def _await_message(messages: select.poll, end: float, limits: Limits, cancelled: threading.Event) -> None:
    """Wait for a message or the end of the process."""
    while True:
        if cancelled.is_set():
            raise JobCancelled
        left = end - time.monotonic()
        if left <= 0:
            raise DeadlineExceeded(limits.deadline)
        if messages.poll(1e3 * min(left, _GLANCE)):
            return


class Process(Protocol):
    """The interface of a child process, as in `subprocess.Popen`."""

    @property
    def pid(self) -> int:
        """Return the process id."""

    def poll(self) -> int | None:
        """Return the exit code; None while the process is running."""

    def wait(self, timeout: float | None = None) -> int:
        """Return the exit code, or raise `subprocess.TimeoutExpired`."""

    def kill(self) -> None:
        """Kill the process."""


Launch = Callable[[Sequence[str], int, int, Mapping[str, str]], Process]
"""Starts the process of a fork server: modules, channel, lifeline, environment."""


def launch(preload: Sequence[str], channel: int, lifeline: int, environment: Mapping[str, str]) -> Process:
    """Start the process of a fork server, which receives its requests over the channel.

    The server's own environment takes precedence over `environment`.
    """
    return subprocess.Popen(
        [sys.executable, "-c", _BOOT, json.dumps(sys.path), str(channel), str(lifeline), *preload],
        pass_fds=[channel, lifeline],
        stdin=subprocess.DEVNULL,
        env={**environment, **os.environ},
        # Ctrl-C in a terminal is for the server, which ends its jobs itself. In a separate session, the
        # niceness of the processes would have no effect: see app/workers/priority.py.
        process_group=0,
    )


class ForkServer:
    """Starts the fork server, restarts it if it has died, and requests processes from it.

    `environment` contains defaults, which the server's own environment overrides. `begin` starts the first
    process, and `launch` every later one.
    """

    def __init__(
        self,
        preload: Sequence[str],
        environment: Mapping[str, str] | None = None,
        begin: Launch | None = None,
    ) -> None:
        self._preload = preload
        self._environment = environment or {}
        self._lock = threading.Lock()
        self._closed = False
        self._start(begin or launch)

    def fork(self) -> JobProcess:
        """Request a process; it may start later, but accepts its job at once.

        Raises
        ------
        JobCancelled
            If the fork server has been closed.
        """
        connection, theirs = Pipe()
        status, exits = Pipe(duplex=False)
        with theirs, exits:
            self._send([theirs.fileno(), exits.fileno()])
        return JobProcess(connection, status)

    def is_alive(self) -> bool:
        """Return whether the fork server is running, neither ended nor stopped by a signal."""
        return self._process.poll() is None and not self.is_stopped()

    def is_stopped(self) -> bool:
        """Return whether a signal has stopped the fork server, so that it cannot answer. Linux only."""
        try:
            state = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return False
        return state in "Tt"

    def close(self) -> None:
        """Kill the fork server and all its processes."""
        self._closed = True
        self._lifeline.cut()  # before the lock, which a thread waiting for a stopped fork server may hold
        with self._lock:
            self._end()

    def _send(self, descriptors: list[int]) -> None:
        with self._lock:
            try:
                socket.send_fds(self._channel, [b"."], descriptors)
            except OSError:  # it has died, or has been closed
                if self._closed:
                    raise JobCancelled from None
                self._end()
                self._start(launch)
                socket.send_fds(self._channel, [b"."], descriptors)

    def _start(self, begin: Launch) -> None:
        self._lifeline = Lifeline()
        self._channel, theirs = socket.socketpair()
        with theirs:
            self._process = begin(self._preload, theirs.fileno(), self._lifeline.reader, self._environment)
        self._lifeline.close_reader()

    def _end(self) -> None:
        self._lifeline.cut()
        self._channel.close()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(_PATIENCE)
            return
        self._process.kill()  # without a lifeline it may still be importing
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(_PATIENCE)
