"""Count the bearings of random engines that are decided or have a stated error, and measure the cost.

    nice python -m benchmarks.engine_bearings [engines] [seed]

Each engine has random values in the usual ranges of car and truck engines: bore, stroke, rod, masses, speed,
gas cycle, bearing sizes, clearance, oil and supply; a hole may be at any angle, also under the load. Template
`engine` calculates the loads. For each engine, one main bearing and one big end are calculated like designs:
at the default level of `oil_film_cycle`, and then by `decide`. The criteria are the minimum film and the
largest pressure, with random limits about usual values. A bearing counts if both criteria are decided, or if
an error is stated and a limit lies within it. A bearing whose film starves is refused with that reason and
counted separately. Results are written to benchmarks/results/engine_bearings.json after every engine; a later
run continues from there.
"""

import json
import sys
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.decision import Climb
from app.designs.graph import Catalogues, build_graph, resolved
from cad.catalogue import models
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.door import built_in

KEPT = Path("benchmarks/results/engine_bearings.json")
ENGINES, SEED = 40, 36
BUDGET = 60.0
OWN = ("film", "pressure")
CATALOGUES = Catalogues(built_in(), models())
ENGINE = CATALOGUES.templates.get("engine", 1)
FILM = CATALOGUES.templates.get("oil_film_cycle", 1)
Row = dict[str, Any]


def engine_inputs(rng: np.random.Generator) -> Row:
    """Return the inputs of an in-line four-stroke engine."""
    cylinders = int(rng.choice([1, 2, 3, 4, 6]))
    order = {1: [1], 2: [1, 2], 3: [1, 3, 2], 4: [1, 3, 4, 2], 6: [1, 5, 3, 6, 2, 4]}[cylinders]
    bore = float(rng.uniform(70, 150))
    stroke = bore * float(rng.uniform(0.8, 1.3))
    pitch = bore * float(rng.uniform(1.1, 1.3))
    mean_piston_speed = float(rng.uniform(6, 16))
    mass = 0.48 * (bore / 86) ** 3
    middle = [(k + 0.5) * pitch for k in range(cylinders)]
    webs = [at + off for at in middle for off in (-pitch / 4, pitch / 4)]
    return {
        "speed": f"{mean_piston_speed / (2 * stroke / 1000) * 60} rpm",
        "strokes": 4,
        "crank_angle_step": "5 deg",
        "firing_order": order,
        "cylinder_positions": {"value": middle, "unit": "mm"},
        "stroke": f"{stroke} mm",
        "rod_length": f"{stroke * rng.uniform(1.5, 2.2)} mm",
        "bore": f"{bore} mm",
        "rod_mass": f"{1.25 * mass} kg",
        "rod_centre": f"{0.49 * stroke} mm",
        "rod_inertia": f"{2200 * (bore / 86) ** 5} kg*mm**2",
        "piston_mass": f"{mass} kg",
        "gas_cycle": "four_stroke",
        "suction_pressure": f"{rng.uniform(0.8, 2.0)} bar",
        "exhaust_pressure": "1.1 bar",
        "compression_ratio": float(rng.uniform(8, 16)),
        "compression_exponent": 1.32,
        "expansion_exponent": 1.28,
        "combustion_pressure": f"{rng.uniform(50, 160)} bar",
        "cutoff": 1.15,
        "inlet_closes": "222 deg",
        "exhaust_opens": "492 deg",
        "crankcase_pressure": "1 bar",
        "main_positions": {"value": [k * pitch for k in range(cylinders + 1)], "unit": "mm"},
        "web_positions": {"value": webs, "unit": "mm"},
        "web_unbalance": f"{12 * (bore / 86) ** 4} kg*mm",
        "counterweights": f"{16 * (bore / 86) ** 4} kg*mm",
    }


def film_inputs(rng: np.random.Generator, loads: Row, engine: Row, *, big_end: bool) -> Row:
    """Return the inputs for the film of one bearing: the first big end or the second main."""
    bore = float(engine["bore"].split()[0])
    diameter = bore * float(rng.uniform(0.55, 0.75))
    width = diameter * float(rng.uniform(0.3, 0.55))
    name = "crankpin_load" if big_end else "main_load"
    inputs = {
        "crank_angle": loads["crank_angle"],
        "load_x": row(loads[f"{name}_x"], 0 if big_end else 1),
        "load_y": row(loads[f"{name}_y"], 0 if big_end else 1),
        "load_sense": "sleeve_on_journal",
        "speed": engine["speed"],
        "bearing_diameter": f"{diameter} mm",
        "bearing_width": f"{width} mm",
        "diametral_clearance": f"{diameter * rng.uniform(0.8e-3, 1.4e-3)} mm",
        "dynamic_viscosity": f"{rng.uniform(6, 15)} mPa*s",
        "supply_pressure": f"{rng.uniform(2, 6)} bar",
        "permissible_film": f"{np.exp(rng.uniform(np.log(0.5), np.log(5)))} um",
        "permissible_pressure": f"{rng.uniform(60, 250)} MPa",
    }
    if big_end:
        inputs["sleeve_speed"] = row(loads["rod_angular_velocity"], 0)
    supply = int(rng.integers(3))
    if big_end and supply < 2:
        return inputs | hole("pin", diameter, rng)
    if not big_end and supply == 0:
        return inputs | hole("sleeve", diameter, rng)
    groove = {"groove_width": f"{width * rng.uniform(0.1, 0.25)} mm"}
    if supply == 1:
        groove |= {"groove_start": "-90 deg", "groove_extent": "180 deg"}
    return inputs | groove


