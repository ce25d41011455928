"""flywheel 1: the nine-cylinder set of DYREMI, balance and flywheel against independent sums, refusals."""

import numpy as np
import pytest
from nine_cylinders import INPUTS as NINE
from nine_cylinders import PRINTED

from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.bearing_load.flywheel_v1 import Flywheel
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.physics.engine.balance import Arrangement, two_planes


def values(raw, **options):
    return {name: answer.value for name, answer in evaluate(Flywheel, raw, **options).outputs.items()}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(Flywheel, raw)
    return {(name, fault.code) for fault in refusal.value.faults for name in fault.names}


class TestLiteratureNineCylinders:
    """Rao & Singh 1993/94, generator set; tests/references/nine_cylinder_set.json says what is derived."""

    def test_literature_derived_masses(self):
        out = values(NINE, outputs=["rotating_mass", "reciprocating_mass"])
        assert out["rotating_mass"] == pytest.approx(20, rel=1e-14)
        assert out["reciprocating_mass"] == pytest.approx(65, rel=1e-14)

    def test_literature_balance_with_exact_pi(self):
        out = values(NINE)
        assert round(out["rotating_couple"], 2) == 12127.84
        assert round(out["balance_flywheel"], 2) == round(out["balance_damper"], 2) == 257.19
        assert out["balance_flywheel_angle"] == pytest.approx(350, abs=1e-9)
        assert out["balance_damper_angle"] == pytest.approx(170, abs=1e-9)

    def test_literature_forces_vanish(self):
        out = values(NINE)
        assert out["rotating_force"] == out["primary_force"] == out["secondary_force"] == 0
        assert not out["residual_force_x"].any()

    def test_literature_print_to_its_last_digit_with_pi_of_the_program(self):
        """π = 3.1416, crank angles (720 − 80 · place) mod 720: the program's arithmetic, here alone."""
        pi = 3.1416
        place = np.argsort(NINE["firing_order"])
        turn = (720 - 80 * place) % 720 * pi / 180
        row = Arrangement(turn, 0 * turn, 0.4 * np.arange(9) - 1.6)
        omega = 2 * pi * 1000 / 60
        couple = 20 * omega**2 * 0.15 * abs(row.rotating(row.arm))
        assert round(float(couple), 2) == PRINTED["rotating_couple"]
        planes = two_planes(row, 1.6, 3.8, -0.5)
        for name in ("flywheel", "damper"):
            phasor = getattr(planes, name)
            assert round(float(20 * 0.15 * abs(phasor) * 1e3), 2) == PRINTED[f"balance_{name}"]
            angle = np.angle(phasor) % (2 * pi) * 180 / pi
            assert round(float(angle), 3) == PRINTED[f"balance_{name}_angle"]

    def test_analytic_couples_go_with_their_masses(self):
        """By hand: sums of arms times cos and sin of the cranks, in Python's own arithmetic."""
        out = values(NINE)
        omega, radius = 1000 * 2 * np.pi / 60, 0.15
        place = {cylinder: k for k, cylinder in enumerate(NINE["firing_order"])}
        for harmonic, name, mass in ((1, "primary_couple", 65.0), (2, "secondary_couple", 65.0 / 4)):
            angles = [np.radians(-80.0 * place[i] * harmonic) for i in range(1, 10)]
            x = sum((0.4 * i - 1.6) * np.cos(a) for i, a in enumerate(angles))
            y = sum((0.4 * i - 1.6) * np.sin(a) for i, a in enumerate(angles))
            assert out[name] == pytest.approx(mass * omega**2 * radius * np.hypot(x, y), rel=1e-12)

    def test_analytic_masses_in_the_planes_balance_forces_and_couples(self):
        places = {"value": [0, 0.3, 0.8, 1.1, 1.7, 2.2, 2.4, 3.0, 3.3], "unit": "m"}
        raw = {**NINE, "cylinder_positions": places, "firing_order": [1, 3, 5, 7, 9, 8, 6, 4, 2]}
        out, z = values(raw), np.array(raw["cylinder_positions"]["value"])
        crank = 20 * 150 * np.exp(-1j * np.radians(80) * np.argsort(raw["firing_order"]))
        planes = [(out["balance_flywheel"], out["balance_flywheel_angle"], 3.8),
                  (out["balance_damper"], out["balance_damper_angle"], -0.5)]  # fmt: skip
        masses = [(b * np.exp(1j * np.radians(angle)), at) for b, angle, at in planes]
        assert abs(crank.sum() + sum(b for b, _ in masses)) < 1e-10 * 3000
        assert abs((crank * z).sum() + sum(b * at for b, at in masses)) < 1e-10 * 3000


FOUR = {
    **Flywheel.example,
    "cylinders": 4,
    "firing_order": [1, 3, 4, 2],
    "cylinder_positions": {"value": [0, 0.1, 0.2, 0.3], "unit": "m"},
}


