"""`torsional_vibration` 1 against Mendes' six-cylinder engine, the paper's crankshaft, and its refusals."""

import csv
from math import pi
from pathlib import Path

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.stiffness.torsional_vibration_v1 import TorsionalVibration

REFERENCES = Path(__file__).parents[2] / "references"
TWO = {"inertias": ["1 kg*m**2", "2 kg*m**2"], "stiffnesses": ["6000 N*m/rad"]}


def mendes():
    lines = (REFERENCES / "torsional_frequencies.csv").read_text(encoding="utf-8").splitlines()
    (row,) = csv.DictReader(line for line in lines if not line.startswith("#"))
    return {
        name: [float(x) for x in row[name].split()] for name in ("inertias", "stiffnesses", "frequencies")
    }


def outputs(raw, *names):
    return {n: a.value for n, a in evaluate(TorsionalVibration, raw, outputs=names or None).outputs.items()}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(TorsionalVibration, raw)
    return {(name, fault.code) for fault in refusal.value.faults for name in fault.names}


class TestLiterature:
    def test_literature_mendes_2008(self):
        case = mendes()
        raw = {
            "inertias": {"value": case["inertias"], "unit": "kg*m**2"},
            "stiffnesses": {"value": case["stiffnesses"], "unit": "N*m/rad"},
        }
        result = outputs(raw)["natural_frequencies"]
        assert result[0] == 0
        assert result == pytest.approx(case["frequencies"], rel=1e-6, abs=0)

    @pytest.mark.parametrize(("stiffness", "unit"), [(1.882e5, "N*m/rad"), (3.285e6, "N*mm/deg")])
    def test_literature_the_paper_s_crankshaft(self, stiffness, unit):
        raw = {"inertias": ["4.609e-3 kg*m**2"], "stiffnesses": [f"{stiffness} {unit}"], "ends": "fixed_free"}
        assert outputs(raw)["natural_frequencies"] == pytest.approx([1017.1], rel=1e-4)


class TestAnalytic:
    def test_analytic_one_free_inertia_only_turns(self):
        result = outputs({"inertias": ["2 kg*m**2"]}, "natural_frequencies", "mode_shapes")
        assert result["natural_frequencies"].tolist() == [0]
        assert result["mode_shapes"].tolist() == [[1]]

    def test_analytic_two_inertias(self):
        result = outputs(TWO, "natural_frequencies", "mode_shapes")
        assert result["natural_frequencies"] == pytest.approx([0, 9000**0.5 / (2 * pi)], rel=1e-14)
        assert result["mode_shapes"] == pytest.approx(np.array([[1, 1], [1, -0.5]]), rel=1e-14)

    def test_analytic_orders_meet_frequencies(self):
        raw = {**TWO, "engine_orders": [0.5, 3], "speed_range": ["100 rpm", "400 rpm"]}
        result = outputs(raw)
        critical = 9000**0.5 / (2 * pi) * 60
        assert result["critical_speeds"] == pytest.approx(np.array([[0, critical / 0.5], [0, critical / 3]]))
        assert result["resonances"] == f"order 3 meets mode 1 at {critical / 3:.5g} rpm"
        speeds, lines = result["campbell_speeds"], result["excitation_frequencies"]
        assert (speeds[0], speeds[-1]) == pytest.approx((100, 400))
        assert lines == pytest.approx(np.outer([0.5, 3], speeds) / 60)
        at = np.interp(critical / 3, speeds, lines[1])
        assert at == pytest.approx(result["natural_frequencies"][1], rel=1e-12)

    def test_analytic_no_resonance_in_the_range_is_said(self):
        raw = {**TWO, "engine_orders": 1, "speed_range": ["10 rpm", "20 rpm"]}
        assert outputs(raw)["resonances"] == "none from 10 to 20 rpm"
        assert outputs(raw)["critical_speeds"].shape == (1, 2)

    def test_analytic_rows_are_trains(self):
        raw = {"inertias": {"value": [[1, 2], [2, 4]], "unit": "kg*m**2"}, "engine_orders": [1, 2],
               "stiffnesses": {"value": [[6000], [12000]], "unit": "N*m"},
               "speed_range": ["1 rpm", "9000 rpm"]}  # fmt: skip
        result = outputs(raw)
        assert result["natural_frequencies"][0] == pytest.approx(result["natural_frequencies"][1], rel=1e-14)
        assert result["critical_speeds"].shape == result["mode_shapes"].shape == (2, 2, 2)
        assert result["resonances"][0] == result["resonances"][1]


