"""Gas cycles: ideal efficiencies, tables, events, and refusals by name."""

import numpy as np
import pytest

from templates.bearing_load.bearing_load_v1 import BearingLoad
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.physics.engine.gas_checks import _work, work_between_points

BASE = {**BearingLoad.example, "crank_angle_step": "1 deg"}
IDEAL = {**BASE, "compression_exponent": 1.4, "expansion_exponent": 1.4, "suction_pressure": "1 bar",
         "exhaust_pressure": "1 bar"}  # fmt: skip


def values(raw, **options):
    return {name: answer.value for name, answer in evaluate(BearingLoad, raw, **options).outputs.items()}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(BearingLoad, raw)
    return {name: fault.detail for fault in refusal.value.faults for name in fault.names}


class TestIdeal:
    @pytest.mark.parametrize("strokes", [2, 4])
    def test_analytic_otto_efficiency(self, strokes):
        """Work over heat is 1 − r^(1−k); heat at constant volume is (p_3 − p_2) V_c/(k − 1)."""
        out = values({**IDEAL, "gas_cycle": "otto", "strokes": strokes})
        heat = (60 - 10**1.4) / 9 / 0.4  # bar, over the swept volume
        efficiency = out["indicated_mean_effective_pressure"] / heat
        assert efficiency == pytest.approx(1 - 10**-0.4, rel=1e-12)

    @pytest.mark.parametrize("strokes", [2, 4])
    def test_analytic_diesel_efficiency(self, strokes):
        """Work over heat is 1 − r^(1−k) (ρ^k − 1)/(k (ρ − 1)); heat is k/(k − 1) p_2 V_c (ρ − 1)."""
        ratio, rho = 18, 2.2
        out = values({**IDEAL, "gas_cycle": "diesel", "compression_ratio": ratio, "cutoff": rho,
                      "strokes": strokes})  # fmt: skip
        heat = 1.4 / 0.4 * ratio**1.4 / (ratio - 1) * (rho - 1)
        expected = 1 - ratio**-0.4 * (rho**1.4 - 1) / (1.4 * (rho - 1))
        assert out["indicated_mean_effective_pressure"] / heat == pytest.approx(expected, rel=1e-12)
        assert out["peak_gas_pressure"] == pytest.approx(ratio**1.4, rel=1e-12)

    def test_analytic_isothermal_exponent_is_no_exception(self):
        near = values({**IDEAL, "gas_cycle": "otto", "compression_exponent": 1 + 1e-9})
        at = values({**IDEAL, "gas_cycle": "otto", "compression_exponent": 1})
        name = "indicated_mean_effective_pressure"
        assert at[name] == pytest.approx(near[name], rel=1e-8)

    def test_analytic_otto_pressures_at_dead_centres(self):
        p = values({**IDEAL, "gas_cycle": "otto"})["gas_pressure"]
        assert p[[0, 90, 360, 540, 630]] == pytest.approx([1, 1, 60, 1, 1], rel=1e-12)
        assert p[539] > 2
        assert p[359] == pytest.approx(10**1.4, rel=0.01)

    def test_analytic_practical_cycle_with_ideal_events_is_otto(self):
        ideal = {"inlet_opens": "0 deg", "inlet_closes": "180 deg", "exhaust_opens": "540 deg",
                 "exhaust_closes": "720 deg", "cutoff": 1}  # fmt: skip
        four, otto = (values({**BASE, **ideal, "gas_cycle": cycle}) for cycle in ("four_stroke", "otto"))
        assert np.array_equal(four["gas_pressure"], otto["gas_pressure"])
        assert four["mean_torque"] == otto["mean_torque"]


