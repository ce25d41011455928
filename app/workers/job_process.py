"""The main loop of a job process, from the fork to its exit."""

import ctypes
import gc
import math
import os
import pickle
import resource
import signal
import sys
import traceback
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache, partial
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NoReturn, cast

from app.workers.base import Limits
from app.workers.errors import MemoryExceeded, RemoteError, WorkerError
from app.workers.lifeline import hang_on, has_hung_up
from app.workers.messages import (
    ErrorMessage,
    PackedMessage,
    Progress,
    Request,
    ResultMessage,
    pack,
    receive,
    send,
)
from templates.core.progress import reporting

Rehearsal = Callable[[Callable[[], bool]], object]
"""Function that rehearses the work of a job. Its argument returns whether the job has arrived; then it
ends soon."""

_PR_SET_PDEATHSIG = 1
_GROWTH = 4  # a process that keeps more than 1/4 of its allowance takes no other request


def serve_jobs(
    connection: Connection, parent: int, lifeline: int, rehearsals: Iterable[Rehearsal] = ()
) -> NoReturn:
    """Wait for a request, answer it, and end the process, unless another request may follow.

    While it waits, the process rehearses, so that modules loaded at first use are ready. It exits without
    cleaning up, because destructors of geometry kernels may crash after the work is done.
    """
    exit_code = 1
    try:
        _die_with(parent)
        os.setpgid(0, 0)
        hang_on(lifeline, group=os.getpid())  # works even if the fork server is stopped or was killed
        for rehearse in rehearsals:
            with suppress(Exception):  # the job will raise this error again and report it
                rehearse(connection.poll)
        request = receive(connection)
        reusable = not has_hung_up(
            connection.fileno()
        )  # otherwise the job was cancelled before this process started
        is_first = True
        while reusable:
            answer, reusable = _answer(request, connection)
            send(connection, answer)
            del answer
            if reusable:
                gc.collect()  # reference cycles left by a calculation may be large
                if is_first:
                    gc.freeze()  # modules loaded at first use stay; later collections can skip them
                is_first = False
                request = receive(connection)
        exit_code = 0
    finally:  # also if the server closes its end, by which it dismisses a process
        os._exit(exit_code)


def _die_with(parent: int) -> None:
    """Make the kernel kill this process when its parent dies; elsewhere than on Linux the parent does it."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # the parent died before the kernel was told
        raise ProcessLookupError(parent)


def _answer(packed: PackedMessage, connection: Connection) -> tuple[PackedMessage, bool]:
    """Run a pickled request; return its pickled outcome, and whether another request may follow."""
    reusable = False
    try:
        request = packed.unpacked()
        assert isinstance(request, Request), "the server sends nothing else"
        task = _task(request)
        _limit(request.limits)
        reusable = request.reusable
        return _run(task, request, connection)
    except BaseException as error:  # the caller receives any error
        reusable = reusable and isinstance(error, Exception) and not isinstance(error, WorkerError)
        return pack(ErrorMessage(pack(_portable(error)), reusable)), reusable


def _task(request: Request) -> Callable[[], object]:
    function, args = cast(tuple[Callable[..., object], tuple[object, ...]], request.task.unpacked())
    return partial(function, *args)


def _run(task: Callable[[], object], request: Request, connection: Connection) -> tuple[PackedMessage, bool]:
    try:
        with reporting(lambda fraction, text: send(connection, pack(Progress(fraction, text)))):
            result = task()
        reusable = request.reusable and not _has_grown(request.limits)
        return pack(ResultMessage(_packed_result(result), reusable)), reusable
    except MemoryError:
        raise MemoryExceeded(request.limits.memory_mb, request.limits.memory_setting) from None


def _packed_result(result: object) -> PackedMessage:
    try:
        return pack(result)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        kind = type(result).__qualname__
        raise RemoteError(kind, f"the result cannot be pickled: {error}") from None


def _portable(error: BaseException) -> BaseException:
    """Return the exception, or a RemoteError if it cannot be sent; a note names where it was raised."""
    where = "".join(traceback.format_exception(error))
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        error = RemoteError(type(error).__qualname__, str(error))
    error.add_note(f"In the job process:\n{where}")
    return error


def _limit(limits: Limits) -> None:
    """Set this process's limits in the kernel, which enforces them even without the server.

    These are soft limits, which a process raises for its next request. The kernel adds up the processor time
    of all requests, and ends the process at the soft limit.
    """
    used = resource.getrusage(resource.RUSAGE_SELF)
    seconds = math.ceil(used.ru_utime + used.ru_stime + limits.deadline * (os.cpu_count() or 1)) + 1
    _set_soft(resource.RLIMIT_CPU, seconds)
    _set_soft(resource.RLIMIT_CORE, 0)
    if sys.platform == "linux":
        _set_soft(resource.RLIMIT_AS, _mapped_at_start() + limits.memory_mb * 2**20)


def _set_soft(kind: int, wanted: int) -> None:
    hard = resource.getrlimit(kind)[1]
    soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
    resource.setrlimit(kind, (soft, hard))


def _has_grown(limits: Limits) -> bool:
    """Return whether the process holds so much memory that the next request could exceed the limit."""
    if sys.platform != "linux":
        return False
    return _mapped_bytes() - _mapped_at_start() > limits.memory_mb * 2**20 / _GROWTH


@cache
def _mapped_at_start() -> int:
    """Return the size of the address space before the first request [bytes]."""
    return _mapped_bytes()


def _mapped_bytes() -> int:
    """Return the present size of the process's address space [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    return pages * resource.getpagesize()
