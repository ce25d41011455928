"""Servers that `benchmarks.service` measures, each in a process of its own on a free port."""

import http.client
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from benchmarks import processor_time

LOOPS = '''
"""A model whose build never ends."""

from cad.model import Box, CadModel
from templates.core.language.template import Array, given


class Loops(CadModel):
    """A model whose build never ends."""

    example = {"size": "10 mm"}

    a: Array = given("mm", "size", gt=0)

    def build(self):
        while True:
            pass

    def bounding_box(self):
        return Box((0, 0, 0), (1, 1, 1))

    def dimensions(self, seen):
        return {}
'''
PATIENCE = 240.0  # for a server to start, also on a busy machine [s]


@dataclass(frozen=True)
class Server:
    """Where a server listens, and its process."""

    port: int
    pid: int

    @property
    def url(self) -> str:
        """The root."""
        return f"http://127.0.0.1:{self.port}"

    def processor_seconds(self) -> float:
        """Processor time of the server's own process, without its children [s]."""
        fields = Path(f"/proc/{self.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@contextmanager
def crankwright(folder: Path, **settings: str) -> Iterator[Server]:
    """The service, with a team's folder that holds a model whose build loops, and with further settings."""
    own = folder / "templates" / "own"
    own.mkdir(parents=True)
    (own / "loops_v1.py").write_text(LOOPS.lstrip())
    environment = {
        "CRANKWRIGHT_TEMPLATE_FOLDERS": f'["{folder / "templates"}"]',
        "CRANKWRIGHT_JOB_DEADLINE": "600",
        **settings,
    }
    port = free_port()
    with _serving(
        port, ["-m", "app", "serve", f"--port={port}", f"--data={folder / 'data'}"], environment
    ) as it:
        yield it


@contextmanager
def bare(answers: Path) -> Iterator[Server]:
    """The bare FastAPI service with these answers."""
    port = free_port()
    with _serving(port, ["-m", "benchmarks.service_bare", str(port), str(answers)], {}) as it:
        yield it


@contextmanager
def _serving(port: int, arguments: list[str], environment: dict[str, str]) -> Iterator[Server]:
    process = subprocess.Popen(
        [sys.executable, *arguments],
        env={**processor_time.environment(), **environment},
        stderr=subprocess.DEVNULL,
    )
    try:
        _await(port, process)
        yield Server(port, process.pid)
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(PATIENCE)


def _await(port: int, process: subprocess.Popen[bytes]) -> None:
    end = time.monotonic() + PATIENCE
    while not _healthy(port):
        if process.poll() is not None or time.monotonic() > end:
            raise RuntimeError(f"the server did not start: {process.args}")
        time.sleep(0.1)


def _healthy(port: int) -> bool:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
    try:
        connection.request("GET", "/healthz")
        return connection.getresponse().status == 200
    except OSError:
        return False
    finally:
        connection.close()


def free_port() -> int:
    """A port that nobody uses."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
