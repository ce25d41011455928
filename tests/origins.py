"""Processes from which tests fork: an import takes seconds, a fork of a process with the import none.

An origin imports modules and waits. For each request it forks, and the fork calls a function of tests with
the request, in an environment of its own and with nothing to read.
"""

import atexit
import gc
import importlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from functools import cache

LARGEST = 1 << 20  # bytes of a request: the arguments and the environment


class Forked:
    """A fork of an origin; behaves as a `subprocess.Popen`.

    Args:
        function: what the fork calls, `module:name`, with the request and the descriptors.
        preload: modules that the origin has imported.
        request: goes through JSON; its `environment` becomes the process's own.
        descriptors: of open files, which the fork receives.
    """

    def __init__(self, function: str, preload: tuple, request: dict, descriptors: list[int]) -> None:
        reader, writer = os.pipe()
        message = json.dumps(request).encode()
        socket.send_fds(origin(function, preload), [message], [writer, *descriptors])
        os.close(writer)
        self._status = os.fdopen(reader, encoding="ascii")
        self.pid = int(self._status.readline())
        self.returncode = None

    def poll(self):
        """Return the exit code, None while the process lives."""
        with suppress(subprocess.TimeoutExpired):
            self.wait(0)
        return self.returncode

    def wait(self, timeout=None):
        """Return the exit code once the process has ended."""
        if self.returncode is None:
            if not select.select([self._status], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("crankwright", timeout)
            self.returncode = int(self._status.readline())
            self._status.close()
        return self.returncode

    def send_signal(self, number) -> None:
        """Send a signal, unless the process has ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        """End the process at once."""
        self.send_signal(signal.SIGKILL)


@cache
def origin(function: str, preload: tuple) -> socket.socket:
    """Return the channel to the process from which others are forked; it ends with these tests."""
    ours, theirs = channel()
    with theirs:
        command = [sys.executable, __file__, str(theirs.fileno()), function, *preload]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        process = subprocess.Popen(command, pass_fds=[theirs.fileno()], env=environment)
    atexit.register(process.wait)
    atexit.register(ours.close)  # runs first
    return ours


def own_origin(run) -> socket.socket:
    """Fork an origin from this process, which has no threads yet and has imported all; return its channel."""
    ours, theirs = channel()
    if os.fork() == 0:
        ours.close()
        serve_forks(theirs.detach(), run)
        os._exit(0)
    theirs.close()
    return ours


def channel() -> tuple[socket.socket, socket.socket]:
    """Both ends of what requests go through."""
    ends = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    for end in ends:
        end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, LARGEST)
    return ends


def import_all(function: str, preload: list[str]):
    """Import what forks need, as a fork server does; return the function that they call."""
    from app.workers.forkserver import load
    from app.workers.threads import use_one_thread

    use_one_thread()
    for module in preload:
        load(module)
    module, _, name = function.partition(":")
    return getattr(importlib.import_module(module), name)


def serve_forks(descriptor: int, run) -> None:
    """Fork for each request that comes in through the channel, until it is closed."""
    gc.freeze()
    with socket.socket(fileno=descriptor) as requests:
        while True:
            message, descriptors, *_ = socket.recv_fds(requests, LARGEST, 4)
            if not message:
                return
            if os.fork() == 0:
                requests.close()
                _watch(run, json.loads(message), *descriptors)
            for descriptor in descriptors:
                os.close(descriptor)
            _collect()


def _collect() -> None:
    """Wait for the watchers that have ended, so that their processor time counts as that of these tests."""
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


def _watch(run, request, status: int, *descriptors: int) -> None:
    """Fork once more, and write the number and then the exit code of that process."""
    pid = os.fork()
    if pid == 0:
        os.close(status)
        _become(run, request, descriptors)
    for descriptor in descriptors:
        os.close(descriptor)
    with suppress(BrokenPipeError):  # whoever asked has gone
        os.write(status, f"{pid}\n".encode())
        _, ended = os.waitpid(pid, 0)
        os.write(status, f"{os.waitstatus_to_exitcode(ended)}\n".encode())
    os._exit(0)


def _become(run, request, descriptors) -> None:
    """Call the function as a process of its own would."""
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.environ.clear()
    os.environ.update(request["environment"])
    code = 1
    try:
        run(request, *descriptors)
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        sys.stderr.flush()
        os._exit(code)


if __name__ == "__main__":
    serve_forks(int(sys.argv[1]), import_all(sys.argv[2], sys.argv[3:]))