def hole(part: str, diameter: float, rng: np.random.Generator) -> Row:
    """Return the inputs of a hole in a part of a bearing [mm], at any angle."""
    angle = float(rng.uniform(-180, 180))
    return {f"{part}_hole_length": f"{diameter * 0.1} mm", f"{part}_hole_angle": f"{angle} deg"}


def row(curve: Row, number: int) -> Row:
    """Return the load curve of one bearing."""
    values = np.asarray(curve["value"], dtype=float)
    return {"value": (values[number] if values.ndim > 1 else values).tolist(), "unit": curve["unit"]}


def decided(inputs: Row) -> Row:
    """Return the outcome for a bearing, and its cost."""
    begin = process_time()
    step = {"template": "oil_film_cycle", "version": 1, "inputs": inputs}
    document = Document.model_validate({"name": "bearing", "steps": {"film": step}})
    graph, faults = build_graph(resolved(document, CATALOGUES), CATALOGUES)
    assert not faults
    calculation = calculate(graph, lambda shape: None, lambda *question: None)
    if calculation.faults:
        return {"refused": calculation.faults[0].detail}
    climb = Climb(calculation, [f"film.{name}" for name in OWN], BUDGET)
    result = climb.decide()
    judged = {one.name.partition(".")[2]: one for one in result.criteria}
    evaluation = climb.calculation.evaluations["film"]
    return {
        "level": evaluation.level,
        "verdicts": {name: judged[name].verdict for name in OWN},
        "open": [name for name in OWN if judged[name].is_open],
        "errors": {name: judged[name].relative_error for name in OWN if judged[name].band},
        "refused": next((trial.reason for trial in result.trials if trial.reason), None),
        "seconds": round(process_time() - begin, 2),
    }


def bearings(seed: int, number: int) -> Row:
    """Return the two bearings of an engine."""
    rng = np.random.default_rng([seed, number])
    engine = engine_inputs(rng)
    names = ["crank_angle", "crankpin_load_x", "crankpin_load_y", "main_load_x", "main_load_y",
             "rod_angular_velocity"]  # fmt: skip
    found = evaluate(ENGINE, engine, outputs=names).outputs
    loads = {n: {"value": np.asarray(found[n].value).tolist(), "unit": found[n].unit} for n in names}
    result: Row = {}
    for name, big_end in (("main", False), ("big_end", True)):
        try:
            result[name] = decided(film_inputs(rng, loads, engine, big_end=big_end))
        except InvalidInputs as refusal:
            result[name] = {"refused": str(refusal)}
    return result


def main() -> None:
    """Calculate the engines that are not stored yet, and print the counts."""
    engines, seed = (int(one) for one in [*sys.argv[1:], *map(str, (ENGINES, SEED)[len(sys.argv) - 1 :])])
    kept: Row = json.loads(KEPT.read_text("utf-8")) if KEPT.exists() else {}
    evaluate(ENGINE, engine_inputs(np.random.default_rng(0)), outputs=["crankpin_load_max"])  # compiles
    for number in range(engines):
        if f"{seed}-{number}" not in kept:
            kept[f"{seed}-{number}"] = bearings(seed, number)
            KEPT.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    report([one for key, two in kept.items() if key.startswith(f"{seed}-") for one in two.values()])


def report(rows: list[Row]) -> None:
    """Print how many bearings are decided, and the cost."""
    starved = [one for one in rows if "starved" in (one["refused"] or "")]
    whole = [one for one in rows if "verdicts" in one]
    left = [one for one in whole if one not in starved]
    ended = [one for one in left if not one["open"]]
    stated = [one for one in left if one["open"] and len(one["errors"]) == len(OWN)]
    others = len(rows) - len(ended) - len(stated) - len(starved)
    print(f"{len(rows)} bearings: {len(ended)} decided, {len(stated)} undecided with a stated error, "
          f"{len(starved)} refused as starved, {others} without")  # fmt: skip
    print(f"climbed to supplied: {sum(one['level'] == 'supplied' for one in whole)}")
    seconds = np.array([one["seconds"] for one in whole])
    print(f"processor s a bearing: mean {seconds.mean():.2f}, median {np.median(seconds):.2f}, "
          f"95 % {np.quantile(seconds, 0.95):.2f}, largest {seconds.max():.2f}")  # fmt: skip
    for one in rows:
        if one.get("refused"):
            print(one["refused"][:150])


if __name__ == "__main__":
    main()
