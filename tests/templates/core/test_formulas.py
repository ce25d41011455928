"""What a template may declare, its formulas on paper, and their dimensions."""

import json

import numpy as np
import pytest
from declared import Shaft, doubled, rounded_up, swept

from templates.core.language import dimensions
from templates.core.language.evaluate import evaluate
from templates.core.language.template import (
    Template,
    Truth,
    formula,
    given,
    require,
    units,
)
from templates.core.paper.report import rows
from templates.core.paper.schema import describe, inputs_schema


class TestLanguage:
    def test_property_a_template_is_a_record(self):
        template = Shaft.from_quantities(Shaft.example)
        with pytest.raises(AttributeError, match="create a new one"):
            template.d = 1.0
        with pytest.raises(AttributeError, match="create a new one"):
            del template.d
        assert template.t is template.t

    def test_property_equal_names_are_refused(self):
        with pytest.raises(TypeError, match="'bore'"):

            class Twice(Template):
                a = given("mm", "bore")
                b = given("mm", "Bore")

    def test_property_words_of_the_language_are_refused(self):
        with pytest.raises(TypeError, match="version is reserved"):

            class Reserved(Template):
                version = given("1", "number")

    @pytest.mark.parametrize("keywords", [{"words": "Ø"}, {"words": "2 radii"}, {"words": "x", "name": "aB"}])
    def test_property_names_must_be_snake_case(self, keywords):
        with pytest.raises(TypeError, match="snake_case"):
            given("mm", **keywords)

    def test_property_border_must_be_si(self):
        with pytest.raises(TypeError, match="mm is not an SI unit"):
            units("mm", returns="m")

    def test_property_rule_needs_a_sentence(self):
        with pytest.raises(TypeError, match="docstring"):
            require("a", remedy="b")(lambda self: True)

    def test_property_branches_have_no_place_in_a_formula(self):
        class Branching(Template):
            """Branches."""

            a = given("m", "length")

            @formula("m", "result")
            def r(self):
                if self.a > 1:
                    return self.a
                return -self.a

        with pytest.raises(TypeError, match="the body of a formula must be one return statement"):
            describe_formulas(Branching)


def describe_formulas(cls):
    return [f.expression for f in cls.formulas.values()]


class TestPaper:
    def test_property_report(self):
        written = {row.name: row for row in rows(evaluate(Shaft, Shaft.example).template)}
        assert written["wall"].latex == (
            r"t=\frac{D-d}{2}=\frac{100\,\text{mm}-50\,\text{mm}}{2}=25\,\text{mm}"
        )
        assert written["pressure"].expression == r"\frac{F_\max}{d\,f\left(2\,t\right)}"
        assert written["linear_mass"].expression == r"\frac{\operatorname{branched}\left(m\right)}{t}"
        assert written["largest_load"].numbers == ""

    def test_property_negative_numbers_stand_in_parentheses(self):
        class Difference(Template):
            """A difference."""

            a = given("degC", "first")
            x = given("1", "second")

            @formula("1", "result")
            def r(self):
                return 2 - self.x**2

        (row,) = rows(evaluate(Difference, {"first": "5 degC", "second": -3}).template)
        assert row.latex == r"r=2-x^{2}=2-\left(-3\right)^{2}=-7"

    def test_property_formulas_written_by_hand_hold_numbers_as_well(self):
        class Momentum(Template):
            """A product whose LaTeX is written by hand."""

            a = given("mm", "first")
            x = given("1", "second")

            @formula("m**2", "result", symbol="P")
            def r(self):
                return swept(self.a, self.x)

        (row,) = rows(evaluate(Momentum, {"first": "5 mm", "second": -3}).template)
        assert row.expression == r"2\,a^2\,x-x"
        five, three = r"\left(5\,\text{mm}\right)^2", r"\left(-3\right)"
        assert row.numbers == rf"2\cdot {five}\cdot {three}-{three}"

    def test_property_page(self):
        page = json.loads(json.dumps(describe(Shaft)))
        assert page["title"] == "A shaft"
        assert page["errata"] == ["The first is said in one line.", "The second takes two lines."]
        assert page["references"] == ["Nobody 1900."]
        limits = {(limit.get("name"), limit["text"]) for limit in page["limits"]}
        assert (None, "For shafts only.") in limits
        assert ("bore", "bore > 1 mm and ≤ 100 mm") in limits
        assert ("outer_diameter", "The outside is larger than the bore") in limits

    def test_property_schema(self):
        schema = inputs_schema(Shaft)
        assert schema["required"] == ["bore", "load"]
        bore, balls, shape = (schema["properties"][name] for name in ("bore", "balls", "web_shape"))
        assert (bore["unit"], bore["exclusiveMinimum"], bore["maximum"]) == ("mm", 1, 100)
        assert (balls["multipleOf"], balls["minimum"], balls["default"]) == (
            1,
            3,
            {"value": 8.0, "unit": "1"},
        )
        assert (shape["enum"], shape["default"]) == (["round", "square_cut"], "round")
        assert schema["properties"]["outer_diameter"]["default_formula"] == r"2\,d"


def squared(self):
    return self.d**2


def added_to_mass(self):
    return self.d + self.m


def added_to_number(self):
    return self.d + 1


def exponential(self):
    return np.exp(self.d) * self.d


def mass_across_border(self):
    return rounded_up(self.m)


def mass_doubled(self):
    return doubled(self.m)


class TestDimensions:
    def test_analytic_right_dimensions_pass(self):
        assert dimensions.faults(Shaft) == []

    @pytest.mark.parametrize(
        ("calculate", "words"),
        [
            (squared, "wrong is declared in m, but its formula gives m²"),
            (added_to_mass, "wrong: Cannot convert"),
            (added_to_number, "wrong: Cannot convert"),
            (exponential, "wrong: Cannot convert"),
            (mass_across_border, "rounded_up takes x in m, not in kg"),
            (mass_doubled, "wrong is declared in m, but its formula gives kg"),
        ],
    )
    def test_analytic_wrong_dimensions_are_found(self, calculate, words):
        class Wrong(Template):
            """Wrong on purpose."""

            example = {"length": "2 m", "mass": "3 kg"}
            d = given("m", "length")
            m = given("kg", "mass")
            w = formula("m", "wrong")(calculate)

        (fault,) = dimensions.faults(Wrong)
        assert words in fault

    def test_analytic_wrong_rule_is_found(self):
        class Wrong(Template):
            """Wrong on purpose."""

            example = {"length": "2 m", "mass": "3 kg"}
            d = given("m", "length")
            m = given("kg", "mass")

            @require("length", "mass", remedy="none")
            def rule(self) -> Truth:
                """A length is less than a mass."""
                return self.d < self.m

        (fault,) = dimensions.faults(Wrong)
        assert fault.startswith("A length is less than a mass: Cannot convert")
