"""Expressions of relations and worksheets: their results, and what is refused where."""

from __future__ import annotations

from dataclasses import dataclass, field

import lark
import numpy as np
import pytest

from templates.core.errors import FaultyText
from templates.core.units.closures import closure
from templates.core.units.expressions import GRAMMAR, FaultyPlace, Sort, checked
from templates.core.units.nodes import kind_of
from templates.core.units.operations import Name
from templates.core.units.relation import parse
from templates.core.units.sorts import MAX_NODES_DEEP

PARSER = lark.Lark(GRAMMAR, parser="lalr", propagate_positions=True)


def of(text, **more):
    return Sort(kind_of(text), **more)


SORTS = {
    "T_1": of("degC"),
    "T_2": of("degF"),
    "dT": of("delta_degC"),
    "kelvins": of("K"),
    "x": of("m"),
    "n": of("1"),
    "half": of("1"),
    "beyond": of("1"),
    "F": of("N", axis="cycle"),
    "G": of("N", axis="cylinder"),
    "law": Sort(words=("walther", "SAE 30")),
}


@dataclass
class Names:
    """Names of a worksheet, and one function of its own."""

    spent: int = field(default=0)

    def name(self, text):
        if text not in SORTS:
            raise FaultyText("unknown_name", f"{text} is not declared")
        return Name(text), SORTS[text]

    def function(self, name):
        return (lambda arguments: arguments[0]) if name == "same" else None

    def spend(self):
        self.spent += 1


class Values:
    """What the names are: single values, or one for each of three points."""

    def __init__(self, points=None):
        values = {
            "T_1": 300.0,
            "T_2": 310.0,
            "dT": 5.0,
            "kelvins": 5.0,
            "x": 2e-3,
            "n": 2.0,
            "half": 0.5,
            "beyond": 4.0,
        }
        lists = {"F": [1.0, 2.0, 5.0], "G": [3.0, 4.0]}
        for name, value in (values | lists).items():
            single = np.array(value) if name in lists else value
            setattr(self, name, single if points is None else np.stack([np.asarray(single)] * points))
        self.law = "walther"


def sort(text):
    return checked(PARSER.parse(text), Names())[1]


def value(text, points=None):
    with np.errstate(all="ignore"):
        return closure(checked(PARSER.parse(text), Names())[0])(Values(points))


def refusal(text):
    with pytest.raises(FaultyPlace) as error:
        checked(PARSER.parse(text), Names())
    return error.value


class TestValues:
    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            ("if x < 3 mm then 1 else 2", 1),
            ("if x < 3 mm and n == 2 then 1 else 2", 1),
            ("if x > 3 mm or not n == 2 then 1 else 2", 2),
            ("if 1 mm < x <= 2 mm then 1 else 2", 1),
            ("if 1 mm < x < 2 mm then 1 else 2", 2),
            ("if n != 2 then 1 else if n >= 2 then 3 else 4", 3),
            ("if(n > 1)then n else(2)", 2),
            ("if not(n > 1)then n else 3", 3),
            ("1 + (if n > 1 then 2 else 3) * 2", 5),
            ('if law is "SAE 30" then 1 else 2', 2),
            ("if law is walther then 1 else 2", 1),
            ("if 1/0 > 1 then 1 else 2", 1),
            ("log10(1000) + sinh(0) + cosh(0) + tanh(0)", 4),
            ("atan2(1 mm, -1 mm)", 3 * np.pi / 4),
            ("floor(2.7) + ceil(2.1)", 5),
            ("same(3)", 3),
            ("sum(F) / 1 N", 8),
            ("mean([1, 2, 6])", 3),
            ("count(F)", 3),
            ("max(F) / min(F)", 5),
            ("max(n, 3)", 3),
            ("F[3] / F[n]", 2.5),
            ("[1, 2, 7][3] + [4, 5][n]", 12),
            ("sum(x * F) / (x * sum(F))", 1),
            ("27 ** (1/3)", 3),
            ("8 in / 4 in", 2),
            ("(-8) ** n", 64),
            ("T_1 / (1 K)", 300),
        ],
    )
    def test_analytic_one_point_and_many(self, text, expected):
        assert value(text) == pytest.approx(expected, rel=1e-14)
        assert np.asarray(value(text, 3)) == pytest.approx(np.full(np.shape(value(text, 3)), expected))

    def test_analytic_lists_stand_behind_the_points(self):
        expected = np.array([1.0, 2.0, 5.0]) * 2e-3 + 1
        np.testing.assert_allclose(value("x * F / 1 J + 1"), expected)
        many = value("x * F / 1 J + 1", 4)
        assert many.shape == (4, 3)
        np.testing.assert_allclose(many, [expected] * 4)
        np.testing.assert_allclose(value("if x < 1 mm then F else 3 N", 4), np.full((4, 3), 3.0))
        np.testing.assert_allclose(value("if F > 1.5 N then x else 0 m", 2), [[0, 2e-3, 2e-3]] * 2)

    @pytest.mark.parametrize("text", ["F[4]", "F[half]", "[1 N, 2 N][half]", "F[beyond]"])
    def test_property_beyond_a_list_there_is_no_value(self, text):
        assert np.isnan(value(text))
        assert np.isnan(value(text, 2)).all()

    @pytest.mark.parametrize(
        "text",
        ["if {} > 1 then 1 else 2", "if not {} > 1 then 1 else 2", "if n > 5 and {} < 1 then 1 else 2"],
    )
    def test_property_what_is_not_known_decides_nothing(self, text):
        assert np.isnan(value(text.format("(0/0)")))
        assert np.isnan(value(text.format("(n * (0/0))"), 2)).all()
        assert np.isfinite(value(text.format("n")))

    def test_property_a_condition_of_the_unknown_is_not_true(self):
        assert not value("0/0 < 1")
        assert not value("not 0/0 < 1")
        assert value("x < 1 m").dtype == bool


