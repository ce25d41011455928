"""A design over many rows: what the engine adds to bare array calls, and 10⁶ points in bounded memory.

`python -m benchmarks.net` takes two minutes. It prints a table and keeps it in benchmarks/results/net.json.

- Two steps, a film with its heat balance and a lightly loaded journal, over 10 000 rows: the processor time
  of `Net` over that of the same array calls written by hand (`from_si`, attributes), in the same run; also
  with all criteria judged, against the values alone.
- One output of `oil_film` 2 at level `map` over 10⁶ rows: processor time, and the largest resident memory
  beyond that before the call (of Linux, which can forget a process's largest memory so far).
- 128 rows decided against a limit of the film, from the cheapest level: processor time over that of level
  reynolds for all rows, and how many verdicts that level contradicts.

Times are the least of several runs, as other processes can only add to them.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from app.designs.climbing_rows import decide_rows
from app.designs.document import Document
from app.designs.graph import Catalogues
from app.designs.net import Net
from app.reference import Reference
from cad.catalogue import models
from templates.core.arrays import Array
from templates.core.judging.comparison import MET, NOT_MET, UNDECIDED
from templates.core.language.template import Template
from templates.door import built_in

RESULTS = Path("benchmarks/results/net.json")
ROWS, MANY, DECIDED, CHUNK, REPEATS = 10_000, 1_000_000, 128, 4096, 5
SPEED, LOAD, SUPPLY = 5000 * np.pi / 30, 25e3, 353.15  # rad/s, N, K
LOW, HIGH = np.array([[44e-3], [14e-3], [30e-6]]), np.array([[56e-3], [24e-3], [90e-6]])  # m
PLACES = tuple(map(Reference, ("diameter", "width", "clearance")))
FILM, LOSS, IDLE = map(Reference.parse, ("film.minimum_film_thickness", "film.power_loss", "idle.power_loss"))
INPUTS = {
    "radial_load": "25 kN",
    "bearing_diameter": "= diameter",
    "bearing_width": "= width",
    "diametral_clearance": "= clearance",
    "speed": "5000 rpm",
}
DESIGN: dict[str, Any] = {
    "name": "bearing",
    "parameters": {"diameter": "48 mm", "width": "18 mm", "clearance": "55 um"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 2,
            "outputs": ["minimum_film_thickness", "power_loss"],
            "inputs": {**INPUTS, "supply_temperature": "80 degC"},
        },
        "idle": {
            "template": "journal_friction",
            "version": 1,
            "outputs": ["power_loss"],
            "inputs": {
                "journal_diameter": "= film.journal_diameter",
                "bearing_width": "= width",
                "speed": "5000 rpm",
                "radial_clearance": "= clearance / 2",
                "dynamic_viscosity": "= film.dynamic_viscosity",
            },
        },
    },
    "criteria": {"film": {"require": "film.minimum_film_thickness >= 1.8 um"}},
}
POINTS: dict[str, Any] = {
    "name": "points",
    "parameters": DESIGN["parameters"],
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 2,
            "level": "map",
            "outputs": ["minimum_film_thickness"],
            "inputs": {**INPUTS, "dynamic_viscosity": "10 mPa*s"},
        }
    },
}


def net(design: dict[str, Any]) -> Net:
    """A design of which diameter, width and clearance vary."""
    catalogues = Catalogues(built_in(), models())
    return Net.of(Document.model_validate(design), catalogues, PLACES)


def rows(count: int) -> dict[Reference, Array]:
    """Random bearings."""
    shares = np.random.default_rng(1).random((3, count))
    return dict(zip(PLACES, LOW + shares * (HIGH - LOW), strict=True))


def value(template: Template, output: str) -> Array:
    """An output [SI]."""
    result: Array = getattr(template, template.formulas[output].attribute)
    return result


def by_hand(columns: dict[Reference, Array]) -> None:
    """The two steps without a design: SI values in, attributes out."""
    film, idle = built_in().get("oil_film", 2), built_in().get("journal_friction", 1)
    for start in range(0, ROWS, CHUNK):
        diameter, width, clearance = (columns[place][start : start + CHUNK] for place in PLACES)
        one = film.from_si(
            {
                "radial_load": LOAD,
                "bearing_diameter": diameter,
                "bearing_width": width,
                "diametral_clearance": clearance,
                "speed": SPEED,
                "supply_temperature": SUPPLY,
            }
        )
        two = idle.from_si(
            {
                "journal_diameter": value(one, "journal_diameter"),
                "bearing_width": width,
                "speed": SPEED,
                "radial_clearance": clearance / 2,
                "dynamic_viscosity": value(one, "dynamic_viscosity"),
            }
        )
        for template, outputs in ((one, (FILM, LOSS)), (two, (IDLE,))):
            for output in outputs:
                value(template, output.member)


def least(*calls: Callable[[], object]) -> list[float]:
    """The least processor time of each call [s]; the calls take turns."""
    times: list[list[float]] = [[] for _ in calls]
    for _ in range(REPEATS):
        for call, taken in zip(calls, times, strict=True):
            start = time.process_time()
            call()
            taken.append(time.process_time() - start)
    return [min(taken) for taken in times]


def two_steps() -> dict[str, float]:
    """Processor time over 10 000 rows through two steps, and its ratio to the bare calls."""
    design, columns, wanted = net(DESIGN), rows(ROWS), (FILM, LOSS, IDLE)
    with np.errstate(all="ignore"):
        bare, values, judged = least(
            lambda: by_hand(columns),
            lambda: design(columns, wanted),
            lambda: design(columns, wanted, judge=True),
        )
    return {
        "rows": ROWS,
        "seconds_by_hand": round(bare, 3),
        "seconds": round(values, 3),
        "ratio": round(values / bare, 3),
        "aim": 1.3,
        "seconds_judged": round(judged, 3),
        "judged_over_values": round(judged / values, 3),
        "estimated_seconds": round(design.seconds(ROWS, wanted, {}), 3),
    }


def resident(line: str) -> float:
    """A line of this process's status [MiB]."""
    status = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(one.split()[1]) for one in status if one.startswith(line)) / 1024


