"""`crank_stiffness` 1 against the hand case of the shared references, limits, and its own derivatives."""

from math import pi

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.physics.shafts.torsion_throw import ring
from templates.stiffness.crank_stiffness_v1 import CrankStiffness

HAND = {
    "journal_length": "45 mm",
    "journal_diameter": "100 mm",
    "web_thickness": "28 mm",
    "web_width": "130 mm",
    "pin_length": "50 mm",
    "pin_diameter": "85 mm",
    "throw": "68.5 mm",
    "shear_modulus": "80 GPa",
}
DIMENSIONS = [name for name in CrankStiffness.inputs if name not in ("shear_modulus", "reference_stiffness")]


def outputs(raw, *names):
    return {n: a.value for n, a in evaluate(CrankStiffness, raw, outputs=names or None).outputs.items()}


def refused(raw, *names):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(CrankStiffness, raw, outputs=names or None)
    return {(name, fault.code) for fault in refusal.value.faults for name in fault.names}


def carter(Lj, Dj, dj, Lw, W, Lc, Dc, dc, R):
    """As printed; over G pi/32."""
    return 1 / ((Lj + 0.8 * Lw) / (Dj**4 - dj**4) + 0.75 * Lc / (Dc**4 - dc**4) + 1.5 * R / (Lw * W**3))


def wilson(Lj, Dj, dj, Lw, W, Lc, Dc, dc, R):
    """As printed; over G pi/32."""
    return 1 / (
        (Lj + 0.4 * Dj) / (Dj**4 - dj**4)
        + (Lc + 0.4 * Dc) / (Dc**4 - dc**4)
        + (R - 0.2 * (Dj + Dc)) / (Lw * W**3)
    )


def random_throws(size):
    rng = np.random.default_rng(3)
    D_j, D_c = rng.uniform(40, 120, (2, size))
    return {
        "journal_length": rng.uniform(10, 90, size),
        "journal_diameter": D_j,
        "journal_bore": D_j * rng.uniform(0, 0.9, size),
        "web_thickness": rng.uniform(10, 50, size),
        "web_width": rng.uniform(80, 200, size),
        "pin_length": rng.uniform(10, 90, size),
        "pin_diameter": D_c,
        "pin_bore": D_c * rng.uniform(0, 0.9, size),
        "throw": rng.uniform(40, 150, size),
    }


def typed(throws):
    quantities = {name: {"value": values.tolist(), "unit": "mm"} for name, values in throws.items()}
    return {**quantities, "shear_modulus": "80 GPa"}


class TestLiterature:
    def test_literature_thin_throw_by_hand(self):
        result = outputs(HAND)
        assert result["stiffness_carter"] == pytest.approx(2.56442e6, rel=2e-6)
        assert result["stiffness_wilson"] == pytest.approx(2.64334e6, rel=2e-6)
        assert result["overlap"] == pytest.approx(24)
        assert result["recommended"] == "wilson"

    def test_literature_throw_of_the_finite_elements(self):
        raw = {"journal_diameter": "55 mm", "journal_length": "40 mm", "pin_diameter": "48 mm",
               "pin_length": "32 mm", "throw": "42 mm", "web_thickness": "18 mm", "web_width": "80 mm",
               "shear_modulus": {"value": 210 / 2.6, "unit": "GPa"},
               "reference_stiffness": "456.6 kN*m/rad"}  # fmt: skip
        result = outputs(raw)
        assert result["stiffness_carter"] == pytest.approx(458.3e3, abs=50)
        assert result["stiffness_wilson"] == pytest.approx(423.1e3, abs=50)
        assert result["carter_minus_reference_of_reference"] == pytest.approx(0.37, abs=0.01)

    def test_literature_bases_of_the_paper_s_differences(self):
        """15.711 % of Carter's value is 18.64 % of the finite elements' value."""
        base = outputs(HAND)["stiffness_carter"]
        raw = {**HAND, "reference_stiffness": {"value": base * (1 - 0.15711), "unit": "N*m/rad"}}
        result = outputs(raw)
        assert result["carter_minus_reference_of_carter"] == pytest.approx(15.711, rel=1e-9)
        assert result["carter_minus_reference_of_reference"] == pytest.approx(18.64, abs=5e-3)


