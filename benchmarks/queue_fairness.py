"""After how many jobs another client's first design ends while one client submits 1 000 builds.

Run `python -m benchmarks.queue_fairness`. It counts jobs, so the speed of the machine does not matter.
"""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx

from benchmarks.service_process import crankwright

BUILDS = 1000
API = "/api/v1"
BUILD = f"{API}/models/ball_bearing/versions/1/build"
GREEDY, MODEST = ({"Crankwright-Client": name, "Prefer": "respond-async"} for name in ("greedy", "modest"))
UNLIMITED = {"CRANKWRIGHT_CLIENT_QUEUE_LIMIT": "2000", "CRANKWRIGHT_QUEUE_LIMIT": "4000"}
DESIGN = {
    "name": "of the modest client",
    "model": {"id": "ball_bearing", "version": 1, "parameters": {"inner_diameter": "77 mm"}},
}


def submitted(http: httpx.Client) -> list[httpx.Response]:
    """The answers to 1 000 small builds of the greedy client, each of another size."""
    sizes = (f"{20 + number / 100:g} mm" for number in range(BUILDS))
    bodies = ({"parameters": {"inner_diameter": size}, "artifacts": []} for size in sizes)
    return [http.post(BUILD, json=body, headers=GREEDY) for body in bodies]


def jobs(http: httpx.Client) -> Iterator[dict[str, Any]]:
    """All jobs, newest first."""
    cursor: str | None = ""
    while cursor is not None:
        page = http.get(f"{API}/jobs", params={"limit": 500, **({"cursor": cursor} if cursor else {})}).json()
        yield from page["items"]
        cursor = page["next"]


def ended(http: httpx.Client, place: str) -> dict[str, Any]:
    """A job once it has ended."""
    while (job := http.get(place).json())["state"] in ("queued", "running"):
        time.sleep(0.02)
    return dict(job)


def delay(http: httpx.Client) -> tuple[int, int]:
    """How many jobs of the greedy client end before the modest one's first design; and how many wait then."""
    answer = http.post(f"{API}/designs", json=DESIGN, headers=MODEST)
    first = ended(http, answer.headers["location"])
    assert first["state"] == "done", first
    others = [job for job in jobs(http) if job["id"] != first["id"]]
    before = [job for job in others if job["state"] == "done" and job["updated"] < first["updated"]]
    between = [job for job in before if job["updated"] > first["created"]]
    return len(between), sum(job["state"] == "queued" for job in others)


def measured(name: str, environment: dict[str, str]) -> None:
    """Print a line for a server with these settings."""
    with tempfile.TemporaryDirectory() as folder, crankwright(Path(folder), **environment) as server:
        with httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
            answers = submitted(http)
            accepted = sum(answer.status_code == 202 for answer in answers)
            advice = sorted({int(a.headers["retry-after"]) for a in answers if a.status_code == 429})
            count, waiting = delay(http)
    advised = f"Retry-After {advice[0]} to {advice[-1]} s" if advice else "none refused"
    print(
        f"{name:28} accepted {accepted:4} of {BUILDS} ({advised}); another's design ends after {count} jobs"
    )
    print(f"{'':28} while {waiting} jobs of the first client still wait")


def main() -> None:
    """Print the table."""
    measured("shares as they are set", {})
    measured("no limits", UNLIMITED)


if __name__ == "__main__":
    main()
