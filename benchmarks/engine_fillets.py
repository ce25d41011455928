"""Stress tensors at the fillets of the gallery's crank throws under unit loads, by finite elements.

    python -m benchmarks.engine_fillets    # writes app/web/gallery_fillets.py

One throw of each engine, without drilling and counterweight. Of the points that `unit_loads` finds, 96 of
them, the file keeps the POINTS that bear the largest share of their endurance limit under the engine's own
loads, with the torque's swing as large as torsion makes it; the others cannot govern unless the loads change
in kind. Numbers have four digits.
"""

from pathlib import Path
from typing import Any

import numpy as np

from app.web.gallery_engine import FOUR, V_EIGHT
from benchmarks.crank_life import STEEL, as_inputs, stresses_of
from templates.core.language.evaluate import evaluate
from templates.door import built_in

FILE = Path("app/web/gallery_fillets.py")
POINTS = 16
FILLET = 2.5  # mm
SWING = 2.5  # of the torque about its mean, dynamic over static: `forced_torsion` says 2.2 and 2.5
LOADS = ("force_1", "force_2", "moment_1")
HEAD = '''"""Stress tensors at the fillets of the gallery's crank throws under unit loads, by finite elements.

Made by `python -m benchmarks.engine_fillets`, which says how; not edited by hand. A row for each point: xx,
yy, zz, xy, yz, xz; force 1 along the throw, force 2 across it, moment 1 the torque.
"""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import JsonValue


@dataclass(frozen=True)
class Tensors:
    """Tables of one throw."""

    force_1: list[JsonValue]  # MPa/kN
    force_2: list[JsonValue]  # MPa/kN
    moment_1: list[JsonValue]  # MPa/(kN m)

'''


def sizes_of(engine: dict[str, Any]) -> dict[str, float]:
    """The throw of an engine [mm]."""
    number = {n: float(str(engine[n]).split()[0]) for n in
              ("journal_diameter", "crankpin_diameter", "crankpin_length", "web_thickness", "web_width",
               "stroke")}  # fmt: skip
    first, second = engine["main_positions"]["value"][:2]
    return {
        "journal_diameter": number["journal_diameter"],
        "journal_length": second - first - number["crankpin_length"] - 2 * number["web_thickness"],
        "pin_diameter": number["crankpin_diameter"],
        "pin_length": number["crankpin_length"],
        "web_thickness": number["web_thickness"],
        "web_width": number["web_width"],
        "throw": number["stroke"] / 2,
        "fillet": FILLET,
    }


def loads_of(engine: dict[str, Any], per_throw: int) -> dict[str, np.ndarray]:
    """Loads [N, N m] of the throw beside the flywheel in its axes, and the torque that comes in there."""
    template = built_in().get("engine", 2)
    names = ["crankpin_load_x", "crankpin_load_y", "crank_angle", "crankpin_angles"]
    raw = {**engine, "bore": "86 mm"}
    outputs = evaluate(template, raw, outputs=names).outputs
    x, y, angle, pins = (np.asarray(outputs[name].value) for name in names)
    turned = (x + 1j * y) * np.exp(-1j * np.radians(angle + pins[:, None]))
    radius = float(str(engine["stroke"]).split()[0]) / 2000
    last = turned[-per_throw:].sum(axis=0)
    torque = radius * turned[:-per_throw].imag.sum(axis=0)
    return {
        "force_1": last.real,
        "force_2": last.imag,
        "moment_1": torque.mean() + SWING * (torque - torque.mean()),
    }


def kept(engine: dict[str, Any], per_throw: int) -> dict[str, np.ndarray]:
    """The tables of the points that are used most, in the order of their use."""
    found = stresses_of(sizes_of(engine))
    tables = as_inputs(found)
    loads = loads_of(engine, per_throw)
    raw = {**STEEL}
    for name in LOADS:
        unit = "N" if name.startswith("force") else "N*m"
        raw[name] = {"value": loads[name].tolist(), "unit": unit}
        raw[f"stress_of_{name}"] = tables[f"stress_of_{name}"]
    life = built_in().get("fatigue_life", 2)
    used = np.asarray(evaluate(life, raw, level="extremes", outputs=["load_use"]).outputs["load_use"].value)
    first = np.argsort(-used)[:POINTS]
    print(f"{found.elements} elements, use {used[first].max():.3f} to {used[first].min():.3f}",
          np.round(found.points[first[:3]], 1).tolist())  # fmt: skip
    return {name: np.asarray(tables[f"stress_of_{name}"]["value"])[first] for name in LOADS}


def rows(values: np.ndarray) -> str:
    """A table as the file writes it, in lines that are short enough."""
    lines = ["        [" + ", ".join(f"{value:.4g}" for value in row) + "],\n" for row in values]
    return "[\n" + "".join(lines) + "    ]"


def main() -> None:
    """Write the module."""
    text = HEAD
    for name, engine, per_throw in (("FOUR", FOUR, 1), ("V_EIGHT", V_EIGHT, 2)):
        tables = kept(engine, per_throw)
        parts = "".join(f"    {load}={rows(values)},\n" for load, values in tables.items())
        text += f"\n{name} = Tensors(\n{parts})\n"
    FILE.write_text(text)


if __name__ == "__main__":
    main()
