"""forced_torsion 1: closed forms, gears by hand, power in and out, a second program, traps."""

import numpy as np
import pytest
from trains import TONE, reference, values

from templates.core.language.evaluate import evaluate
from templates.stiffness.forced_torsion_v1 import ForcedTorsion
from templates.stiffness.torsional_vibration_v1 import TorsionalVibration

W = np.linspace(1, 400, 300)


def test_analytic_single_inertia_on_a_damped_shaft():
    J, k, c = 2.0, 8e4, 30.0
    out = values({**TONE, "inertias": [J], "shaft_from": [1], "shaft_to": [0], "shaft_stiffness": [k],
                  "shaft_damping": [c], "speeds": W})  # fmt: skip
    angle = 1 / np.abs(k - J * W**2 + 1j * c * W)
    assert np.radians(out["vibratory_angle"][0]) == pytest.approx(angle, rel=1e-12)
    assert out["vibratory_torque"][0] == pytest.approx(angle * np.abs(k + 1j * c * W), rel=1e-12)
    assert out["shaft_heat"][0] == pytest.approx(c * (W * angle) ** 2 / 2, rel=1e-12)
    assert out["natural_frequencies"] == pytest.approx([np.sqrt(k / J) / (2 * np.pi)], rel=1e-12)


def test_analytic_two_inertias_without_damping():
    J, k = (0.3, 1.7), 9e4
    out = values({**TONE, "inertias": J, "shaft_from": [1], "shaft_to": [2], "shaft_stiffness": [k],
                  "speeds": W})  # fmt: skip
    torque = np.abs(k / J[0] / (k * (1 / J[0] + 1 / J[1]) - W**2))
    assert out["vibratory_torque"][0] == pytest.approx(torque, rel=1e-10)
    assert out["natural_frequencies"][0] == 0
    assert np.max(out["power_in"]) < 1e-12 * np.max(torque)


def test_analytic_resonance_is_limited_by_damping_alone():
    """At the natural frequency of one inertia the inertia and the shaft cancel: T over damping is left."""
    J, k, eta = 0.5, 2e4, 0.01
    resonance = np.sqrt(k / J)
    one = {**TONE, "inertias": [J], "shaft_from": [1], "shaft_to": [0], "shaft_stiffness": [k],
           "speeds": [resonance]}  # fmt: skip
    out = values({**one, "loss_factors": [eta]})
    assert out["vibratory_torque"][0, 0] == pytest.approx(np.abs(1 + 1j * eta) / eta, rel=1e-10)
    out = values({**one, "absolute_damping": [3.0]})
    assert np.radians(out["vibratory_angle"][0, 0]) == pytest.approx(1 / (3 * resonance), rel=1e-10)
    assert out["inertia_loss"][0, 0] == pytest.approx(1 / (2 * 3), rel=1e-10)


@pytest.mark.parametrize("ratio", [-2.5, 0.4])
def test_analytic_gear_is_its_reduction_by_hand(ratio):
    geared = {**TONE, "inertias": [0.5, 0.2, 0.1, 3], "shaft_from": [1, 3], "shaft_to": [2, 4],
              "shaft_stiffness": [5e4, 2e4], "shaft_damping": [2, 0], "loss_factors": [0, 0.03],
              "absolute_damping": [0, 0, 0, 4], "gear_from": [2], "gear_to": [3], "gear_ratios": [ratio],
              "speeds": W}  # fmt: skip
    square = ratio**2
    plain = {**TONE, "inertias": [0.5, 0.2 + 0.1 * square, 3 * square], "shaft_from": [1, 2],
             "shaft_to": [2, 3], "shaft_stiffness": [5e4, 2e4 * square], "shaft_damping": [2, 0],
             "loss_factors": [0, 0.03], "absolute_damping": [0, 0, 4 * square], "speeds": W}  # fmt: skip
    a, b = values(geared), values(plain)
    assert a["vibratory_angle"][:2] == pytest.approx(b["vibratory_angle"][:2], rel=1e-10)
    assert a["vibratory_angle"][3] == pytest.approx(abs(ratio) * b["vibratory_angle"][2], rel=1e-10)
    assert a["vibratory_torque"][1] * abs(ratio) == pytest.approx(b["vibratory_torque"][1], rel=1e-10)
    assert a["natural_frequencies"] == pytest.approx(b["natural_frequencies"], rel=1e-10, abs=1e-9)
    assert a["shaft_heat"] == pytest.approx(b["shaft_heat"], rel=1e-9)