class TestPractical:
    def test_analytic_pressure_is_continuous_but_at_combustion(self):
        """Twenty times finer angles jump a twentieth, apart from the rise at 360°."""
        coarse = np.abs(np.diff(values({**BASE, "crank_angle_step": "2 deg"})["gas_pressure"]))
        fine = np.abs(np.diff(values({**BASE, "crank_angle_step": "0.1 deg"})["gas_pressure"]))
        assert fine.argmax() == 3599
        smooth = np.delete(fine, 3599)
        assert smooth.max() < np.delete(coarse, 179).max() / 12

    def test_analytic_valve_events(self):
        out = values({**BASE, "crank_angle_step": "1 deg"})
        angle, p = out["crank_angle"], out["gas_pressure"]
        assert p[(angle >= 14) & (angle <= 222)] == pytest.approx(0.9, rel=1e-12)
        assert p[(angle >= 540) & (angle <= 705)] == pytest.approx(1.1, rel=1e-12)
        assert p[0] == pytest.approx(1.1 - 0.2 * 15 / 29, rel=1e-12)
        assert out["peak_gas_pressure"] == pytest.approx(60, rel=1e-12)
        assert p[222] < p[230] < p[300]

    def test_analytic_valves_may_be_counted_from_either_side(self):
        one = values({**BASE, "inlet_opens": "705 deg", "exhaust_closes": "14 deg"})
        other = values({**BASE, "inlet_opens": "-15 deg", "exhaust_closes": "734 deg"})
        assert other["gas_pressure"] == pytest.approx(one["gas_pressure"], rel=1e-12)

    def test_analytic_late_exhaust_drops_at_once(self):
        out = values({**BASE, "exhaust_opens": "570 deg"})
        assert out["gas_pressure"][570] == pytest.approx(1.1)
        assert out["gas_pressure"][569] > 2


def indicated(step):
    angle = np.arange(0, 720, step)
    return angle, 1 + 50 * np.exp(-(((angle - 370) / 25) ** 2))


class TestTable:
    @pytest.mark.parametrize("step", [5, 10, 15])
    def test_analytic_linear_between_points(self, step):
        angle, p = indicated(step)
        raw = {**BASE, "gas_cycle": "table", "pressure": {"value": p.tolist(), "unit": "bar"}}
        out = values(raw)
        expected = np.interp(out["crank_angle"], [*angle, 720], [*p, p[0]])
        assert out["gas_pressure"] == pytest.approx(expected, rel=1e-12)
        reported = {**raw, "pressure_angle": {"value": angle.tolist(), "unit": "deg"}}
        assert values(reported)["gas_pressure"] == pytest.approx(expected, rel=1e-12)

    def test_analytic_last_point_may_repeat_the_first(self):
        angle, p = indicated(5)
        raw = {**BASE, "gas_cycle": "table"}
        plain = {"pressure": {"value": p.tolist(), "unit": "bar"},
                 "pressure_angle": {"value": angle.tolist(), "unit": "deg"}}  # fmt: skip
        twice = {"pressure": {"value": [*p.tolist(), float(p[0])], "unit": "bar"},
                 "pressure_angle": {"value": [*angle.tolist(), 720], "unit": "deg"}}  # fmt: skip
        one, other = values({**raw, **plain}), values({**raw, **twice})
        assert other["gas_pressure"] == pytest.approx(one["gas_pressure"], rel=1e-12)
        assert other["mean_torque"] == pytest.approx(one["mean_torque"], rel=1e-12)

    def test_analytic_table_may_begin_anywhere(self):
        angle, p = indicated(5)
        raw = {**BASE, "gas_cycle": "table"}
        turned = {"pressure": {"value": np.roll(p, 72).tolist(), "unit": "bar"},
                  "pressure_angle": {"value": (angle - 360).tolist(), "unit": "deg"}}  # fmt: skip
        plain = {"pressure": {"value": p.tolist(), "unit": "bar"}}
        one, other = values({**raw, **plain}), values({**raw, **turned})
        assert other["gas_pressure"] == pytest.approx(one["gas_pressure"], rel=1e-9)
        assert other["mean_torque"] == pytest.approx(one["mean_torque"], rel=1e-10)

    def test_property_many_tables_at_once(self):
        _, p = indicated(10)
        raw = {**BASE, "gas_cycle": "table"}
        both = values({**raw, "pressure": {"value": [p.tolist(), (2 * p).tolist()], "unit": "bar"}})
        for i, alone in enumerate((p, 2 * p)):
            single = values({**raw, "pressure": {"value": alone.tolist(), "unit": "bar"}})
            assert both["torque"][i] == pytest.approx(single["torque"], rel=1e-12)
            assert both["mean_torque"][i] == pytest.approx(single["mean_torque"], rel=1e-12)


