"""`crank_stiffness`: one formula outside the transition, and no jump inside it."""

import numpy as np
import pytest

from templates.core.language.evaluate import evaluate
from templates.stiffness.crank_stiffness_v1 import CrankStiffness

THROW = {
    "journal_length": "45 mm",
    "journal_diameter": "100 mm",
    "web_thickness": "28 mm",
    "web_width": "130 mm",
    "pin_length": "50 mm",
    "pin_diameter": "85 mm",
    "shear_modulus": "80 GPa",
}
TOUCHING = 92.5  # mm of throw: half of the diameters together
HALF_WIDTH = 18.5  # mm: a tenth of them


def outputs(throws):
    raw = {**THROW, "throw": {"value": np.asarray(throws, float).tolist(), "unit": "mm"}}
    return {name: answer.value for name, answer in evaluate(CrankStiffness, raw).outputs.items()}


def relative_steps(values):
    return np.abs(np.diff(values)) / values[:-1]


class TestTransition:
    def test_property_no_jump_across_overlap_0(self):
        """A step of a micrometre changes the stiffness by less than 2e-5; a choice by sign, by percents."""
        throws = TOUCHING + np.arange(-500, 501) * 1e-3
        assert relative_steps(outputs(throws)["recommended_stiffness"]).max() < 2e-5
        result = outputs(throws)
        by_sign = np.where(throws > TOUCHING, result["stiffness_carter"], result["stiffness_wilson"])
        assert relative_steps(by_sign).max() > 0.02

    def test_property_no_jump_and_no_kink_anywhere(self):
        throws = np.linspace(60, 130, 7001)
        stiffness = outputs(throws)["recommended_stiffness"]
        slope = np.diff(stiffness) / np.diff(throws)
        assert relative_steps(stiffness).max() < 1e-3
        assert np.abs(np.diff(slope)).max() < 1e-2 * np.abs(slope).max()

    def test_analytic_half_of_each_flexibility_at_overlap_0(self):
        result = outputs([TOUCHING, TOUCHING])
        carter, wilson = result["stiffness_carter"][0], result["stiffness_wilson"][0]
        assert result["share_of_wilson"][0] == pytest.approx(0.5, rel=1e-12)
        assert result["recommended_stiffness"][0] == pytest.approx(2 / (1 / carter + 1 / wilson), rel=1e-12)
        assert result["recommended"][0] == "between"

    def test_property_the_stiffness_lies_between_the_two(self):
        result = outputs(np.linspace(60, 130, 701))
        both = np.stack([result["stiffness_carter"], result["stiffness_wilson"]])
        assert np.all(result["recommended_stiffness"] <= both.max(axis=0) * (1 + 1e-12))
        assert np.all(result["recommended_stiffness"] >= both.min(axis=0) * (1 - 1e-12))

    def test_property_the_share_falls_with_the_throw(self):
        share = outputs(np.linspace(60, 130, 701))["share_of_wilson"]
        assert np.all(np.diff(share) <= 0)
        assert (share[0], share[-1]) == (1, 0)


class TestWord:
    @pytest.mark.parametrize(
        ("throw", "word"),
        [(40, "wilson"), (68.5, "wilson"), (TOUCHING - HALF_WIDTH - 1e-6, "wilson"),
         (TOUCHING + HALF_WIDTH + 1e-6, "carter"), (130, "carter")],
    )  # fmt: skip
    def test_property_outside_it_one_formula_alone_is_recommended(self, throw, word):
        result = outputs([throw, throw])
        assert result["recommended"][0] == word
        np.testing.assert_array_equal(result["recommended_stiffness"], result[f"stiffness_{word}"])

    @pytest.mark.parametrize(("throw", "word"), [(75, "between"), (92, "between"), (93, "between")])
    def test_property_within_it_says_so(self, throw, word):
        result = outputs([throw, throw])
        assert result["recommended"][0] == word
        assert "passes from" in result["reason"][0]