class TestTemperatures:
    @pytest.mark.parametrize(
        ("text", "counts"),
        [
            ("T_1", {1}),
            ("20 degC", {1}),
            ("20 K", {0, 1}),
            ("kelvins", {0, 1}),
            ("T_1 - T_2", {0}),
            ("(T_1 + T_2) / 2", {1}),
            ("0.5 * T_1 + T_2 * 0.5", {1}),
            ("T_1 + dT", {1}),
            ("T_1 + kelvins", {1, 2}),
            ("T_1 - kelvins", {0, 1}),
            ("-T_1", {-1}),
            ("T_1 + T_2 - 20 degC", {1}),
            ("2/3 * T_1", {2 / 3}),
            ("max(T_1, 20 degC)", {1}),
            ("max(T_1, kelvins)", {1}),
            ("if n > 1 then T_1 else T_2", {1}),
            ("if n > 1 then kelvins else dT", {0}),
            ("mean([T_1, T_2])", {1}),
            ("[T_1, T_2][n]", {1}),
            ("sum([dT, dT])", {0}),
            ("sum([T_1, T_2])", None),
            ("n * T_1", None),
            ("n * dT", {0}),
            ("n * kelvins", {0}),
            ("T_1 / n", None),
            ("sqrt(T_1 * T_2)", None),
            ("T_1 / T_2", {0}),
            ("1 W / (1 W/K)", {0, 1}),
        ],
    )
    def test_analytic_how_many_are_added_up(self, text, counts):
        assert sort(text).kind.temperatures == counts

    @pytest.mark.parametrize("text", ["max(T_1, dT)", "if n > 1 then T_1 else dT", "T_1 < dT", "[T_1, dT]"])
    def test_analytic_temperatures_and_differences_do_not_meet(self, text):
        assert refusal(text).code == "unit_mismatch"

    @pytest.mark.parametrize("text", ["20 degC * n", "n / 20 degC", "sqrt(20 degC)", "sum([20 degC, T_1])"])
    def test_analytic_a_number_in_degc_is_no_factor(self, text):
        assert "temperature or a difference" in str(refusal(text))

    @pytest.mark.parametrize(("text", "holds"), [("dT < 6 degC", 1), ("4 degC > dT", 0), ("dT != 9 degF", 0)])
    def test_analytic_beside_a_difference_a_number_in_degc_is_one(self, text, holds):
        assert value(f"if {text} then 1 else 0") == holds

    def test_analytic_beside_kelvins_a_number_in_degc_is_refused_with_both_meanings(self):
        words = str(refusal("kelvins <= 30 degC"))
        assert "303.15 K for a temperature" in words
        assert "30 delta_degC for a difference" in words


