"""`stress_life` 1: Basquin's line, mean stress, notches; limits, monotony, refusals."""

from math import log10, sqrt

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.physics.shafts.stress_concentration import shoulder_fillet_Pilkey_2008
from templates.stiffness.stress_life_v1 import StressLife

STEEL = {
    "ultimate_strength": "800 MPa",
    "fatigue_strength_coefficient": "1150 MPa",
    "fatigue_strength_exponent": -0.09,
}
REACH = {"torsion": 4.0, "bending": 20.0}
ROARK = {
    "torsion": [
        (0.953, 0.680, -0.053),
        (-0.493, -1.820, 0.517),
        (1.621, 0.908, -0.529),
        (-1.081, 0.232, 0.065),
    ],
    "blunt": [
        (0.927, 1.149, -0.086),
        (0.015, -3.281, 0.837),
        (0.847, 1.716, -0.506),
        (-0.790, 0.417, -0.246),
    ],
    "sharp": [
        (1.225, 0.831, -0.010),
        (-3.790, 0.958, -0.257),
        (7.374, -4.834, 0.862),
        (-3.809, 3.046, -0.595),
    ],
}
LINES = ("goodman", "gerber", "morrow")


def answers(raw):
    return evaluate(StressLife, {**STEEL, **raw})


def outputs(raw):
    return {name: answer.value for name, answer in answers(raw).outputs.items()}


def local(amplitude, mean, **others):
    return {"stress_amplitude": f"{amplitude} MPa", "mean_stress": f"{mean} MPa", **others}


def refused(raw):
    with pytest.raises(InvalidInputs) as refusal:
        answers(raw)
    return {(name, fault.code) for fault in refusal.value.faults for name in fault.names}


def roark(loading, D, slope):
    """Roark's polynomial for a shoulder on a section of diameter 1; slope is its height over its fillet."""

    def polynomial(rows):
        return sum((a + b * slope**0.5 + c * slope) * (1 - 1 / D) ** i for i, (a, b, c) in enumerate(rows))

    if loading == "torsion":
        return polynomial(ROARK["torsion"])
    return np.where(slope <= 2, polynomial(ROARK["blunt"]), polynomial(ROARK["sharp"]))


class TestLiterature:
    @pytest.mark.parametrize(
        ("coefficient", "exponent", "amplitude", "reversals"),
        [(1758, -0.0977, 1758 * 2e6**-0.0977, 2e6), (900, -0.1, 900 * 1e5**-0.1, 1e5)],
    )
    def test_literature_basquin(self, coefficient, exponent, amplitude, reversals):
        raw = {"fatigue_strength_coefficient": f"{coefficient} MPa", "fatigue_strength_exponent": exponent}
        result = outputs({**local(amplitude, 0), **raw, "ultimate_strength": "1172 MPa"})
        assert result["cycles"] == pytest.approx(reversals / 2, rel=1e-9)

    def test_literature_dowling_morrow(self):
        """sigma_a = (sigma_f' - sigma_m)(2 N)^b: AISI 4340, 1758 MPa, -0.0977 (Dowling, table 9.1)."""
        N = 1e5
        amplitude = (1758 - 200) * (2 * N) ** -0.0977
        raw = {"fatigue_strength_coefficient": "1758 MPa", "fatigue_strength_exponent": -0.0977,
               "ultimate_strength": "1172 MPa", "mean_stress_correction": "morrow"}  # fmt: skip
        assert outputs({**local(amplitude, 200), **raw})["cycles"] == pytest.approx(N, rel=1e-9)

    @pytest.mark.parametrize("loading", ["torsion", "bending"])
    def test_literature_roark_s_fit_of_the_same_charts(self, loading):
        """Roark's Formulas for Stress and Strain, table 17.1: other coefficients, the same to 3.5 %."""
        D, slope = np.meshgrid(np.linspace(1.02, 2.5, 30), np.linspace(0.25, REACH[loading], 60))
        fitted = roark(loading, D, slope)
        assert shoulder_fillet_Pilkey_2008(loading, D, 1.0, (D - 1) / 2 / slope) == pytest.approx(
            fitted, rel=0.035
        )


