"""`solve` on functions whose solutions are known."""

import numpy as np
import pytest

from templates.core.errors import InvalidInputs, Unreachable
from templates.core.language.solve import solve
from templates.core.language.template import Template, choice, formula, given


class Curves(Template):
    """Functions of one length."""

    example = {"x": "1 m"}

    x = given("m", "x")
    k = given("1", "factor", default=1)
    n = given("1", "count", default=1, integer=True)
    way = choice("up", "down", words="way", default="up")

    @formula("m**2", "parabola")
    def parabola(self):
        return self.k * self.x**2

    @formula("1", "root", ge=0)
    def root(self):
        return np.sqrt(self.x - 0.7) + 0 * self.x

    @formula("1", "wave")
    def wave(self):
        return np.sin(self.x)

    @formula("1", "step")
    def step(self):
        return np.floor(self.x) + 0 * self.x

    @formula("1", "flat")
    def flat(self):
        return self.k


def solved(output, target, low="0 m", high="10 m", **raw):
    return solve(Curves, raw, "x", [low, high], {output: target}, outputs=[output])


class TestSolutions:
    @pytest.mark.parametrize("target", [1e-8, 0.3, 4.0, 99.9])
    def test_analytic_parabola(self, target):
        result = solved("parabola", f"{target} m**2")
        assert result.unknown == pytest.approx(target**0.5, rel=1e-7)
        assert result.evaluation.outputs["parabola"].value == pytest.approx(target, rel=1e-9)
        assert (result.unit, result.warnings) == ("m", [])

    @pytest.mark.parametrize(("low", "high"), [("1e-9 m", "1e9 m"), ("10 mm", "1e7 mm")])
    def test_analytic_bounds_decades_apart(self, low, high):
        assert solved("parabola", "4 m**2", low, high).unknown == pytest.approx(2, rel=1e-12)

    def test_analytic_several_solutions_are_said(self):
        result = solved("parabola", "4 m**2", "-5 m", "5 m")
        assert result.unknown == pytest.approx(-2)
        assert [w.code for w in result.warnings] == ["not_monotone", "several_solutions"]
        assert "2 m give the target too" in result.warnings[1].detail

    def test_analytic_solution_beside_the_end_of_the_domain(self):
        """The root function begins at 0.7 m, between two samples."""
        assert solved("root", "1e-4").unknown == pytest.approx(0.7 + 1e-8, rel=1e-11)

    def test_analytic_target_at_a_bound(self):
        assert solved("parabola", "100 m**2").unknown == pytest.approx(10)

    def test_property_options_reach_the_evaluation(self):
        result = solve(
            Curves, {}, "x", ["0 m", "5 m"], {"parabola": "4 m**2"}, outputs=["wave"], units={"wave": "%"}
        )
        assert result.evaluation.outputs["wave"].value == pytest.approx(100 * np.sin(2))


class TestRefusals:
    @pytest.mark.parametrize(
        ("output", "target", "reachable", "words"),
        [
            (
                "parabola",
                "101 m**2",
                (0, 100),
                "101 m**2 is out of reach: between the bounds parabola is 0 m**2 … 100",
            ),
            ("root", "5", (0, 9.3**0.5), "out of reach"),
            ("step", "2.5", (0, 10), "jump"),
            ("flat", "2", (1, 1), "out of reach"),
        ],
    )
    def test_analytic_unreachable_says_what_is(self, output, target, reachable, words):
        with pytest.raises(Unreachable) as error:
            solved(output, target)
        assert error.value.reachable == pytest.approx(reachable, abs=1e-4)
        assert words in str(error.value)
        assert error.value.name == output

    def test_analytic_no_value_at_all(self):
        with pytest.raises(Unreachable, match="no value anywhere") as error:
            solved("root", "1", "-5 m", "0.5 m")
        assert np.isnan(error.value.reachable).all()

    @pytest.mark.parametrize(
        ("raw", "unknown", "bounds", "target", "faults"),
        [
            ({"factor": "1 mm", "y": 1}, "x", ["0 m"], {"wavy": 1},
             {("inputs.factor", "wrong_unit"), ("inputs.y", "unknown_name"), ("between", "two_values"),
              ("target.wavy", "unknown_name")}),
            ({"x": "1 m"}, "x", ["0 m", "1 m"], {"wave": 0.5}, {("inputs.x", "solved_for")}),
            ({}, "x", ["1 m", "0 m"], {"wave": 0.5}, {("between", "not_ascending")}),
            ({}, "x", ["1 kg", "x"], {"wave": 0.5},
             {("between", "wrong_unit"), ("between", "not_a_quantity")}),
            ({}, "x", ["0 m", "1 m"], {"wave": "0.5 m"}, {("target.wave", "wrong_unit")}),
            ({}, "x", ["0 m", "1 m"], {}, {("target", "one_output")}),
            ({}, "x", ["0 m", "1 m"], {"wave": 0, "step": 1}, {("target", "one_output")}),
            ({"factor": [1, 2]}, "x", ["0 m", "1 m"], {"wave": 0.5}, {("inputs.factor", "not_a_number")}),
            ({"factor": [1, 2, 3]}, "x", ["0 m", "1 m"], {"wave": 0.5}, {("inputs.factor", "not_a_number")}),
            ({"x": "1 m"}, "z", ["0 m", "1 m"], {"wave": 0.5}, {("unknown", "unknown_name")}),
            ({"x": "1 m"}, "way", ["0 m", "1 m"], {"wave": 0.5}, {("unknown", "not_solvable")}),
            ({"x": "1 m"}, "count", ["0", "5"], {"wave": 0.5}, {("unknown", "not_solvable")}),
        ],
    )  # fmt: skip
    def test_property_all_faults_at_once(self, raw, unknown, bounds, target, faults):
        with pytest.raises(InvalidInputs) as refusal:
            solve(Curves, raw, unknown, bounds, target)
        assert {(fault.name, fault.code) for fault in refusal.value.faults} == faults
