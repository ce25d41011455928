"""Crankwright commands as parts of a team: each can be killed, and restarted on its port."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import httpx

from app.team.processes import LOOPBACK, START, ChildProgram, free_port, listens


class Command:
    """A Crankwright command in a separate process.

    Parameters
    ----------
    name
        Name of the command; its log in `folder` has this name.
    arguments
        The arguments after `crankwright`.
    folder
        The folder of its log.
    environment
        Its settings, as environment variables.
    """

    def __init__(
        self, name: str, arguments: Sequence[str], folder: Path, environment: Mapping[str, str]
    ) -> None:
        self.name, self._arguments = name, arguments
        self._log, self._environment = folder / f"{name.replace(' ', '-')}.log", environment
        self._process: ChildProgram | None = None

    @property
    def lives(self) -> bool:
        """Return whether the process is still running."""
        return self._process is not None and self._process.lives

    @property
    def pid(self) -> int:
        """Return the id of the process; 0 if it was not started."""
        return self._process.pid if self._process else 0

    def start(self) -> None:
        """Start the process, which becomes ready some seconds later."""
        self.stop()  # the remains of a process that has died
        command = [sys.executable, "-m", "app", *self._arguments]
        self._process = ChildProgram(self.name, command, self._log, environment=self._environment)

    def until(self, answers: Callable[[], bool], seconds: float = START) -> None:
        """Wait until the command answers; raises as `ChildProgram.until` does."""
        assert self._process is not None, "it has been started"
        self._process.until(answers, seconds)

    def require(self) -> None:
        """Raise DidNotStart if the process was started and has ended."""
        if self._process:
            self._process.require()

    def kill(self) -> None:
        """Kill only this process by `kill -9`; the processes that it started notice that."""
        if self._process:
            self._process.kill()

    def stop(self) -> None:
        """Ask the process to end, and wait until it has ended."""
        if self._process:
            self._process.stop()
            self._process = None


class Server(Command):
    """`crankwright serve` with its own data folder in `folder`."""

    def __init__(self, name: str, folder: Path, environment: Mapping[str, str]) -> None:
        self.port = free_port()
        arguments = ["serve", "--host", LOOPBACK, "--port", str(self.port), "--data", str(folder / name)]
        super().__init__(f"server {name}", arguments, folder, environment)

    @property
    def url(self) -> str:
        """Return the address of the server."""
        return f"http://{LOOPBACK}:{self.port}"

    def ready(self, others: Sequence[Command] = (), seconds: float = START) -> None:
        """Wait until the server is ready, as long as the parts that it needs run; raises as `until` does."""

        def answers() -> bool:
            for other in others:
                other.require()
            return _is_ready(http)

        with httpx.Client(base_url=self.url, timeout=10.0, trust_env=False) as http:
            self.until(answers, seconds)


class Scheduler(Command):
    """`crankwright scheduler`, which passes jobs to the workers."""

    def __init__(self, folder: Path, environment: Mapping[str, str]) -> None:
        self.port = free_port()
        arguments = ["scheduler", "--host", LOOPBACK, "--port", str(self.port)]
        super().__init__("scheduler", arguments, folder, environment)

    @property
    def address(self) -> str:
        """Return the address for `CRANKWRIGHT_ENGINE`."""
        return f"tcp://{LOOPBACK}:{self.port}"

    def ready(self) -> None:
        """Wait until the scheduler listens; raises as `until` does."""
        self.until(lambda: listens(self.port))


def _is_ready(http: httpx.Client) -> bool:
    with suppress(httpx.TransportError):
        return http.get("/readyz").status_code == 200
    return False
