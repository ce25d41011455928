"""What happens inside a job process, from the fork to its end."""

import ctypes
import math
import os
import pickle
import resource
import signal
import sys
import traceback
from collections.abc import Callable, Iterable
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NoReturn

from app.workers.base import Limits
from app.workers.errors import MemoryExceeded, RemoteError
from app.workers.lifeline import hang_on, has_hung_up
from app.workers.messages import Progress, Raised, Request, Returned
from app.workers.progress import reporting

Rehearsal = Callable[[Callable[[], bool]], object]
"""Does some work like a job's; it is given what tells whether the job has come, and then ends soon."""

_PR_SET_PDEATHSIG = 1


def serve_one_job(
    connection: Connection, parent: int, lifeline: int, rehearsals: Iterable[Rehearsal] = ()
) -> NoReturn:
    """Wait for one request, answer it, and end the process.

    Meanwhile it rehearses, so that the job finds ready what is made at first use. It ends without cleaning
    up: destructors of geometry kernels may crash when the work is long done.
    """
    exit_code = 1
    try:
        _die_with(parent)
        os.setpgid(0, 0)
        hang_on(lifeline, group=os.getpid())  # also if the forkserver is stopped or was killed
        for rehearse in rehearsals:
            with suppress(Exception):  # the job will meet it again, and say so
                rehearse(connection.poll)
        request = connection.recv_bytes()
        if not has_hung_up(connection.fileno()):  # else the job was cancelled before this process was born
            connection.send_bytes(_answer(request, connection))
            exit_code = 0
    finally:  # also when the server has closed its end, which is how it dismisses a process
        os._exit(exit_code)


def _die_with(parent: int) -> None:
    """Have the kernel kill this process when its parent dies; Linux only, elsewhere the parent must do it."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # it died before the kernel was told
        raise ProcessLookupError(parent)


def _answer(packed: bytes, connection: Connection) -> bytes:
    """Run a pickled request and return the pickled message that tells how it ended."""
    try:
        return _run(pickle.loads(packed), connection)
    except BaseException as error:  # whatever it is belongs to the caller
        return pickle.dumps(Raised(_portable(error)))


def _run(request: Request, connection: Connection) -> bytes:
    _limit(request.limits)
    try:
        with reporting(lambda fraction, text: connection.send(Progress(fraction, text))):
            return _packed_result(request.function(*request.args))
    except MemoryError:
        raise MemoryExceeded(request.limits.memory_mb) from None


def _packed_result(value: Any) -> bytes:
    try:
        return pickle.dumps(Returned(value))
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        raise RemoteError(type(value).__qualname__, f"the result cannot be pickled: {error}") from None


def _portable(error: BaseException) -> BaseException:
    """Return the exception, or a RemoteError if it would be lost on the way; a note tells where it arose."""
    where = "".join(traceback.format_exception(error))
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        error = RemoteError(type(error).__qualname__, str(error))
    error.add_note(f"In the job process:\n{where}")
    return error


def _limit(limits: Limits) -> None:
    """Let the kernel hold this process to its limits, even if the server can no longer do so."""
    processor_seconds = math.ceil(limits.deadline) * (os.cpu_count() or 1) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (processor_seconds, processor_seconds + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if sys.platform == "linux":
        memory = _mapped_bytes() + limits.memory_mb * 2**20
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def _mapped_bytes() -> int:
    """Return the address space that the preloaded program takes already [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    return pages * resource.getpagesize()
