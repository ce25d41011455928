"""One design contains an engine and its forced torsion; the torque of one cylinder excites all throws.

The design is the example of docs/forced_torsion.md.
"""

import numpy as np
import pytest
from engines import four_cylinders
from serving import created, revision

TRAIN = {
    "inertias": {"value": [0.02, 0.008, 0.012, 0.012, 0.012, 0.012, 0.14, 0.05], "unit": "kg*m**2"},
    "shaft_from": [1, 2, 3, 4, 5, 6, 7],
    "shaft_to": [2, 3, 4, 5, 6, 7, 8],
    "shaft_stiffness": {"value": [0, 300, 500, 500, 500, 700, 1], "unit": "kN*m/rad"},
    "shaft_damping": "= [damper, 0 N*m*s/rad, 0 N*m*s/rad, 0 N*m*s/rad, 0 N*m*s/rad, 0 N*m*s/rad, clutch]",
    "loss_factors": [0, 0.005, 0.005, 0.005, 0.005, 0.005, 0.1],
    "section_moduli": {"value": [0, 20, 20, 20, 20, 30, 0], "unit": "cm**3"},
    "absolute_damping": {"value": [0, 0, 0.3, 0.3, 0.3, 0.3, 0, 0.5], "unit": "N*m*s/rad"},
    "excited_inertias": [3, 4, 5, 6],
    "highest_order": 8,
    "speeds": {"value": [*range(1000, 6001, 250)], "unit": "rpm"},
    "crank_angle": "= engine.crank_angle",
    "firing_angles": "= engine.ignition_angles",
    "gas_torque": "= gas_torque",
    "inertia_torque": "= throw * (engine.crankpin_load_y[1] * cos(turn)"
    " - engine.crankpin_load_x[1] * sin(turn)) - gas_torque",
    "inertia_speed": "= engine.speed",
}
DESIGN = {
    "name": "torsion of a four-cylinder engine",
    "parameters": {
        "bore": "86 mm",
        "throw": "= engine.stroke / 2",
        "damper": "6 N*m*s/rad",
        "clutch": "2 N*m*s/rad",
        "turn": "= engine.crank_angle + engine.crankpin_angles[1]",
        "lean": "= throw / engine.rod_length * sin(turn)",
        "area": "= 3.141592653589793 / 4 * engine.bore**2",
        "gas_torque": "= (engine.gas_pressure[1] - engine.crankcase_pressure) * area * throw"
        " * (sin(turn) + cos(turn) * lean / sqrt(1 - lean**2))",
    },
    "steps": {
        "engine": {**four_cylinders(), "outputs": ["torque", "firing_intervals"]},
        "torsion": {
            "template": "forced_torsion",
            "version": 1,
            "inputs": TRAIN,
            "limits": {"permissible_vibratory_stress": "60 MPa"},
        },
    },
}


@pytest.fixture(scope="module")
def design(http):
    design = created(http, DESIGN)
    assert design["state"] == "current", design
    return design


@pytest.fixture(scope="module")
def steps(http, design):
    return revision(http, design)["steps"]


def test_the_torque_of_one_cylinder_makes_that_of_the_engine(steps):
    """The first cylinder's torque, shifted by the firing angles and summed, is the engine's."""
    given = steps["torsion"]["inputs"]
    one = np.add(given["gas_torque"]["value"], given["inertia_torque"]["value"])
    step = 720 / one.size
    firing = np.rint(np.array(given["firing_angles"]["value"]) / step).astype(int)
    total = sum(np.roll(one, shift - firing[0]) for shift in firing)
    torque = np.array(steps["engine"]["outputs"]["torque"]["value"])
    assert total == pytest.approx(torque, abs=1e-9 * np.abs(torque).max())


def test_the_response_of_the_engine_balances_its_power_and_has_its_firing_order(steps):
    out = {name: np.array(answer["value"]) for name, answer in steps["torsion"]["outputs"].items()}
    assert out["power_balance_error"] < 1e-8
    assert out["power_in"] == pytest.approx(out["power_lost"], rel=1e-8)
    assert out["vibratory_torque"].shape == (7, 21)
    clutch = out["torque_of_orders"][6].max(axis=0)
    assert out["engine_orders"][clutch.argmax()] == 2
    minor = ~np.isin(out["engine_orders"], [2, 4, 6, 8])
    assert clutch[minor].max() < 0.05 * clutch.max()
    assert out["shaft_heat"][0].max() > 1


def test_a_misfire_and_a_bore_change_what_the_shafts_bear(http, steps):
    missing = {**TRAIN, "gas_factors": [1, 0, 1, 1]}
    torsion = {
        **DESIGN["steps"]["torsion"],
        "inputs": missing,
        "outputs": ["torque_of_orders", "largest_torque"],
    }
    changed = created(http, {**DESIGN, "steps": {**DESIGN["steps"], "torsion": torsion}})
    orders = np.array(revision(http, changed)["steps"]["torsion"]["outputs"]["torque_of_orders"]["value"])
    even = np.array(steps["torsion"]["outputs"]["torque_of_orders"]["value"])
    assert orders[6, :, 0].max() > 20 * even[6, :, 0].max()
    wider = created(http, {**DESIGN, "parameters": {**DESIGN["parameters"], "bore": "90 mm"}})
    torque = revision(http, wider)["steps"]["torsion"]["outputs"]["largest_torque"]["value"]
    assert torque[6] > 1.05 * steps["torsion"]["outputs"]["largest_torque"]["value"][6]


def test_the_stress_is_judged(http, design, steps):
    criteria = revision(http, design)["criteria"]
    stress = next(one for one in criteria if one["name"] == "torsion.stress")
    largest = np.max(steps["torsion"]["outputs"]["largest_stress"]["value"])
    assert stress["value"]["value"] == pytest.approx(largest, rel=1e-9)
    assert stress["verdict"] == ("met" if largest <= 60 else "not_met")
