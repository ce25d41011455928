"""Measure the errors of the levels of `cad.analysis` on random shafts, for cad/analysis/levels.json.

    python -m benchmarks.torsion_levels [COUNT] [SEED] [FILE]

There are COUNT shafts; every third is a crankshaft with plain ends, the others are throws. For each shaft and
level the script determines the true error of every output except stress, and the change from the next lower
order; a multiple of this change plus a constant is the stated error. Every second shaft has no fillets, so
its corners are sharp. The reference is that of `benchmarks.shaft_truth`. `share` is the true error over the
stated one, which must be below 1.

All results are stored in FILE, by default benchmarks/results/torsion_levels.json, after every shaft. Stored
results for the same shaft, mesh and orders are not computed again, so an interrupted run continues, and a
changed level costs only its own time. With COUNT 0 the stored results are judged by the present table.
"""

import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from time import process_time
from typing import Any

import ngsolve as ng
import numpy as np

from benchmarks.shaft_truth import KEY, OUTPUTS, Found, by_orders, extrapolated, outputs_by
from cad.analysis.kinds import LOADS
from cad.analysis.levels import LEVELS, Level
from cad.analysis.mesh import Fineness, Grid, make_grid
from cad.analysis.solid import read_solid
from cad.model import CadModel
from cad.models.crank_throw_v1 import CrankThrow
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import regenerate
from cad.shaft import Shaft
from templates.core.errors import InvalidInputs

RESULTS = Path("benchmarks/results/torsion_levels.json")
COUNT, SEED = 12, 20261121

# Ratios to the journal's diameter: throws of engines and compressors, with and without overlap of pin and
# journal.
RANGES = {
    "journal_length": (0.5, 1.0), "pin_diameter": (0.7, 1.05), "pin_length": (0.4, 0.9),
    "web_thickness": (0.25, 0.5), "web_width": (1.35, 1.8), "throw": (0.5, 1.1), "fillet": (0.02, 0.08),
}  # fmt: skip
OPTIONS = {
    "journal_bore": (0.15, 0.4), "pin_bore": (0.15, 0.4), "oil_drilling_diameter": (0.06, 0.12),
    "counterweight_radius": (1.2, 1.6),
}  # fmt: skip
ENDS = {
    "nose_diameter": (0.5, 0.9), "nose_length": (0.3, 1.0), "flange_diameter": (0.5, 0.9),
    "flange_thickness": (0.3, 1.0),
}  # fmt: skip


def random_throws(count: int, seed: int) -> Iterator[dict[str, Any]]:
    """Yield parameters [SI] of throws that can be built.

    Half of them have no fillets; half of them have each bore, drilling or counterweight.
    """
    rng = np.random.default_rng(seed)
    while count > 0:
        size = rng.uniform(0.04, 0.1)
        drawn: dict[str, Any] = {
            "journal_diameter": size,
            "web_shape": rng.choice(["obround", "rectangular"]).item(),
        }
        for name, (low, high) in (RANGES | OPTIONS).items():
            share = rng.uniform(low, high)
            drawn[name] = size * share if name in RANGES or rng.random() < 0.5 else 0.0
        drawn["fillet"] *= count % 2
        if possible(CrankThrow, drawn):
            count -= 1
            yield drawn


def random_crankshafts(count: int, seed: int) -> Iterator[dict[str, Any]]:
    """Yield parameters [SI] of crankshafts that can be built: a random throw, a nose and a plain flange."""
    rng = np.random.default_rng(seed + 1)
    for thrown in random_throws(10 * count, seed):
        size = thrown["journal_diameter"]
        ends = {name: size * rng.uniform(low, high) for name, (low, high) in ENDS.items()}
        if count > 0 and possible(Crankshaft, drawn := {"pin_angles": [0.0], **thrown, **ends}):
            count -= 1
            yield drawn


