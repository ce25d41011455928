"""Time of `forced_torsion` 1 on 10 inertias, 24 orders, 400 speeds, and what adding amplitudes would say.

python -m benchmarks.forced_torsion
"""

import json
import time
from pathlib import Path
from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.core.language.evaluate import evaluate
from templates.stiffness.forced_torsion_v1 import ForcedTorsion

FOLDER = Path(__file__).parents[1]
REFERENCE = FOLDER / "tests" / "references" / "forced_torsion.json"
UNITS = {
    "inertias": "kg*m**2", "shaft_stiffness": "N*m/rad", "shaft_damping": "N*m*s/rad",
    "absolute_damping": "N*m*s/rad", "firing_angles": "deg",
}  # fmt: skip


def diesel(speeds: Array, highest: float) -> dict[str, Any]:
    """The reference's diesel at these speeds [rpm], up to an order, with its torque in steps of 3 deg."""
    record = json.loads(REFERENCE.read_text(encoding="utf-8"))
    train = record["cases"]["diesel"]["train"]
    fine, coarse = np.arange(0, 720, 3.0), np.arange(0, 721, record["crank_angle_step"])
    curves = {name: [*record[name], record[name][0]] for name in ("gas_torque", "inertia_torque")}
    torques = {
        name: {"value": np.interp(fine, coarse, curve).tolist(), "unit": "N*m"}
        for name, curve in curves.items()
    }
    lists = {n: {"value": v, "unit": UNITS[n]} if n in UNITS else v for n, v in train.items()}
    return {
        **lists, **torques, "crank_angle": {"value": fine.tolist(), "unit": "deg"},
        "inertia_speed": f"{record['inertia_speed']} rpm", "highest_order": highest,
        "speeds": {"value": speeds.tolist(), "unit": "rpm"},
    }  # fmt: skip


def seconds(outputs: list[str] | None) -> float:
    """The best of five calculations."""
    inputs, times = diesel(np.linspace(600, 2600, 400), 12), []
    for _ in range(5):
        start = time.perf_counter()
        evaluate(ForcedTorsion, inputs, outputs=outputs)
        times.append(time.perf_counter() - start)
    return min(times)


def main() -> None:
    """All numbers of the page."""
    outputs = evaluate(ForcedTorsion, diesel(np.linspace(600, 2600, 400), 12)).outputs
    torque = np.array(outputs["vibratory_torque"].value)
    added = np.array(outputs["torque_of_orders"].value).sum(axis=-1)
    record = {
        "torque_seconds": round(seconds(["vibratory_torque"]), 3),
        "all_outputs_seconds": round(seconds(None), 3),
        "added_over_swing_most": round(float((added / torque).max()), 2),
        "added_over_swing_at_the_peak": round(float(added.flat[torque.argmax()] / torque.max()), 2),
        "power_balance_error": float(outputs["power_balance_error"].value),
    }
    print(json.dumps(record, indent=1))
    (Path(__file__).parent / "results" / "forced_torsion.json").write_text(
        json.dumps(record, indent=1) + "\n"
    )


if __name__ == "__main__":
    main()
