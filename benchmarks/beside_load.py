"""Measure how long `/healthz` takes beside 48 clients of one kind, as a multiple of the idle service.

Run with: python -m benchmarks.beside_load [kinds, such as small array large save step]

The load comes from another process, which encodes its bodies before it begins and reads answers as bytes, so
that it shares no interpreter lock with the server or with the measurement. Each kind is compared with an idle
time measured just before it. Other work on the machine lengthens both.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import cycle
from pathlib import Path

import httpx

from benchmarks.speed.servers import Server, crankwright
from templates.door import built_in

CLIENTS = 48
IDLE_SECONDS, WARM_SECONDS, SECONDS = 4.0, 4.0, 10.0
PAUSE = 5e-3  # between two measured requests [s]
EVALUATE = "/api/v1/templates/{}/versions/1/evaluate"
DESIGNS = "/api/v1/designs"


@dataclass(frozen=True)
class Call:
    """A request of one client, repeated: each time with its next body."""

    method: str
    path: str
    bodies: tuple[str, ...] = ("",)
    needs_etag: bool = False


def small() -> list[Call]:
    """Return evaluations of single values."""
    return [Call("POST", EVALUATE.format("journal_friction"), (_body(1),))] * CLIENTS


def array() -> list[Call]:
    """Return evaluations of 30 000 points in a body of about 200 kB."""
    return [Call("POST", EVALUATE.format("journal_friction"), (_body(30_000),))] * CLIENTS


def large() -> list[Call]:
    """Return evaluations of 300 000 points in a body of about 2 MB."""
    return [Call("POST", EVALUATE.format("journal_friction"), (_body(300_000),))] * CLIENTS


def save(http: httpx.Client) -> list[Call]:
    """Return changes of designs, one design for each client."""
    calls = []
    for number in range(CLIENTS):
        example = dict(built_in().get("journal_friction", 1).example)
        step = {"template": "journal_friction", "version": 1, "inputs": example}
        made = http.post(DESIGNS, json={"name": f"design {number}", "steps": {"film": step}})
        made.raise_for_status()
        bodies = tuple(json.dumps({"name": f"design {number} {word}"}) for word in ("a", "b"))
        calls.append(Call("PATCH", f"{DESIGNS}/{made.json()['id']}", bodies, needs_etag=True))
    return calls


def step(http: httpx.Client) -> list[Call]:
    """Return downloads of a STEP file."""
    document = {
        "name": "bearing",
        "model": {"id": "plain_bearing", "parameters": {"inner_diameter": "50 mm"}},
    }
    made = http.post(DESIGNS, json=document, headers={"Prefer": "wait=60"})
    made.raise_for_status()
    return [Call("GET", f"{DESIGNS}/{made.json()['id']}/model.step")] * CLIENTS


def _body(points: int) -> str:
    inputs: dict[str, object] = dict(built_in().get("journal_friction", 1).example)
    diameters = [round(50 + n / 6000, 4) for n in range(points)]
    inputs["journal_diameter"] = {"value": diameters if points > 1 else diameters[0], "unit": "mm"}
    return json.dumps({"inputs": inputs, "outputs": ["friction_torque"]})


def percentile(url: str, seconds: float, share: float = 0.99) -> float:
    """Return the time that `/healthz` takes at most in this share of the requests [ms]."""
    times, end = [], time.monotonic() + seconds
    with httpx.Client(base_url=url, trust_env=False, timeout=60) as http:
        while time.monotonic() < end:
            start = time.perf_counter()
            http.get("/healthz").raise_for_status()
            times.append(time.perf_counter() - start)
            time.sleep(PAUSE)
    return sorted(times)[int(share * len(times))] * 1e3


def measure(server: Server, calls: list[Call], folder: Path) -> str:
    """Return the line of the result for one kind."""
    idle = percentile(server.url, IDLE_SECONDS)
    file = folder / "calls.json"
    file.write_text(json.dumps([vars(call) for call in calls]))
    command = [sys.executable, "-m", "benchmarks.beside_load", "--load", server.url, str(file)]
    load, used = subprocess.Popen(command, stdout=subprocess.PIPE, text=True), server.processor_seconds()
    time.sleep(WARM_SECONDS)
    beside = percentile(server.url, SECONDS)
    answers = load.communicate()[0].strip()
    used = server.processor_seconds() - used
    times = f"idle {idle:6.2f} ms, beside {beside:7.2f} ms, {beside / idle:5.1f} times"
    return f"{times}; server's processor {used:.1f} s; {answers}"


def load(url: str, file: Path) -> None:
    """Send the calls for some time, a thread for each, and print how many answers of each status came."""
    calls = [Call(**{**fields, "bodies": tuple(fields["bodies"])}) for fields in json.loads(file.read_text())]
    counts: Counter[int] = Counter()
    end = time.monotonic() + WARM_SECONDS + SECONDS + 1
    threads = [threading.Thread(target=_repeat, args=(url, call, end, counts)) for call in calls]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    sys.stdout.write(f"answers {dict(sorted(counts.items()))}\n")


def _repeat(url: str, call: Call, end: float, counts: Counter[int]) -> None:
    headers = {"Content-Type": "application/json"}
    with httpx.Client(base_url=url, trust_env=False, timeout=120, headers=headers) as http:
        etag = http.get(call.path).headers["ETag"] if call.needs_etag else ""
        for body in _encoded(call):
            if time.monotonic() > end:
                return
            match = {"If-Match": etag} if call.needs_etag else {}
            answer = http.request(call.method, call.path, content=body, headers=match)
            counts[answer.status_code] += 1
            etag = answer.headers.get("ETag", etag)
            if answer.status_code in (429, 503):
                time.sleep(float(answer.headers["Retry-After"]))


def _encoded(call: Call) -> Iterator[bytes]:
    return cycle([body.encode() for body in call.bodies])


def main(kinds: list[str]) -> None:
    """Measure the kinds, all by default, and print a line for each."""
    with tempfile.TemporaryDirectory() as name, crankwright(Path(name)) as server:
        with httpx.Client(base_url=server.url, trust_env=False, timeout=120) as http:
            time.sleep(3)  # its processes start
            makers: dict[str, Callable[[], list[Call]]] = {
                "small": small,
                "array": array,
                "large": large,
                "save": partial(save, http),
                "step": partial(step, http),
            }
            for kind in kinds or makers:
                line = measure(server, makers[kind](), Path(name))
                sys.stdout.write(f"{kind:6} {line}\n")
                sys.stdout.flush()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--load"]:
        load(sys.argv[2], Path(sys.argv[3]))
    else:
        main(sys.argv[1:])
