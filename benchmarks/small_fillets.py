"""Measure what it changes in the stiffness of random throws that a level does not resolve small fillets.

    python -m benchmarks.small_fillets [COUNT] [SEED]

The journals have 40 to 100 mm. Of the first 20 throws, the fillets of three of four are 0.015 to 0.027 of
that, the others 0.008 to 0.015; of the further ones, three of four 0.008 to 0.015, the others 0.004 to 0.008.
All have at least 0.2 mm. Half of the throws are twisted, the others bent. The full model is the mesh
of level `default` with all fillets resolved, in elements of third order. Throws are skipped if their full
mesh has too many elements, which are counted before meshing. `share` is the difference between a level and
the full model over the stated error of the level, which must be below 1. Every result is stored in
benchmarks/results/small_fillets.json at once, so an interrupted run continues; a throw takes about 12 s of
processor time. The reference throw with a fillet of 0.3 mm follows, bent and twisted. With COUNT 0 the stored
results are judged by the present levels.
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.torsion import THROW
from benchmarks.torsion_levels import possible, random_throws, shaft_of
from cad.analysis.corners import NONE
from cad.analysis.elastic import System, respond
from cad.analysis.element_count import estimated_elements
from cad.analysis.kinds import LOADS, Kind
from cad.analysis.levels import LEVELS, Level
from cad.analysis.mesh import Fineness, bound_sizes, make_grid, sizes
from cad.analysis.solid import Solid, read_solid
from cad.models.crank_throw_v1 import CrankThrow
from cad.shaft import STEEL_MATERIAL, Shaft

RESULTS = Path("benchmarks/results/small_fillets.json")
COUNT, SEED = 50, 3701
SMALLEST = 0.2e-3  # [m]
FIRST = 20
FILLETS = (*3 * [(0.015, 0.027, 6500)], (0.008, 0.015, 10_000))
SMALLER = (*3 * [(0.008, 0.015, 10_000)], (0.004, 0.008, 20_000))
"""Range of the fillets relative to the journal, and most elements of the full mesh; used in turn, the second
after the first throws."""
CHEAP = LEVELS[:2]
FULL, ORDER = replace(LEVELS[1].fineness, least=0.0), 3

Row = dict[str, Any]
Throw = tuple[bytes, Shaft]  # STEP file, and the positions at which it is held and loaded


def small_filleted(seed: int, number: int) -> tuple[Row, Throw]:
    """Return parameters [SI] and file of a random throw with small fillets whose full mesh is affordable."""
    rng = np.random.default_rng([seed, number])
    low, high, most = (FILLETS if number < FIRST else SMALLER)[number % len(FILLETS)]
    for drawn in random_throws(1000, seed + 1000 * number):
        parameters = {**drawn, "fillet": drawn["journal_diameter"] * rng.uniform(low, high)}
        if parameters["fillet"] > SMALLEST and possible(CrankThrow, parameters):
            throw = shaft_of(parameters)
            if estimate(read_solid(*throw), most) <= most:
                return parameters, throw
    raise LookupError(number)


def estimate(solid: Solid, most: int) -> int:
    """Return the estimated number of elements of the full model; a smaller one if it exceeds `most`."""
    bound_sizes(solid, FULL)
    parameters = sizes(solid, FULL, (), NONE)  # for sharp edges there are more
    return estimated_elements(solid.shape, parameters, FULL.size * solid.scale, most)


def solved(step: bytes, shaft: Shaft, load: Kind, fineness: Fineness, orders: tuple[int, ...]) -> Row:
    """Return the stiffness [N·m/rad] of a throw with a free end in elements of each order, and its cost."""
    begin = process_time()
    grid = make_grid(read_solid(step, shaft), fineness)
    values = []
    for order in orders:
        system = System(grid, order, STEEL_MATERIAL, load, few_forces=True)
        values.append(1e-3 / respond(system, "free_end").compliance)
    return {
        "stiffness": values,
        "elements": grid.mesh.ne,
        "is sharp": grid.is_sharp,
        "is resolved": grid.is_resolved,
        "seconds": round(process_time() - begin, 2),
    }


def measured(seed: int, number: int) -> Row:
    """Return the stiffness of a throw by the levels and by the full model."""
    parameters, throw = small_filleted(seed, number)
    return compared(parameters, throw, LOADS[number // len(FILLETS) % 2])


def compared(parameters: Row, throw: Throw, load: Kind) -> Row:
    """Return the stiffness of one throw by the levels and by the full model."""
    levels = {level.name: solved(*throw, load, level.fineness, (2, 3)) for level in CHEAP}
    full = solved(*throw, load, FULL, (ORDER,))
    return {"load": load, "parameters": parameters, **levels, "full": full}


def judged(row: Row, level: Level) -> dict[str, float]:
    """Return the difference of a level from the full model, and its share of the stated error."""
    kept, true = row[level.name], row["full"]["stiffness"][-1]
    low, high = kept["stiffness"]
    stated = level.error(low, high, is_sharp=kept["is sharp"], is_resolved=kept["is resolved"])
    return {"difference": abs(high / true - 1), "share": abs(high / true - 1) / stated, "stated": stated}


def summary(rows: list[Row]) -> Row:
    """Return how many throws that a level does not resolve lie within its stated error."""
    found: Row = {}
    for level in CHEAP:
        some = [row for row in rows if not row[level.name]["is resolved"]]
        errors = [judged(row, level) for row in some]
        found[level.name] = {
            "throws": len(some),
            "within": sum(one["share"] <= 1 for one in errors),
            **{f"largest {name}": max((one[name] for one in errors), default=0.0) for name in KEYS},
            "elements over those of the full models": ratio(some, level, "elements"),
            "seconds over those of the full models": ratio(some, level, "seconds"),
        }
    return found


KEYS = ("difference", "share", "stated")


def ratio(rows: list[Row], level: Level, cost: str) -> float:
    """Return the cost of a level over that of the full models, summed over throws."""
    full = sum(float(row["full"][cost]) for row in rows)
    return sum(float(row[level.name][cost]) for row in rows) / full if rows else 1.0


def main(count: int, seed: int) -> None:
    """Measure what is not stored yet, print and store it."""
    stored: Row = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    rows, reference = stored.get("rows", []), stored.get("reference", [])
    for number in range(len(rows), count):
        rows.append(measured(seed, number))
        print(number, json.dumps({level.name: judged(rows[-1], level) for level in CHEAP}), flush=True)
        keep(rows, reference, seed)
    for load in LOADS[len(reference) :] if count else ():
        parameters = {**THROW, "fillet": 0.3e-3}
        reference.append(compared(parameters, shaft_of(parameters), load))
    keep(rows, reference, seed)
    print(json.dumps({"throws": summary(rows), "reference": summary(reference)}, indent=1))


def keep(rows: list[Row], reference: list[Row], seed: int) -> None:
    """Store the results so far."""
    found = {"seed": seed, "summary": summary(rows), "reference summary": summary(reference)}
    RESULTS.write_text(json.dumps({**found, "rows": rows, "reference": reference}, indent=1) + "\n")


if __name__ == "__main__":
    given = [int(one) for one in sys.argv[1:]]
    main(*given, *(COUNT, SEED)[len(given) :])
