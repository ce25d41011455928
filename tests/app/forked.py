"""The command line of the service in processes that are forked from one which has imported it.

`python -m app serve` takes seconds to import the geometry kernel, a fork takes none of them. All else
is the same. `test_demo.py` and `test_version_0_1.py` start the real command.
"""

import atexit
import gc
import json
import os
import select
import signal
import socket
import subprocess
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path

LARGEST = 1 << 20  # bytes of a request: the arguments and the environment


class Forked:
    """A process of the command line; behaves as a `subprocess.Popen`."""

    def __init__(self, arguments, environment, log: Path) -> None:
        reader, writer = os.pipe()
        with log.open("ab") as errors:
            request = json.dumps({"arguments": list(map(str, arguments)), "environment": environment})
            socket.send_fds(origin(), [request.encode()], [errors.fileno(), writer])
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
def origin() -> socket.socket:
    """Return the channel to the process from which the others are forked; it ends with these tests."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    for end in (ours, theirs):
        end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, LARGEST)
    with theirs:
        command = [sys.executable, __file__, str(theirs.fileno())]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        process = subprocess.Popen(command, pass_fds=[theirs.fileno()], env=environment)
    atexit.register(process.wait)
    atexit.register(ours.close)  # runs first
    return ours


def serve_forks(channel: int) -> None:
    """Fork for each request that comes in through the channel, until it is closed."""
    from app.workers.threads import use_one_thread

    use_one_thread()
    import app.cli  # noqa: F401 - what the forks share

    gc.freeze()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # what watches a process is not waited for
    with socket.socket(fileno=channel) as requests:
        while True:
            message, descriptors, *_ = socket.recv_fds(requests, LARGEST, 2)
            if not message:
                return
            if os.fork() == 0:
                requests.close()
                _watch(json.loads(message), *descriptors)
            for descriptor in descriptors:
                os.close(descriptor)


def _watch(request, errors: int, status: int) -> None:
    """Fork once more, and write the number and then the exit code of that process."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    pid = os.fork()
    if pid == 0:
        os.close(status)
        _run(request, errors)
    os.close(errors)
    os.write(status, f"{pid}\n".encode())
    _, ended = os.waitpid(pid, 0)
    os.write(status, f"{os.waitstatus_to_exitcode(ended)}\n".encode())
    os._exit(0)


def _run(request, errors: int) -> None:
    """Do what `python -m app` does, in a session of its own with nothing to read."""
    from app.__main__ import main

    os.setsid()
    nothing = os.open(os.devnull, os.O_RDWR)
    for ours, standard in ((nothing, 0), (nothing, 1), (errors, 2)):
        os.dup2(ours, standard)
    os.close(nothing)
    os.close(errors)
    os.environ.clear()
    os.environ.update(request["environment"])
    sys.argv = ["crankwright", *request["arguments"]]
    code = 1
    try:
        main()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        sys.stderr.flush()
        os._exit(code)


if __name__ == "__main__":
    serve_forks(int(sys.argv[1]))
