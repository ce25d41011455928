"""Measure how cost grows with points, mesh, designs, steps, variants and clients.

The script takes about three minutes on two idle cores, prints each line, stores all in
benchmarks/results/growth.json and draws docs/pictures/growth.svg; `python -m benchmarks.growth draw` draws
the picture again from the stored results.

Cost is processor time: of this process for points and meshes, of the service with its descendants for the
others. The exponent of a line is the slope between its last two points in logarithms: 1 means that twice as
many cost twice as much.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import partial
from itertools import count
from pathlib import Path
from statistics import median
from typing import Any

import httpx
import numpy as np

from app.calculations.bodies import OIL_FILM
from benchmarks.processor_time import used
from benchmarks.speed.figures import processor_seconds
from benchmarks.speed.servers import Server, commit, crankwright, machine
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v1 import OilFilm
from templates.physics.films.reynolds import static_film

RESULTS, PICTURE = Path("benchmarks/results/growth.json"), Path("docs/pictures/growth.svg")
POINTS = (1, 10, 100, 1_000, 10_000, 100_000, 1_000_000)
MESHES = (64, 128, 256, 512)  # circumferential cells; an eighth of them axially
DESIGNS = (10, 100, 1_000, 3_000)
STEPS = (1, 3, 10, 30, 100)
VARIANTS = (1, 3, 10, 30, 100)
CLIENTS = (1, 2, 4, 8, 16, 32, 64)
TURNS, SECONDS = 5, 2.0
API = "/api/v1/designs"
STEP: dict[str, Any] = {"template": "oil_film", "version": 1, "inputs": dict(OIL_FILM)}
Line = list[tuple[int, float]]


def points() -> Line:
    """Return the time for all outputs of `oil_film` 1 at this many points in one call [s]."""
    line = []
    for number in POINTS:
        loads = {"value": np.linspace(6.3, 200, number), "unit": "kN"}
        action = partial(evaluate, OilFilm, {**OIL_FILM, "radial_load": loads})
        line.append((number, processor_seconds(action, repeats=3)))
    return line


def meshes() -> Line:
    """Return the time for one Reynolds film, eccentricity ratio 0.8 and B/D 0.5 [s]."""
    line = []
    for around in MESHES:
        action = partial(static_film, 0.8, 0.5, around, around // 8)
        line.append((around * (around // 8), processor_seconds(action, repeats=3)))
    return line


class Served:
    """The service and a client."""

    def __init__(self, server: Server, http: httpx.Client) -> None:
        self.server, self.http = server, http
        self._numbers = count(1)

    def created(self, **design: object) -> dict[str, Any]:
        """Return a new design, as the service returns it."""
        answer = self.http.post(API, json={"name": f"growth {next(self._numbers)}", **design})
        created: dict[str, Any] = answer.raise_for_status().json()
        return created

    def changed(self, design: Mapping[str, Any], *values: str) -> None:
        """Change the parameter `a` of a design, once for each value."""
        place = f"{API}/{design['id']}"
        for value in values:
            tag = self.http.get(place).headers["etag"]
            patch = {"parameters": {"a": value}}
            self.http.patch(place, json=patch, headers={"If-Match": tag}).raise_for_status()

    def looked(self, times: int) -> None:
        """Read the first page of the list of designs."""
        for _ in range(times):
            self.http.get(API).raise_for_status()

    def spent(self, actions: Iterable[Callable[[], object]]) -> float:
        """Return the median processor time of all actions but the first [s]."""
        times = []
        for action in actions:
            before = used(self.server.pid)
            action()
            times.append(used(self.server.pid) - before)
        return median(times[1:])

    def loads_spent(self, design: Mapping[str, Any]) -> float:
        """Return the median processor time of ten changes of `a`, a load [s].

        Ten are measured together, because one takes only a few clock ticks.
        """
        tens = [[f"{21 + turn}.{n} kN" for n in range(10)] for turn in range(TURNS + 1)]
        return self.spent(partial(self.changed, design, *ten) for ten in tens)


@contextmanager
def serving() -> Iterator[Served]:
    """Yield a new service on an empty folder."""
    with (
        tempfile.TemporaryDirectory() as folder,
        crankwright(Path(folder)) as server,
        httpx.Client(base_url=server.url, timeout=300, trust_env=False) as http,
    ):
        time.sleep(4)  # the service forks its first processes
        yield Served(server, http)


def designs() -> dict[str, Line]:
    """Return the times of ten changes and ten reads of the first list page, with this many designs [s]."""
    change: Line = []
    look: Line = []
    with serving() as it:
        one, stored = it.created(parameters={"a": "0"}), 1
        for number in DESIGNS:
            while stored < number:
                it.created(parameters={"a": "0"})
                stored += 1
            values = [[f"{number + turn}.{n}" for n in range(10)] for turn in range(TURNS + 1)]
            change.append((number, it.spent(partial(it.changed, one, *ten) for ten in values)))
            look.append((number, it.spent([partial(it.looked, 10)] * (TURNS + 1))))
    return {"designs: ten changes of one": change, "designs: ten looks at the list": look}


def steps() -> Line:
    """Return the times of ten changes of a design with this many steps that all use the changed value [s]."""
    line = []
    with serving() as it:
        for number in STEPS:
            inputs = {**OIL_FILM, "radial_load": "= a"}
            many = {f"film_{n}": {**STEP, "inputs": inputs} for n in range(number)}
            design = it.created(parameters={"a": "20 kN"}, steps=many)
            line.append((number, it.loads_spent(design)))
    return line


def variants() -> Line:
    """Return the times of ten changes that affect all of this many variants of a design [s]."""
    line = []
    with serving() as it:
        for number in VARIANTS:
            inputs = {**OIL_FILM, "radial_load": "= a", "bearing_width": "= width"}
            own = {f"bearing_{n}": {"width": f"{15 + n / 16} mm"} for n in range(number)}
            design = it.created(
                parameters={"a": "20 kN", "width": "18 mm"},
                steps={"film": {**STEP, "inputs": inputs}},
                variants=own,
            )
            line.append((number, it.loads_spent(design)))
    return line


def clients() -> Line:
    """Return the time of one evaluation of one output while this many clients ask at once [s]."""
    body = {"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]}
    line = []
    with serving() as it:

        def asking(_: int) -> int:
            end, asked = time.monotonic() + SECONDS, 0
            with httpx.Client(base_url=it.server.url, timeout=60, trust_env=False) as http:
                while time.monotonic() < end:
                    http.post("/api/v1/templates/oil_film/versions/1/evaluate", json=body).raise_for_status()
                    asked += 1
            return asked

        for number in CLIENTS:
            before = used(it.server.pid)
            with ThreadPoolExecutor(number) as pool:
                asked = sum(pool.map(asking, range(number)))
            line.append((number, (used(it.server.pid) - before) / asked))
    return line


def exponent(line: Line) -> float:
    """Return the slope of the last two points in logarithms."""
    (few, cheap), (many, expensive) = line[-2:]
    return float(np.log(expensive / cheap) / np.log(many / few))


def measured() -> dict[str, Line]:
    """Return every line by its name, printed as it ends."""
    lines: dict[str, Line] = {}
    for name, measure in {
        "points: all outputs of `oil_film` 1": points,
        "mesh: unknowns of one Reynolds film": meshes,
        "steps: ten changes that all read": steps,
        "variants: ten changes that all read": variants,
        "clients: one evaluation": clients,
    }.items():
        lines[name] = measure()
        print(name, lines[name], flush=True)
    lines |= designs()
    print(lines, flush=True)
    return lines


def draw(kept: Mapping[str, Any]) -> None:
    """Draw all lines: cost against number, in logarithmic scales."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    matplotlib.rcParams["svg.hashsalt"] = "crankwright"
    figure, axes = plt.subplots(2, 3, figsize=(12, 6.4), layout="constrained", sharey=False)
    for panel, kind in zip(
        axes.flat, ("points", "mesh", "designs", "steps", "variants", "clients"), strict=True
    ):
        for name, line in kept["lines"].items():
            if name.startswith(kind + ":"):
                label = f"{name.partition(': ')[2].replace('`', '')}, exponent {exponent(line):.2f}"
                panel.loglog(*zip(*line, strict=True), "o-", label=label)
        low, high = panel.get_ylim()
        panel.set_ylim(low / 3, high * 3)
        panel.set(xlabel=kind, ylabel="processor time [s]")
        panel.grid(color="0.9")
        panel.legend(fontsize=8, loc="best")
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE, metadata={"Date": None})
    print(PICTURE, PICTURE.stat().st_size // 1000, "kB")


def main() -> None:
    """Measure and draw, or draw the stored results."""
    if sys.argv[1:] != ["draw"]:
        load = os.getloadavg()
        lines = measured()
        kept = {
            "date": datetime.now(UTC).isoformat(timespec="seconds"),
            "commit": commit(),
            "machine": machine(),
            "load_average": {"before": load, "after": os.getloadavg()},
            "lines": lines,
            "exponents": {name: round(exponent(line), 2) for name, line in lines.items()},
        }
        RESULTS.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    draw(json.loads(RESULTS.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