@pytest.mark.parametrize("name", ["diesel", "geared"])
def test_literature_openTorsion_agrees_order_by_order(name):
    plain, expected = reference(name)
    out = values(plain, speeds="rpm")
    assert out["torque_of_orders"].shape == expected.shape
    assert out["torque_of_orders"] == pytest.approx(expected, rel=1e-6)
    assert out["power_balance_error"] < 1e-8
    assert out["power_lost"] == pytest.approx(out["power_in"], rel=1e-8)


def test_property_swing_is_below_the_sum_of_amplitudes_and_above_each():
    plain, amplitudes = reference("diesel")
    torque = values(plain, ["vibratory_torque"], speeds="rpm")["vibratory_torque"]
    assert np.all(torque <= amplitudes.sum(axis=-1) * (1 + 1e-6))
    assert np.all(torque >= amplitudes.max(axis=-1) * np.pi / 4 * (1 - 1e-6))
    assert np.max(amplitudes.sum(axis=-1) / torque) > 1.5


@pytest.mark.parametrize("mu", [0.1, 0.2, 0.5])
def test_literature_den_hartog_untuned_viscous_damper(mu):
    """The best damping is 2 mu J w / sqrt(2 (1+mu) (2+mu)); the peak at the fixed point is then 1 + 2/mu."""
    w, best = 100.0, 1 / np.sqrt(2 * (1 + mu) * (2 + mu))
    speeds = w * np.sqrt(2 / (2 + mu)) * np.linspace(0.7, 1.3, 1801)

    def peak(share):
        out = values({**TONE, "inertias": [1, mu], "shaft_from": [1, 1], "shaft_to": [0, 2],
                      "shaft_stiffness": [w**2, 0], "shaft_damping": [0, share * 2 * best * mu * w],
                      "speeds": speeds}, ["largest_angle"])  # fmt: skip
        return np.radians(out["largest_angle"][0]) * w**2

    assert peak(1) == pytest.approx(1 + 2 / mu, rel=1e-6)
    assert min(peak(0.97), peak(1.03)) > 1 + 2 / mu


@pytest.mark.parametrize("kind", ["viscous", "rubber"])
def test_literature_den_hartog_tuned_damper_at_its_fixed_points(kind):
    """With f = 1/(1+mu) the response is sqrt(1+2/mu) at two frequencies, whatever the damping."""
    mu, w = 0.2, 100.0
    f = 1 / (1 + mu)
    fixed = w * np.sqrt((1 + np.array([-1, 1]) * np.sqrt(mu / (2 + mu))) / (1 + mu))
    for z in (0.05, 0.2, 0.5):
        damping = (
            {"shaft_damping": [0, 2 * z * mu * w]} if kind == "viscous" else {"loss_factors": [0, 2 * z]}
        )
        out = values({**TONE, **damping, "inertias": [1, mu], "shaft_from": [1, 1], "shaft_to": [0, 2],
                      "shaft_stiffness": [w**2, mu * (f * w) ** 2], "speeds": fixed})  # fmt: skip
        assert np.radians(out["vibratory_angle"][0]) * w**2 == pytest.approx(np.sqrt(1 + 2 / mu), rel=1e-10)


