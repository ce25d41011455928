"""bearing_load 1 and flywheel 1 with absurd inputs give a finite result or a refusal by name."""

import json

import numpy as np
import pytest
from seeds import seeded

from app.calculations import json_values
from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.bearing_load.flywheel_v1 import Flywheel
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate

BOTH = pytest.mark.parametrize("cls", [BearingLoad, Flywheel])
WILD = (0, -1, 1e-3, 1e3, 1e-9, 1e9, 1e-150, 1e150, 1e300)


def answered(cls, raw):
    """The answer as JSON, which takes neither NaN nor infinity; or the names of what is refused."""
    try:
        return json.loads(json.dumps(json_values.evaluation(evaluate(cls, raw)), allow_nan=False))["outputs"]
    except InvalidInputs as refusal:
        faults = refusal.faults
    assert faults
    assert all(fault.name in {*cls.inputs, *cls.formulas} and fault.detail for fault in faults), faults
    return None


class TestSingleExtremes:
    @BOTH
    @pytest.mark.parametrize(
        "change",
        [
            {"speed": "0 rpm"}, {"speed": "-3000 rpm"}, {"bore": "0 mm"}, {"rod_mass": "0 kg"},
            {"piston_mass": "0 kg"}, {"rod_centre": "0 mm"}, {"rod_ratio": 1 + 1e-9}, {"rod_ratio": 1e6},
            {"rod_ratio": np.nextafter(1, 2).item()}, {"crank_centre": "-40 mm"}, {"gas_cycle": "none"},
            {"gas_cycle": "none", "speed": "0 rpm"}, {"crankcase_pressure": "100 bar"},
        ],
    )  # fmt: skip
    def test_property_answers(self, cls, change):
        raw = {n: v for n, v in cls.example.items() if n != "rod_pendulum_period"}
        outputs = answered(cls, {**raw, "rod_centre": "30 mm", "rod_inertia": "1e-3 kg*m**2", **change})
        assert outputs
        assert outputs["torque"]["value"] is not None

    @BOTH
    @pytest.mark.parametrize("n", [1, 0.5, 0, -3])
    def test_property_rod_no_longer_than_the_crank_is_refused(self, cls, n):
        with pytest.raises(InvalidInputs) as refusal:
            evaluate(cls, {**cls.example, "rod_ratio": n})
        (fault,) = refusal.value.faults
        assert (fault.name, fault.code) == ("rod_ratio", "out_of_range")
        assert "> 1" in fault.detail

    def test_analytic_towards_the_locking_ratio(self):
        """At 90° the piston's acceleration is omega² r/√(n² − 1)."""
        for n in (2, 1.01, 1.0001, 1 + 1e-9, 1 + 1e-14):
            raw = {**BearingLoad.example, "rod_ratio": n, "crank_angle_step": "30 deg", "gas_cycle": "none"}
            t = evaluate(BearingLoad, raw, outputs=["piston_acceleration"], level="lumped").template
            exact = float(t.omega) ** 2 * float(t.r) / np.sqrt((float(t.n) - 1) * (float(t.n) + 1))
            assert t.a[3] == pytest.approx(exact, rel=1e-9), n

    def test_analytic_reversed_speed_has_the_forces_of_the_same_angle(self):
        forward = evaluate(BearingLoad, BearingLoad.example)
        back = evaluate(BearingLoad, {**BearingLoad.example, "speed": "-3000 rpm"})
        assert np.array_equal(forward.outputs["main_load_y"].value, back.outputs["main_load_y"].value)
        spin = [built.outputs["rod_angular_velocity"].value for built in (forward, back)]
        assert np.array_equal(spin[0], -spin[1])
        assert back.outputs["mean_power"].value == -forward.outputs["mean_power"].value
        assert [w.code for w in back.warnings] == ["coarse_curves", "reversed_cycle"]

    def test_analytic_loads_pass_through_zero(self):
        raw = {**BearingLoad.example, "crank_angle_step": "1 deg"}
        for name in ("crankpin_load_x", "crankpin_load_y", "wall_force", "torque"):
            curve = evaluate(BearingLoad, raw, outputs=[name]).outputs[name].value
            assert curve.min() < 0 < curve.max()

    @BOTH
    def test_property_default_that_does_not_exist_is_not_shown(self, cls):
        """No suction, no exhaust pressure; and null for the point of an array at which there is none."""
        raw = {n: v for n, v in cls.example.items() if n not in ("suction_pressure", "exhaust_pressure")}
        reported = json_values.evaluation(evaluate(cls, {**raw, "gas_cycle": "none"}))
        assert "exhaust_pressure" not in reported["inputs"]
        some = {**raw, "suction_pressure": {"value": [1, -1], "unit": "bar"}}
        reported = json.loads(json.dumps(json_values.evaluation(evaluate(cls, some)), allow_nan=False))
        assert reported["inputs"]["exhaust_pressure"]["value"] == [1, None]

    @BOTH
    def test_property_too_many_values_are_refused(self, cls):
        speeds = {"value": list(range(1000, 2000)), "unit": "rpm"}
        with pytest.raises(InvalidInputs) as refusal:
            evaluate(cls, {**cls.example, "speed": speeds, "crank_angle_step": "0.1 deg"}, outputs=["torque"])
        assert {fault.name for fault in refusal.value.faults} == {"crank_angle_step"}


def drawn(cls, rng):
    """Inputs around the example, single ones decades away, signs turned, some left out."""
    t = cls.from_quantities(cls.example)
    raw = {}
    for name in cls.example:
        declared = cls.inputs[name]
        if rng.random() < 0.005:
            continue
        if name in ("strokes", "gas_cycle", "crank_angle_step", "cylinders", "firing_order"):
            raw[name] = cls.example[name]
            continue
        if name == "cylinder_positions":
            raw[name] = {"value": rng.normal(size=5).tolist(), "unit": "m"}
            continue
        value = float(declared.meaning.scale.from_si(getattr(t, declared.attribute)))
        wild = rng.choice(WILD) if rng.random() < 0.04 else 1.0
        raw[name] = {"value": float(value * wild * rng.uniform(0.95, 1.05)), "unit": declared.meaning.unit}
    raw["gas_cycle"] = str(rng.choice(["none", "otto", "diesel", "four_stroke"]))
    raw["strokes"] = int(rng.choice([2, 4]))
    if "cylinders" in cls.inputs:
        raw["firing_order"] = [int(i) for i in rng.permutation(5) + 1]
        if rng.random() < 0.1:
            raw["firing_order"][0] = raw["firing_order"][-1]
    return raw


def check(cls, seed, count):
    rng = np.random.default_rng(seed)
    reported = 0
    for _ in range(count):
        raw = drawn(cls, rng)
        outputs = answered(cls, raw)
        for name, answer in (outputs or {}).items():
            reported += 1
            assert answer["value"] is not None or answer["reason"], (name, raw)
    assert reported > count


@BOTH
def test_property_random_inputs(cls):
    check(cls, 1, 300)


@pytest.mark.slow
@BOTH
def test_property_ten_thousand_random_inputs(cls):
    check(cls, seeded(2), 10_000)
