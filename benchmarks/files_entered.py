"""Count the files of `app` and `templates` that a request enters, for the paper's design.

`python -m benchmarks.files_entered` prints them for a change from the merge patch to the checked STEP file
(without HTTP, queue and the kernel's process), and for a PATCH of one closed-form step and an evaluation,
with HTTP. With `--list` it names the files.

A file counts if one of its functions is called while the request is answered, in any thread of the service
except those in `BACKGROUND`, which poll for work. With HTTP a file counts if each of six such requests enters
it, because the thread that writes to the database also serves other requests. Each request is first sent a
few times to warm all caches, each time with a new value.
"""

from __future__ import annotations

import json
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from types import CodeType
from typing import Any

import httpx
import uvicorn

from benchmarks.function_calls import PACKAGES, WARM_UP, Bench, Calls

ROOT = Path(__file__).parents[1]
API = "/api/v1"
COUNTS = 6  # number of requests, each of which must enter a file
PAUSE = 0.1  # [s] before each request, so that work left over from the start ends
QUIET = {"If-Match": "*", "Prefer": "wait=60"}


class Files:
    """The files of each package that one request entered."""

    def __init__(self, functions: Iterable[CodeType], root: Path) -> None:
        names = {Path(code.co_filename).relative_to(root) for code in functions}
        self.by_package = {
            package: sorted(str(name) for name in names if name.parts[0] == package) for package in PACKAGES
        }

    @property
    def app(self) -> int:
        """Return the number of files of `app`."""
        return len(self.by_package["app"])

    @property
    def templates(self) -> int:
        """Return the number of files of `templates`."""
        return len(self.by_package["templates"])


def change_to_step(root: Path = ROOT) -> Files:
    """Return the files that a change enters, from the merge patch to the checked STEP file."""
    from app.designs.bodies import PAPER

    with _profiled(root) as calls, TemporaryDirectory() as folder, ExitStack() as stack:
        bench = Bench(Path(folder), stack)
        design = bench.create(dict(PAPER))
        for turn in range(WARM_UP):
            bench.patch(design, scale(turn))
        with calls.counting():
            bench.patch(design, scale(WARM_UP))
        if not bench.is_current(design):
            raise RuntimeError("the change that was counted did not lead to a solid")
        return Files(calls.counts, root)


def scale(turn: int) -> dict[str, Any]:
    """Return the merge patch that sets another scale of the bearing."""
    return {"parameters": {"scale": f"{1.05 + 0.05 * turn}"}}


def changed_step(root: Path = ROOT) -> Files:
    """Return the files that a PATCH of one closed-form step enters, with HTTP."""
    from app.designs.bodies import PAPER

    document = {name: part for name, part in PAPER.items() if name != "model"}
    with _profiled(root) as calls, TemporaryDirectory() as folder, _server(Path(folder)) as http:
        design = http.post(f"{API}/designs", json=document, headers=QUIET).raise_for_status().json()

        def patch(turn: int) -> httpx.Response:
            change = {"steps": {"film": {"inputs": {"bearing_width": f"{20 + turn} mm"}}}}
            address, minimal = f"{API}/designs/{design['id']}", {"return": "minimal"}
            return http.patch(address, params=minimal, json=change, headers=QUIET)

        return _counted(calls, root, patch)


def evaluation(root: Path = ROOT) -> Files:
    """Return the files that an evaluation of one template enters, with HTTP."""
    from app.calculations.bodies import OIL_FILM

    with _profiled(root) as calls, TemporaryDirectory() as folder, _server(Path(folder)) as http:

        def evaluate(turn: int) -> httpx.Response:
            body = {"inputs": {**OIL_FILM, "bearing_width": f"{20 + turn} mm"}}
            return http.post(f"{API}/templates/oil_film/versions/1/evaluate", json=body)

        return _counted(calls, root, evaluate)


COUNTED: dict[str, Callable[[], Files]] = {
    "PATCH → STEP without HTTP, queue and the kernel's process": change_to_step,
    "PATCH of one closed-form step": changed_step,
    "evaluate": evaluation,
}
"""The kinds of requests whose files are counted."""

LIMITS = dict(zip(COUNTED, (50, 45, 20), strict=True))
"""Largest number of files of `app` that each kind may enter."""


def _counted(calls: Calls, root: Path, ask: Callable[[int], httpx.Response]) -> Files:
    for turn in range(WARM_UP):
        ask(turn).raise_for_status()
    entered = list[set[CodeType]]()
    for turn in range(WARM_UP, WARM_UP + COUNTS):
        time.sleep(PAUSE)
        with calls.counting():
            answer = ask(turn).raise_for_status()
        if not json.loads(answer.content):
            raise RuntimeError("the request that was counted has no answer")
        entered.append(set(calls.counts))
    return Files(set.intersection(*entered), root)


@contextmanager
def _profiled(root: Path) -> Iterator[Calls]:
    """Count the calls of all threads that start in the meantime."""
    calls = Calls(root)
    threading.setprofile(calls)
    try:
        yield calls
    finally:
        threading.setprofile(None)


@contextmanager
def _server(folder: Path) -> Iterator[httpx.Client]:
    """Run the service in a thread of this process."""
    from app.http.server import configuration
    from app.main import create_app
    from app.settings import Settings

    settings = Settings(data=folder / "data")
    with socket.create_server(("127.0.0.1", 0)) as listener:
        server = uvicorn.Server(configuration(create_app(settings), settings))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        url = f"http://127.0.0.1:{listener.getsockname()[1]}"
        try:
            with httpx.Client(base_url=url, trust_env=False, timeout=120) as http:
                yield http
        finally:
            server.should_exit = True
            thread.join()


def main() -> None:
    """Print the counts; with `--list` also the files."""
    for name, count in COUNTED.items():
        files = count()
        print(f"{name}: {files.app} files of app (limit {LIMITS[name]}), {files.templates} of templates")
        for package in ("app", "templates") if "--list" in sys.argv else ():
            print("\n".join(f"  {file}" for file in files.by_package[package]))


if __name__ == "__main__":
    main()