def test_analytic_propeller_damps_by_its_slope_at_each_speed():
    """Torque 900 N m at 300 rad/s of its own shaft, here at half the speed of the crank: slope 2 T/w."""
    speeds = np.array([200.0, 400.0, 600.0])
    train = {**TONE, "inertias": [0.4, 0.1, 2.0], "shaft_from": [1], "shaft_to": [2],
             "shaft_stiffness": [3e4], "gear_from": [2], "gear_to": [3], "gear_ratios": [-0.5]}  # fmt: skip
    got = values({**train, "speeds": speeds, "propeller_inertia": 3, "propeller_torque": "900 N*m",
                  "propeller_speed": {"value": 300, "unit": "rad/s"}})  # fmt: skip
    for i, speed in enumerate(speeds):
        own = speed / 2
        c = 2 * (900 * (own / 300) ** 2) / own
        one = values({**train, "speeds": [speed], "absolute_damping": [0, 0, c]})
        assert got["vibratory_torque"][:, i] == pytest.approx(one["vibratory_torque"][:, 0], rel=1e-12)
        assert got["inertia_loss"][2, i] == pytest.approx(one["power_in"][0], rel=1e-9)


def test_second_method_frequencies_and_critical_speeds_of_a_chain():
    chain = evaluate(TorsionalVibration, TorsionalVibration.example).outputs
    out = values({"inertias": [0.012, 0.0046, 0.35, 0.1], "shaft_from": [1, 2, 3], "shaft_to": [2, 3, 4],
                  "shaft_stiffness": [60e3, 188.2e3, 20e3], "crank_angle": TONE["crank_angle"],
                  "gas_torque": TONE["gas_torque"], "highest_order": 3, "excited_inertias": [1],
                  "firing_angles": [0], "speeds": [100.0]})  # fmt: skip
    assert out["natural_frequencies"] == pytest.approx(chain["natural_frequencies"].value, rel=1e-9)
    assert np.abs(out["mode_shapes"]) == pytest.approx(np.abs(chain["mode_shapes"].value), rel=1e-6, abs=1e-9)
    assert out["engine_orders"].tolist() == [1, 2, 3]
    assert out["critical_speeds"][1] == pytest.approx(chain["critical_speeds"].value[0], rel=1e-9)


class TestExcitation:
    ONE = {"inertias": [0.4], "shaft_from": [1], "shaft_to": [0], "shaft_stiffness": [4e4],
           "shaft_damping": [20], "speeds": [40.0, 90.0]}  # fmt: skip
    THETA = np.arange(0, 720, 10.0)
    GAS = 900 * np.exp(-(((np.radians(THETA) - 1) / 0.5) ** 2))
    SIX = {**ONE, "excited_inertias": [1] * 6, "firing_angles": [0, 480, 240, 600, 120, 360],
           "crank_angle": THETA, "gas_torque": GAS, "highest_order": 6}  # fmt: skip

    def test_trap_a_closed_cycle_counts_its_last_point_once(self):
        closed = {**self.SIX, "crank_angle": [*self.THETA, 720], "gas_torque": [*self.GAS, self.GAS[0]]}
        a, b = values(closed), values(self.SIX)
        assert a["engine_orders"].tolist() == b["engine_orders"].tolist() == [i / 2 for i in range(1, 13)]
        assert a["torque_of_orders"] == pytest.approx(b["torque_of_orders"], rel=1e-12, abs=1e-9)

    def test_trap_equal_firing_leaves_the_major_orders_alone(self):
        """Six cylinders on one inertia leave orders 3 and 6, of six times the size."""
        six = values(self.SIX)["torque_of_orders"][0]
        one = values({**self.SIX, "excited_inertias": [1], "firing_angles": [0]})["torque_of_orders"][0]
        major = np.isin(np.arange(1, 13) / 2, [3, 6])
        assert six[:, major] == pytest.approx(6 * one[:, major], rel=1e-10)
        assert np.all(six[:, ~major] < 1e-10 * six[:, major].max())

    def test_limit_a_misfire_brings_the_minor_orders(self):
        out = values({**self.SIX, "gas_factors": [1, 1, 0, 1, 1, 1]})["torque_of_orders"][0]
        one = values({**self.SIX, "excited_inertias": [1], "firing_angles": [0]})["torque_of_orders"][0]
        assert out[:, 0] == pytest.approx(one[:, 0], rel=1e-10)

    def test_property_the_origin_of_the_crank_angle_does_not_count(self):
        late = {**self.SIX, "crank_angle": self.THETA + 130, "gas_torque": np.roll(self.GAS, -13)}
        assert values(late)["vibratory_torque"] == pytest.approx(
            values(self.SIX)["vibratory_torque"], rel=1e-9
        )

    def test_analytic_inertia_torque_grows_with_the_square_of_the_speed(self):
        tone = {**TONE, **self.ONE, "inertia_torque": TONE["gas_torque"],
                "inertia_speed": {"value": 45, "unit": "rad/s"}}  # fmt: skip
        gas = values({**TONE, **self.ONE})["vibratory_torque"][0]
        both = values(tone)["vibratory_torque"][0]
        assert both == pytest.approx(gas * (1 + (np.array([40, 90]) / 45) ** 2), rel=1e-12)


