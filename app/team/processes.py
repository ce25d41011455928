"""Child processes that are stopped by their id, and end with the process that started them."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from app.team.errors import DidNotStart
from app.workers.lifeline import Lifeline

LOOPBACK = "127.0.0.1"
START = 120.0  # longest time until a process answers [s]
END = 30.0  # longest time for a process to end after a request [s]
_GLANCE = 0.05  # time between two checks [s]
_LONGEST = 400  # characters of a line of a log


def free_port() -> int:
    """Return a TCP port on loopback on which nothing listens."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        port: int = probe.getsockname()[1]
        return port


def listens(port: int) -> bool:
    """Return whether some process accepts connections on a loopback port."""
    with suppress(OSError), socket.create_connection((LOOPBACK, port), timeout=1.0):
        return True
    return False


class ChildProgram:
    """A program in its own session, with its output in a file; it ends with this process.

    Parameters
    ----------
    name
        Name of the program in errors.
    command
        The program and its arguments.
    log
        The file to which its output is appended.
    environment
        Environment variables in addition to those of this process.
    user
        The user that runs the program, if it is not the user of this process; only root may set this.
    """

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        log: Path,
        *,
        environment: Mapping[str, str] | None = None,
        user: str | None = None,
    ) -> None:
        self.name, self.log = name, log
        self._line = Lifeline()
        tied = [sys.executable, "-m", "app.team.tether", str(self._line.reader), user or ""]
        with log.open("ab") as output:
            self._process = subprocess.Popen(
                [*tied, *command],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                env={**os.environ, "PYTHONPATH": _path(), **(environment or {})},
                pass_fds=[self._line.reader],
                start_new_session=True,
            )
        self._line.close_reader()

    @property
    def pid(self) -> int:
        """Return the id of the process, which is also that of its group."""
        return self._process.pid

    @property
    def lives(self) -> bool:
        """Return whether the process is still running."""
        return self._process.poll() is None

    def until(self, answers: Callable[[], bool], seconds: float = START) -> None:
        """Wait until the process answers.

        Raises
        ------
        DidNotStart
            If it has ended, or does not answer in time.
        """
        end = time.monotonic() + seconds
        while not answers():
            self.require()
            if time.monotonic() > end:
                raise DidNotStart(f"{self.name} does not answer after {seconds:.0f} s; {self.said()}")
            time.sleep(_GLANCE)

    def require(self) -> None:
        """Raise DidNotStart if the process has ended."""
        if not self.lives:
            code = self._process.returncode
            raise DidNotStart(f"{self.name} ended with exit code {code}; {self.said()}")

    def send(self, number: int) -> None:
        """Send a signal to the process, unless it has ended."""
        self._process.send_signal(number)

    def kill(self) -> None:
        """Kill only the process by `kill -9`, as an accident would; its children are left to themselves."""
        self._process.kill()
        self._process.wait()

    def stop(self, number: int = signal.SIGTERM, seconds: float = END) -> int:
        """Ask the process to end, kill it after some time, and kill the rest of its group.

        Returns
        -------
        int
            Its exit code; negative if a signal ended it.
        """
        with suppress(ProcessLookupError):
            self.send(number)
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            self._process.kill()
        finally:
            self._line.cut()
        return self._process.wait()

    def said(self, lines: int = 5) -> str:
        """Return the end of the program's output, as text for a message."""
        written = [
            line[-_LONGEST:] for line in self.log.read_text(errors="replace").strip().splitlines()[-lines:]
        ]
        if not written:
            return f"it wrote nothing to {self.log}"
        return "\n  ".join([f"{self.log} ends with", *written])


def _path() -> str:
    """Return the module path of this process for a process that may run in another folder."""
    return os.pathsep.join(filter(None, sys.path))
