"""forced_torsion 1 refuses impossible trains, names the input, and states what would be right."""

import re

import numpy as np
import pytest
from trains import TONE, typed

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.stiffness.forced_torsion_v1 import ForcedTorsion

TRAIN = {**TONE, "inertias": [0.4, 0.1, 2.0, 0.5], "shaft_from": [1, 3], "shaft_to": [2, 4],
         "shaft_stiffness": [3e4, 1e4], "shaft_damping": [1, 1], "gear_from": [2], "gear_to": [3],
         "gear_ratios": [-0.5], "speeds": [50.0, 100.0]}  # fmt: skip


def refused(change):
    raw = typed({name: value for name, value in {**TRAIN, **change}.items() if value is not None})
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(ForcedTorsion, raw)
    return {name: fault.detail for fault in refusal.value.faults for name in fault.names}


@pytest.mark.parametrize(
    ("change", "name", "words"),
    [
        ({"shaft_to": [2, 9]}, "shaft_to", "two existing inertias"),
        ({"shaft_to": [1, 4]}, "shaft_to", "two existing inertias"),
        ({"shaft_from": [0, 3]}, "shaft_from", "number the inertias from 1"),
        ({"shaft_from": [1.5, 3]}, "shaft_from", "whole number"),
        ({"shaft_to": [2]}, "shaft_to", "give equal lengths"),
        ({"shaft_stiffness": [3e4, 1e4, 1e4]}, "shaft_stiffness", ""),
        ({"shaft_stiffness": [-3e4, 1e4]}, "shaft_stiffness", "≥ 0"),
        ({"inertias": [0.4, 0, 2.0, 0.5]}, "inertias", "> 0"),
        ({"inertias": [0.4, -0.1, 2.0, 0.5]}, "inertias", "> 0"),
        ({"gear_to": [8]}, "gear_to", "two existing inertias"),
        ({"gear_to": None}, "gear_to", "three lists"),
        ({"gear_ratios": [0]}, "gear_ratios", "no ratio is 0"),
        ({"gear_from": [2, 3, 4], "gear_to": [3, 4, 2], "gear_ratios": [1, 1, 1]}, "gear_to", "in a loop"),
        ({"gear_from": [2, 1], "gear_to": [3, 3], "gear_ratios": [-0.5, -0.5]}, "gear_to", "twice|once"),
        ({"gear_from": [2, 1], "gear_to": [3, 4], "gear_ratios": [-0.5, 2]}, "gear_ratios", "around a loop"),
        ({"gear_from": None, "gear_to": None, "gear_ratios": None}, "shaft_from", "loose parts|one train"),
        ({"excited_inertias": [7]}, "excited_inertias", "exist"),
        ({"excited_inertias": [1, 3], "firing_angles": [0, 180]}, "excited_inertias", "same mean speed"),
        ({"firing_angles": [0, 180]}, "firing_angles", ""),
        ({"propeller_inertia": 4}, "propeller_inertia", "all three"),
        ({"observed_inertia": 5}, "observed_inertia", "exists"),
        ({"crank_angle": [0, 45, 90, 135, 180, 225, 270, 300]}, "crank_angle", "equal steps"),
        ({"crank_angle": [30.0 * i for i in range(8)]}, "crank_angle", "720 deg"),
        ({"gas_torque": None}, "gas_torque", "one of them"),
        ({"inertia_torque": TONE["gas_torque"]}, "inertia_speed", "both"),
        ({"inertia_speed": "1000 rpm"}, "inertia_speed", "both"),
        ({"highest_order": 4}, "highest_order", "lower order"),
        ({"highest_order": 0.5}, "highest_order", ""),
        ({"speeds": [0.0, 50.0]}, "speeds", "> 0"),
        ({"speeds": np.linspace(1, 2, 2001)}, "speeds", "fewer"),
        ({"inertias": [[0.4, 0.1, 2.0, 0.5]] * 2, "shaft_from": [[1, 3]] * 2}, "shaft_from", "lists"),
    ],
)  # fmt: skip
def test_property_refusals_name_the_input(change, name, words):
    faults = refused(change)
    assert name in faults, faults
    assert re.search(words, faults[name]), faults


def test_property_a_closed_cycle_that_does_not_close_is_refused():
    closed = {"crank_angle": [*TONE["crank_angle"], 360.0], "gas_torque": [*TONE["gas_torque"], 0.3]}
    assert "omit the last point" in refused(closed)["gas_torque"]


@pytest.mark.parametrize("shift", [0.0, 1e-15])
def test_property_an_undamped_resonance_that_is_hit_is_refused_with_its_remedy(shift):
    one = {"inertias": [0.5], "shaft_from": [1], "shaft_to": [0], "shaft_stiffness": [2e4],
           "shaft_damping": None, "gear_from": None, "gear_to": None, "gear_ratios": None}  # fmt: skip
    faults = refused({**one, "speeds": [100.0, 200.0 * (1 + shift)]})
    assert all("has no finite value" in detail or "resonance" in detail for detail in faults.values()), faults
    assert any("resonance without damping" in detail for detail in faults.values())
    near = {**TRAIN, **one, "speeds": [100.0, 200.1]}
    raw = typed({name: value for name, value in near.items() if value is not None})
    assert np.isfinite(np.array(evaluate(ForcedTorsion, raw).outputs["vibratory_torque"].value)).all()


def test_property_hostile_lists_are_refused_quickly():
    many = list(range(1, 20001))
    faults = refused({"shaft_from": many, "shaft_to": [n + 1 for n in many],
                      "shaft_stiffness": [1e4] * 20000, "shaft_damping": None})  # fmt: skip
    assert "300 shafts" in faults["shaft_from"]


def test_property_random_lists_are_refused_or_calculated():
    rng = np.random.default_rng(65)
    calculated, reasons = 0, set()
    for _ in range(600):
        n, s, g = (int(rng.integers(low, high)) for low, high in ((1, 5), (1, 5), (0, 3)))
        change = {
            "inertias": 10 ** rng.uniform(-3, 2, n), "shaft_from": rng.integers(1, n + 2, s),
            "shaft_to": rng.integers(0, n + 2, s), "shaft_stiffness": 10 ** rng.uniform(1, 6, s),
            "shaft_damping": rng.uniform(0.1, 2, s), "excited_inertias": rng.integers(1, n + 2, 1),
            "gear_from": rng.integers(1, n + 1, g).tolist() or None,
            "gear_to": rng.integers(1, n + 1, g).tolist() or None,
            "gear_ratios": rng.choice([-2.0, 0.5, 1.0], g).tolist() or None,
        }  # fmt: skip
        numbers = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in change.items()}
        raw = typed({name: value for name, value in {**TRAIN, **numbers}.items() if value is not None})
        try:
            out = evaluate(ForcedTorsion, raw).outputs
        except InvalidInputs as error:
            reasons.update(fault.name for fault in error.faults)
        else:
            calculated += 1
            assert np.isfinite(np.array(out["vibratory_torque"].value)).all()
    assert calculated > 5
    assert {"shaft_from", "gear_to", "excited_inertias"} <= reasons