def test_analytic_angular_speed_of_a_free_inertia():
    """T cos(w t) on an inertia that turns freely: its speed swings by T/(J w)."""
    out = values({**TONE, "inertias": [0.4, 1e-6], "shaft_from": [1], "shaft_to": [2],
                  "shaft_stiffness": [1e3], "speeds": [50.0, 100.0]})  # fmt: skip
    swing = 1 / (0.400001 * np.array([50, 100]))
    assert out["angular_speed_spectrum"][:, 0] == pytest.approx(swing, rel=1e-5)
    assert out["irregularity"] == pytest.approx(2 * swing / [50, 100], rel=1e-5)


def test_property_points_of_arrays_are_those_points():
    plain, _ = reference("geared")
    dampings = [[4, 3, 20, 10, 2], [8, 3, 20, 10, 2], [4, 3, 20, 0, 2]]
    many = values({**plain, "shaft_damping": dampings}, speeds="rpm")
    for i, damping in enumerate(dampings):
        one = values({**plain, "shaft_damping": damping}, speeds="rpm")
        for name in ("vibratory_torque", "power_lost", "largest_angle", "torque_of_orders"):
            assert many[name][i] == pytest.approx(one[name], rel=1e-10), name


def test_property_random_trees_give_out_what_they_take_in():
    rng = np.random.default_rng(18)
    for _ in range(12):
        n = int(rng.integers(2, 9))
        parents = [int(rng.integers(1, i + 1)) for i in range(1, n)]
        shafts = len(parents)
        train = {"inertias": 10 ** rng.uniform(-3, 2, n), "shaft_from": parents,
                 "shaft_to": list(range(2, n + 1)), "shaft_stiffness": 10 ** rng.uniform(2, 7, shafts),
                 "shaft_damping": 10 ** rng.uniform(-2, 2, shafts),
                 "loss_factors": rng.uniform(0, 0.3, shafts),
                 "crank_angle": np.arange(0, 720, 20.0), "gas_torque": rng.normal(0, 500, 36),
                 "excited_inertias": [1, n], "firing_angles": rng.uniform(0, 720, 2), "highest_order": 6,
                 "section_moduli": [5.0], "speeds": [50.0, 120.0, 333.0]}  # fmt: skip
        out = values(train)
        assert out["power_balance_error"] < 1e-8
        assert np.all(np.isfinite(out["vibratory_torque"]))
        assert out["largest_torque"] == pytest.approx(out["vibratory_torque"].max(axis=1), rel=1e-12)
        assert out["vibratory_stress"] == pytest.approx(out["vibratory_torque"] / 5, rel=1e-9)


def test_property_example_names_the_shaft_that_is_worst():
    out = values_of_example()
    worst = out["vibratory_torque"].argmax(axis=1)
    assert out["worst_speed"] == pytest.approx(np.array([800, 1300, 1800, 2300])[worst], rel=1e-12)
    amplitudes = np.array([rows[at] for rows, at in zip(out["torque_of_orders"], worst, strict=True)])
    assert out["worst_order"].tolist() == out["engine_orders"][amplitudes.argmax(axis=1)].tolist()
    assert out["torque_envelope"] == pytest.approx(out["vibratory_torque"].max(axis=0), rel=1e-12)


def values_of_example():
    answers = evaluate(ForcedTorsion, ForcedTorsion.example).outputs
    return {name: np.array(answer.value) for name, answer in answers.items()}
