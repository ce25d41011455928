"""Servers for tests: the real app under uvicorn, in a thread of the tests or in a process to be killed."""

import json
import os
import signal
import socket
import threading
import time
from contextlib import contextmanager, nullcontext
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent

import httpx
import pytest
import uvicorn
from components import ON_POSTGRESQL, shared
from forked import Forked
from one_context import share_one_context
from patience import GLANCE, patient, until
from unsynced import spare_the_disk

from app import main
from app.client import Client
from app.designs.bodies import PAPER
from app.http.server import configuration
from app.main import create_app
from app.settings import Settings

spare_the_disk()
share_one_context()
API = "/api/v1"
PATIENCE = patient(60.0)  # for a server to start [s]; importing the geometry kernel takes some of it
HANG = patient(5.0)  # an answer that takes longer hangs [s]

MOODY = '''
"""A block that misbehaves on request."""

import ctypes
import time

from cadquery import Location, Solid, Vector

from cad.model import Box, CadModel, Part, mm
from templates.core.language.template import Array, choice, given


class Moody(CadModel):
    """A block that misbehaves on request."""

    example = {"size": "10 mm"}

    a: Array = given("mm", "size", gt=0, le=1000)
    mood: str = choice("good", "raises", "two_solids", "wrong_volume", "loops", "eats", "dies",
                       words="mood", default="good")

    def build(self):
        size = mm(self.a)
        block = Solid.makeBox(size, size, size)
        volume = size**3
        match self.mood:
            case "raises":
                raise RuntimeError("the kernel is in a bad mood")
            case "two_solids":
                block = block.fuse(Solid.makeBox(size, size, size, Vector(2 * size, 0, 0)))
                volume *= 2
            case "wrong_volume":
                volume *= 1.01
            case "loops":
                while True:
                    pass
            case "eats":
                hoard = []
                while True:
                    hoard.append(bytearray(50 * 2**20))
            case "dies":
                ctypes.string_at(0)
        return (Part("block", block, volume),)

    def bounding_box(self):
        size = mm(self.a)
        return Box((0, 0, 0), (3 * size if self.mood == "two_solids" else size, size, size))

    def dimensions(self, seen):
        return {"size": seen["block"].length(Vector(0, 0, 1))}
'''


DOUBLE = '''
"""Twice a length."""

from templates.core.language.template import Array, Template, formula, given


class Double(Template):
    """Twice a length."""

    example = {"length": "1 mm"}

    a: Array = given("mm", "length", ge=0)

    @formula("mm", "twice the length")
    def b(self) -> Array:
        return 2 * self.a
'''


BAR = '''
"""A round bar, of which stiffness and frequency are known."""

from math import pi

from cadquery import Solid, Vector

from cad.model import Box, CadModel, Part, mm
from cad.shaft import Shaft
from templates.core.language.template import Array, choice, given


class Bar(CadModel):
    """A round bar along z, held at its foot, as it says; or in a way that cannot be."""

    example = {"diameter": "20 mm", "length": "40 mm"}

    d: Array = given("mm", "diameter", gt=0, le=1000)
    l: Array = given("mm", "length", gt=0, le=1000)
    ends: str = choice("flat", "elsewhere", "none", words="ends", default="flat")

    def build(self):
        d, l = mm(self.d), mm(self.l)
        return (Part("bar", Solid.makeCylinder(d / 2, l), pi / 4 * d**2 * l),)

    def bounding_box(self):
        d, l = mm(self.d), mm(self.l)
        return Box((-d / 2, -d / 2, 0), (d / 2, d / 2, l))

    def dimensions(self, seen):
        return {"length": seen["bar"].length(Vector(0, 0, 1))}

    def shaft(self):
        l = mm(self.l)
        return {"flat": Shaft(0, l), "elsewhere": Shaft(0, l + 1), "none": None}[self.ends]
'''


