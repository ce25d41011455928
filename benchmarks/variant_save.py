"""Cost of saving a table of nine bearings without a change of any solid: `python -m benchmarks.variant_save`.

Five mains and four big ends are variants of the gallery's plain bearing, with two kinds of shell. Each round
uploads the table as XLSX with other loads, and waits until the revision is current. The processor time is
that of the service and its descendants. The time on the clock is true of an idle machine only; `load` says
how busy it was.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import tempfile
import time
from pathlib import Path
from statistics import median

import httpx
from openpyxl import Workbook

from app.presentation.spreadsheets import XLSX
from benchmarks.service_process import Server, crankwright
from benchmarks.variant_solids import spent

RESULTS = Path("benchmarks/results/variant_save.json")
HEAD = ["variant", "film.radial_load", "film.bearing_diameter", "film.bearing_width"]
UNITS = ["unit", "kN", "mm", "mm"]
AIM = 2.0  # [s]


def table(turn: int) -> bytes:
    """Five mains and four big ends as XLSX; the loads follow from the round."""
    book = Workbook()
    mains = [[f"main_{n}", 20 + n + turn / 16, None, None] for n in range(1, 6)]
    ends = [[f"big_end_{n}", 18 + n / 2 + turn / 16, 45, 18] for n in range(1, 5)]
    for row in (HEAD, UNITS, *mains, *ends):
        book.active.append(row)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def saved(http: httpx.Client, design: str, turn: int) -> None:
    """Upload a table, and wait until its revision is current."""
    tag = http.get(design).headers["etag"]
    headers = {"Content-Type": XLSX, "If-Match": tag, "Prefer": "wait=60"}
    http.put(f"{design}/variants", content=table(turn), headers=headers).raise_for_status()
    while (state := http.get(design).json()["state"]) == "regenerating":
        time.sleep(0.05)
    if state != "current":
        raise RuntimeError(http.get(design).text)


def measured(server: Server, rounds: int) -> dict[str, list[float]]:
    """Processor time and time on the clock of every save after the first, which builds the solids [s]."""
    seconds: dict[str, list[float]] = {"processor": [], "clock": []}
    with httpx.Client(base_url=server.url, timeout=120, trust_env=False) as http:
        page = http.post("/designs", data={"example": "shell"}).headers["location"]
        saved(http, f"/api/v1{page}", 0)
        for turn in range(1, rounds + 1):
            time.sleep(2)  # processes that are forked ahead rehearse after an answer
            before, start = spent(server), time.perf_counter()
            saved(http, f"/api/v1{page}", turn)
            seconds["clock"].append(time.perf_counter() - start)
            seconds["processor"].append(spent(server) - before)
            print(seconds["processor"][-1], seconds["clock"][-1], flush=True)
    return seconds


def main() -> None:
    """Run, print and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=10)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, crankwright(Path(folder)) as server:
        seconds = measured(server, options.rounds)
    figures = {
        f"{kind}, {what} [s]": round(value(times), 3)
        for kind, times in seconds.items()
        for what, value in (("median", median), ("most", max))
    }
    content = {"variants": 9, "rounds": options.rounds, "load": os.getloadavg()[0], **figures, "aim [s]": AIM}
    print(json.dumps(content, indent=1))
    RESULTS.write_text(json.dumps(content, indent=1) + "\n")


if __name__ == "__main__":
    main()
