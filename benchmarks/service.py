"""The service against what it is made of, as ratios in one run: the aims of issue 2.

python -m benchmarks.service           measures; four minutes on two cores
python -m benchmarks.service quick     with few repeats

Every comparison is interleaved: service and baseline take turns, a ratio is that of one turn, and the table
shows the median of the ratios with their quartiles, which tell the noise. Times depend on what else the
machine does, ratios hardly: the load average stands in the results. Writes `benchmarks/results/service.json`.
"""

import http.client
import json
import os
import sqlite3
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from app.calculations.schemas import OIL_FILM
from app.designs.schemas import PAPER
from benchmarks import service_cad, service_hostile, service_load, service_process
from benchmarks.service_process import Server
from benchmarks.service_rows import Row, commit, judged, line, machine, milliseconds, row
from cad.regenerate import regenerate
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v1 import OilFilm
from templates.physics.journals.oil import density, double_logarithm, temperature_logarithm, walther
from templates.physics.numerics.power_fit import exponent_k2, factor_k1

RESULTS = Path("benchmarks/results/service.json")
EVALUATE = "/api/v1/templates/oil_film/versions/1/evaluate"
QUESTIONS: dict[str, dict[str, Any]] = {
    "one output": {"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]},
    "all outputs": {"inputs": OIL_FILM},
}
POINTS = 10**6
PAUSE = 0.5  # around a change, as between the changes of one user: the service prepares its next job [s]
QUICK = "quick" in sys.argv[1:]


# (a) ------------------------------------------------------------------------------------------------------


def evaluations(server: Server, folder: Path, rounds: int) -> list[Row]:
    """Requests per second of `evaluate`, and the server's processor time, against bare FastAPI."""
    with httpx.Client(base_url=server.url, trust_env=False) as http:
        answers = {name: http.post(EVALUATE, json=asked).json() for name, asked in QUESTIONS.items()}
    file = folder / "answers.json"
    file.write_text(json.dumps(answers))
    rows = []
    with service_process.bare(file) as plain:
        for name, asked in QUESTIONS.items():
            places = {
                "service": (server, EVALUATE),
                "bare FastAPI": (plain, f"/dict/{name.replace(' ', '%20')}"),
                "bare FastAPI, ready bytes": (plain, f"/ready/{name.replace(' ', '%20')}"),
            }
            body = json.dumps(asked).encode()
            rows += _compared(name, places, body, rounds)
    return rows


def _compared(name: str, places: dict[str, tuple[Server, str]], body: bytes, rounds: int) -> list[Row]:
    rates: dict[str, list[float]] = {place: [] for place in places}
    costs: dict[str, list[float]] = {place: [] for place in places}
    for turn in range(rounds + 1):
        for place, (server, path) in places.items():
            used = server.processor_seconds()
            start = time.perf_counter()
            rate = service_load.requests_per_second(server.url + path, body, 1.0)
            requests = rate * (time.perf_counter() - start)
            if turn:  # the first warms up
                rates[place].append(rate)
                costs[place].append(1e6 * (server.processor_seconds() - used) / requests)
    ours, ready = rates["service"], "bare FastAPI, ready bytes"
    rate = row(
        "a", f"evaluate, {name}", "1/s", ours, baseline=rates["bare FastAPI"], against="bare FastAPI, dict"
    )
    return [
        judged(rate, "≥ 0.5", ratio_at_least=0.5),
        row("a", f"evaluate, {name}", "1/s", ours, baseline=rates[ready], against=ready),
        row("a", f"bare FastAPI, {name}", "1/s", rates["bare FastAPI"]),
        row(
            "a",
            f"processor time, {name}",
            "us",
            costs["service"],
            baseline=costs["bare FastAPI"],
            against="bare FastAPI, dict",
        ),
    ]


# (b), (c) -------------------------------------------------------------------------------------------------


class Changes:
    """One design that is changed again and again."""

    def __init__(self, server: Server) -> None:
        self.http = httpx.Client(
            base_url=server.url, trust_env=False, timeout=90, headers={"Prefer": "wait=60"}
        )
        answer = self.http.post("/api/v1/designs", json=PAPER)
        answer.raise_for_status()
        self.place, self.tag = f"/api/v1/designs/{answer.json()['id']}", answer.headers["ETag"]

    def change(self, patch: dict[str, Any]) -> None:
        """A new revision, regenerated."""
        answer = self.http.patch(self.place, json=patch, headers={"If-Match": self.tag})
        answer.raise_for_status()
        self.tag = answer.headers["ETag"]
        assert answer.status_code == 200, answer.text
        assert answer.json()["state"] == "current", answer.text

    def regenerated(self, diameter: float) -> bytes:
        """The STEP file of a new bore [mm]."""
        self.change({"parameters": {"scale": f"{diameter / 48!r}"}})
        answer = self.http.get(f"{self.place}/model.step")
        answer.raise_for_status()
        return answer.content

    def build(self) -> str:
        """The key of the model's build."""
        number = self.tag.strip('"')
        revision = self.http.get(f"{self.place}/revisions/{number}").raise_for_status().json()
        return str(revision["models"]["model"]["build"])


def regenerations(server: Server, folder: Path, rounds: int) -> list[Row]:
    """PATCH → the new STEP downloaded, against CadQuery alone in this process, a new bore each turn."""
    changes, file = Changes(server), folder / "bare.step"
    ours, inside = [], []
    bare: dict[str, list[float]] = {name: [] for name in service_cad.BASELINES}
    alike = [service_cad.volume(make(50.0, file)) for make in service_cad.BASELINES.values()]
    assert np.ptp(alike) < 1e-9 * alike[0], f"the baselines are not the same bearing: {alike}"
    for turn in range(rounds + 2):
        bore = 50 + 0.37 * turn
        time.sleep(PAUSE)
        taken = milliseconds(lambda: changes.regenerated(bore))  # noqa: B023 - called at once
        time.sleep(PAUSE)
        alone = milliseconds(lambda: regenerate("ball_bearing", 1, {"inner_diameter": bore / 1e3}))  # noqa: B023
        both = {n: milliseconds(lambda: make(bore, file)) for n, make in service_cad.BASELINES.items()}  # noqa: B023
        if turn > 1:
            ours.append(taken)
            inside.append(alone)
            for name in bare:
                bare[name].append(both[name])
    own, script = service_cad.BASELINES
    what = "PATCH → new STEP"
    return [
        judged(row("b", what, "ms", ours, baseline=bare[own], against=own), "< 3", ratio_below=3),
        judged(
            row("b", what, "ms", ours, baseline=bare[script], against=script),
            "< 3, < 200 ms idle",
            ratio_below=3,
            below=200,
        ),
        row("b", what, "ms", ours, baseline=inside, against="its regenerate(), alone, with checks"),
        row("b", "regenerate() alone, with checks", "ms", inside, baseline=bare[own], against=own),
        *(row("b", f"baseline: {name}", "ms", bare[name]) for name in bare),
    ]


def quiet_changes(server: Server, folder: Path, rounds: int) -> list[Row]:
    """PATCH that changes no parameter of the model, against one synced commit of SQLite."""
    changes = Changes(server)
    before, ours, commits = changes.build(), [], []
    database = sqlite3.connect(folder / "bare.sqlite", isolation_level=None)
    database.executescript("PRAGMA journal_mode = wal; PRAGMA synchronous = full; CREATE TABLE t (a TEXT)")
    for turn in range(rounds + 3):
        time.sleep(PAUSE / 10)
        load = {"steps": {"film": {"inputs": {"radial_load": f"{25 + 0.1 * turn!r} kN"}}}}
        taken = milliseconds(lambda: changes.change(load))  # noqa: B023 - called at once
        alone = milliseconds(lambda: database.execute("INSERT INTO t VALUES (?)", ["x" * 2000]))
        if turn > 2:
            ours.append(taken)
            commits.append(alone)
    assert changes.build() == before, "the model was rebuilt"
    database.close()
    measured = row(
        "c", "PATCH of the load only", "ms", ours, baseline=commits, against="one synced SQLite commit"
    )
    return [judged(measured, "< 10 ms", below=10)]


# (d) ------------------------------------------------------------------------------------------------------


def arrays(server: Server, folder: Path, rounds: int) -> list[Row]:
    """A million points in one call, in this process, against the same worksheet in plain NumPy."""
    loads = np.round(np.linspace(6.3, 200, POINTS), 3)  # as typed: the body stays below its limit
    one = {**OIL_FILM, "radial_load": {"value": loads, "unit": "kN"}}
    typed = {**OIL_FILM, "radial_load": {"value": loads.tolist(), "unit": "kN"}}
    thickness = ["minimum_film_thickness"]
    actions: dict[str, Callable[[], Any]] = {
        "NumPy": lambda: worksheet(1e3 * loads),
        "10⁶ points, one output": lambda: evaluate(OilFilm, one, outputs=thickness),
        "10⁶ points, all outputs": lambda: evaluate(OilFilm, one),
        "10⁶ points, one output, from a list": lambda: evaluate(OilFilm, typed, outputs=thickness),
    }
    thicknesses = actions["10⁶ points, one output"]().outputs[thickness[0]].value
    assert np.allclose(thicknesses, 1e6 * actions["NumPy"](), rtol=1e-12)
    taken: dict[str, list[float]] = {name: [] for name in actions}
    for _ in range(rounds):
        for name, action in actions.items():
            taken[name].append(milliseconds(action))
    plain = taken.pop("NumPy")
    against = "the worksheet in NumPy"
    rows = [
        judged(row("d", name, "ms", values, baseline=plain, against=against), "< 1 s", below=1000)
        for name, values in taken.items()
    ]
    body = json.dumps({"inputs": typed, "outputs": thickness}).encode()
    with httpx.Client(base_url=server.url, trust_env=False, timeout=90) as http:
        headers = {"Content-Type": "application/json"}
        whole = [
            milliseconds(lambda: http.post(EVALUATE, content=body, headers=headers).raise_for_status())
            for _ in range(max(3, rounds // 2))
        ]
    return [*rows, row("d", "10⁶ points, one output, by REST", "ms", whole)]


def worksheet(F: Any) -> Any:
    """oil_film 1 at its example, for many loads [N]: the minimum film thickness [m]."""
    c, D, W, omega = 55e-6, 48e-3, 18e-3, 5000 * 2 * np.pi / 60
    T = (80 + 87.762) / 2 + 273.15
    B = (double_logarithm(110e-6) - double_logarithm(14.5e-6)) / (
        temperature_logarithm(373.15) - temperature_logarithm(313.15)
    )
    A = double_logarithm(14.5e-6) + B * temperature_logarithm(373.15)
    eta = walther(A, B, T) * density(875, T, 293.15)
    C = c / (D - c)
    S_0 = F * C**2 / (D * W * eta * omega)
    return D * C * (1 - factor_k1(S_0) * S_0 ** exponent_k2(S_0)) / 2


# (e) ------------------------------------------------------------------------------------------------------


def health(server: Server, folder: Path, rounds: int) -> list[Row]:
    """Time of /healthz, idle and while a job loops for ever, in turns."""
    count, times = 100 if QUICK else 500, {"idle": [], "a job loops": []}
    with httpx.Client(base_url=server.url, trust_env=False, timeout=90) as http:
        for turn in range(rounds):
            times["idle"].append(pings(server, count))
            job = looping(http, turn)
            times["a job loops"].append(pings(server, count))
            assert http.get(job).json()["state"] == "running", "the job does not loop"
            http.delete(job).raise_for_status()
            time.sleep(PAUSE)
    rows = []
    for part in (50, 99):
        of = {when: [float(np.percentile(turn, part)) for turn in turns] for when, turns in times.items()}
        measured = row(
            "e",
            f"/healthz p{part}, a job loops",
            "ms",
            of["a job loops"],
            baseline=of["idle"],
            against="the same, idle",
        )
        rows.append(judged(measured, "< 50 ms", below=50) if part == 99 else measured)
    return [
        *rows,
        row(
            "e", "/healthz slowest of a turn, a job loops", "ms", [max(turn) for turn in times["a job loops"]]
        ),
    ]


def looping(http: httpx.Client, turn: int) -> str:
    """Start a job that loops, and wait until it does; its place."""
    asked = {"parameters": {"size": f"{turn + 1} mm"}, "artifacts": ["step"]}
    place = "/api/v1/models/loops/versions/1/build"
    job = http.post(place, json=asked, headers={"Prefer": "respond-async"}).headers["Location"]
    while http.get(job).json()["state"] != "running":
        time.sleep(0.02)
    return job


def pings(server: Server, count: int) -> list[float]:
    """Times of /healthz on one kept connection [ms]."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)

    def ping() -> None:
        connection.request("GET", "/healthz")
        assert connection.getresponse().read() == b'{"status":"ok"}'

    taken = []
    for _ in range(count):
        taken.append(milliseconds(ping))
        time.sleep(0.002)
    connection.close()
    return taken


# (f) ------------------------------------------------------------------------------------------------------


def hostile(server: Server, folder: Path, rounds: int) -> list[Row]:
    """Every hostile input, to its whole answer; the slowest of its repeats is printed too."""
    rows = []
    for name, times in service_hostile.measure(server, service_hostile.CASES, rounds).items():
        refused = all(400 <= status < 500 for status in times["statuses"])
        rows.append(judged(_refusal("f", name, times), "4xx < 100 ms", below=100 if refused else 0))
    beyond = service_hostile.measure(server, service_hostile.LARGEST, 3)
    return [*rows, *(_refusal("f+", name, times) for name, times in beyond.items())]


def _refusal(part: str, name: str, times: dict[str, Any]) -> Row:
    statuses = "/".join(map(str, sorted(times["statuses"])))
    return row(part, f"{name} → {statuses}, slowest {max(times['ms']):.3g}", "ms", times["ms"])


# ----------------------------------------------------------------------------------------------------------

PARTS: dict[str, tuple[Callable[[Server, Path, int], list[Row]], int]] = {
    "a": (evaluations, 9),
    "b": (regenerations, 15),
    "c": (quiet_changes, 60),
    "d": (arrays, 9),
    "e": (health, 7),
    "f": (hostile, 7),
}


def main() -> None:
    """Measure what is named (a to f; all, if nothing is), print the table, write the results if all is."""
    wanted = [name for name in sys.argv[1:] if name in PARTS] or list(PARTS)
    before, rows = os.getloadavg(), []
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        server = stack.enter_context(service_process.crankwright(folder))
        for name in wanted:
            measure, rounds = PARTS[name]
            measured = measure(server, folder, 3 if QUICK else rounds)
            print("\n".join(line(summary) for summary in measured), flush=True)
            rows += measured
    summary = {
        "commit": commit(),
        "machine": machine(),
        "load_average": {"before": before, "after": os.getloadavg()},
    }
    print(json.dumps(summary))
    if len(wanted) == len(PARTS) and not QUICK:
        RESULTS.parent.mkdir(exist_ok=True)
        written = [
            {key: value for key, value in asdict(measured).items() if value not in (None, "")}
            for measured in rows
        ]
        lines = ",\n".join(f"  {json.dumps(measured, ensure_ascii=False)}" for measured in written)
        date = datetime.now(UTC).isoformat(timespec="seconds")
        head = json.dumps({"date": date, **summary}, ensure_ascii=False)[:-1]
        RESULTS.write_text(f'{head}, "rows": [\n{lines}\n]}}\n')


if __name__ == "__main__":
    main()
