"""`decide` on random bearings with limits near the value: wrong verdicts, and the cost.

    python -m benchmarks.decide [--count 500] [--seed 0] [--within 0.05]

Each bearing gets a permissible film within a share of its film at level map. `decide_rows` starts at the
cheapest level. Every verdict is held against a solution on a mesh twice as fine each way as that of level
reynolds, extrapolated (256 × 32 and 512 × 64 intervals). The cost is processor time, against that of level
reynolds for all bearings in the same run. Figures go to `benchmarks/results/decide.json`.
"""

import argparse
import json
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from templates.core.judging.comparison import MET, NOT_CHECKED, NOT_MET, UNDECIDED
from templates.core.language.deciding import Decided, decide_rows
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Array, Template
from templates.door import built_in
from templates.physics.films.film_map import mapped_film
from templates.physics.films.film_map_inverse import mapped_eccentricity
from templates.physics.films.reynolds import extrapolated_film

FINEST, AT_ONCE = "reynolds", 400
AROUND, ACROSS = 256, 32  # and twice as many: each way twice those of the finest level
OUTPUT = "minimum_film_thickness"
RESULT = Path(__file__).parent / "results" / "decide.json"


def bearings(count: int, random: np.random.Generator) -> dict[str, Any]:
    """Inputs of random bearings: B/D 0.15 … 1, Sommerfeld numbers 0.2 … 30."""
    diameter = random.uniform(0.02, 0.2, count)  # m
    width = diameter * random.uniform(0.15, 1.0, count)
    clearance = diameter * 10 ** random.uniform(-3.3, -2.6, count)
    speed = random.uniform(50, 600, count)  # rad/s
    viscosity = 10 ** random.uniform(-2.3, -1.3, count)  # Pa s
    number = 10 ** random.uniform(-0.7, 1.5, count)
    load = number * diameter * width * viscosity * speed / (clearance / diameter) ** 2
    columns = {
        "bearing_diameter": (diameter, "m"),
        "bearing_width": (width, "m"),
        "diametral_clearance": (clearance, "m"),
        "speed": (speed, "rad/s"),
        "dynamic_viscosity": (viscosity, "Pa*s"),
        "radial_load": (load, "N"),
    }
    return {name: {"value": values.tolist(), "unit": unit} for name, (values, unit) in columns.items()}


def film(cls: type[Template], raw: dict[str, Any], level: str) -> Any:
    """The smallest films [um] at a level."""
    return evaluate(cls, raw, level=level, outputs=[OUTPUT]).outputs[OUTPUT].value


def finest(cls: type[Template], raw: dict[str, Any], count: int) -> Array:
    """The smallest films [um] at the finest level, as many at once as it takes."""
    parts = []
    for first in range(0, count, AT_ONCE):
        rows = {n: {**part, "value": part["value"][first : first + AT_ONCE]} for n, part in raw.items()}
        parts.append(film(cls, rows, FINEST))
    return np.concatenate(parts)


def true_film(clearance: float, number: float, ratio: float) -> float:
    """The smallest film on the finer meshes, of the dimension of the clearance.

    The map's slope moves the solution to the load; a second solution there leaves nothing of its error.
    """
    eps = float(mapped_eccentricity(np.array(number), np.array(ratio)))
    for _ in range(2):
        borne = extrapolated_film(eps, ratio, AROUND, ACROSS)[0].So
        mapped = float(mapped_film(np.array(eps), np.array(ratio))["So"])
        eps = float(mapped_eccentricity(np.array(mapped * number / borne), np.array(ratio)))
    return clearance * (1 - eps) / 2


def truths(cls: type[Template], raw: dict[str, Any]) -> Array:
    """The smallest films [um] of all bearings on the finer meshes."""
    names = ["sommerfeld_number", "width_ratio"]
    result = evaluate(cls, raw, level="map", outputs=names)
    number, ratio = (np.asarray(result.outputs[name].value) for name in names)
    clearance = np.array(raw["diametral_clearance"]["value"]) * 1e6
    return np.array([true_film(*map(float, row)) for row in zip(clearance, number, ratio, strict=True)])


def figures(result: Decided, true: Array, limit: Array, seconds: float, whole: float) -> dict[str, Any]:
    """The question, the errors, and the cost."""
    count, codes = limit.size, result.codes
    verdicts = {"met": MET, "not met": NOT_MET, "undecided": UNDECIDED, "not checked": NOT_CHECKED}
    asked = sum(trial.rows for trial in result.trials if trial.level == FINEST)
    before = [trial for trial in result.trials if trial.level != FINEST]
    left = before[-1].rows - before[-1].decided if before else count
    decided = (codes == MET) | (codes == NOT_MET)
    wrong = ((codes == MET) & (true < limit)) | ((codes == NOT_MET) & (true >= limit))
    return {
        "levels": {
            trial.level: {"bearings": trial.rows, "decided": trial.decided} for trial in result.trials
        },
        "left out": dict(result.skipped),
        "verdicts": {word: int((codes == code).sum()) for word, code in verdicts.items()},
        "contradicted by the finer meshes": int(wrong.sum()),
        "nearest limit of a decided bearing, distance over film": float(
            np.abs(limit / true - 1)[decided].min()
        ),
        "share for which the finest level was asked": asked / count,
        "share undecided before it": left / count,
        "processor time [s]": round(seconds, 3),
        f"processor time, {FINEST} for all [s]": round(whole, 3),
        "cost over that": round(seconds / whole, 5),
    }


def record(name: str, run: dict[str, Any]) -> None:
    """Keep the figures of a run beside those of others."""
    runs = json.loads(RESULT.read_text()) if RESULT.exists() else {}
    RESULT.write_text(json.dumps({**runs, name: run}, indent=1) + "\n")


def main() -> None:
    """Decide, compare and record."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--within", type=float, default=0.05, help="limits lie within this share of the film")
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    cls = built_in().get("oil_film", 2)
    raw = bearings(options.count, random)
    limit = film(cls, raw, "map") * (1 + options.within * random.uniform(-1, 1, options.count))
    limits = {"permissible_film": {"value": limit.tolist(), "unit": "um"}}
    start = process_time()
    result = decide_rows(cls, raw, "own_film", limits=limits)
    seconds = process_time() - start
    start = process_time()
    finest(cls, raw, options.count)
    whole = process_time() - start
    name = f"limits within {options.within:g} of the film, {options.count} bearings, seed {options.seed}"
    record(name, figures(result, truths(cls, raw), limit, seconds, whole))
    print(RESULT.read_text())


if __name__ == "__main__":
    main()
