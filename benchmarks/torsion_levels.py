"""How good the levels of `cad.analysis` are on random throws; what cad/analysis/levels.json is read from.

    python -m benchmarks.torsion_levels [COUNT]

COUNT shafts, every third of them a crankshaft with plain ends, the others throws. For each shaft and level
the true error of every output but stress, and the change from one order less, whose multiple is stated as
the error, above a floor. Every second shaft has no fillets: its corners are sharp. The truth is a run with
elements of a higher order on a mesh of its own, far finer along sharp corners. `share` is the true error by
the stated one, which must be below 1. Kept after every shaft in
benchmarks/results/torsion_levels.json; with COUNT 0 what is kept there is judged by the present table.
"""

import json
import sys
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from cad.analysis.elastic import System, respond
from cad.analysis.kinds import LOADS, Boundary, Kind
from cad.analysis.levels import LEVELS, Level
from cad.analysis.mesh import Fineness, Grid, make_grid
from cad.analysis.modes import torsional_mode
from cad.analysis.solid import read_solid
from cad.model import CadModel
from cad.models.crank_throw_v1 import CrankThrow
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import regenerate
from cad.shaft import Shaft
from templates.core.errors import InvalidInputs

RESULTS = Path("benchmarks/results/torsion_levels.json")
COUNT, SEED = 12, 20261121
TRUTH = Fineness(size=0.8, curvature=0.4, turn=np.pi / 3, sharp=0.06)
ORDER, SHARP_ORDER = 5, 4
ASKED: dict[str, tuple[Kind, Boundary]] = {
    "stiffness": ("torsion", "free_end"),
    "guided stiffness": ("torsion", "guided_end"),
    "bending stiffness": ("bending", "free_end"),
}
FREQUENCY = "torsional frequency"
OUTPUTS = (*ASKED, FREQUENCY)

# Of the journal's diameter: throws of engines and compressors, with overlap of pin and journal and without.
RANGES = {
    "journal_length": (0.5, 1.0), "pin_diameter": (0.7, 1.05), "pin_length": (0.4, 0.9),
    "web_thickness": (0.25, 0.5), "web_width": (1.35, 1.8), "throw": (0.5, 1.1), "fillet": (0.02, 0.08),
}  # fmt: skip
OPTIONS = {
    "journal_bore": (0.15, 0.4), "pin_bore": (0.15, 0.4), "oil_drilling_diameter": (0.06, 0.12),
    "counterweight_radius": (1.2, 1.6),
}  # fmt: skip


def random_throws(count: int, seed: int) -> Iterator[dict[str, Any]]:
    """Parameters [SI] of throws that can be drawn.

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
    """Parameters [SI] of crankshafts that can be drawn: random throws, each with ends of its own."""
    rng = np.random.default_rng(seed + 1)
    for thrown in random_throws(10 * count, seed):
        size = thrown["journal_diameter"]
        ends = {
            f"{end}_{name}": size * rng.uniform(low, high)
            for end in ("front", "rear")
            for name, low, high in (("diameter", 0.5, 0.9), ("length", 0.3, 1.0))
        }
        if count > 0 and possible(Crankshaft, drawn := {**thrown, **ends}):
            count -= 1
            yield drawn


def random_shafts(count: int, seed: int) -> Iterator[tuple[type[CadModel], dict[str, Any]]]:
    """Models and parameters [SI]: every third a crankshaft, the others throws."""
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
    """A throw's STEP file, and where it is held and loaded."""
    half = 500 * (parameters["pin_length"] + 2 * parameters["web_thickness"] + parameters["journal_length"])
    return regenerate("crank_throw", 1, parameters).step, Shaft(-half, half)


def drawn(model: type[CadModel], parameters: dict[str, Any]) -> tuple[bytes, Shaft]:
    """The STEP file of a shaft of any model, and where it is held and loaded."""
    shaft = model.from_si(parameters).shaft()
    assert shaft is not None
    return regenerate(model.id, model.version, parameters).step, shaft


Found = dict[str, float]


def outputs_by(grid: Grid, order: int, shaft: Shaft, outputs: Collection[str] = OUTPUTS) -> Found:
    """Outputs on one mesh: stiffnesses [N·m/rad], frequency [Hz]."""
    computed: Found = {}
    few = FREQUENCY not in outputs
    for load in LOADS:
        asked = {name: end for name, (kind, end) in ASKED.items() if kind == load and name in outputs}
        if not asked:
            continue
        system = System(grid, order, shaft.material, load, few_forces=few)
        for name, boundary in asked.items():
            response = respond(system, boundary)
            computed[name] = 1e-3 / response.compliance
            if name == "stiffness" and not few:
                computed[FREQUENCY] = torsional_mode(response).frequency
    return computed


def truth(step: bytes, shaft: Shaft, outputs: Collection[str] = OUTPUTS) -> Found:
    """The same from another mesh, in elements of a higher order than any level has."""
    grid = make_grid(read_solid(step, shaft), TRUTH)
    return outputs_by(grid, SHARP_ORDER if grid.is_sharp else ORDER, shaft, outputs)


def row(model: type[CadModel], parameters: dict[str, Any]) -> dict[str, Any]:
    """Results of each level for a shaft, by themselves and against the truth."""
    step, shaft = drawn(model, parameters)
    true = truth(step, shaft)
    kept: dict[str, Any] = {"model": model.id, "parameters": parameters, **true}
    for level in LEVELS:
        grid = make_grid(read_solid(step, shaft), level.fineness)
        low, high = (outputs_by(grid, order, shaft) for order in (level.order - 1, level.order))
        outputs = {
            name: {"true error": high[name] / true[name] - 1, "change": low[name] / high[name] - 1}
            for name in true
        }
        kept[level.name] = {"elements": grid.mesh.ne, "is sharp": grid.is_sharp, "outputs": outputs}
    return kept


def summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """For each level and sort of corners the greatest true error, change and share of the stated error."""
    return {
        f"{level.name}, {'sharp' if sharp else 'filleted'}": worst(
            level, [one[level.name] for one in rows if one[level.name]["is sharp"] == sharp], is_sharp=sharp
        )
        for level in LEVELS
        for sharp in (False, True)
    }


def worst(level: Level, cases: list[dict[str, Any]], *, is_sharp: bool) -> dict[str, Any]:
    """By output, the greatest of each, in magnitude."""
    worst_ones: dict[str, Any] = {}
    for name in OUTPUTS:
        errors = [(abs(one["outputs"][name]["true error"]), one["outputs"][name]["change"]) for one in cases]
        worst_ones[name] = {
            "true error": max((true for true, _ in errors), default=0),
            "change": max((abs(change) for _, change in errors), default=0),
            "share": max(
                (true / level.error(1 + change, 1, is_sharp=is_sharp) for true, change in errors), default=0
            ),
        }
    return worst_ones


def main(count: int) -> None:
    """Measure, print and keep the table."""
    rows: list[dict[str, Any]] = [] if count else json.loads(RESULTS.read_text())["rows"]
    for model, parameters in random_shafts(count, SEED):
        rows.append(row(model, parameters))
        keep(rows)
    keep(rows)
    print(json.dumps(summary(rows), indent=1))


def keep(rows: list[dict[str, Any]]) -> None:
    """Write what is known so far."""
    record = {"shafts": len(rows), "summary": summary(rows), "rows": rows}
    RESULTS.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else COUNT)
