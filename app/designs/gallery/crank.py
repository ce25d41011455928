"""An example design: the paper's study of a crankshaft, from its dimensions to its life.

Punewale, Khobragade, Chaudhari and Khandre (2015) change crankpin, journals, throw and the face inclination
of a single-cylinder crankshaft; see docs/crank_study.md. The paper states no dimensions; those here are our
own.
"""

from __future__ import annotations

from pydantic import JsonValue

STEP = 30  # deg
_GAS: list[JsonValue] = [
    0, 310, 420, 300, 190, 90, 0, -10, -20, -20, -15, -8, 0, 10, 20, 20, 15, 8, 0, -20, -50, -100, -160, -150,
]  # fmt: skip

CRANK: dict[str, JsonValue] = {
    "name": "the paper's study of a crankshaft",
    "parameters": {"pin": "46 mm", "journal": "44 mm", "throw": "80 mm", "inclination": "4.5 deg"},
    "steps": {
        "torsion": {
            "template": "forced_torsion",
            "version": 1,
            "inputs": {
                "inertias": ["= model.polar_inertia"],
                "shaft_from": [1],
                "shaft_to": [0],
                "shaft_stiffness": ["= model.torsion.stiffness"],
                "loss_factors": [0.01],
                "excited_inertias": [1],
                "firing_angles": {"value": [0], "unit": "deg"},
                "crank_angle": {"value": list(range(0, 720, STEP)), "unit": "deg"},
                "gas_torque": {"value": _GAS, "unit": "N*m"},
                "highest_order": 5,
                "speeds": {"value": list(range(600, 4001, 200)), "unit": "rpm"},
            },
            "outputs": ["natural_frequencies", "largest_torque", "worst_speed", "torque_envelope"],
        },
        "life": {
            "template": "stress_life",
            "version": 1,
            "inputs": {
                "stress_amplitude": "= model.torsion.maximum_stress * torsion.largest_torque[1] / 1 N*m",
                "mean_stress": "0 MPa",
                "ultimate_strength": "800 MPa",
                "yield_strength": "600 MPa",
                "fatigue_strength_coefficient": "1150 MPa",
                "fatigue_strength_exponent": -0.09,
            },
            "outputs": ["cycles"],
        },
    },
    "model": {
        "id": "crankshaft",
        "version": 1,
        "parameters": {
            "pin_angles": {"value": [0], "unit": "deg"},
            "journal_diameter": "= journal",
            "journal_length": "36 mm",
            "pin_diameter": "= pin",
            "pin_length": "34 mm",
            "web_thickness": "8 mm",
            "web_width": "56 mm",
            "web_shape": "obround",
            "throw": "= throw",
            "fillet": "2 mm",
            "counterweight_radius": "60 mm",
            "counterweight_angle": "120 deg",
            "face_inclination": "= inclination",
            "nose_length": "15 mm",
            "nose_diameter": "40 mm",
            "flange_thickness": "12 mm",
            "flange_diameter": "52 mm",
        },
        "analyses": {"torsion": {"level": "default"}},
    },
    "table": {
        "columns": [
            "model.torsion.stiffness",
            "model.mass",
            "model.polar_inertia",
            "torsion.natural_frequencies[1]",
            "life.cycles",
        ],
        "changes": True,
    },
}
