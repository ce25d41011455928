"""Trains for the tests of `forced_torsion`: typed inputs, a pure tone, the cases of the reference."""

import json
from pathlib import Path

import numpy as np

from templates.core.language.evaluate import evaluate
from templates.stiffness.forced_torsion_v1 import ForcedTorsion

REFERENCE = json.loads(
    (Path(__file__).parents[2] / "references" / "forced_torsion.json").read_text(encoding="utf-8")
)
UNITS = {
    "inertias": "kg*m**2", "shaft_stiffness": "N*m/rad", "shaft_damping": "N*m*s/rad", "speeds": "rad/s",
    "absolute_damping": "N*m*s/rad", "firing_angles": "deg", "crank_angle": "deg", "gas_torque": "N*m",
    "inertia_torque": "N*m", "section_moduli": "cm**3",
}  # fmt: skip
TURN = [45.0 * i for i in range(8)]
TONE = {"crank_angle": TURN, "gas_torque": np.cos(np.radians(TURN)).tolist(), "highest_order": 1,
        "excited_inertias": [1], "firing_angles": [0.0]}  # fmt: skip
"""One turn, order 1 alone, 1 N m."""


def typed(plain, **units):
    """Lists of numbers with the units of `UNITS`."""
    names = {**UNITS, **units}
    return {
        name: {"value": np.asarray(value).tolist(), "unit": names[name]} if name in names else value
        for name, value in plain.items()
    }


def values(plain, outputs=None, **units):
    answers = evaluate(ForcedTorsion, typed(plain, **units), outputs=outputs).outputs
    return {name: np.array(answer.value) for name, answer in answers.items()}


def reference(name):
    """Inputs and expected amplitudes [shaft, speed, order] of a case of openTorsion."""
    case, curves = REFERENCE["cases"][name], {n: REFERENCE[n] for n in ("gas_torque", "inertia_torque")}
    step = REFERENCE["crank_angle_step"]
    plain = {
        **case["train"], **curves, "crank_angle": [step * i for i in range(len(curves["gas_torque"]))],
        "inertia_speed": f"{REFERENCE['inertia_speed']} rpm", "highest_order": REFERENCE["highest_order"],
    }  # fmt: skip
    return plain, np.moveaxis(np.array(case["amplitudes"]), -1, 0)
