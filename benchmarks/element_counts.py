"""Compare the estimated number of elements with that of the mesh, for random throws at each fineness.

    python -m benchmarks.element_counts [COUNT] [SEED]

Every second throw has no fillets, so its corners are sharp. `stress` is the mesh on which a stress begins.
The last line gives the smallest, mean and largest ratio of the mesh to its estimate, and the processor time
of the estimates relative to that of the meshes. Results are in benchmarks/results/element_counts.json.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from math import exp, log
from pathlib import Path
from statistics import mean
from time import process_time
from typing import Any

from benchmarks.torsion_levels import random_throws, shaft_of
from cad.analysis import mesh
from cad.analysis.element_count import estimated_elements
from cad.analysis.levels import LEVELS
from cad.analysis.solid import read_solid
from cad.analysis.stress import START

RESULTS = Path("benchmarks/results/element_counts.json")
COUNT, SEED = 3, 3700
FINENESS = {**{level.name: level.fineness for level in LEVELS[:2]}, "stress": START}


def counted(number: int, parameters: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the estimate and the number of elements of a throw at each fineness."""
    solid = read_solid(*shaft_of(parameters))
    for name, fineness in FINENESS.items():
        estimate, spent = _estimate(solid, fineness)
        begin = process_time()
        elements = mesh.make_grid(solid, fineness).mesh.ne
        yield {
            "throw": number,
            "fineness": name,
            "fillet": parameters["fillet"] / parameters["journal_diameter"],
            "estimate": estimate,
            "elements": elements,
            "seconds of the estimate": round(spent, 3),
            "seconds": round(process_time() - begin, 3),
        }


def _estimate(solid: Any, fineness: mesh.Fineness) -> tuple[int, float]:
    """Return the estimate that `make_grid` makes, and its processor time [s]."""
    edges = mesh.sharp_edges(solid, fineness)
    parameters, largest = mesh.sizes(solid, fineness, (), edges), fineness.size * solid.scale
    begin = process_time()
    return estimated_elements(solid.shape, parameters, largest, float("inf")), process_time() - begin


def main(count: int, seed: int) -> None:
    """Compare, print and store."""
    rows: list[dict[str, Any]] = []
    for number, parameters in enumerate(random_throws(count, seed)):
        for row in counted(number, parameters):
            print(json.dumps(row), flush=True)
            rows.append(row)
    found = summary(rows)
    RESULTS.write_text(json.dumps({"seed": seed, "throws": count, **found, "rows": rows}, indent=1) + "\n")
    print(json.dumps(found))


def summary(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return how well the estimates agree with the meshes."""
    ratios = [row["elements"] / row["estimate"] for row in rows]
    return {
        "smallest ratio": min(ratios),
        "mean ratio": exp(mean(map(log, ratios))),
        "largest ratio": max(ratios),
        "relative time": sum(row["seconds of the estimate"] for row in rows)
        / sum(r["seconds"] for r in rows),
    }


if __name__ == "__main__":
    given = [int(one) for one in sys.argv[1:]]
    main(*given, *(COUNT, SEED)[len(given) :])