def paper(**changes):
    """The paper's design as a document of its own."""
    return {**deepcopy(PAPER), **changes}


def moody(size="10 mm", mood="good", **more):
    """A design of one block."""
    return {
        "name": "block",
        "model": {"id": "moody", "version": 1, "parameters": {"size": size, "mood": mood}},
        **more,
    }


def folder_of_models(path: Path) -> Path:
    """A team's own folder: the model that misbehaves, one that can be analysed, and a template."""
    (path / "own").mkdir(parents=True)
    (path / "own" / "double_v1.py").write_text(dedent(DOUBLE).lstrip())
    (path / "own" / "bar_v1.py").write_text(dedent(BAR).lstrip())
    (path / "own" / "moody_v1.py").write_text(dedent(MOODY).lstrip())
    return path


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@dataclass
class Served:
    """A server in a thread of this process."""

    url: str
    app: object
    settings: Settings

    @property
    def jobs(self):
        return self.app.state.services.jobs


@contextmanager
def serving(settings: Settings):
    """The real app under uvicorn in a thread, until the end."""
    settings = on_the_database_of_tests(settings)
    app = create_app(settings)
    server = uvicorn.Server(configuration(app, settings, port=0))
    thread = threading.Thread(target=server.run, name="uvicorn")
    try:
        started(server, thread)
        port = server.servers[0].sockets[0].getsockname()[1]
        prepared(f"http://127.0.0.1:{port}")
        yield Served(f"http://127.0.0.1:{port}", app, settings)
    finally:
        server.should_exit = True
        thread.join(PATIENCE)
        assert not thread.is_alive(), "the server did not stop"


def started(server: uvicorn.Server, thread: threading.Thread) -> None:
    """Wait until the server has started; tests/conftest.py has spared the program from collections."""
    end = time.monotonic() + PATIENCE
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(main, "spared_by_collections", nullcontext)
        thread.start()
        while not server.started:
            assert thread.is_alive(), "the server did not start"
            assert time.monotonic() < end, "the server takes too long to start"
            time.sleep(0.02)


def prepared(url: str) -> None:
    """Have a server in this process prepare its routes, as FastAPI does at the first request.

    Two servers in threads would do so at the same time otherwise, and `warnings.catch_warnings`, by which
    FastAPI silences Pydantic there, belongs to the whole process.
    """
    httpx.get(f"{url}/there/is/no/such/page", timeout=PATIENCE, trust_env=False)


def on_the_database_of_tests(settings: Settings) -> Settings:
    """The settings, with a database on PostgreSQL if tests run on that, and these name none."""
    if not ON_POSTGRESQL or settings.database_url is not None:
        return settings
    prefix = "CRANKWRIGHT_"
    given = {name.removeprefix(prefix).lower(): value for name, value in shared(settings.data).items()}
    return Settings(**{**settings.model_dump(exclude_unset=True), **given})


class ServerProcess:
    """`crankwright serve` in a process, and a session, of its own."""

    def __init__(self, data: Path, **environment: str) -> None:
        self.data = data
        self.environment = {**shared(data), **environment} if ON_POSTGRESQL else environment
        self.process = None
        self.port = free_port()
        self.log = data.with_name(f"{data.name}.log")

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def start(self) -> "ServerProcess":
        command = ["serve", "--port", self.port, "--data", self.data]
        self.process = Forked(command, {**os.environ, **self.environment}, self.log)
        return self

    def ready(self) -> "ServerProcess":
        end = time.monotonic() + PATIENCE
        with Client(self.url) as client:
            while not client.healthy():
                assert self.process.poll() is None, self.log.read_text()[-2000:]
                assert time.monotonic() < end, "the server takes too long to start"
                time.sleep(GLANCE)
        return self

    def kill(self) -> set[int]:
        """Kill -9 the server alone, and return the processes that descended from it."""
        family = descendants(self.process.pid)
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        return family

    def stop(self) -> int:
        """Ask the server to stop; its exit code."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(PATIENCE)

    def __enter__(self) -> "ServerProcess":
        return self.start().ready()

    def __exit__(self, *exception) -> None:
        if self.process.poll() is None:
            self.stop()


def descendants(pid: int) -> set[int]:
    """All living processes that descend from this one, from /proc."""
    parents = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            parents[int(entry.name)] = parent_of(entry)
    pids: set[int] = set()
    while more := {child for child, parent in parents.items() if parent in pids | {pid}} - pids:
        pids |= more
    return pids


def alive(pid: int) -> bool:
    """Whether a process exists and is more than a zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def parent_of(entry: Path) -> int:
    try:
        return int((entry / "stat").read_text().rpartition(")")[2].split()[1])
    except (FileNotFoundError, ProcessLookupError):
        return 0


