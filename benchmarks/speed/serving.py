"""The service over HTTP: evaluations, changes, regenerations, a large array, a page, a report, its start."""

from __future__ import annotations

import multiprocessing
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from itertools import count
from pathlib import Path
from statistics import median, quantiles

import httpx
import numpy as np
from pydantic_core import to_json

from app.calculations import rendering
from app.calculations.array_files import NPY, npy
from app.calculations.schemas import OIL_FILM
from benchmarks import databases, service, service_cad, service_process
from benchmarks.processor_time import proportional_megabytes, used
from benchmarks.service_process import Server
from benchmarks.speed.figures import Figure, processor_seconds
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v1 import OilFilm

ROUNDS = 5
CLIENTS, PROCESSES, SECONDS = 32, 4, 6.0
STEPS = 60
POINTS = 10**6
SETTLING = 2.0  # after a change: the service prepares its next job [s]


def figures() -> list[Figure]:
    """All lines of the service, from one server."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        begin = time.perf_counter()
        server = stack.enter_context(service_process.crankwright(folder))
        ready = time.perf_counter() - begin
        time.sleep(2 * SETTLING)
        rows = [
            Figure("`serve` to ready", ready, "s", 2.0, detail="by the clock"),
            Figure(
                "its memory, all processes",
                proportional_megabytes(server.pid),
                "MB",
                500.0,
                detail="proportional set size, at rest",
            ),
        ]
        for measure in (evaluations, changes, regenerations, large_arrays, pages):
            rows += measure(server, folder)
    return rows


def evaluations(server: Server, folder: Path) -> list[Figure]:
    """`evaluate`, against a bare endpoint that returns the same answer: ratio of processor times."""
    rows = service.evaluations(server, folder, ROUNDS)
    costs = [row for row in rows if row.what.startswith("processor time")]
    return [
        Figure(
            f"`evaluate`, {row.what.removeprefix('processor time, ')}, against bare FastAPI",
            1 / float(row.ratio or np.nan),
            "",
            aim,
            is_floor=True,
            detail=f"bare processor time over ours, {row.median:.0f} µs; median of {ROUNDS} turns",
        )
        for row, aim in zip(costs, (0.75, None), strict=True)
    ]


def changes(server: Server, folder: Path) -> list[Figure]:
    """Creates and changes of designs without geometry by 32 clients at once."""
    rows = []
    kinds = {"creates": create, "PATCHes": databases.change}
    with ProcessPoolExecutor(PROCESSES, mp_context=multiprocessing.get_context("spawn")) as pool:
        list(pool.map(abs, range(PROCESSES)))  # they are there
        for name, action in kinds.items():
            before, begin = used(server.pid), time.perf_counter()
            runs = [pool.submit(clients, action, server.url, f"{name} {n}") for n in range(PROCESSES)]
            delays = [delay for run in runs for delay in run.result()]
            spent, clock = used(server.pid) - before, time.perf_counter() - begin
            rate = f"{len(delays) / clock:.0f} a second beside the clients"
            each, slow = 1e3 * spent / len(delays), 1e3 * quantiles(delays, n=100)[98]
            rows += [
                Figure(f"accepted {name}, {CLIENTS} clients", each, "ms", 1.0, detail=rate),
                Figure("their 99th percentile", slow, "ms", 50.0, detail="by the clock"),
            ]
    return rows


def clients(action: Callable[[str, str, float], list[float]], url: str, name: str) -> list[float]:
    """The delays of several clients, in threads of this process [s]."""
    from concurrent.futures import ThreadPoolExecutor

    number = CLIENTS // PROCESSES
    with ThreadPoolExecutor(number) as pool:
        runs = [pool.submit(action, url, f"{name} {n}", SECONDS) for n in range(number)]
        return [delay for run in runs for delay in run.result()]


def create(url: str, name: str, seconds: float) -> list[float]:
    """Create designs for some time; the delay of each [s]."""
    delays = []
    with httpx.Client(base_url=url, timeout=60, trust_env=False) as http:
        end = time.monotonic() + seconds
        for number in count():
            start = time.monotonic()
            if start >= end:
                break
            body = {"name": f"{name} {number}", "parameters": {"a": "0"}}
            http.post("/api/v1/designs", json=body).raise_for_status()
            delays.append(time.monotonic() - start)
    return delays


def regenerations(server: Server, folder: Path) -> list[Figure]:
    """PATCH → new STEP against the model's own build and export: processor time of all processes."""
    changing, file = service.Changes(server), folder / "bare.step"
    ratios, ours, bare = [], [], []
    for turn in range(ROUNDS + 1):
        bore = 50 + 0.37 * turn
        time.sleep(SETTLING)
        before = used(server.pid)
        changing.regenerated(bore)
        spent = used(server.pid) - before
        own = time.process_time()
        service_cad.model_alone(bore, file)
        alone = time.process_time() - own
        if turn:
            ours.append(1e3 * spent)
            bare.append(1e3 * alone)
            ratios.append(spent / alone)
    detail = f"{median(ours):.0f} ms of {median(bare):.0f} ms; median of {ROUNDS} turns"
    return [Figure("PATCH → new STEP, against build and export", median(ratios), "times", 3.0, detail=detail)]


