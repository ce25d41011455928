"""The service under 48 expensive requests: what its neighbours wait, who calculates, and what is abandoned.

python -m benchmarks.service_flood            measures; three minutes on two cores
python -m benchmarks.service_flood estimates  holds estimates of cost against measured times

Idle and flooded are measured in the same run, and compared as ratios of their 99th percentiles. A flooding
client waits as Retry-After says: on two cores 34 of 48 requests calculate or wait, the others come again.

The client that measures shares the two cores with the calculations and with the flood's clients. It asks the
system for short slices, as the server does, and `client wakes late` says what its own sleeps miss: of a
measured time, that much may be the client's. `server waits for a core` is what the kernel counts for all
threads of the server, a request (/proc/PID/task/*/schedstat); on an idle machine only the flood causes it.
Writes `benchmarks/results/service_flood.json`.
"""

from __future__ import annotations

import http.client
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import numpy as np

from app.calculations.cost import estimated_seconds
from app.calculations.schemas import OIL_FILM, EvaluateIn
from app.calculations.service import run_evaluate
from app.catalogue.finding import find_templates
from app.designs.schemas import PAPER
from app.workers.scheduling import answer_promptly, share_fairly
from benchmarks import service_process

RESULTS = Path("benchmarks/results/service_flood.json")
EACH, COUNT, PINGS = 12, 4, 400
SETTLED = 8.0  # from the beginning of the flood to the first measurement [s]
HEADERS = {"Content-Type": "application/json"}
CHEAP = json.dumps({"inputs": OIL_FILM, "outputs": ["minimum_film_thickness"]}).encode()
EVALUATE = "/api/v1/templates/oil_film/versions/1/evaluate"


def heavy() -> dict[str, tuple[str, dict[str, Any]]]:
    """The expensive requests, by name: path and body."""
    catalogue = find_templates(())
    film, cycle = catalogue.get("oil_film", 2), catalogue.get("oil_film_cycle", 1)

    def loads(count: int) -> dict[str, Any]:
        return {"value": np.linspace(10, 30, count).round(4).tolist(), "unit": "kN"}

    place = "/api/v1/templates/{}/versions/{}/evaluate".format
    return {
        "mass_conserving, 20 points": (
            place("oil_film", 2),
            {"inputs": {**film.example, "radial_load": loads(20)}, "level": "mass_conserving"},
        ),
        "reynolds, 400 points": (
            place("oil_film", 2),
            {"inputs": {**film.example, "radial_load": loads(400)}, "level": "reynolds"},
        ),
        "transient": (place("oil_film_cycle", 1), {"inputs": dict(cycle.example), "level": "transient"}),
        "10⁶ points": (
            place("oil_film", 1),
            {"inputs": {**OIL_FILM, "radial_load": loads(10**6)}, "outputs": ["minimum_film_thickness"]},
        ),
    }


# The flood, in a process of its own -----------------------------------------------------------------------


def flood(port: int) -> None:
    """Keep 48 requests in flight until standard input closes; then print how they were answered."""
    share_fairly()
    statuses: Counter[str] = Counter()
    stopping = threading.Event()
    for name, (path, body) in heavy().items():
        packed = json.dumps(body).encode()
        for _ in range(EACH):
            target = _again_and_again
            threading.Thread(
                target=target, args=(port, name, path, packed, statuses, stopping), daemon=True
            ).start()
    print("flooding", flush=True)
    sys.stdin.read()
    stopping.set()
    print(json.dumps(statuses), flush=True)
    os._exit(0)


def _again_and_again(
    port: int, name: str, path: str, body: bytes, statuses: Counter[str], stopping: threading.Event
) -> None:
    while not stopping.is_set():
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=400)
        try:
            connection.request("POST", path, body, HEADERS)
            answer = connection.getresponse()
            answer.read()
            statuses[f"{name}: {answer.status}"] += 1
            if answer.status == 429:
                stopping.wait(float(answer.headers["Retry-After"]))
        except OSError:
            statuses[f"{name}: broken"] += 1
        finally:
            connection.close()


