"""Inputs and limits of templates, on a small one."""

import numpy as np
import pytest
from declared import Shaft, codes

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.paper.schema import describe


class TestInputs:
    def test_property_kinds_and_defaults(self):
        assert list(Shaft.inputs) == ["bore", "balls", "rod_mass", "load", "web_shape", "outer_diameter"]
        assert list(Shaft.formulas) == ["wall", "largest_load", "pressure", "linear_mass"]
        echo = evaluate(Shaft, Shaft.example).inputs
        assert {name: e.source for name, e in echo.items() if e.source == "given"} == {
            "bore": "given",
            "load": "given",
        }
        assert (echo["outer_diameter"].value, echo["outer_diameter"].unit) == (pytest.approx(100), "mm")
        assert (echo["web_shape"].value, echo["web_shape"].unit) == ("round", None)
        assert echo["balls"].value == 8

    def test_property_derived_gives_way_to_what_is_given(self):
        given_one = evaluate(Shaft, {**Shaft.example, "outer_diameter": "60 mm"})
        assert given_one.outputs["wall"].value == pytest.approx(5)
        assert given_one.inputs["outer_diameter"].source == "given"

    def test_property_curve_reduces_along_its_last_axis(self):
        assert evaluate(Shaft, Shaft.example).outputs["largest_load"].value == pytest.approx(3000)
        two = {"value": [[1, 3, 2], [5, 4, 4]], "unit": "kN"}
        answer = evaluate(Shaft, {**Shaft.example, "load": two}, outputs=["largest_load"]).outputs[
            "largest_load"
        ]
        np.testing.assert_allclose(answer.value, [3000, 5000])

    @pytest.mark.parametrize(
        ("inputs", "name", "code", "words"),
        [
            ({"bore": "1 mm"}, "bore", "out_of_range", "bore is 1 mm; it must be > 1 mm and ≤ 100 mm"),
            ({"bore": "5 inch"}, "bore", "out_of_range", "bore is 5 inch; it must be"),
            ({"balls": 8.5}, "balls", "out_of_range", "it must be a whole number ≥ 3"),
            ({"balls": 2}, "balls", "out_of_range", "balls is 2"),
            ({"web_shape": "oval"}, "web_shape", "not_an_option", "'oval' is not one of round, square_cut"),
            ({"web_shape": 5}, "web_shape", "not_an_option", "5 is not one of"),
            ({"web_shape": {"value": "oval"}}, "web_shape", "not_an_option", "is not one of"),
            ({"web_shape": {"value": "round", "unit": "mm"}}, "web_shape", "not_an_option", "is not one of"),
            ({"load": "5 kN"}, "load", "not_a_curve", "give an array over the cycle"),
            ({"bor": "5 mm"}, "bor", "unknown_name", "did you mean bore"),
            ({"\ud800": 1}, "\\ud800", "unknown_name", "use one of bore"),
            (
                {"outer_diameter": "50 mm"},
                "bore",
                "inconsistent",
                "outer diameter 50 mm is not above bore 50 mm; required: The outside is larger",
            ),
        ],
    )
    def test_property_refusals_name_and_mend(self, inputs, name, code, words):
        with pytest.raises(InvalidInputs) as refusal:
            Shaft.from_quantities({**Shaft.example, **inputs})
        detail = next(f.detail for f in refusal.value.faults if name in f.names and f.code == code)
        assert words in detail
        detail.encode("utf-8")

    def test_property_an_option_is_taken_as_answers_write_it(self):
        reported = {**Shaft.example, "web_shape": {"value": "square_cut"}}
        assert evaluate(Shaft, reported, outputs=[]).inputs["web_shape"].value == "square_cut"

    def test_property_missing_inputs_are_named_with_their_unit(self):
        with pytest.raises(InvalidInputs, match="bore is needed; give it in mm") as refusal:
            Shaft.from_quantities({})
        assert codes(refusal) == {("bore", "missing"), ("load", "missing")}

    def test_property_si_values_are_checked_like_typed_ones(self):
        good = Shaft.from_quantities(Shaft.example).inputs_si()
        assert Shaft.from_si(good).t == pytest.approx(0.025)
        with pytest.raises(InvalidInputs) as refusal:
            Shaft.from_si({**good, "rod_mass": np.nan, "bore": 5.0, "load": np.array([1.0, np.inf])})
        assert codes(refusal) == {
            ("rod_mass", "out_of_range"),
            ("bore", "out_of_range"),
            ("load", "out_of_range"),
        }

    def test_property_arrays_must_fit_together(self):
        wrong = {"bore": {"value": [10, 20], "unit": "mm"}, "rod_mass": {"value": [1, 2, 3], "unit": "kg"}}
        with pytest.raises(InvalidInputs, match="bore 2, rod_mass 3") as refusal:
            Shaft.from_quantities({**Shaft.example, **wrong})
        assert codes(refusal) >= {("bore", "shape"), ("rod_mass", "shape")}

    def test_property_curve_is_one_thing_for_each_point(self):
        """Points of other inputs have nothing to do with the places of a curve, only with its other axes."""
        two = {"bore": {"value": [10, 20], "unit": "mm"}, "outer_diameter": "40 mm"}
        answer = evaluate(Shaft, {**Shaft.example, **two}, outputs=["pressure"]).outputs["pressure"]
        assert answer.value.shape == (2,)
        rows = {"load": {"value": [[1, 3, 2]] * 3, "unit": "kN"}}
        with pytest.raises(InvalidInputs, match="bore 2, load 3×3"):
            Shaft.from_quantities({**Shaft.example, **two, **rows})


