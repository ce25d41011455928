"""Answer random bearings: the time of `POST /answer` in a warm process, and whether each answer is confirmed.

    python -m benchmarks.answers [--count 100] [--seed 0]

The bearings are those of `benchmarks.sizing`: every second one with a heat balance. Diameter and clearance
are free between bounds, the width on a grid of 0.5 mm; the loss is minimised with a film of at least a share
of 0.5 … 0.9 of the thickest one. The search explores the film map; verdicts are those of `mass_conserving`.
Results in benchmarks/results/answers.json.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

from app.answers.tasks import answer_request
from app.designs.graph import read_document, resolved
from app.designs.tasks import DesignTask
from app.plain import JsonObject
from benchmarks.sizing import CATALOGUES, FILM, LOSS, Sizing, document, engine, sizing, space, thickest

__all__ = ["CATALOGUES", "FILM", "LOSS", "bearing", "within"]

RESULTS = Path("benchmarks/results/answers.json")
AIMS = {"median": 0.5, "p99": 1.0}
"""Largest times [s] on two idle cores."""


def bearing(number: int, seed: int = 0) -> tuple[Sizing, JsonObject]:
    """Return a random bearing and the document of its design."""
    random = np.random.default_rng([seed, number])
    one = sizing(random, heat=bool(number % 2))
    return one, document(one)


def within(one: Sizing) -> list[tuple[float, float]]:
    """Return the bounds [m] of diameter, width and clearance."""
    return [(variable.low, variable.high) for variable in space(one).variables]  # type: ignore[union-attr]


def request(one: Sizing, limit: float) -> JsonObject:
    """Return the request for one bearing; `limit` is the smallest film [m]."""
    free: JsonObject = {
        name: {"between": [f"{low!r} m", f"{high!r} m"]}
        for name, (low, high) in zip(("diameter", "width", "clearance"), within(one), strict=True)
    }
    free["width"]["step"] = "0.5 mm"
    require = [f"film.minimum_film_thickness >= {limit!r} m"]
    return {"design": "", "free": free, "require": require, "minimise": "film.power_loss"}


def measured(number: int, seed: int) -> JsonObject:
    """Return the time and the outcome of one answer."""
    one, raw = bearing(number, seed)
    share = np.random.default_rng([seed, number, 1]).uniform(0.5, 0.9)
    limit = float(share * thickest(one, engine(one), "map"))
    document = resolved(read_document(raw), CATALOGUES).model_dump(mode="json")
    task, body = DesignTask.of(document, CATALOGUES), json.dumps(request(one, limit))
    start, spent = perf_counter(), process_time()
    answer = answer_request(task, None, body)
    return {
        "seconds": perf_counter() - start,
        "processor": process_time() - spent,
        "state": answer.state,
        "heat": bool(number % 2),
        "level": answer.confirmed_at.levels["film"],
        "confirmed": answer.confirmed_at.rows,
        "width_mm": answer.values["width"].value.value,
    }


def summary(done: list[JsonObject]) -> JsonObject:
    """Return the times and the share of confirmed answers."""
    seconds = np.array([one["processor"] for one in done])
    return {
        "bearings": len(done),
        "confirmed at mass_conserving": sum(
            one["state"] == "confirmed" and one["level"] == "mass_conserving" for one in done
        ),
        "processor seconds, median": float(np.median(seconds)),
        "processor seconds, 99 %": float(np.quantile(seconds, 0.99)),
        "wall seconds, median": float(np.median([one["seconds"] for one in done])),
        "aims": f"median below {AIMS['median']} s, 99 % below {AIMS['p99']} s, all confirmed",
    }


def main() -> None:
    """Answer the bearings; print and write the summary."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    measured(0, options.seed + 1000)  # warm
    done = [measured(number, options.seed) for number in range(options.count)]
    table = {"summary": summary(done), "each": done}
    print(json.dumps(table["summary"], indent=1))
    RESULTS.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