@contextmanager
def flooding(port: int, statuses: dict[str, int]) -> Iterator[None]:
    """Flood the service within the context; `statuses` are filled in at its end."""
    command = [sys.executable, "-m", "benchmarks.service_flood", "flood", str(port)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(SETTLED)
        try:
            yield
        finally:
            process.stdin.close()
            statuses.update(json.loads(process.stdout.readline()))


# What is measured -----------------------------------------------------------------------------------------


PAUSE = 0.01  # between requests [s]


def milliseconds(
    port: int, method: str, path: str, body: bytes | None = None
) -> tuple[list[float], list[float]]:
    """Times of a request on one kept connection, and how late the client wakes after each pause."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    taken, late = [], []
    for _ in range(PINGS):
        start = time.perf_counter()
        connection.request(method, path, body, HEADERS)
        answer = connection.getresponse()
        answer.read()
        taken.append(1e3 * (time.perf_counter() - start))
        assert answer.status == 200, answer.status
        start = time.perf_counter()
        time.sleep(PAUSE)
        late.append(1e3 * (time.perf_counter() - start - PAUSE))
    connection.close()
    return taken, late


LATE, WAITS = "client wakes late", "server waits for a core"


def pings(server: service_process.Server, design: str) -> dict[str, list[float]]:
    """The neighbours' requests, and what of their times is not the service's own."""
    before = core_waits(server.pid)
    evaluated, late = milliseconds(server.port, "POST", EVALUATE, CHEAP)
    shown, later = milliseconds(server.port, "GET", design)
    waits = (core_waits(server.pid) - before) / (2 * PINGS)
    return {"evaluate": evaluated, "GET design": shown, LATE: late + later, WAITS: [waits]}


def core_waits(pid: int) -> float:
    """How long the threads of a process have been ready and had no core, in all [ms]."""
    rows = [(task / "schedstat").read_text().split() for task in Path(f"/proc/{pid}/task").iterdir()]
    return sum(int(row[1]) for row in rows) / 1e6


def children(pid: int) -> dict[int, float]:
    """Processor seconds of all processes that descend from this one."""
    stats = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            seconds = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
            stats[int(entry.name)] = (int(fields[1]), seconds)
    pids: set[int] = set()
    while more := {p for p, (parent, _) in stats.items() if parent in pids | {pid}} - pids:
        pids |= more
    return {p: stats[p][1] for p in pids}


def cores_used(pid: int, seconds: float = 5.0) -> list[float]:
    """Which part of a core each calculation process uses, the busiest first."""
    before = children(pid)
    time.sleep(seconds)
    after = children(pid)
    used = (after[p] - before.get(p, 0.0) for p in after)
    return sorted((round(part / seconds, 2) for part in used), reverse=True)[:4]


def abandoned(server: service_process.Server) -> float:
    """Seconds from closing the connection of a long calculation to the end of its process."""
    path, body = heavy()["transient"]
    before = children(server.pid)
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    connection.request("POST", path, json.dumps(body), HEADERS)
    busy: list[int] = []
    while not busy:
        time.sleep(0.1)
        busy = [p for p, used in children(server.pid).items() if used - before.get(p, 0.0) > 0.5]
    start = time.perf_counter()
    connection.close()
    while busy[0] in children(server.pid):
        time.sleep(0.01)
    return time.perf_counter() - start


def compare() -> dict[str, Any]:
    """Everything, in one run."""
    answer_promptly()
    with (
        tempfile.TemporaryDirectory() as folder,
        service_process.crankwright(Path(folder)) as server,
        httpx.Client(base_url=server.url, trust_env=False, timeout=90) as client,
    ):
        response = client.post(
            "/api/v1/designs", json=PAPER, headers={"Prefer": "wait=60"}
        ).raise_for_status()
        design = f"/api/v1/designs/{response.json()['id']}"
        client.post(heavy()["mass_conserving, 20 points"][0], json=heavy()["mass_conserving, 20 points"][1])
        pings(server, design)  # warms up
        free, statuses = [abandoned(server) for _ in range(5)], dict[str, int]()
        idle = pings(server, design)
        with flooding(server.port, statuses):
            flooded = pings(server, design)
            cores = cores_used(server.pid)
        load = os.getloadavg()
    rows = {}
    for name in ("evaluate", "GET design"):
        was, now = (np.percentile(times[name], [50, 99]).round(2).tolist() for times in (idle, flooded))
        rows[name] = {"idle p50, p99 [ms]": was, "flooded": now, "ratio of p99": round(now[1] / was[1], 2)}
    sides = {"idle": idle, "flooded": flooded}
    return {
        "neighbours": rows,
        "client wakes late, p50, p99 [ms]": {
            name: np.percentile(times[LATE], [50, 99]).round(2).tolist() for name, times in sides.items()
        },
        "server waits for a core [ms a request]": {
            name: round(times[WAITS][0], 3) for name, times in sides.items()
        },
        "answers to the flood": statuses,
        "part of a core used by the busiest processes": cores,
        "abandoned, until the process is free [s]": [round(seconds, 2) for seconds in free],
        "load average": load,
    }


def estimates() -> None:
    """Estimates of cost against processor time in this process."""
    catalogue = find_templates(())
    cases: list[tuple[str, Callable[[], float], float]] = []
    for name, (path, body) in heavy().items():
        if name != "transient" or "all" in sys.argv:
            cls = catalogue.get(path.split("/")[4], int(path.split("/")[6]))
            asked = EvaluateIn(**body)
            estimate = estimated_seconds(cls, asked.inputs, asked.level, None, asked.outputs)
            cases.append((name, _timed(cls, asked), estimate))
    for cls in catalogue:
        asked = EvaluateIn(inputs=dict(cls.example))
        cases.append((f"{cls.id} {cls.version}", _timed(cls, asked), estimated_seconds(cls, asked.inputs)))
    for name, action, estimate in cases:
        action()
        seconds = min(action() for _ in range(2))
        print(f"{name:30} estimated {estimate:9.4f} s, measured {seconds:9.4f} s, × {estimate / seconds:.1f}")


def _timed(cls: Any, asked: EvaluateIn) -> Callable[[], float]:
    def action() -> float:
        start = time.process_time()
        run_evaluate(cls, asked)
        return time.process_time() - start

    return action


def main() -> None:
    """Measure, print, write."""
    if sys.argv[1:2] == ["flood"]:
        flood(int(sys.argv[2]))
    if "estimates" in sys.argv:
        estimates()
        return
    comparison = compare()
    text = json.dumps(comparison, ensure_ascii=False, indent=1)
    print(text)
    RESULTS.write_text(text + "\n")


if __name__ == "__main__":
    main()
