"""Start servers for measurements, each in its own process on a free port: the service, and bare FastAPI.

`python -m benchmarks.speed.servers PORT ANSWERS` is the bare one. It parses, checks and answers, no more:
`POST /{name}` returns an answer from a JSON file, as a plain endpoint does: a dict that FastAPI renders.
"""

from __future__ import annotations

import http.client
import json
import os
import platform
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI
from pydantic import BaseModel

from benchmarks import processor_time

PATIENCE = 240.0  # time that a server may take to start, also on a busy machine [s]


@dataclass(frozen=True)
class Server:
    """The address of a server, and its process."""

    port: int
    pid: int

    @property
    def url(self) -> str:
        """Return the root address."""
        return f"http://127.0.0.1:{self.port}"

    def processor_seconds(self) -> float:
        """Return the processor time of the server's own process, without its children [s]."""
        fields = Path(f"/proc/{self.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@contextmanager
def crankwright(folder: Path) -> Iterator[Server]:
    """Yield the service with its data in a folder."""
    port = free_port()
    with _serving(port, ["-m", "app", "serve", f"--port={port}", f"--data={folder / 'data'}"]) as server:
        yield server


@contextmanager
def bare(answers: Path) -> Iterator[Server]:
    """Yield the bare FastAPI service with these answers."""
    port = free_port()
    with _serving(port, ["-m", "benchmarks.speed.servers", str(port), str(answers)]) as server:
        yield server


@contextmanager
def _serving(port: int, arguments: list[str]) -> Iterator[Server]:
    process = subprocess.Popen(
        [sys.executable, *arguments], env=processor_time.environment(), stderr=subprocess.DEVNULL
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
            raise RuntimeError(f"the server did not start: {process.args!r}")
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
    """Return a port that is not in use."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def commit() -> str:
    """Return the measured commit, marked if the working tree differs from it."""
    command = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    return subprocess.run(command, capture_output=True, text=True).stdout.strip()


def machine() -> dict[str, Any]:
    """Return a description of the machine, with the versions of the largest packages."""
    names = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    packages = {name: version(name) for name in ("fastapi", "uvicorn", "cadquery", "numpy")}
    processor = names[0].partition(":")[2].strip() if names else platform.processor()
    return {
        "processor": processor,
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        **packages,
    }


class Body(BaseModel):
    """The body of `evaluate` as a straightforward Pydantic model."""

    inputs: dict[str, Any]
    outputs: list[str] | None = None


def bare_app(answers: dict[str, Any]) -> FastAPI:
    """Return the bare FastAPI application."""
    app = FastAPI()

    @app.get("/healthz")
    async def healthz() -> dict[str, str]:
        return {"status": "ok"}

    @app.post("/{name}")
    async def answer(name: str, body: Body) -> dict[str, Any]:
        answered: dict[str, Any] = answers[name]
        return answered

    return app


def main() -> None:
    """Serve the bare application, with the settings of `crankwright serve`."""
    answers = json.loads(Path(sys.argv[2]).read_text())
    uvicorn.run(bare_app(answers), host="127.0.0.1", port=int(sys.argv[1]), log_level="warning")


if __name__ == "__main__":
    main()