def settled(http: httpx.Client, id: str, seconds: float = 60.0) -> dict:
    """The design once nothing of it is being regenerated."""
    ask = lambda: http.get(f"{API}/designs/{id}").json()  # noqa: E731
    return until(ask, lambda design: design["state"] != "regenerating", seconds)


def ended(http: httpx.Client, response: httpx.Response) -> dict:
    """The job of an accepted request, after its end."""
    assert response.status_code == 202, response.text
    job = response.headers["Location"]
    with http.stream("GET", f"{job}/events") as events:
        for _ in events.iter_lines():
            pass
    return http.get(job).json()


def pages(http: httpx.Client, path: str, limit: int, most: int):
    """The items of a list, page by page; fail if it goes on beyond so many pages."""
    cursor = {}
    for _ in range(most):
        page = http.get(path, params={"limit": limit, **cursor}).json()
        assert len(page["items"]) <= limit
        yield from page["items"]
        if page["next"] is None:
            return
        cursor = {"cursor": page["next"]}
    raise AssertionError(f"{path} goes on beyond {most} pages of {limit}")


def created(http: httpx.Client, document: dict) -> dict:
    """A new design once its regeneration has ended, whatever came out."""
    answer = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=60"})
    if answer.status_code == 202:  # it takes more than the minute for which a client may wait
        return settled(http, answer.json()["id"], 240.0)
    assert answer.status_code == 201, answer.text
    return answer.json()


def patched(http: httpx.Client, design: dict, patch: dict) -> dict:
    """A design after a change, once its regeneration has ended, whatever came out."""
    headers = {"If-Match": f'"{design["revision"]}"', "Prefer": "wait=60"}
    answer = http.patch(f"{API}/designs/{design['id']}", json=patch, headers=headers)
    assert answer.status_code == 200, answer.text
    return answer.json()


def revision(http: httpx.Client, design: dict, number: int | None = None) -> dict:
    answer = http.get(f"{API}/designs/{design['id']}/revisions/{number or design['revision']}")
    assert answer.status_code == 200, answer.text
    return answer.json()


def problem(answer: httpx.Response, status: int, slug: str) -> dict:
    """The problem in an answer, which must be of this kind."""
    assert answer.status_code == status, (answer.status_code, answer.text[:2000])
    assert answer.headers["content-type"] == "application/problem+json"
    content = answer.json()
    assert content["type"] == f"/problems/{slug}", content
    assert content["status"] == status
    assert content["title"]
    assert content["detail"]
    return content


def faults(answer: httpx.Response) -> dict[str, str]:
    """The wrong inputs of a refusal: name → code."""
    content = problem(answer, 422, "invalid-inputs")
    assert all(fault["name"] and fault["code"] and fault["detail"] for fault in content["errors"])
    return {fault["name"]: fault["code"] for fault in content["errors"]}


def heard(stream: httpx.Response):
    """The events of a stream: (name, data)."""
    name = None
    for line in stream.iter_lines():
        if line.startswith("event:"):
            name = line.removeprefix("event:").strip()
        elif line.startswith("data:"):
            yield name, json.loads(line.removeprefix("data:"))