def million() -> dict[str, float]:
    """Processor time of one output over 10⁶ rows, and the memory that it takes."""
    design, columns = net(POINTS), rows(MANY)
    design({place: column[:CHUNK] for place, column in columns.items()}, [FILM])
    Path("/proc/self/clear_refs").write_text("5")  # forget the largest memory so far
    before = resident("VmHWM")
    start = time.process_time()
    table = design(columns, [FILM])
    seconds = time.process_time() - start
    grown = resident("VmHWM") - before
    kept = (table.columns[FILM].nbytes + table.errors[FILM].nbytes) / 2**20
    return {
        "rows": MANY,
        "seconds": round(seconds, 2),
        "aim": 10.0,
        "memory_grown_MiB": round(grown, 1),
        "columns_MiB": round(kept, 1),
        "estimated_seconds": round(design.seconds(MANY, [FILM], {}), 2),
    }


def decided() -> dict[str, Any]:
    """Processor time of `decide_rows` over that of the finest level for all rows."""
    raw = {**POINTS, "criteria": {"film": {"require": "film.minimum_film_thickness >= 3 um"}}}
    film = {name: value for name, value in POINTS["steps"]["film"].items() if name != "level"}
    design, columns = net({**raw, "steps": {"film": film}}), rows(DECIDED)
    start = time.process_time()
    result = decide_rows(design, columns, ["film"])
    seconds = time.process_time() - start
    start = time.process_time()
    finest = design(columns, [FILM], levels={"film": "reynolds"}).columns[FILM]
    whole = time.process_time() - start
    codes = result.verdicts["film"]
    wrong = ((codes == MET) & (finest < 3e-6)) | ((codes == NOT_MET) & (finest >= 3e-6))
    return {
        "rows": DECIDED,
        "rows_by_round": [trial.rows for trial in result.trials],
        "seconds": round(seconds, 3),
        "seconds_finest": round(whole, 2),
        "ratio": round(seconds / whole, 4),
        "aim": 0.02,
        "undecided": int((codes == UNDECIDED).sum()),
        "wrong": int(wrong.sum()),
    }


def main() -> None:
    """Measure, print and keep."""
    results = {
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "numpy": np.__version__,
        "million": million(),
        "two_steps": two_steps(),
        "decided": decided(),
    }
    RESULTS.write_text(json.dumps(results, indent=1) + "\n")
    print(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