class TestBalance:
    def test_analytic_in_line_four_has_its_secondary_force_alone(self):
        out = values(FOUR)
        omega, r = 1500 * np.pi / 30, 0.06
        assert out["primary_force"] == out["primary_couple"] == out["rotating_couple"] == 0
        expected = 4 * out["reciprocating_mass"] * omega**2 * r / 3.8
        assert out["secondary_force"] == pytest.approx(expected, rel=1e-13)
        assert out["secondary_couple"] == 0

    def test_analytic_residual_force_is_its_harmonics(self):
        """One cylinder, F_h = (m_rot + m_rec) ω² r cos θ + m_rec ω² r cos 2θ/n; the paper drops r."""
        out = values({**FOUR, "cylinders": 1, "firing_order": [1],
                      "cylinder_positions": {"value": [0], "unit": "m"}})  # fmt: skip
        theta, scale = np.radians(out["crank_angle"]), (1500 * np.pi / 30) ** 2 * 0.06
        M, m = out["rotating_mass"], out["reciprocating_mass"]
        F_h = scale * ((M + m) * np.cos(theta) + m * np.cos(2 * theta) / 3.8)
        assert out["residual_force_x"] == pytest.approx(F_h, rel=1e-12, abs=1e-12 * scale)
        assert out["residual_force_y"] == pytest.approx(M * scale * np.sin(theta), abs=1e-12 * scale)

    def test_analytic_90_degree_pair_on_one_pin_has_a_turning_primary_force(self):
        """Of constant size, one piston's m ω² r, so that a counterweight takes it; of the secondary √2."""
        row = Arrangement(np.array([0, -np.pi / 2]), np.array([0, np.pi / 2]), np.zeros(2))
        theta = np.linspace(0, 2 * np.pi, 25)
        assert np.abs(row.reciprocating(1).at(theta)) == pytest.approx(1, rel=1e-14)
        assert row.reciprocating(1).amplitude == pytest.approx(1, rel=1e-14)
        assert row.reciprocating(2).amplitude == pytest.approx(np.sqrt(2), rel=1e-14)

    @pytest.mark.parametrize("harmonic", [1, 2])
    def test_analytic_amplitude_in_banks_is_the_largest_on_the_way(self, harmonic):
        """V8 of 90° with five-bearing crank, unevenly placed pistons, against a search over the turn."""
        row = Arrangement(np.arange(8) * -np.pi / 2, np.radians([0, 90] * 4), np.arange(8) ** 1.5)
        theta = np.linspace(0, 2 * np.pi, 3601)[:, None]
        pistons = row.arm * np.cos(harmonic * (theta + row.turn)) * np.exp(1j * row.bank)
        largest = np.abs(pistons.sum(axis=-1)).max()
        assert row.reciprocating(harmonic, row.arm).amplitude == pytest.approx(largest, rel=1e-5)

    def test_analytic_bank_angle_turns_nothing_but_the_frame(self):
        turned = values({**FOUR, "bank_angles": "30 deg"})
        plain = values(FOUR)
        for name in ("secondary_force", "secondary_couple", "torque", "rotating_couple"):
            assert turned[name] == pytest.approx(plain[name], rel=1e-12, abs=1e-9)
        both = turned["residual_force_x"] + 1j * turned["residual_force_y"]
        straight = plain["residual_force_x"] + 1j * plain["residual_force_y"]
        assert both == pytest.approx(straight * np.exp(1j * np.pi / 6), rel=1e-9, abs=1e-6)


