"""Loads, torque, balance and combustion of published engines."""

from __future__ import annotations

import json

import numpy as np

from benchmarks.validation.by_template import by_template
from benchmarks.validation.case import Case, by_row
from benchmarks.validation.reference import FOLDER
from templates import get

NINE_CYLINDERS = json.loads((FOLDER / "nine_cylinder_set.json").read_text(encoding="utf-8"))["inputs"]


def slider_crank(row: dict[str, float]) -> dict[str, float]:
    """Return the forces of a cylinder under a constant gas pressure, at one crank angle.

    The crank has no mass here and the rod, split into two points, a millionth of the piston's.
    """
    angles = {"value": [30.0 * n for n in range(12)], "unit": "deg"}
    mass = row["mass"]
    load = get("bearing_load", 1)(
        speed=f"{row['speed']} rpm", stroke=f"{row['stroke']} mm", rod_ratio=row["rod_ratio"],
        bore=f"{row['bore']} mm", crankpin_mass="0 kg", crank_mass="0 kg", crank_centre="0 mm",
        counterweight_mass="0 kg", counterweight_centre="0 mm", rod_mass=f"{1e-6 * mass} kg",
        rod_centre=f"{row['stroke'] / 4} mm", rod_inertia="0 kg*m**2", piston_mass=f"{mass} kg", strokes=2,
        gas_cycle="table", pressure_angle=angles, crankcase_pressure="0 bar", crank_angle_step="1 deg",
        pressure={"value": [row["pressure"]] * 12, "unit": "MPa"},
    )  # fmt: skip
    here = int(row["crank_angle"])
    along, across = (abs(getattr(load, f"wristpin_load_{axis}")[here].to("N").magnitude) for axis in "xy")
    return {"rod_force": float(np.hypot(along, across)), "wall_force": float(across),
            "torque": float(abs(load.torque[here].to("N*m").magnitude))}  # fmt: skip


ENGINES = (
    *(
        Case(
            f"khurmi_{example.replace('.', '_')}",
            f"Khurmi, Gupta, example {example}: {words}",
            "khurmi_gupta_ch_15.csv",
            "bearing_load 1",
            "printed example",
            by_row(slider_crank),
            rows={"example": example},
        )
        for example, words in (
            ("15.7", "gas engine of 500 mm bore at 60°"),
            ("15.9", "petrol engine of 80 mm bore at 33°"),
            ("15.12", "double-acting steam engine of 250 mm bore at 45°"),
        )
    ),
    Case(
        "dyremi_nine_cylinders",
        "Rao, Singh 1993: balance of a generator set of nine cylinders",
        "nine_cylinder_set.csv",
        "flywheel 1",
        "printed example",
        by_template("flywheel", 1, "nine_cylinder_set.csv", **NINE_CYLINDERS),
    ),
)
