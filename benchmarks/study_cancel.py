"""How soon the work of a study ends after the study is cancelled, while its workers run.

    python -m benchmarks.study_cancel --rounds 10 --workers 4

Each round begins a study, waits a random part of a second into its work, then until a process is seen to
work, and cancels it. The work has ended when no process that lived at that moment has used processor time
since; this is read every 10 ms, in ticks of 10 ms. `--workers` is how many processes calculate, and how many
jobs run, at the same time.

- plain_bearing, loops: each row needs a solid. One kind takes about a second, the other never ends.
- rows: a million rows of a film at level map.
- fine_rows: rows at level mass_conserving, of which a chunk has few.
- front: NSGA-II of two goals.
"""

from __future__ import annotations

import argparse
import json
import random
import tempfile
import time
from pathlib import Path

import httpx

from app.plain import JsonObject
from benchmarks.service_process import Server, crankwright

RESULTS = Path("benchmarks/results/study_cancel.json")
API = "/api/v1"
WATCHED, GLANCE = 3.0, 0.01  # after the cancelling; between two looks [s]
STARTED = 8.0  # within which a build has begun [s]
ROWS = 200
BEARING = {"inner_diameter": "50 mm", "width": "20 mm"}
VARY = {
    "film.diametral_clearance": {"between": ["30 um", "90 um"]},
    "film.bearing_width": {"between": ["15 mm", "25 mm"]},
}
LOSS, FILM = "film.power_loss", "film.minimum_film_thickness"
WAYS: dict[str, JsonObject] = {
    "rows": {"method": "sample", "points": 10**6, "outputs": [LOSS]},
    "fine_rows": {"method": "sample", "points": 10**4, "outputs": [LOSS]},
    "front": {"method": "optimise", "minimise": [LOSS], "maximise": [FILM]},
}
LEVELS = {"rows": "map", "fine_rows": "mass_conserving", "front": "map"}
KINDS: dict[str, tuple[JsonObject, str]] = {
    "plain_bearing": ({"id": "plain_bearing", "version": 1, "parameters": BEARING}, "part.width"),
    "loops": ({"id": "loops", "version": 1, "parameters": {"size": "10 mm"}}, "part.size"),
}


def ticks(server: Server) -> dict[int, int]:
    """The processor time [ticks] of the server's living descendants, by process."""
    table = {int(path.name): _fields(path) for path in Path("/proc").iterdir() if path.name.isdigit()}
    parents = {pid: int(fields[1]) for pid, fields in table.items() if fields}
    inside = {server.pid}
    while more := {pid for pid, parent in parents.items() if parent in inside} - inside:
        inside |= more
    return {pid: int(table[pid][11]) + int(table[pid][12]) for pid in inside - {server.pid} if table[pid]}


def _fields(process: Path) -> list[str]:
    try:
        return (process / "stat").read_text().rpartition(")")[2].split()
    except OSError:
        return []


def calculating(http: httpx.Client, kind: str, level: str, seed: int) -> str:
    """A study of a film, once it has rows, or has had time for them."""
    inputs = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    step = {"template": "oil_film", "version": 2, "level": level, "inputs": inputs}
    made = http.post(f"{API}/designs", json={"name": "cancelled", "steps": {"film": step}}).json()["id"]
    body: JsonObject = {"design": made, "vary": VARY, "seed": seed, **WAYS[kind]}
    answer = http.post(f"{API}/studies", json=body)
    answer.raise_for_status()
    id: str = answer.json()["id"]
    end = time.monotonic() + STARTED
    while not http.get(f"{API}/studies/{id}").json()["done"] and time.monotonic() < end:
        time.sleep(0.02)
    return id


def building(http: httpx.Client, model: JsonObject, place: str, first: float) -> str:
    """A study with a solid for each row, once it builds."""
    document = {"name": "cancelled", "models": {"part": model}}
    made = http.post(f"{API}/designs", json=document, headers={"Prefer": "respond-async"})
    made.raise_for_status()
    if made.status_code == httpx.codes.ACCEPTED:
        http.delete(made.headers["Location"])  # its job: the part of the design itself is not measured
    design = made.json()["id"]
    rows = {place: {"value": [first + 0.01 * n for n in range(ROWS)], "unit": "mm"}}
    body = {"design": design, "method": "table", "rows": rows, "outputs": ["part.mass"]}
    answer = http.post(f"{API}/studies", json=body)
    answer.raise_for_status()
    id: str = answer.json()["id"]
    end = time.monotonic() + STARTED
    while "solids" not in _words(http, id) and time.monotonic() < end:
        time.sleep(0.02)  # one that never ends its first build says nothing
    return id


def _await_work(server: Server) -> None:
    """Wait until a process works: what is idle anyway ends its work at once."""
    end, last = time.monotonic() + STARTED, ticks(server)
    while time.monotonic() < end:
        time.sleep(GLANCE)
        now = ticks(server)
        if any(used > last.get(pid, used) for pid, used in now.items()):
            return
        last = now
    raise RuntimeError("no process of the server works")


def _words(http: httpx.Client, id: str) -> str:
    job = http.get(f"{API}/studies/{id}").json()["job"]
    return str(http.get(job).json().get("message") or http.get(job).json())


def cancelled(server: Server, http: httpx.Client, id: str) -> tuple[float, float]:
    """When the interface has answered, and when the last work was seen, after the request [s]."""
    before = last = ticks(server)
    start = time.monotonic()
    http.delete(f"{API}/studies/{id}").raise_for_status()
    answered, worked = time.monotonic() - start, 0.0
    while time.monotonic() - start < WATCHED:
        time.sleep(GLANCE)
        now = {pid: used for pid, used in ticks(server).items() if pid in before}
        if any(used > last.get(pid, used) for pid, used in now.items()):
            worked = time.monotonic() - start
        last = now
    return answered, worked


def measured(server: Server, rounds: int, seed: int) -> dict[str, list[tuple[float, float]]]:
    """Answer and end of work of every round, by kind of solid."""
    chance, found = random.Random(seed), dict[str, list[tuple[float, float]]]()
    with httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
        for number in range(rounds):
            for kind in (*KINDS, *WAYS):
                if kind in KINDS:
                    id = building(http, *KINDS[kind], 20.0 + 10 * number)
                else:
                    id = calculating(http, kind, LEVELS[kind], number)
                time.sleep(chance.random())
                _await_work(server)
                found.setdefault(kind, []).append(cancelled(server, http, id))
    return found


def main() -> None:
    """Run, print and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=2, help="processes that calculate, and jobs at a time")
    options = parser.parse_args()
    count = str(options.workers)
    settings = {"CRANKWRIGHT_CALCULATION_PROCESSES": count, "CRANKWRIGHT_WORKERS": count}
    with tempfile.TemporaryDirectory() as folder, crankwright(Path(folder), **settings) as server:
        found = measured(server, options.rounds, options.seed)
    table: JsonObject = {
        kind: {
            "rounds": len(pairs),
            "answer, most [s]": round(max(answer for answer, _ in pairs), 3),
            "end of work, most [s]": round(max(worked for _, worked in pairs), 3),
            "end of work, each [s]": [round(worked, 3) for _, worked in pairs],
        }
        for kind, pairs in found.items()
    }
    table["workers"] = options.workers
    table["aim"] = {"end of work, most [s]": 1.0}
    print(json.dumps(table, indent=1))
    RESULTS.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