class TestTorque:
    def test_analytic_one_cylinder_is_that_of_bearing_load(self):
        shared = {n: v for n, v in Flywheel.example.items() if n in BearingLoad.inputs}
        one = {"cylinders": 1, "firing_order": [1], "cylinder_positions": {"value": [0], "unit": "m"}}
        cylinder = evaluate(BearingLoad, shared).outputs
        for level in ("lumped", "rigid"):
            cylinder = evaluate(BearingLoad, shared, level=level).outputs
            engine = values({**shared, **one}, level=level)
            T = cylinder["torque"].value
            assert engine["torque"] == pytest.approx(T, rel=1e-12, abs=1e-12 * np.abs(T).max())
            assert engine["mean_torque"] == pytest.approx(cylinder["mean_torque"].value, rel=1e-14)

    @pytest.mark.parametrize("count", [2, 3, 5, 9, 24])
    def test_analytic_sum_of_shifted_cylinders(self, count):
        """Against one cylinder at its own shifted angles, which need not fall on the engine's steps."""
        step = 720 / (count * -(-24 // count))
        raw = {**Flywheel.example, "cylinders": count, "firing_order": list(range(1, count + 1)),
               "cylinder_positions": {"value": [0.1 * i for i in range(count)], "unit": "m"},
               "crank_angle_step": f"{step:.17g} deg"}  # fmt: skip
        shared = {n: v for n, v in raw.items() if n in BearingLoad.inputs}
        T = evaluate(BearingLoad, shared).outputs["torque"].value
        shift = round(720 / count / step)
        expected = sum(np.roll(T, k * shift) for k in range(count))
        assert values(raw)["torque"] == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(T).max())

    def test_analytic_firing_order_does_not_change_the_torque(self):
        swapped = values({**FOUR, "firing_order": [1, 2, 4, 3]})
        assert np.array_equal(swapped["torque"], values(FOUR)["torque"])

    def test_analytic_energy_fluctuation_does_not_depend_on_the_step_of_the_curves(self):
        """It is summed at 1 deg at most, and converges with the square of a smaller step."""

        def swing(step):
            return values({**FOUR, "crank_angle_step": f"{step} deg"})["energy_fluctuation"]

        assert swing(8) == swing(30) == swing(1)
        errors = {step: abs(swing(step) / swing(0.1) - 1) for step in (1, 0.5)}
        assert errors[1] < 2e-4
        assert errors[0.5] < errors[1] / 2

    def test_analytic_flywheel_meets_both_criteria(self):
        out = values(FOUR)
        omega = 1500 * np.pi / 30
        by_swing = out["energy_fluctuation"] / (0.01 * omega**2)
        by_start = out["mean_torque"] / 40
        installed = out["engine_inertia"] + 0.05 + 0.5
        assert out["flywheel_inertia"] == pytest.approx(max(by_swing, by_start) - installed, rel=1e-12)
        lazy = values({**FOUR, "maximum_acceleration": "1e6 rad/s**2"})
        assert lazy["flywheel_inertia"] == pytest.approx(by_swing - installed, rel=1e-12)

    def test_analytic_inertia_of_the_engine(self):
        """I_c = m_w g_w² + m_cb g_cb² + (m_cp + m_3A) r² + ½ m_j r_j² + ½ m_cp r_cp² + ½ (m_3B + m_4) r²."""
        m_3A, m_3B = 1.9 * (228 - 70) / 228, 1.9 * 70 / 228
        I_c = (6 * 0.02**2 + 2.5 * 0.045**2 + (1.2 + m_3A) * 0.06**2 + 0.5 * 2 * 0.04**2
               + 0.5 * 1.2 * 0.035**2 + 0.5 * (m_3B + 1.4) * 0.06**2)  # fmt: skip
        assert values(FOUR)["engine_inertia"] == pytest.approx(4 * I_c, rel=1e-12)


class TestRefusals:
    def test_property_repeated_cylinder_in_the_firing_order(self):
        names = {("firing_order", "inconsistent"), ("cylinders", "inconsistent")}
        assert refused({**FOUR, "firing_order": [1, 3, 3, 2]}) == names
        assert refused({**FOUR, "firing_order": [0, 1, 2, 3]}) == {("firing_order", "out_of_range")}
        assert refused({**FOUR, "firing_order": [1, 2.5, 3, 4]}) == {("firing_order", "out_of_range")}

    def test_property_counts_that_do_not_fit(self):
        assert ("cylinders", "inconsistent") in refused({**FOUR, "cylinders": 5})
        positions = {"value": [0, 0.1], "unit": "m"}
        assert ("cylinder_positions", "shape") in refused({**FOUR, "cylinder_positions": positions})
        assert ("cylinders", "not_single") in refused({**FOUR, "cylinders": [4, 4]})

    def test_property_planes_that_coincide(self):
        raw = {**FOUR, "damper_position": "0.7 m"}
        names = {("damper_position", "inconsistent"), ("flywheel_position", "inconsistent")}
        assert refused(raw) == names

    def test_property_what_is_not_given_is_absent_with_its_reason(self):
        left = {"damper_position", "speed_fluctuation", "maximum_acceleration"}
        outputs = evaluate(Flywheel, {n: v for n, v in FOUR.items() if n not in left}).outputs
        assert "damper_position" in outputs["balance_flywheel"].reason
        assert outputs["flywheel_inertia"].value is None
        assert outputs["rotating_couple"].value is not None

    def test_property_at_rest_there_is_no_swing_to_even_out(self):
        outputs = evaluate(Flywheel, {**FOUR, "speed": "0 rpm"}).outputs
        assert outputs["inertia_for_fluctuation"].reason.startswith("at rest")
        assert np.isfinite(outputs["flywheel_inertia"].value)

    def test_property_twenty_four_cylinders_unevenly_spaced(self):
        rng = np.random.default_rng(24)
        places = {"value": np.sort(rng.uniform(0, 9, 24)).tolist(), "unit": "m"}
        order = [int(i) for i in rng.permutation(24) + 1]
        raw = {**FOUR, "cylinders": 24, "firing_order": order, "cylinder_positions": places}
        assert all(v is None or np.isfinite(v).all() for v in values(raw).values())
