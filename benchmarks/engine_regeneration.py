"""What another cylinder bore costs in the gallery's engines: `python -m benchmarks.engine_regeneration`.

A four-cylinder engine and a cross-plane V8, each one design: loads, a film in each bearing, shells,
crankshaft, torsion, life, verdicts. Each round patches the bore and waits until the revision is current and
the STEP file of every model can be read. Films are at level `mobility`, all else at its default level. The
time on the clock is true of an idle machine only; `load` says how busy it was. The processor time is that of
the service and its descendants.

`shaft` is the STEP file of the crankshaft alone, asked for by `POST …/build` with dimensions of its own in
every round.

Written to benchmarks/results/engine_regeneration.json. The aim of both engines is 30 s, that of a shaft 2 s.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import httpx

from app.plain import Json
from app.web.gallery import GALLERY
from benchmarks.service_process import Server, crankwright
from benchmarks.variant_solids import spent

RESULTS = Path("benchmarks/results/engine_regeneration.json")
ENGINES = ("engine", "v8")
AIM, SHAFT_AIM = 30.0, 2.0  # [s]
API = "/api/v1"
PATIENCE = 900.0  # [s]


def current(http: httpx.Client, address: str) -> dict[str, Json]:
    """The design, once all of it is calculated and built.

    Raises
    ------
    RuntimeError
        If it fails, or takes longer than PATIENCE.
    """
    end = time.monotonic() + PATIENCE
    while (design := http.get(address).json())["state"] == "regenerating":
        if time.monotonic() > end:
            raise RuntimeError(f"{address} is not ready after {PATIENCE:g} s")
        time.sleep(0.05)
    if design["state"] != "current":
        raise RuntimeError(json.dumps(design)[:2000])
    return dict(design)


def read_steps(http: httpx.Client, address: str, models: list[str]) -> None:
    """Read the STEP file of every model of a design."""
    for model in models:
        answer = http.get(f"{address}/models/{model}/model.step")
        answer.raise_for_status()
        if not answer.content.startswith(b"ISO-10303-21;"):
            raise RuntimeError(f"{address}: {model} has no STEP file")


def timed(server: Server, action: Callable[[], object]) -> tuple[float, float]:
    """Seconds by the clock and of the processor that something takes, after a rest."""
    time.sleep(2)  # processes that are forked ahead rehearse after an answer
    before, start = spent(server), time.perf_counter()
    action()
    return time.perf_counter() - start, spent(server) - before


def regenerated(server: Server, http: httpx.Client, name: str, rounds: int) -> dict[str, Json]:
    """Both times of each change of the bore [s], and what came out in the end."""
    raw: dict[str, Json] = dict(GALLERY[name].document)
    answer = http.post(f"{API}/designs", json=raw)
    answer.raise_for_status()
    address = f"{API}/designs/{answer.json()['id']}"
    current(http, address)

    def change(bore: float) -> None:
        tag = http.get(address).headers["etag"]
        patch = {"parameters": {"bore": f"{bore:g} mm"}}
        http.patch(address, json=patch, headers={"If-Match": tag}).raise_for_status()
        current(http, address)
        read_steps(http, address, list(raw["models"]))

    times = [timed(server, lambda turn=turn: change(86.5 + turn / 2)) for turn in range(rounds)]  # type: ignore[misc]
    table = http.get(f"{address}/variants").json()
    return {
        "engine": name,
        "clock [s]": round(median(clock for clock, _ in times), 2),
        "processor [s]": round(median(used for _, used in times), 2),
        "slowest [s]": round(max(clock for clock, _ in times), 2),
        "variants": len(table["variants"]),
        "governing": table["governing"],
        "aim met": max(clock for clock, _ in times) < AIM,
    }


def shafts(server: Server, http: httpx.Client, name: str, rounds: int) -> dict[str, Json]:
    """Both times of a STEP file of the crankshaft alone [s]."""
    raw: dict[str, Json] = {**GALLERY[name].document, "variants": {}}
    answer = http.post(f"{API}/designs", json=raw)
    answer.raise_for_status()
    address = f"{API}/designs/{answer.json()['id']}"
    design = current(http, address)
    shown = http.get(f"{address}/revisions/{design['revision']}").json()["models"]["crankshaft"]
    parameters = dict(shown["parameters"])
    length = parameters["journal_length"]["value"]

    def build(turn: int) -> None:
        own = {**parameters, "journal_length": f"{length + 0.25 * (turn + 1):g} mm"}
        body = {"parameters": own, "artifacts": ["step"]}
        answer = http.post(
            f"{API}/models/crankshaft/versions/2/build", json=body, headers={"Prefer": "wait=60"}
        )
        answer.raise_for_status()
        if "build" not in answer.json():
            raise RuntimeError(answer.text[:2000])

    times = [timed(server, lambda turn=turn: build(turn)) for turn in range(rounds)]  # type: ignore[misc]
    return {
        "engine": name,
        "clock [s]": round(median(clock for clock, _ in times), 3),
        "processor [s]": round(median(used for _, used in times), 3),
        "slowest [s]": round(max(clock for clock, _ in times), 3),
        "aim met": max(clock for clock, _ in times) < SHAFT_AIM,
    }


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--engines", nargs="+", choices=ENGINES, default=list(ENGINES))
    options = parser.parse_args()
    before = os.getloadavg()
    summary: dict[str, Json] = {"rounds": options.rounds, "shaft": [], "engines": []}
    with tempfile.TemporaryDirectory() as folder, crankwright(Path(folder)) as server:
        with httpx.Client(base_url=server.url, timeout=120, trust_env=False) as http:
            for name in options.engines:
                summary["shaft"].append(shafts(server, http, name, options.rounds))
                print(json.dumps(summary["shaft"][-1]), flush=True)
            for name in options.engines:
                row = regenerated(server, http, name, options.rounds)
                summary["engines"].append(row)
                print(json.dumps(row), flush=True)
    summary["load"] = {"before": before, "after": os.getloadavg()}
    RESULTS.write_text(json.dumps(summary, indent=1) + "\n")


if __name__ == "__main__":
    main()
