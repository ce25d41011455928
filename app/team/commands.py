"""Crankwright commands as parts of a team: each can be killed, and restarted on its port."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import httpx

from app.team.processes import LOOPBACK, START, ChildProgram, free_port, listens


class Command:
    """A command of Crankwright's in a process of its own.

    Parameters
    ----------
    name
        What it is called; its log in `folder` has this name.
    arguments
        What stands behind `crankwright`.
    folder
        Where its log is.
    environment
        Its settings, as variables.
    """

    def __init__(
        self, name: str, arguments: Sequence[str], folder: Path, environment: Mapping[str, str]
    ) -> None:
        self.name, self._arguments = name, arguments
        self._log, self._environment = folder / f"{name.replace(' ', '-')}.log", environment
        self._process: ChildProgram | None = None

    @property
    def lives(self) -> bool:
        """Return whether its process still runs."""
        return self._process is not None and self._process.lives

    @property
    def pid(self) -> int:
        """Return the number of its process; 0 if it was not started."""
        return self._process.pid if self._process else 0

    def start(self) -> None:
        """Start it; it works some seconds later."""
        self.stop()  # what is left of a process that has died
        command = [sys.executable, "-m", "app", *self._arguments]
        self._process = ChildProgram(self.name, command, self._log, environment=self._environment)

    def until(self, answers: Callable[[], bool], seconds: float = START) -> None:
        """Wait until it answers; raises as `ChildProgram.until` does."""
        assert self._process is not None, "it has been started"
        self._process.until(answers, seconds)

    def require(self) -> None:
        """Raise DidNotStart if it has been started and has ended."""
        if self._process:
            self._process.require()

    def kill(self) -> None:
        """Kill -9 it alone; what it started notices that."""
        if self._process:
            self._process.kill()

    def stop(self) -> None:
        """Ask it to end, and wait for that."""
        if self._process:
            self._process.stop()
            self._process = None


class Server(Command):
    """`crankwright serve` with a data folder of its own in `folder`."""

    def __init__(self, name: str, folder: Path, environment: Mapping[str, str]) -> None:
        self.port = free_port()
        arguments = ["serve", "--host", LOOPBACK, "--port", str(self.port), "--data", str(folder / name)]
        super().__init__(f"server {name}", arguments, folder, environment)

    @property
    def url(self) -> str:
        """Return the address at which it answers."""
        return f"http://{LOOPBACK}:{self.port}"

    def ready(self, others: Sequence[Command] = (), seconds: float = START) -> None:
        """Wait until it can work, while the others live on which it depends; raises as `until` does."""

        def answers() -> bool:
            for other in others:
                other.require()
            return _is_ready(http)

        with httpx.Client(base_url=self.url, timeout=10.0, trust_env=False) as http:
            self.until(answers, seconds)


class Scheduler(Command):
    """`crankwright scheduler`, which hands jobs to the workers."""

    def __init__(self, folder: Path, environment: Mapping[str, str]) -> None:
        self.port = free_port()
        arguments = ["scheduler", "--host", LOOPBACK, "--port", str(self.port)]
        super().__init__("scheduler", arguments, folder, environment)

    @property
    def address(self) -> str:
        """Return the address that `CRANKWRIGHT_ENGINE` names."""
        return f"tcp://{LOOPBACK}:{self.port}"

    def ready(self) -> None:
        """Wait until it listens; raises as `until` does."""
        self.until(lambda: listens(self.port))


def _is_ready(http: httpx.Client) -> bool:
    with suppress(httpx.TransportError):
        return http.get("/readyz").status_code == 200
    return False