def random_shafts(count: int, seed: int) -> Iterator[tuple[type[CadModel], dict[str, Any]]]:
    """Yield models and parameters [SI]: every third a crankshaft, the others throws."""
    cranks = random_crankshafts(count // 3, seed + 100)
    throws = random_throws(count - count // 3, seed)
    for number in range(count):
        is_crank = number % 3 == 2
        yield (Crankshaft, next(cranks)) if is_crank else (CrankThrow, next(throws))


def possible(model: type[CadModel], parameters: dict[str, Any]) -> bool:
    """Return whether a model accepts its parameters [SI]."""
    try:
        model.from_si(parameters)
    except InvalidInputs:
        return False
    return True


def shaft_of(parameters: dict[str, Any]) -> tuple[bytes, Shaft]:
    """Return a throw's STEP file, and the positions at which it is held and loaded."""
    half = 500 * (parameters["pin_length"] + 2 * parameters["web_thickness"] + parameters["journal_length"])
    return regenerate("crank_throw", 1, parameters).step, Shaft(-half, half)


def drawn(model: str, parameters: dict[str, Any]) -> tuple[bytes, Shaft]:
    """Return the STEP file of a model of a shaft, and the positions at which it is held and loaded."""
    cls = {one.id: one for one in (CrankThrow, Crankshaft)}[model]
    shaft = cls.from_si(parameters).shaft()
    assert shaft is not None
    return regenerate(cls.id, cls.version, parameters).step, shaft


Row = dict[str, Any]


PASSES = (LEVELS[:-1], LEVELS[-1:])
"""Order of the measurements: the slowest level is last, so that an interrupted run has the others."""


def measure(row: Row, levels: Iterable[Level]) -> None:
    """Add missing values to a row: those from which its reference is extrapolated, and those of levels."""
    if row.get("truth", {}).get("by") == KEY and not any(lacks(row, level) for level in levels):
        return
    step, shaft = drawn(row["model"], row["parameters"])
    if row.get("truth", {}).get("by") != KEY:
        row["truth"] = {"by": KEY, "orders": by_orders(step, shaft)}
    grids: dict[Fineness, Grid] = {}
    values: dict[tuple[Fineness, int], Found] = {}
    for level in LEVELS:
        if not lacks(row, level):
            orders = {level.order - 1: "low", level.order: "high"}
            values |= {(level.fineness, order): row[level.name][kept] for order, kept in orders.items()}
    for level in levels:
        if not lacks(row, level):
            continue
        fineness = level.fineness
        if fineness not in grids:
            grids[fineness] = make_grid(read_solid(step, shaft), fineness)
        grid = grids[fineness]
        for order in (level.order - 1, level.order):
            if (fineness, order) not in values:
                values[fineness, order] = outputs_by(grid, order, shaft)
        row[level.name] = {
            "mesh": mesh_of(level),
            "elements": grid.mesh.ne,
            "is sharp": grid.is_sharp,
            "is resolved": grid.is_resolved,
            "low": values[fineness, level.order - 1],
            "high": values[fineness, level.order],
        }


def mesh_of(level: Level) -> str:
    """Return the parameters on which the values of a level depend."""
    return f"{level.fineness}, order {level.order}, ngsolve {ng.__version__}"


def lacks(row: Row, level: Level) -> bool:
    """Return whether a row lacks values of a level with its present parameters."""
    return bool(row.get(level.name, {}).get("mesh") != mesh_of(level))


def summary(rows: list[Row]) -> dict[str, Any]:
    """Return the largest true error, change and share of the stated error, by level and kind of corners."""
    return {
        f"{level.name}, {'sharp' if sharp else 'filleted'}": worst(
            level,
            [one for one in rows if level.name in one and one[level.name]["is sharp"] == sharp],
            is_sharp=sharp,
        )
        for level in LEVELS
        for sharp in (False, True)
    }


def worst(level: Level, rows: list[Row], *, is_sharp: bool) -> dict[str, Any]:
    """Return the largest magnitude of each output."""
    worst_ones: dict[str, Any] = {"shafts": len(rows)}
    for name in OUTPUTS:
        found = [judged(row, level, name, is_sharp=is_sharp) for row in rows]
        worst_ones[name] = {key: max((one[key] for one in found), default=0) for key in CRITERIA}
    return worst_ones


CRITERIA = ("true error", "change", "share", "truth's last step")


def judged(row: Row, level: Level, name: str, *, is_sharp: bool) -> dict[str, float]:
    """Return the errors of one output of one shaft at one level.

    The last value is the extrapolation step of the reference.
    """
    kept = row[level.name]
    low, high = (kept[order][name] for order in ("low", "high"))
    orders = row["truth"]["orders"]
    true = extrapolated(orders)[name]
    off = abs(high / true - 1)
    return {
        "true error": off,
        "change": abs(low / high - 1),
        "share": off / level.error(low, high, is_sharp=is_sharp, is_resolved=kept["is resolved"]),
        "truth's last step": abs(orders[-1][name] / true - 1),
    }


def main(count: int, seed: int, results: Path) -> None:
    """Measure what is not stored yet, print and store the table."""
    rows: list[Row] = json.loads(results.read_text())["rows"] if results.exists() else []
    shafts = [(model.id, parameters) for model, parameters in random_shafts(count, seed)]
    for (model, parameters), row in zip(shafts, rows, strict=False):
        if (row["model"], row["parameters"]) != (model, parameters):
            raise SystemExit(f"{results} keeps other shafts; remove it, or name another file")
    rows += [{"model": model, "parameters": parameters} for model, parameters in shafts[len(rows) :]]
    for levels in PASSES:
        for number, row in enumerate(rows if count else []):
            measure(row, levels)
            keep(rows, seed, results)
            print(number + 1, process_time(), flush=True)
    if not count:
        keep(rows, seed, results)
    print("\n".join(table(summary(rows))))


def table(kept: dict[str, Any]) -> Iterator[str]:
    """Print the largest true errors and their ratios to the stated ones, as the documentation quotes them."""
    corners = ("filleted", "sharp")
    heads = [f"{load}, {kind}" for kind in corners for load in LOADS]
    yield f"| level | {' | '.join(heads)} | shafts, filleted and sharp |"
    yield f"|---|{'---:|' * (len(heads) + 1)}"
    for level in LEVELS:
        cells = []
        for kind in corners:
            worst_ones = kept[f"{level.name}, {kind}"]
            for load in LOADS:
                names = [name for name in OUTPUTS if (load == "bending") == ("bending" in name)]
                off, share = (max(worst_ones[name][key] for name in names) for key in ("true error", "share"))
                cells.append(f"{100 * off:.2g} % ({share:.2f})" if worst_ones["shafts"] else "not measured")
        shafts = " and ".join(str(kept[f"{level.name}, {kind}"]["shafts"]) for kind in corners)
        yield f"| `{level.name}` | {' | '.join(cells)} | {shafts} |"


def keep(rows: list[Row], seed: int, results: Path) -> None:
    """Store the results so far."""
    record = {"shafts": len(rows), "seed": seed, "summary": summary(rows), "rows": rows}
    results.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else COUNT,
        int(sys.argv[2]) if len(sys.argv) > 2 else SEED,
        Path(sys.argv[3]) if len(sys.argv) > 3 else RESULTS,
    )