class TestAnalytic:
    @pytest.mark.parametrize("size", [200, pytest.param(10_000, marks=pytest.mark.slow)])
    def test_analytic_both_formulas_as_printed(self, size):
        throws = random_throws(size)
        result = outputs(typed(throws), "stiffness_carter", "stiffness_wilson")
        metres = [throws[name] * 1e-3 for name in DIMENSIONS]
        assert result["stiffness_carter"] == pytest.approx(80e9 * pi / 32 * carter(*metres), rel=1e-12)
        assert result["stiffness_wilson"] == pytest.approx(80e9 * pi / 32 * wilson(*metres), rel=1e-12)

    @pytest.mark.parametrize("size", [200, pytest.param(10_000, marks=pytest.mark.slow)])
    @pytest.mark.parametrize(("formula", "name"), [(carter, "carter"), (wilson, "wilson")])
    def test_analytic_sensitivities_are_those_of_a_complex_step(self, formula, name, size):
        throws = random_throws(size)
        result, step = outputs(typed(throws)), 1e-30
        for moved in DIMENSIONS:
            metres = [throws[n] * 1e-3 * (1 + 1j * step * (n == moved)) for n in DIMENSIONS]
            K = formula(*metres)
            exact = K.imag / step / K.real
            assert result[f"sensitivity_of_{name}_to_{moved}"] == pytest.approx(exact, rel=1e-9, abs=1e-12), (
                moved
            )

    def test_analytic_scaling_all_dimensions_gives_the_cube(self):
        """K is G times a length cubed: by Euler the sensitivities of each formula add up to 3."""
        result = outputs({**HAND, "journal_bore": "40 mm", "pin_bore": "30 mm"})
        for formula in ("carter", "wilson"):
            assert sum(
                v for n, v in result.items() if n.startswith(f"sensitivity_of_{formula}")
            ) == pytest.approx(3)

    @pytest.mark.parametrize(("outer", "wall"), [(0.1, 1e-3), (0.1, 1e-9), (0.1, 1e-15)])
    def test_analytic_thin_walls_keep_their_digits(self, outer, wall):
        inner = outer - wall
        thickness = outer - inner
        exact = (
            4 * outer**3 * thickness - 6 * outer**2 * thickness**2 + 4 * outer * thickness**3 - thickness**4
        )
        assert ring(outer, inner) == pytest.approx(exact, rel=1e-14)

    def test_analytic_stiffness_vanishes_with_the_wall(self):
        stiffness = [
            outputs({**HAND, "pin_bore": {"value": 85 * (1 - wall), "unit": "mm"}}, "stiffness_wilson")
            for wall in (1e-3, 1e-6, 1e-9, 1e-12)
        ]
        values = [result["stiffness_wilson"] for result in stiffness]
        assert values == sorted(values, reverse=True)
        assert values[3] / values[2] == pytest.approx(1e-3, rel=1e-3)


class TestRecommendation:
    @pytest.mark.parametrize(
        ("throw", "word", "reason"),
        [(30, "wilson", "web term is negative"), (68.5, "wilson", "short and stiff"),
         (112, "carter", "webs bend"), (130, "carter", "webs bend")],
    )  # fmt: skip
    def test_property_overlap_decides(self, throw, word, reason):
        result = outputs({**HAND, "throw": f"{throw} mm"})
        assert result["recommended"] == word
        assert reason in result["reason"]
        assert result["recommended_stiffness"] == result[f"stiffness_{word}"]

    def test_property_a_bad_throw_has_no_recommendation(self):
        many = {**HAND, "throw": {"value": [68.5, -1, 130], "unit": "mm"}}
        answer = evaluate(CrankStiffness, many).outputs["recommended"]
        assert answer.value.tolist() == ["wilson", None, "carter"]
        assert [bool(reason) for reason in answer.reasons] == [False, True, False]

    def test_property_differences_name_their_base(self):
        result = outputs(HAND)
        one, other = result["stiffness_carter"], result["stiffness_wilson"]
        assert result["wilson_minus_carter_of_carter"] == pytest.approx(100 * (other / one - 1))
        assert result["wilson_minus_carter_of_wilson"] == pytest.approx(100 * (1 - one / other))
        answer = evaluate(CrankStiffness, HAND).outputs["carter_minus_reference_of_carter"]
        assert (answer.value, answer.reason) == (None, "needs reference_stiffness")

    def test_property_a_negative_web_term_is_warned_of(self):
        assert evaluate(CrankStiffness, {**HAND, "throw": "37.1 mm"}).warnings == []
        (warning,) = evaluate(CrankStiffness, {**HAND, "throw": "36.9 mm"}).warnings
        assert (warning.code, warning.name) == ("outside_published_range", "effective_throw")
        assert "web term turns negative" in warning.detail
        only_carter = evaluate(CrankStiffness, {**HAND, "throw": "30 mm"}, outputs=["stiffness_carter"])
        assert only_carter.warnings == []


class TestRefusals:
    THICK = {"throw": "5 mm", "web_width": "20 mm"}

    def test_property_no_stiffness_is_left(self):
        assert refused({**HAND, **self.THICK}) == {("sum_of_wilson", "outside_domain")}
        assert outputs({**HAND, **self.THICK}, "stiffness_carter")["stiffness_carter"] > 0
        many = {**HAND, "throw": {"value": [5, 60], "unit": "mm"}, "web_width": "20 mm"}
        answer = evaluate(CrankStiffness, many).outputs["stiffness_wilson"]
        assert np.isnan(answer.value[0])
        assert "too short for Ker Wilson" in answer.reasons[0]
        assert answer.value[1] > 0

    @pytest.mark.parametrize("bore", ["100 mm", "120 mm"])
    def test_property_a_bore_without_wall_is_named(self, bore):
        assert refused({**HAND, "journal_bore": bore}) >= {("journal_bore", "inconsistent")}
        assert refused({**HAND, "pin_bore": bore}) >= {("pin_bore", "inconsistent")}

    @pytest.mark.parametrize("name", [n for n in HAND if n != "shear_modulus"])
    @pytest.mark.parametrize("value", ["0 mm", "-1 mm", "1e309 mm"])
    def test_property_no_size_is_named(self, name, value):
        assert {fault for fault, _ in refused({**HAND, name: value})} >= {name}