class TestRefusals:
    @pytest.mark.parametrize(
        ("text", "code", "column"),
        [
            ("y + 1", "unknown_name", 1),
            ("1 + same(y)", "unknown_name", 10),
            ("other(1)", "unknown_function", 1),
            ("sin(1, 2)", "syntax", 1),
            ("1 + 2 foo", "unknown_unit", 5),
            ("1 + (x + 3)", "unit_mismatch", 6),
            ("x < 3", "unit_mismatch", 1),
            ("if x < 3 mm then 1 mm else 2", "unit_mismatch", 1),
            ("floor(x)", "unit_mismatch", 1),
            ("floor(30 deg)", "unit_mismatch", 1),
            ("log10(x)", "unit_mismatch", 1),
            ("atan2(x, n)", "unit_mismatch", 1),
            ("[x, n]", "unit_mismatch", 1),
            ("x ** n", "unit_mismatch", 1),
            ("x ** 13", "unit_mismatch", 1),
            ("(((x ** 12) ** 12) ** 12)", "unit_mismatch", 2),
            ("x and n", "no_truth", 1),
            ("not x", "no_truth", 1),
            ("(x < 1 m) + 1", "no_truth", 1),
            ("(x < 1 m) < (x > 2 m)", "no_truth", 1),
            ("if x then 1 else 2", "no_truth", 1),
            ("if n > 1 then x < 1 m else 2", "no_truth", 1),
            ("law + 1", "no_truth", 1),
            ("n is walther", "no_truth", 1),
            ("law is valter", "unknown_name", 1),
            ("F + G", "axis_mismatch", 1),
            ("F * [1, 2]", "axis_mismatch", 1),
            ("if F > 1 N then G else G", "axis_mismatch", 1),
            ("[F, F]", "axis_mismatch", 1),
            ("sum(x)", "axis_mismatch", 1),
            ("max(x)", "axis_mismatch", 1),
            ("x[1]", "axis_mismatch", 1),
            ("F[x]", "index", 1),
            ("F[0]", "syntax", 1),
            ("F[1.5]", "syntax", 1),
            ("1e999", "not_finite", 1),
        ],
    )
    def test_property_code_and_column(self, text, code, column):
        error = refusal(text)
        assert (error.code, error.meta.column) == (code, column)

    def test_a_list_that_is_written_out_is_named_by_its_items(self):
        assert "2 items" in str(refusal("F * [1, 2]"))
        single = str(refusal("F * [1]"))
        assert "1 item" in single
        assert "1 items" not in single

    @pytest.mark.parametrize(
        "text",
        [
            "10 then",
            "1 if",
            "a or",
            "if a then b",
            "[]",
            "x[",
            "a is",
            "a is 3",
            "(a < b",
            "a = b",
            "not a <",
        ],
    )
    def test_property_what_is_no_expression(self, text):
        with pytest.raises(lark.exceptions.UnexpectedInput):
            PARSER.parse(text)

    def test_property_each_operation_is_counted(self):
        names = Names()
        checked(PARSER.parse("1 + 2 * (n - 3)"), names)
        assert names.spent == 7

    def test_property_functions_nest_no_deeper_than_is_evaluated(self):
        tree, scope, deep = PARSER.parse("abs(n)"), Names(), Names().name("n")
        scope.name = lambda text: deep
        for _ in range(MAX_NODES_DEEP - 1):
            deep = checked(tree, scope)
        assert closure(deep[0])(Values()) == 2
        with pytest.raises(FaultyPlace) as error:
            checked(tree, scope)
        assert error.value.code == "too_large"


class TestNames:
    @pytest.mark.parametrize(
        "word", ["then", "else", "and", "or", "is", "to", "gives", "iffy", "nota", "andy"]
    )
    def test_property_words_behind_values_are_names_elsewhere(self, word):
        assert parse(f"= {word} + 1").names == {word}

    @pytest.mark.parametrize("word", ["if", "not"])
    @pytest.mark.parametrize("text", ["{}", "{} * 2", "2 / {}", "max({}, 1)", "({}) ** 2", "{}[2]", "{}.x"])
    def test_property_words_before_values_are_names_elsewhere(self, word, text):
        (name,) = parse(f"= {text.format(word)}").names
        assert name.removesuffix(".x") == word

    def test_property_a_choice_is_no_quantity_beside(self):
        relation = parse('= if film.oil is "SAE 30" then a else 2')
        assert (relation.names, relation.choices) == ({"film.oil", "a"}, {"film.oil"})
        assert relation.tests == (("film.oil", "SAE 30"),)
        decided = relation.decided({"film.oil": "SAE 30"})
        assert (decided.names, decided.choices, decided.decided_by) == ({"a"}, frozenset(), ("film.oil",))
        assert decided.value({"a": 3.0}) == 3
        with pytest.raises(FaultyText, match="a choice in one place and a quantity in another"):
            parse("= if law is walther then law else 2")