class TestLimits:
    LOAD = {"load": {"value": [[1, 2]], "unit": "kN"}}

    def test_property_rule_masks_points_of_arrays(self):
        outside = {"value": [60, 40, 70], "unit": "mm"}
        raw = {**Shaft.example, "outer_diameter": outside}
        answer = evaluate(Shaft, raw, outputs=["wall", "largest_load"]).outputs
        np.testing.assert_allclose(answer["wall"].value, [5, np.nan, 10])
        assert list(answer["wall"].reasons) == [
            None,
            "outer diameter is not above bore; "
            "required: The outside is larger than the bore; make the outside larger",
            None,
        ]
        assert answer["largest_load"].value == pytest.approx(3000)

    def test_property_masks_reach_what_is_beneath_only(self):
        bores = {"value": [50, 500, 20], "unit": "mm"}
        answer = evaluate(
            Shaft, {**Shaft.example, "bore": bores}, outputs=["wall", "largest_load", "pressure"]
        ).outputs
        assert answer["wall"].reasons[1] == "bore must be > 1 mm and ≤ 100 mm"
        assert np.isnan(answer["pressure"].value).tolist() == [False, True, False]
        assert answer["largest_load"].reasons is None

    def test_property_result_outside_its_domain(self):
        heavy = {**Shaft.example, "load": {"value": [1, 9e9], "unit": "N"}}
        assert evaluate(Shaft, heavy, outputs=["wall"]).outputs["wall"].value == pytest.approx(25)
        with pytest.raises(
            InvalidInputs, match=r"would be 3.6e\+06 MPa; it must be ≥ 0 MPa and < 1000 MPa; lower"
        ) as refusal:
            evaluate(Shaft, heavy)
        assert codes(refusal) == {("pressure", "outside_domain")}

    def test_property_published_range_warns(self):
        (warning,) = evaluate(Shaft, {**Shaft.example, "rod_mass": "3 kg"}).warnings
        assert warning.detail == "published for rod mass ≥ 0.5 kg and ≤ 2 kg (Nobody 1900); here it is 3 kg"
        many = {**Shaft.example, "rod_mass": {"value": [1, 3, 4], "unit": "kg"}}
        (warning,) = evaluate(Shaft, many).warnings
        assert "leaves it at 2 of 3 points" in warning.detail

    def test_property_withdrawn_is_said(self):
        class Old(Shaft):
            withdrawn = "wrong by 2 %, use 2"

        (warning,) = evaluate(Old, Shaft.example).warnings
        assert (warning.code, "use 2" in warning.detail) == ("withdrawn", True)
        assert describe(Shaft)["status"] == "released"

    def test_property_tolerance_that_nobody_measured(self):
        (warning,) = evaluate(Shaft, Shaft.example, tolerance=0.01).warnings
        assert warning.code == "tolerance_unmet"
        with pytest.raises(InvalidInputs, match="only one level"):
            evaluate(Shaft, Shaft.example, level="map")
