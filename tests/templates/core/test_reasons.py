"""Messages about missing values and faults give only the reason and where it applies."""

import jsonschema_rs
import numpy as np
import pytest

from templates.core.errors import Fault, FaultyText, InvalidInputs, Unreachable
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template, formula, given
from templates.core.paper import schema


class Hollow(Template):
    """A tube."""

    example = {"x": "1 m"}

    x = given("m", "x")

    @formula("m", "bore", absent="thin tubes have no bore")
    def bore(self):
        return np.where(self.x > 1, self.x - 1, np.nan)

    @formula("m", "double bore", absent="thin tubes have no bore")
    def double(self):
        return 2 * self.bore


class Huge(Template):
    """A tube."""

    example = {"x": "1 m"}

    x = given("m", "x")

    @formula("um", "bore")
    def bore(self):
        return 1 * self.x


class Rated(Template):
    """A tube, of which a bore below 1 m is not rated."""

    example = {"x": "1 m"}

    x = given("m", "x")

    @formula("m", "bore", ge=1, absent="thin tubes have no bore")
    def bore(self):
        return np.where(self.x > 1, self.x - 1, np.nan)


def test_an_absent_value_and_one_out_of_its_domain_have_each_their_reason():
    answer = evaluate(Rated, {"x": {"value": [0.5, 1.5, 3.0], "unit": "m"}}).outputs["bore"]
    assert np.isnan(answer.value).tolist() == [True, True, False]
    assert answer.reasons.tolist() == ["thin tubes have no bore", "bore must be ≥ 1 m", None]


@pytest.mark.parametrize("name", ["bore", "double_bore"])
def test_a_value_is_absent_with_its_reason_only_where_it_does_not_exist(name):
    answer = evaluate(Hollow, {"x": {"value": [0.5, 2.0, 1.0, 3.0], "unit": "m"}}).outputs[name]
    assert np.isnan(answer.value).tolist() == [True, False, True, False]
    assert answer.reasons.tolist() == ["thin tubes have no bore", None, "thin tubes have no bore", None]


def test_the_text_of_an_error_is_its_sentence():
    faulty = FaultyText("empty", "give a number")
    assert str(faulty) == "give a number"
    assert faulty.fault("speed") == Fault("speed", "empty", "give a number")
    assert str(Unreachable("speed", "too fast", (1.0, 2.0), "rpm")) == "too fast"


@pytest.mark.parametrize("extra", [{}, {"plus": "1 mm"}, {"colour": "red"}])
def test_the_schema_of_a_quantity_knows_its_parts_and_no_others(extra):
    quantity = {"value": 2.0, "unit": "m", **extra}
    is_valid = jsonschema_rs.is_valid(schema.inputs_schema(Hollow), {"x": quantity})
    assert is_valid == ("colour" not in extra)
    if not is_valid:
        with pytest.raises(InvalidInputs, match="colour"):
            evaluate(Hollow, {"x": quantity})


def test_a_value_too_large_for_its_unit_is_absent_with_a_reason():
    """Finite in metres, beyond all numbers in micrometres: no infinity leaves."""
    single = evaluate(Huge, {"x": "1e303 m"}).outputs["bore"]
    assert (single.value, single.reason) == (None, "too large for a number of um")
    many = evaluate(Huge, {"x": {"value": [1e303, 1], "unit": "m"}}).outputs["bore"]
    np.testing.assert_array_equal(many.value, [np.nan, 1e6])
    assert many.reasons.tolist() == ["the formula has no finite value here", None]