class TestRefusals:
    def table(self, angle, p=None):
        p = np.ones(len(angle)) if p is None else p
        p, angle = ({"value": np.asarray(v).tolist(), "unit": u} for v, u in ((p, "bar"), (angle, "deg")))
        return refused({**BASE, "gas_cycle": "table", "pressure": p, "pressure_angle": angle})

    def test_property_each_fault_names_its_input(self):
        swapped = [0.0, 90, 45, 180, 270, 360, 450, 540, 630]
        assert "strictly ascending" in self.table(swapped)["pressure_angle"]
        assert "full cycle" in self.table(np.arange(0, 360, 5.0))["pressure"]
        assert "repeats its" in self.table(np.arange(0, 721, 5.0), np.linspace(1, 2, 145))["pressure"]
        assert "full cycle" in self.table([0.0, 360.0])["pressure"]

    def test_property_pressure_out_of_range(self):
        angle = np.arange(0, 720, 5.0)
        assert "≤ 1000 bar" in self.table(angle, np.full(144, 5000.0))["pressure"]
        assert "≥ -1.1 bar" in self.table(angle, np.full(144, -3.0))["pressure"]

    @pytest.mark.parametrize(
        ("cycle", "name"),
        [("otto", "combustion_pressure"), ("otto", "suction_pressure"), ("diesel", "compression_ratio"),
         ("four_stroke", "combustion_pressure"), ("table", "pressure")],
    )  # fmt: skip
    def test_property_cycle_says_what_it_needs(self, cycle, name):
        raw = {n: v for n, v in BASE.items() if n != name}
        faults = refused({**raw, "gas_cycle": cycle})
        assert list(faults) == [name]
        assert "need" in faults[name]

    def test_property_two_strokes_have_no_practical_four_stroke_cycle(self):
        assert set(refused({**BASE, "strokes": 2})) == {"gas_cycle", "strokes"}
        assert set(refused({**BASE, "strokes": 3})) == {"strokes"}

    def test_property_combustion_that_outlasts_the_stroke(self):
        assert {"cutoff", "compression_ratio"} <= set(refused({**BASE, "cutoff": 9.9}))

    def test_property_step_that_does_not_divide_the_cycle(self):
        assert set(refused({**BASE, "crank_angle_step": "7 deg"})) == {"crank_angle_step", "strokes"}

    def test_property_doubtful_pressures_carry_a_warning(self):
        codes = {w.code for w in evaluate(BearingLoad, {**BASE, "combustion_pressure": "6 bar"}).warnings}
        assert "pressure_falls" in codes
        slip = {**BASE, "gas_cycle": "table", "pressure": {"value": [0.001] * 144, "unit": "bar"}}
        warnings = evaluate(BearingLoad, slip).warnings
        assert any(w.name == "peak_gas_pressure" and "units" in w.detail for w in warnings)

    def test_property_diesel_without_cutoff_does_no_work(self):
        out = evaluate(BearingLoad, {**IDEAL, "gas_cycle": "diesel", "cutoff": 1})
        assert out.outputs["mean_torque"].value == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("step", [5, 10, 20, 24, 30, 36, 40, 45])
def test_the_work_that_a_table_misses_is_estimated(step):
    """The pressure is a bell of 60° behind dead centre; the tables begin at 16 angles within their step."""
    bell = lambda angle: 1e5 + 60e5 * np.exp(-(((angle % 720 - 375) / 30) ** 2))  # noqa: E731
    fine, true, stated = np.arange(0, 720, 0.25), [], []
    whole = _work(np.radians(fine), bell(fine), 4 * np.pi)
    for shift in np.linspace(0, step, 16, endpoint=False):
        angle = np.arange(shift, 720 + shift - 1e-9, step)
        true.append(abs(_work(np.radians(angle), bell(angle), 4 * np.pi) / whole - 1))
        missed = work_between_points("table", np.asarray(4.0), np.radians(angle), bell(angle))
        stated.append(missed.item())
    assert max(true) < 1.5 * max(stated)
    assert max(stated) < 0.02 or step > 10


@pytest.mark.parametrize("p", [np.full(24, 1e5), np.zeros(9)])
def test_a_constant_pressure_misses_no_work(p):
    assert work_between_points("table", np.asarray(4.0), np.asarray(np.nan), p) == 0.0
