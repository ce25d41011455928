"""Measure the service over HTTP: evaluations, changes, regenerations, a large array, pages, its start."""

from __future__ import annotations

import json
import multiprocessing
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import ExitStack
from itertools import count
from pathlib import Path
from statistics import median, quantiles
from typing import Any

import cadquery as cq
import httpx
import numpy as np
from pydantic_core import to_json

from app.calculations import json_values
from app.calculations.array_files import NPY, npy
from app.calculations.bodies import OIL_FILM
from app.designs.bodies import PAPER
from benchmarks.processor_time import proportional_megabytes, used
from benchmarks.speed.figures import Figure, processor_seconds
from benchmarks.speed.load import answered
from benchmarks.speed.servers import Server, bare, crankwright
from cad.catalogue import models
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v1 import OilFilm

EVALUATE, DESIGNS = "/api/v1/templates/oil_film/versions/1/evaluate", "/api/v1/designs"
QUESTIONS: dict[str, dict[str, Any]] = {
    "one output": {"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]},
    "all outputs": {"inputs": OIL_FILM},
}
MINIMAL = {"return": "minimal"}
ROUNDS = 5
CLIENTS, PROCESSES, SECONDS = 32, 4, 6.0
STEPS = 60
POINTS = 10**6
SETTLING = 2.0  # pause after a change, in which the service prepares its next job [s]


def figures() -> list[Figure]:
    """Measure all figures of the service, on one server."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        begin = time.perf_counter()
        server = stack.enter_context(crankwright(folder))
        ready = time.perf_counter() - begin
        time.sleep(2 * SETTLING)
        memory = proportional_megabytes(server.pid)
        at_rest = "proportional set size, idle"
        rows = [
            Figure("`serve` until ready", ready, "s", 3.0, detail="wall time"),
            Figure("its memory, all processes", memory, "MB", 500.0, detail=at_rest),
        ]
        evaluations, alone = evaluating(server, folder)
        rows += evaluations + changes(server, alone)
        for measure in (regenerations, large_arrays, pages):
            rows += measure(server, folder)
    return rows


def evaluating(server: Server, folder: Path) -> tuple[list[Figure], float]:
    """Measure `evaluate` and a bare endpoint with the same body and answer [s]."""
    with httpx.Client(base_url=server.url, trust_env=False) as http:
        answers = {name: http.post(EVALUATE, json=asked).json() for name, asked in QUESTIONS.items()}
    file, rows, least = folder / "answers.json", [], np.inf
    file.write_text(json.dumps(answers))
    with bare(file) as plain:
        for (name, asked), aim in zip(QUESTIONS.items(), (2.2, None), strict=True):
            body, own, others = json.dumps(asked).encode(), [], []
            for turn in range(ROUNDS + 1):
                mine = cost(server, EVALUATE, body)
                other = cost(plain, f"/{name.replace(' ', '%20')}", body)
                if turn:  # the first call warms up
                    own.append(mine)
                    others.append(other)
            ratio = median(np.divide(own, others).tolist())
            detail = (
                f"processor time over the bare endpoint, {1e6 * median(own):.0f} µs; median of {ROUNDS} turns"
            )
            rows.append(
                Figure(f"`evaluate`, {name}, against bare FastAPI", ratio, "times", aim, detail=detail)
            )
            least = min(least, median(others))
    return rows, least


def cost(server: Server, path: str, body: bytes) -> float:
    """Return the processor time of the server for one of many requests [s]."""
    before = server.processor_seconds()
    number = answered(server.url + path, body, 1.0)
    return (server.processor_seconds() - before) / number


def changes(server: Server, alone: float) -> list[Figure]:
    """Measure creates and changes of designs without geometry by 32 clients at once."""
    rows = []
    kinds = {"creates": create, "PATCHes": change}
    with ProcessPoolExecutor(PROCESSES, mp_context=multiprocessing.get_context("spawn")) as pool:
        list(pool.map(abs, range(PROCESSES)))  # waits until the processes have started
        for name, action in kinds.items():
            before, begin = used(server.pid), time.perf_counter()
            runs = [pool.submit(clients, action, server.url, f"{name} {n}") for n in range(PROCESSES)]
            delays = [delay for run in runs for delay in run.result()]
            spent, clock = (used(server.pid) - before) / len(delays), time.perf_counter() - begin
            rate = f"{len(delays) / clock:.0f} per second while the clients also run"
            rows.append(Figure(f"accepted {name}, {CLIENTS} clients", 1e3 * spent, "ms", 1.0, detail=rate))
            slow = 1e3 * quantiles(delays, n=100)[98]
            rows.append(Figure("their 99th percentile", slow, "ms", 50.0, detail="wall time"))
    against = "processor time relative to the bare endpoint of one output"
    rows.append(Figure("PATCH against bare FastAPI", spent / alone, "times", 12.0, detail=against))
    return rows


def clients(action: Callable[[str, str, float], list[float]], url: str, name: str) -> list[float]:
    """Return the response times of several clients in threads of this process [s]."""
    number = CLIENTS // PROCESSES
    with ThreadPoolExecutor(number) as pool:
        runs = [pool.submit(action, url, f"{name} {n}", SECONDS) for n in range(number)]
        return [delay for run in runs for delay in run.result()]


def create(url: str, name: str, seconds: float) -> list[float]:
    """Create designs for some time; return the response time of each [s]."""
    with httpx.Client(base_url=url, timeout=60, trust_env=False) as http:

        def once(number: int) -> None:
            body = {"name": f"{name} {number}", "parameters": {"a": "0"}}
            http.post(DESIGNS, params=MINIMAL, json=body).raise_for_status()

        return delays(once, seconds)


def change(url: str, name: str, seconds: float) -> list[float]:
    """Change one design for some time; return the response time of each accepted change [s]."""
    with httpx.Client(base_url=url, timeout=60, trust_env=False) as http:
        design = http.post(DESIGNS, json={"name": name, "parameters": {"a": "0"}}).raise_for_status().json()

        def once(number: int) -> None:
            headers = {"If-Match": f'"{number}"', "Idempotency-Key": f"{name} {number}"}
            patch = {"parameters": {"a": str(number)}}
            address = f"{DESIGNS}/{design['id']}"
            http.patch(address, params=MINIMAL, json=patch, headers=headers).raise_for_status()

        return delays(once, seconds)


def delays(action: Callable[[int], None], seconds: float) -> list[float]:
    """Repeat an action for some time; return the time of each repetition [s]."""
    taken = []
    end = time.monotonic() + seconds
    for number in count(1):
        start = time.monotonic()
        if start >= end:
            break
        action(number)
        taken.append(time.monotonic() - start)
    return taken


def regenerations(server: Server, folder: Path) -> list[Figure]:
    """Measure PATCH → new STEP relative to the model's build and export, in processor time."""
    ratios, ours, alone = [], [], []
    with httpx.Client(
        base_url=server.url, trust_env=False, timeout=90, headers={"Prefer": "wait=60"}
    ) as http:
        answer = http.post(DESIGNS, json=PAPER).raise_for_status()
        place = f"{DESIGNS}/{answer.json()['id']}"
        for turn in range(ROUNDS + 1):
            bore = 50 + 0.37 * turn
            time.sleep(SETTLING)
            before = used(server.pid)
            patch = {"parameters": {"scale": f"{bore / 48!r}"}}
            answer = http.patch(place, json=patch, headers={"If-Match": answer.headers["ETag"]})
            assert answer.raise_for_status().json()["state"] == "current", answer.text
            http.get(f"{place}/model.step").raise_for_status()
            spent = used(server.pid) - before
            own = time.process_time()
            build(bore, folder / "bare.step")
            own = time.process_time() - own
            if turn:
                ours.append(1e3 * spent)
                alone.append(1e3 * own)
                ratios.append(spent / own)
    detail = f"{median(ours):.0f} ms and {median(alone):.0f} ms; median of {ROUNDS} turns"
    return [Figure("PATCH → new STEP, against build and export", median(ratios), "times", 4.3, detail=detail)]


def build(inner_diameter: float, file: Path) -> None:
    """Build the same ball bearing [mm] by the model's `build()`, and export it by CadQuery."""
    model = models().get("ball_bearing", 1).from_quantities({"inner_diameter": f"{inner_diameter!r} mm"})
    assembly = cq.Assembly(name="ball_bearing")
    for part in model.build():
        for name, place in zip(part.names, part.places, strict=True):
            assembly.add(part.solid, name=name, loc=place, color=cq.Color(*part.colour))
    assembly.export(str(file))


def large_arrays(server: Server, folder: Path) -> list[Figure]:
    """Return the cost of writing the answer of 10⁶ values, in both forms, without the calculation."""
    loads = np.round(np.linspace(6.3, 200, POINTS), 3)
    inputs = {**OIL_FILM, "radial_load": {"value": loads, "unit": "kN"}}
    result = evaluate(OilFilm, inputs, outputs=["minimum_film_thickness"])
    result.inputs.clear()  # the response repeats the request's inputs
    forms: dict[str, tuple[Callable[[], bytes], float | None]] = {
        "JSON": (lambda: to_json(json_values.evaluation(result)), None),
        NPY: (lambda: npy(result), 10.0),
    }
    return [
        Figure(
            f"10⁶ values as {name}",
            1e3 * processor_seconds(write),
            "ms",
            aim,
            detail=f"{len(write()) / 1e6:.1f} MB; only writing",
        )
        for name, (write, aim) in forms.items()
    ]


def pages(server: Server, folder: Path) -> list[Figure]:
    """Return the cost of the page of a design with 60 steps, repeated and after a change, and of its report.

    The cost is the processor time of all processes.
    """
    step = {"template": "oil_film", "version": 1}
    steps = {
        f"film_{n}": {**step, "inputs": {**OIL_FILM, "radial_load": f"{20 + n / 7} kN"}} for n in range(STEPS)
    }
    with httpx.Client(
        base_url=server.url, trust_env=False, timeout=300, headers={"Prefer": "wait=240"}
    ) as http:
        made = http.post(DESIGNS, json={"name": "sixty films", "steps": steps}).raise_for_status()
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
