"""Measure the costs of the program and compare with aims: `python -m benchmarks.all [films elements …]`.

The arguments are kinds of work: films, elements, slopes, serving, shell, answers. `python -m benchmarks.all
kept` prints the stored table without measuring.

Each kind of work runs in its own process, one after the other, with one BLAS thread. Times are processor
times, because other work on the machine affects them least; wall times are marked. The whole run takes less
than 15 minutes on two idle cores. It prints a table in Markdown and, if all kinds were measured, writes
benchmarks/results/all.json and the table of docs/costs.md.
"""

from __future__ import annotations

import json
import os
import re
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from datetime import UTC, datetime
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from benchmarks.speed.figures import Figure
from benchmarks.speed.servers import commit, machine

RESULTS = Path(__file__).parent / "results" / "all.json"
PAGE = Path(__file__).parents[1] / "docs" / "costs.md"
HEAD = "| work | measured | aim | | how |\n|---|---|---|---|---|"
KINDS = ("shell", "serving", "films", "elements", "slopes", "answers")
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")


def figures(kind: str) -> list[Figure]:
    """Return the figures of one kind of work."""
    measured: list[Figure] = import_module(f"benchmarks.speed.{kind}").figures()
    return measured


def main(kinds: list[str]) -> None:
    """Measure, print and store the figures."""
    os.environ.update(dict.fromkeys(THREADS, "1"))
    begin, load = time.perf_counter(), os.getloadavg()
    print(HEAD)
    rows: list[Figure] = []
    for kind in kinds:
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            measured = pool.submit(figures, kind).result()
        print("\n".join(figure.line() for figure in measured), flush=True)
        rows += measured
    minutes = (time.perf_counter() - begin) / 60
    print(f"\n{minutes:.1f} minutes; load average before {load[0]:.2f}, after {os.getloadavg()[0]:.2f}")
    if tuple(kinds) == KINDS:
        kept = {
            "date": datetime.now(UTC).isoformat(timespec="seconds"),
            "commit": commit(),
            "machine": machine(),
            "load_average": {"before": load, "after": os.getloadavg()},
            "minutes": round(minutes, 1),
            "figures": [{**asdict(row), "is_met": row.is_met} for row in rows],
        }
        RESULTS.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


def page(text: str) -> str:
    """Return the page of costs, with its table and date replaced by the stored ones."""
    before, after = text[: text.index(HEAD)], text[text.index(HEAD) :]
    day = datetime.fromisoformat(json.loads(RESULTS.read_text(encoding="utf-8"))["date"])
    before = re.sub(r"\(\d+ \w+ \d{4}\)", f"({day:%-d %B %Y})", before)
    return before + table() + after[after.index("\n\n") :]


def table() -> str:
    """Return the stored figures as a table in Markdown, as in `docs/costs.md`."""
    figures = json.loads(RESULTS.read_text(encoding="utf-8"))["figures"]
    return "\n".join([HEAD, *(Figure(**without(row, "is_met")).line() for row in figures)])


def without(row: dict[str, Any], name: str) -> dict[str, Any]:
    """Return a row without one of its fields."""
    return {key: value for key, value in row.items() if key != name}


if __name__ == "__main__":
    if sys.argv[1:] == ["kept"]:
        print(table())
        raise SystemExit
    named = sys.argv[1:] or list(KINDS)
    if unknown := set(named) - set(KINDS):
        raise SystemExit(f"no such kind of work: {', '.join(sorted(unknown))}; there are {', '.join(KINDS)}")
    main(named)