def large_arrays(server: Server, folder: Path) -> list[Figure]:
    """Cost of writing the answer of 10⁶ values, in both forms, without the calculation."""
    loads = np.round(np.linspace(6.3, 200, POINTS), 3)
    inputs = {**OIL_FILM, "radial_load": {"value": loads, "unit": "kN"}}
    result = evaluate(OilFilm, inputs, outputs=["minimum_film_thickness"])
    result.inputs.clear()  # the echo is what was sent
    forms = {"JSON": (lambda: to_json(rendering.evaluation(result)), None), NPY: (lambda: npy(result), 10.0)}
    return [
        Figure(
            f"10⁶ values as {name}",
            1e3 * processor_seconds(write),
            "ms",
            aim,
            detail=f"{len(write()) / 1e6:.1f} MB; writing alone",
        )
        for name, (write, aim) in forms.items()
    ]


def pages(server: Server, folder: Path) -> list[Figure]:
    """The page of a design of 60 steps, again and after a change, and its report: time of all processes."""
    step = {"template": "oil_film", "version": 1}
    steps = {
        f"film_{n}": {**step, "inputs": {**OIL_FILM, "radial_load": f"{20 + n / 7} kN"}} for n in range(STEPS)
    }
    with httpx.Client(
        base_url=server.url, trust_env=False, timeout=300, headers={"Prefer": "wait=240"}
    ) as http:
        made = http.post("/api/v1/designs", json={"name": "sixty films", "steps": steps}).raise_for_status()
        place = f"/designs/{made.json()['id']}"
        time.sleep(2 * SETTLING)
        page = [_spent(server, lambda: http.get(place).raise_for_status()) for _ in range(ROUNDS)]
        changed = []
        for turn in range(ROUNDS):
            change = {"steps": {"film_3": {"inputs": {"radial_load": f"{40 + turn / 7} kN"}}}}
            http.patch(f"/api/v1{place}", json=change, headers={"If-Match": "*"}).raise_for_status()
            time.sleep(SETTLING)
            changed.append(_spent(server, lambda: http.get(place).raise_for_status()))
        report = _spent(server, lambda: _whole(http, f"/api/v1{place}/report.pdf"))
    return [
        Figure(f"page of a design of {STEPS} steps", min(page), "s", 0.08, detail=f"least of {ROUNDS}"),
        Figure("the page after a change of one step", min(changed), "s", None, detail=f"least of {ROUNDS}"),
        Figure("its report as PDF", report, "s", 2.0, detail="once"),
    ]


def _whole(http: httpx.Client, place: str) -> None:
    answer = http.get(place, headers={"Accept": "application/pdf"})
    while answer.status_code == 202:
        time.sleep(0.5)
        answer = http.get(place, headers={"Accept": "application/pdf"})
    assert answer.raise_for_status().content.startswith(b"%PDF")


def _spent(server: Server, action: Callable[[], object]) -> float:
    before = used(server.pid)
    action()
    return used(server.pid) - before