class TestAnalytic:
    @pytest.mark.parametrize("line", [*LINES, "none"])
    def test_analytic_without_mean_stress_all_are_basquin(self, line):
        result = outputs(local(300, 0, mean_stress_correction=line))
        assert result["equivalent_amplitude"] == pytest.approx(300)
        assert result["cycles"] == pytest.approx(0.5 * (300 / 1150) ** (1 / -0.09), rel=1e-12)

    @pytest.mark.parametrize(
        ("line", "equivalent"),
        [("goodman", 200 / (1 - 300 / 800)), ("gerber", 200 / (1 - (300 / 800) ** 2)),
         ("morrow", 200 / (1 - 300 / 1150)), ("none", 200)],
    )  # fmt: skip
    def test_analytic_equivalent_amplitude(self, line, equivalent):
        result = outputs(local(200, 300, mean_stress_correction=line))
        assert result["equivalent_amplitude"] == pytest.approx(equivalent, rel=1e-12)

    @pytest.mark.parametrize("line", [*LINES, "none"])
    def test_analytic_a_part_loaded_by_its_safety_factor_is_at_the_limit(self, line):
        raw = {"mean_stress_correction": line, "endurance_limit": "300 MPa"}
        n = outputs({**local(100, 120), **raw})["safety_factor"]
        for load, life in ((n * (1 - 1e-9), "endless"), (n * (1 + 1e-9), "finite")):
            assert outputs({**local(100 * load, 120 * load), **raw})["life"] == life

    @pytest.mark.parametrize("line", [*LINES, "none"])
    def test_analytic_design_life_is_where_the_safety_factor_is_one(self, line):
        life = outputs(local(250, 100, mean_stress_correction=line))["cycles"]
        result = outputs(local(250, 100, mean_stress_correction=line, design_life=life))
        assert result["safety_factor"] == pytest.approx(1, rel=1e-12)
        assert result["amplitude_safety_factor"] == pytest.approx(1, rel=1e-12)

    def test_analytic_slope_of_the_line(self):
        """In log-log the line falls by b for each decade of reversals."""
        lives = [outputs(local(a, 0))["cycles"] for a in (300, 330)]
        assert log10(300 / 330) / log10(lives[0] / lives[1]) == pytest.approx(-0.09, rel=1e-10)

    def test_analytic_gerber_lies_above_goodman(self):
        lives = [outputs(local(250, 200, mean_stress_correction=c))["cycles"] for c in ("goodman", "gerber")]
        assert lives[0] < lives[1]

    def test_analytic_nominal_stress_with_its_notch(self):
        raw = {"nominal_stress_amplitude": "80 MPa", "nominal_mean_stress": "30 MPa",
               "notch_sensitivity": 0.8, "stress_concentration_factor": 2.0}  # fmt: skip
        bent, twisted = outputs({**raw, "loading": "bending"}), outputs({**raw, "loading": "torsion"})
        assert (bent["stress_amplitude"], bent["mean_stress"]) == pytest.approx((80 * 1.8, 30 * 1.8))
        assert twisted["stress_amplitude"] == pytest.approx(sqrt(3) * 80 * 1.8)

    @pytest.mark.parametrize("r", [0.0249, 0.02501])
    def test_analytic_the_two_fits_in_bending_meet(self, r):
        """At t/r = 2, here r = 0.025: they differ by less than 1 %."""
        either = shoulder_fillet_Pilkey_2008("bending", 1.1, 1.0, 0.025)
        assert shoulder_fillet_Pilkey_2008("bending", 1.1, 1.0, r) == pytest.approx(either, rel=0.01)

    def test_analytic_solve_finds_the_amplitude_of_a_life(self):
        raw = {**STEEL, "mean_stress": "100 MPa"}
        result = solve(StressLife, raw, "stress_amplitude", ["100 MPa", "600 MPa"], {"cycles": 1e6})
        assert result.unknown == pytest.approx((1 - 100 / 800) * 1150 * 2e6**-0.09, rel=1e-9)


class TestEndless:
    @pytest.mark.parametrize("amplitude", [0, 100, 200])
    def test_property_endless_life_is_said(self, amplitude):
        answer = answers(local(amplitude, 0, endurance_limit="200 MPa")).outputs
        assert answer["cycles"].value is None
        assert answer["cycles"].reason.startswith("endless")
        assert answer["life"].value == "endless"

    def test_property_above_the_limit_life_ends(self):
        assert outputs(local(200.001, 0, endurance_limit="200 MPa"))["life"] == "finite"
        assert outputs(local(100, 0))["life"] == "finite"

    def test_property_no_stress_without_a_limit_is_endless_too(self):
        assert outputs(local(0, 0))["life"] == "endless"
        assert answers(local(1e-200, 0)).outputs["cycles"].reason.startswith("endless")


