"""A pipe that ties child processes to the server: when its end closes, the kernel kills them.

However the server dies, the kernel closes its end of the pipe and immediately sends SIGKILL to the children.
This works whatever the process is doing (importing, forking, stopped by a debugger, holding the interpreter
lock). Unlike a parent-death signal, it does not depend on the server's thread that started the process.

It is for Linux only. On other systems a process notices the end of the server when it next reads from it.
"""

import fcntl
import os
import select
import signal
import sys


class Lifeline:
    """The server's end of the pipe; `reader` is the end for processes that must not outlive the server."""

    def __init__(self) -> None:
        self.reader, self._writer = os.pipe()

    def close_reader(self) -> None:
        """Close the server's copy of the other end after it was passed to a child."""
        os.close(self.reader)

    def cut(self) -> None:
        """Kill the processes tied to this pipe; a second call does nothing."""
        writer, self._writer = self._writer, -1
        if writer >= 0:
            os.close(writer)


def hang_on(reader: int, group: int | None = None) -> None:
    """Tie this process, or its process group, to the server: they die when the server dies.

    Raises
    ------
    ProcessLookupError
        If the server has already ended.
    """
    if sys.platform == "linux":
        # Opened again, because an end of a pipe that processes share can have only one owner.
        own = os.open(f"/proc/self/fd/{reader}", os.O_RDONLY | os.O_NONBLOCK)
        fcntl.fcntl(own, fcntl.F_SETOWN, os.getpid() if group is None else -group)
        fcntl.fcntl(own, fcntl.F_SETSIG, signal.SIGKILL)
        fcntl.fcntl(own, fcntl.F_SETFL, os.O_NONBLOCK | os.O_ASYNC)
    if has_hung_up(reader):
        raise ProcessLookupError("the server has stopped")


def has_hung_up(descriptor: int) -> bool:
    """Return whether the other end of a pipe or socket is closed, even if there are data left to read."""
    poll = select.poll()
    poll.register(descriptor, 0)  # a hang-up is always reported
    return any(event & select.POLLHUP for _, event in poll.poll(0))
