"""`engine`: the mean torque is the work of the gas, by quadrature between the events and by fine steps."""

from itertools import pairwise

import numpy as np
import pytest

from templates.bearing_load.engine_v1 import Engine
from templates.core.language.evaluate import evaluate

OMEGA = 4500 * np.pi / 30
ARTICULATED = {"masters", "articulation_radius", "articulation_angle"}


def deg(*values):
    return {"value": list(values), "unit": "deg"}


def run(raw):
    return evaluate(Engine, raw)


def values(raw):
    names = ["torque", "mean_torque", "mean_power", "indicated_mean_effective_pressure"]
    return {name: one.value for name, one in evaluate(Engine, raw, outputs=names).outputs.items()}


TABLE = {
    "gas_cycle": "table",
    "pressure_angle": deg(*range(0, 720, 15)),
    "pressure": {
        "value": (1 + 40 * np.exp(-(((np.arange(0, 720, 15) - 370) / 40) ** 2))).tolist(),
        "unit": "bar",
    },
}
GASES = {
    "four_stroke": {},
    "opens_after_dead_centre": {"exhaust_opens": "560 deg"},
    "overlap": {"inlet_opens": "690 deg", "exhaust_closes": "40 deg"},
    "otto": {"gas_cycle": "otto"},
    "diesel": {"gas_cycle": "diesel", "cutoff": 2},
    "table": TABLE,
}
OFFSET = {name: value for name, value in Engine.example.items() if name not in ARTICULATED} | {
    "rod_length": "120 mm",
    "cylinder_offset": "9 mm",
}


def work_of(run, cylinder):
    """Return the work of the gas in one cylinder over a cycle [J], by quadrature between its events."""
    template = run.template
    gas, crank, area = template.gas, template.crank, np.pi / 4 * 0.086**2
    if hasattr(gas, "exchange_begins"):
        ends = (gas.exchange_begins, gas.exchange_ends, gas.inlet_closes, gas.exhaust_opens, gas.cut)
        corners = {float(np.broadcast_to(end, (2,))[cylinder]) % gas.cycle for end in ends}
        corners |= {gas.firing, gas.emptied}
    else:
        corners = set(gas.angle)
    corners = sorted(corners | {0.0, gas.cycle})
    node, weight = np.polynomial.legendre.leggauss(60)
    work = 0.0
    for begin, end in pairwise(corners):
        angle = (begin + end) / 2 + (end - begin) / 2 * node
        motion = crank.at(angle + np.broadcast_to(crank.top, (2,))[:, None])
        travel = crank.travel(motion.alpha)
        p = gas.pressure(angle + 0 * travel, travel)
        work += (end - begin) / 2 * weight @ (-p * motion.x1 * area)[cylinder]
    return work


class TestMeanTorque:
    """The work of the gas in all cylinders over the cycle, at any step: no mass takes any in the mean."""

    @pytest.mark.parametrize("base", [Engine.example, OFFSET], ids=["articulated", "offset"])
    @pytest.mark.parametrize("gas", GASES)
    def test_second_method_work_by_quadrature_between_the_events(self, base, gas):
        raw = {**base, **GASES[gas]}
        work = [work_of(run(raw), k) for k in range(2)]
        out = values(raw)
        assert out["mean_torque"] == pytest.approx(sum(work) / (4 * np.pi), rel=1e-9)
        assert out["mean_power"] == pytest.approx(sum(work) / (4 * np.pi) * OMEGA / 1e3, rel=1e-9)
        swept = np.pi / 4 * 0.086**2 * run(raw).template.crank.stroke
        by_work = np.array(work) / swept / 1e5
        assert out["indicated_mean_effective_pressure"] == pytest.approx(by_work, rel=1e-9)

    @pytest.mark.parametrize("gas", GASES)
    def test_limit_it_is_the_mean_of_the_curve_at_fine_steps_and_the_same_at_any_step(self, gas):
        raw = {**Engine.example, **GASES[gas]}
        fine, coarse = (values({**raw, "crank_angle_step": step}) for step in ("0.1 deg", "60 deg"))
        assert coarse["mean_torque"] == fine["mean_torque"]
        assert fine["torque"].mean() == pytest.approx(fine["mean_torque"], rel=5e-5)
        assert coarse["torque"].mean() != pytest.approx(coarse["mean_torque"], rel=1e-3)

    def test_property_without_gas_there_is_none(self):
        out = values({**Engine.example, "gas_cycle": "none"})
        assert out["mean_torque"] == 0
        assert np.ptp(out["torque"]) > 1

    def test_property_a_factor_multiplies_the_work_of_its_cylinder(self):
        whole = values(Engine.example)["indicated_mean_effective_pressure"]
        raw = {**Engine.example, "pressure_factor": [1, 0.7]}
        assert values(raw)["indicated_mean_effective_pressure"] == pytest.approx(whole * [1, 0.7], rel=1e-12)

    def test_property_many_points_at_once(self):
        ratios = [8.0, 9.0, 10.0]
        many = values({**Engine.example, "compression_ratio": ratios})
        for k, ratio in enumerate(ratios):
            alone = values({**Engine.example, "compression_ratio": ratio})
            for name in ("mean_torque", "indicated_mean_effective_pressure"):
                assert many[name][k] == pytest.approx(alone[name], rel=1e-12), name
