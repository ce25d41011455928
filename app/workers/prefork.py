"""Fork servers that the server forks from itself before it has threads, so that they need no imports.

They share the memory pages of all imported modules. The first request for the same modules takes one of them;
later requests get a new process, which imports the modules. If a fork server dies, a new process replaces
it.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import NoReturn

from app.workers.processes import ForkServer
from app.workers.threads import ONE_THREAD

_GLANCE = 0.01  # time between two checks whether a process has ended [s]
_LONGEST_NAME = 15  # longest process name in Linux [characters]
_started: dict[tuple[str, ...], ForkServer] = {}


def fork(preload: Sequence[str], prepare: Callable[[], object] | None = None) -> None:
    """Fork a fork server for these modules in advance; it ends with this process, used or not.

    If this process already has threads, or is not on Linux, nothing is forked: callers then get a new process
    later.

    Parameters
    ----------
    preload
        The modules, in the form that `fork_server` needs.
    prepare
        A function that the new process calls before it imports missing modules.
    """
    if not _may_fork():
        return

    def begin(
        modules: Sequence[str], channel: int, lifeline: int, environment: Mapping[str, str]
    ) -> ForkedProcess:
        sys.stdout.flush()
        sys.stderr.flush()
        if pid := os.fork():
            return ForkedProcess(pid)
        _become_fork_server(modules, channel, lifeline, environment, prepare)

    _started[tuple(preload)] = ForkServer(preload, ONE_THREAD, begin)


def is_forked(preload: Sequence[str]) -> bool:
    """Return whether a fork server for these modules was forked in advance and is unused."""
    return tuple(preload) in _started


def fork_server(preload: Sequence[str], environment: Mapping[str, str]) -> ForkServer:
    """Return the fork server that was forked in advance for these modules, else a new one."""
    return _started.pop(tuple(preload), None) or ForkServer(preload, environment)


def close() -> None:
    """End the unused fork servers."""
    while _started:
        _started.popitem()[1].close()


class ForkedProcess:
    """A child of this process with the interface of `subprocess.Popen`."""

    def __init__(self, pid: int) -> None:
        self.pid = pid
        self._code: int | None = None

    def poll(self) -> int | None:
        """Return the exit code; None while the process is running."""
        if self._code is None:
            try:
                ended, status = os.waitpid(self.pid, os.WNOHANG)
            except (
                ChildProcessError
            ):  # other code has waited for it, so its exit code is lost, as with `Popen`
                self._code = 0
            else:
                self._code = os.waitstatus_to_exitcode(status) if ended else None
        return self._code

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the end of the process, and return its exit code.

        Raises
        ------
        subprocess.TimeoutExpired
            If it takes longer than the timeout [s].
        """
        end = time.monotonic() + (float("inf") if timeout is None else timeout)
        while (code := self.poll()) is None:
            if time.monotonic() >= end:
                raise subprocess.TimeoutExpired("fork server", timeout or 0.0)
            time.sleep(_GLANCE)
        return code

    def kill(self) -> None:
        """Kill the process, unless it has ended."""
        if self.poll() is None:
            os.kill(self.pid, 9)


def _may_fork() -> bool:
    """Return whether this process has only one thread.

    A fork lacks all other threads, and would wait for their locks.
    """
    return sys.platform == "linux" and len(os.listdir("/proc/self/task")) == 1


def _become_fork_server(
    modules: Sequence[str],
    channel: int,
    lifeline: int,
    environment: Mapping[str, str],
    prepare: Callable[[], object] | None,
) -> NoReturn:
    """Turn a fork of the server into a fork server with the state of a new process."""
    try:
        from app.workers.forkserver import main

        os.setpgid(0, 0)
        _keep_only(channel, lifeline)
        with open(
            "/proc/self/comm", "w", encoding="ascii"
        ) as comm:  # its command line remains that of the server
            comm.write(modules[0][:_LONGEST_NAME])
        for name, text in environment.items():
            os.environ.setdefault(name, text)
        main(channel, lifeline, modules, prepare)
    finally:  # in no case may it continue as a second server
        os._exit(1)


def _keep_only(*descriptors: int) -> None:
    """Close all other files and sockets of the server.

    A copy of another fork server's lifeline would keep that one alive after the server's death.
    """
    for descriptor in map(int, os.listdir("/proc/self/fd")):
        if descriptor > 2 and descriptor not in descriptors:
            with suppress(OSError):
                os.close(descriptor)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
