"""Profiles and curves of templates, and inputs with one value for all points."""

import json

import jsonschema_rs
import numpy as np
import pytest
from declared import codes

from app.calculations import json_values
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.core.language.template import (
    Template,
    curve,
    given,
    profile,
)
from templates.core.paper.schema import describe, inputs_schema


def stations(length):
    return np.asarray(length)[..., None] * np.linspace(0, 1, 3)


class Beam(Template):
    """A beam."""

    example = {"length": "2 m", "load": "1 N", "sag": "1 m"}

    l = given("m", "length", gt=0)  # noqa: E741
    w = given("N", "load")
    s = given("m", "sag", optional=True)

    @profile("m", "place", along="place")
    def x(self):
        return stations(self.l)

    @profile("N*m", "moment", along="place", lt=10, remedy="lower the load")
    def m(self):
        return self.w * self.x

    @profile("m", "line", along="place")
    def y(self):
        return stations(self.s)


class Chain(Template):
    """A chain of masses with springs between them."""

    m = curve("kg", "masses", along="mass", gt=0)
    k = curve("N/m", "springs", along="spring", alternative=True, gt=0)
    limit = given("kg", "limit", default="100 kg")

    @profile("kg", "sums of masses", along="masses", axes=2, lt=10, remedy="take lighter masses")
    def sums(self):
        return self.m[..., None, :] + self.m[..., :, None] + 0 * np.asarray(self.limit)[..., None, None]


class TestProfiles:
    MANY = {"load": "4 N", "sag": "1 m", "length": {"value": [1, -1, 3], "unit": "m"}}

    def test_property_profile_of_a_point(self):
        outputs = evaluate(Beam, {"length": "2 m", "load": "1 N"}).outputs
        np.testing.assert_array_equal(outputs["moment"].value, [0, 1, 2])
        assert (outputs["line"].value, outputs["line"].reason) == (None, "needs sag")
        assert describe(Beam)["outputs"]["properties"]["moment"]["along"] == "place"

    def test_property_profile_of_a_point_is_refused_whole(self):
        with pytest.raises(InvalidInputs, match=r"moment would be 12 N\*m; .*lower the load") as refusal:
            evaluate(Beam, {"length": "3 m", "load": "4 N"})
        assert codes(refusal) == {("moment", "outside_domain")}

    def test_property_profiles_of_arrays_are_masked_whole(self):
        moment = evaluate(Beam, self.MANY).outputs["moment"]
        np.testing.assert_array_equal(moment.value, [[0, 2, 4], [np.nan] * 3, [np.nan] * 3])
        assert [bool(reason) for reason in moment.reasons] == [False, True, True]
        assert "length must be" in moment.reasons[1]
        shown = json_values.outputs({"moment": moment})["moment"]
        assert shown["value"] == [[0, 2, 4], None, None]
        assert json.loads(json.dumps(shown))["reasons"] == list(moment.reasons)

    def test_property_profile_of_two_axes_is_one_thing_for_each_point(self):
        pairs = evaluate(Chain, {"masses": ["1 kg", "2 kg", "3 kg"], "springs": ["1 N/m", "5 N/m"]})
        np.testing.assert_array_equal(pairs.outputs["sums_of_masses"].value[0], [2, 3, 4])
        many = {"masses": {"value": [[1, 2], [9, 1], [3, 3]], "unit": "kg"}}
        answer = evaluate(Chain, many).outputs["sums_of_masses"]
        assert [bool(reason) for reason in answer.reasons] == [False, True, False]
        shown = json_values.outputs({"sums": answer})["sums"]
        assert shown["value"] == [[[2, 3], [3, 4]], None, [[6, 6], [6, 6]]]
        limits = evaluate(Chain, {"masses": ["1 kg"], "limit": ["1 kg", "2 kg"]})
        assert limits.outputs["sums_of_masses"].value.shape == (2, 1, 1)

    def test_property_a_curve_may_be_missing_but_is_no_single_value(self):
        assert np.isnan(Chain.from_quantities({"masses": ["1 kg"]}).k)
        with pytest.raises(InvalidInputs, match="give an array over the mass, in kg"):
            Chain.from_quantities({"masses": "1 kg"})

    def test_property_profile_is_no_target(self):
        with pytest.raises(InvalidInputs, match="single value") as refusal:
            solve(Beam, {"load": "1 N"}, "length", ["1 m", "2 m"], {"moment": "1 N*m"})
        assert codes(refusal) == {("target.moment", "not_a_number")}


class Stepped(Template):
    """Steps of a length."""

    example = {"length": "2 m", "steps": "3"}

    a = given("m", "length", gt=0)
    n = given("1", "steps", integer=True, single=True, ge=1, le=9)

    @profile("m", "places", along="places")
    def x(self):
        return np.asarray(self.a)[..., None] * np.arange(int(self.n))


class TestSingle:
    def test_property_one_value_serves_all_points(self):
        outputs = evaluate(Stepped, {"length": {"value": [1, 2], "unit": "m"}, "steps": 3}).outputs
        assert outputs["places"].value.tolist() == [[0, 1, 2], [0, 2, 4]]

    def test_property_an_array_is_refused_by_name(self):
        with pytest.raises(InvalidInputs) as refusal:
            Stepped.from_quantities({"length": "1 m", "steps": [3, 4]})
        assert [(fault.name, fault.code) for fault in refusal.value.faults] == [("steps", "not_single")]

    def test_property_schema_takes_no_array(self):
        forms = inputs_schema(Stepped)["properties"]["steps"]
        assert not jsonschema_rs.is_valid(forms, [3, 4])
        assert not jsonschema_rs.is_valid(forms, {"value": [3, 4], "unit": "1"})
        assert jsonschema_rs.is_valid(forms, 3)