class TestRefusals:
    @pytest.mark.parametrize(
        ("change", "named"),
        [
            ({"stiffnesses": ["1 N*m/rad", "1 N*m/rad"]}, ("stiffnesses", "inconsistent")),
            ({"ends": "fixed_free"}, ("stiffnesses", "inconsistent")),
            ({"ends": "free"}, ("ends", "not_an_option")),
            ({"inertias": ["1 kg*m**2", "0 kg*m**2"]}, ("inertias", "out_of_range")),
            ({"stiffnesses": ["0 N*m/rad"]}, ("stiffnesses", "out_of_range")),
            ({"stiffnesses": ["-1 N*m/rad"]}, ("stiffnesses", "out_of_range")),
            ({"inertias": "1 kg*m**2"}, ("inertias", "not_a_curve")),
            ({"inertias": [1, 2]}, ("inertias", "missing_unit")),
            ({"stiffnesses": ["1 N/m"]}, ("stiffnesses", "wrong_unit")),
            ({"engine_orders": [0]}, ("engine_orders", "out_of_range")),
            ({"speed_range": ["20 rpm", "10 rpm"]}, ("speed_range", "inconsistent")),
            ({"speed_range": ["20 rpm", "30 rpm", "40 rpm"]}, ("speed_range", "inconsistent")),
            ({"speed_range": ["20 Hz", "30 Hz"]}, ("speed_range", "ambiguous_unit")),
            ({"stiffnesses": ["1e300 N*m/rad"]}, ("natural_angular_frequencies", "outside_domain")),
        ],
    )
    def test_property_bad_input_is_named(self, change, named):
        assert named in refused({**TWO, **change})

    def test_property_a_missing_stiffness_is_named(self):
        assert ("stiffnesses", "inconsistent") in refused({"inertias": TWO["inertias"]})

    def test_property_long_chains(self):
        long = {"inertias": {"value": [1] * 501, "unit": "kg*m**2"},
                "stiffnesses": {"value": [1] * 500, "unit": "N*m/rad"}}  # fmt: skip
        assert ("inertias", "inconsistent") in refused(long)
        fits = {name: {**value, "value": value["value"][:-301]} for name, value in long.items()}
        assert outputs(fits, "mode_shapes")["mode_shapes"].shape == (200, 200)
        assert ("inertias", "inconsistent") in refused(
            {**fits, "inertias": {"value": [[1] * 200] * 26, "unit": "kg*m**2"}}
        )

    def test_property_what_needs_an_optional_input_says_so(self):
        answers = evaluate(TorsionalVibration, TWO).outputs
        assert (answers["critical_speeds"].value, answers["critical_speeds"].reason) == (
            None,
            "needs engine_orders",
        )
        assert answers["campbell_speeds"].reason == "needs speed_range"
        assert answers["resonances"].reason == "needs engine_orders, speed_range"


class TestExtremes:
    @pytest.mark.parametrize("size", [300, pytest.param(10_000, marks=pytest.mark.slow)])
    @pytest.mark.parametrize("ends", ["free_free", "fixed_free"])
    def test_property_scales_over_600_decades_are_finite_or_refused(self, ends, size):
        rng, refusals = np.random.default_rng(1), []
        for _ in range(size):
            n = int(rng.integers(1, 6))
            springs = n - (ends == "free_free")
            reach = rng.choice([2, 9, 300])
            raw = {"inertias": {"value": (10 ** rng.uniform(-reach, reach, n)).tolist(), "unit": "kg*m**2"},
                   "ends": ends}  # fmt: skip
            if springs:
                values = (10 ** rng.uniform(-reach, reach, springs)).tolist()
                raw["stiffnesses"] = {"value": values, "unit": "N*m/rad"}
            try:
                result = outputs(raw, "natural_frequencies", "mode_shapes")
            except InvalidInputs:
                refusals.append(reach)
                continue
            assert np.all(np.diff(result["natural_frequencies"]) >= 0)
            assert np.abs(result["mode_shapes"]).max(axis=1) == pytest.approx(np.ones(n), abs=1e-15)
        assert set(refusals) == {300}