class TestWarnings:
    @pytest.mark.parametrize("line", ["goodman", "gerber"])
    def test_property_compression_counts_as_no_mean_stress(self, line):
        answer = answers(local(300, -200, mean_stress_correction=line))
        assert answer.outputs["equivalent_amplitude"].value == pytest.approx(300)
        assert ["compressive_mean"] == [w.code for w in answer.warnings]

    def test_property_morrow_lets_compression_lengthen_life(self):
        answer = answers(local(300, -200, mean_stress_correction="morrow"))
        assert answer.outputs["equivalent_amplitude"].value == pytest.approx(300 / (1 + 200 / 1150))
        assert answer.warnings == []

    @pytest.mark.parametrize("mean", [150, -150])
    def test_property_yield_is_warned_of(self, mean):
        raw = {"mean_stress_correction": "morrow", "yield_strength": "449 MPa"}
        (warning,) = answers({**local(300, mean), **raw}).warnings
        assert warning.code == "yields"
        assert "= 450 MPa is above yield strength 449 MPa" in warning.detail
        assert answers({**local(300, mean), **raw, "yield_strength": "451 MPa"}).warnings == []

    def test_property_few_cycles_are_warned_of(self):
        names = [w.name for w in answers(local(700, 0)).warnings]
        assert names == ["cycles"]

    @pytest.mark.parametrize(("fillet", "warned"), [(1.2, True), (1.3, False), (19, False), (21, True)])
    def test_property_the_chart_s_ends_are_warned_of(self, fillet, warned):
        """d 50 and D 60 mm in torsion: t/r is 4 at 1.25 mm and 0.25 at 20 mm."""
        raw = {"nominal_stress_amplitude": "20 MPa", "nominal_mean_stress": "0 MPa", "loading": "torsion",
               "larger_diameter": "60 mm", "smaller_diameter": "50 mm",
               "fillet_radius": f"{fillet} mm"}  # fmt: skip
        assert any(w.name == "fillet_radius" for w in answers(raw).warnings) == warned


class TestRefusals:
    NOMINAL = {"nominal_stress_amplitude": "20 MPa", "nominal_mean_stress": "0 MPa"}

    @pytest.mark.parametrize(
        ("raw", "named"),
        [
            (local(800, 0), ("stress_amplitude", "inconsistent")),
            (local(0, 800), ("mean_stress", "inconsistent")),
            (local(500, 300), ("ultimate_strength", "inconsistent")),
            (local(-1, 0), ("stress_amplitude", "out_of_range")),
            (local(300, 0, fatigue_strength_exponent=0), ("fatigue_strength_exponent", "out_of_range")),
            (local(300, 0, fatigue_strength_coefficient="200 MPa"), ("cycles", "outside_domain")),
            (local(1, 250, fatigue_strength_coefficient="200 MPa", mean_stress_correction="morrow"),
             ("mean_stress_share", "outside_domain")),
            (local(300, 0, endurance_limit="1200 MPa"), ("endurance_limit", "inconsistent")),
            (local(300, 0, mean_stress_correction="soderberg"), ("mean_stress_correction", "not_an_option")),
            ({"stress_amplitude": "300 MPa"}, ("mean_stress", "inconsistent")),
            ({"mean_stress": "0 MPa"}, ("stress_amplitude", "inconsistent")),
            (NOMINAL, ("stress_concentration_factor", "inconsistent")),
            ({**NOMINAL, "stress_concentration_factor": 0.9},
             ("stress_concentration_factor", "out_of_range")),
            ({**NOMINAL, "larger_diameter": "50 mm", "smaller_diameter": "60 mm", "fillet_radius": "2 mm"},
             ("smaller_diameter", "inconsistent")),
        ],
    )  # fmt: skip
    def test_property_bad_input_is_named(self, raw, named):
        assert named in refused(raw)

    def test_property_nothing_asked_for_a_notch_without_nominal_stress(self):
        assert {name for name, _ in refused({"mean_stress": "0 MPa"})} == {
            "stress_amplitude",
            "nominal_stress_amplitude",
        }


class TestProperty:
    @pytest.mark.parametrize("size", [500, pytest.param(10_000, marks=pytest.mark.slow)])
    @pytest.mark.parametrize("line", [*LINES, "none"])
    def test_property_more_stress_never_means_more_life(self, line, size):
        rng = np.random.default_rng(2)
        amplitude, mean = rng.uniform(1, 500, size), rng.uniform(-400, 400, size)
        growth = rng.uniform(1.0001, 1.5, size)

        def lives(amplitude, mean):
            raw = {"stress_amplitude": {"value": amplitude.tolist(), "unit": "MPa"},
                   "mean_stress": {"value": mean.tolist(), "unit": "MPa"}}  # fmt: skip
            result = evaluate(
                StressLife, {**STEEL, **raw, "mean_stress_correction": line}, outputs=["cycles"]
            )
            return result.outputs["cycles"].value

        life = lives(amplitude, mean)
        present = ~np.isnan(life)
        assert present.mean() > 0.5
        for shorter in (lives(amplitude * growth, mean), lives(amplitude, mean + abs(mean) * (growth - 1))):
            both = present & ~np.isnan(shorter)
            assert np.all(shorter[both] <= life[both] * (1 + 1e-12))
