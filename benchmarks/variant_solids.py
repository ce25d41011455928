"""A hundred variants as STEP files and one report, against their separate builds.

    python -m benchmarks.variant_solids --count 100 --rounds 1

One service does both, in one run, with solids of other sizes. The separate builds are a job each: of the STEP
files alone, and of STEP and the picture that a report shows. All times are processor time of the service and
of every process that descends from it.
"""

from __future__ import annotations

import argparse
import io
import json
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path

import httpx

from app.plain import JsonObject
from app.workers.family import use
from benchmarks.service_process import Server, crankwright

RESULTS = Path("benchmarks/results/variant_solids.json")
API = "/api/v1"
PATIENCE = 600.0  # for a job [s]
ROOMY = {"CRANKWRIGHT_QUEUE_LIMIT": "1000", "CRANKWRIGHT_CLIENT_QUEUE_LIMIT": "1000"}


def spent(server: Server) -> float:
    """The processor time of the service so far [s]."""
    return server.processor_seconds() + use(server.pid).seconds


def measured(server: Server, action: Callable[[], object]) -> float:
    """The processor time that the service needs for something [s], with what it does by itself."""
    before = spent(server)
    action()
    _settle(server)
    return spent(server) - before


def _settle(server: Server) -> None:
    """Wait until the service is idle: processes that are forked ahead rehearse after the answer."""
    last = spent(server)
    while (now := (time.sleep(0.5), spent(server))[1]) - last > 0.02:
        last = now


def ended(http: httpx.Client, place: str) -> None:
    """Wait for the end of a job."""
    end = time.monotonic() + PATIENCE
    while (job := http.get(place).json())["state"] in ("queued", "running") and time.monotonic() < end:
        time.sleep(0.2)
    if job["state"] != "done":
        raise RuntimeError(f"{place}: {job}")


def separate(http: httpx.Client, sizes: list[str], *files: str) -> None:
    """Build one after another, each by a job of its own, with these files."""
    for size in sizes:
        body = {"parameters": {"inner_diameter": size, "width": "18 mm"}, "artifacts": files}
        answer = http.post(f"{API}/models/plain_bearing/versions/1/build", json=body).raise_for_status()
        if answer.status_code == 202:
            ended(http, answer.headers["Location"])


def saved(http: httpx.Client, sizes: list[str]) -> str:
    """A design with a variant of each size, once its revision is current; its path."""
    document: JsonObject = {
        "name": "shells",
        "parameters": {"bore": "30 mm"},
        "models": {
            "shell": {
                "id": "plain_bearing",
                "version": 1,
                "parameters": {"inner_diameter": "= bore", "width": "18 mm"},
            }
        },
        "variants": {f"v_{number}": {"bore": size} for number, size in enumerate(sizes)},
    }
    answer = http.post(f"{API}/designs", json=document).raise_for_status()
    path = f"{API}/designs/{answer.json()['id']}"
    while (state := http.get(path).json()["state"]) == "regenerating":
        time.sleep(0.2)
    if state != "current":
        raise RuntimeError(http.get(path).text)
    return path


def zipped(http: httpx.Client, path: str, count: int) -> None:
    """All STEP files."""
    content = http.get(f"{path}/variants.zip").raise_for_status().content
    names = zipfile.ZipFile(io.BytesIO(content)).namelist()
    if sum(name.endswith(".step") for name in names) != count:
        raise RuntimeError(f"{len(names)} files")


def reported(http: httpx.Client, path: str) -> None:
    """One report, with a picture of every solid."""
    headers = {"Prefer": "wait=600"}  # else a report without pictures is printed in between
    answer = http.get(f"{path}/variants/report.pdf", headers=headers).raise_for_status()
    if answer.status_code == 202:
        ended(http, answer.headers["Location"])
        http.get(f"{path}/variants/report.pdf").raise_for_status()


def rounds(server: Server, count: int, number: int) -> Iterator[tuple[str, float]]:
    """The processor time of each part of one round [s]."""
    own, pictured, other = (
        [f"{40 + number + n / 200 + part / 1000:.3f} mm" for n in range(count)] for part in range(3)
    )
    with httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http:
        yield "separate", measured(server, lambda: separate(http, own, "step"))
        yield "separate_with_pictures", measured(server, lambda: separate(http, pictured, "step", "svg"))
        paths: list[str] = []
        yield "variants", measured(server, lambda: paths.append(saved(http, other)))
        yield "zip", measured(server, lambda: zipped(http, paths[0], count))
        yield "report", measured(server, lambda: reported(http, paths[0]))


def main() -> None:
    """Print the parts and their ratio to the separate builds, and keep them."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=1)
    asked = parser.parse_args()
    with (
        tempfile.TemporaryDirectory() as folder,
        crankwright(Path(folder), **ROOMY) as server,
    ):
        with httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http:
            separate(http, ["35 mm"], "step", "svg")  # what is loaded once does not count
            reported(http, saved(http, ["36 mm"]))
        _settle(server)
        results = [dict(rounds(server, asked.count, number)) for number in range(asked.rounds)]
    for each in results:
        solids = each["variants"] + each["zip"]
        whole = solids + each["report"]
        each |= {
            "solids_to_separate": solids / each["separate"],
            "whole_to_separate": whole / each["separate"],
            "whole_to_separate_with_pictures": whole / each["separate_with_pictures"],
        }
        print({name: round(value, 3) for name, value in each.items()})
    about = {"date": datetime.now(UTC).isoformat(timespec="seconds"), "count": asked.count}
    RESULTS.write_text(json.dumps({**about, "rounds": results}, indent=1) + "\n")


if __name__ == "__main__":
    main()
