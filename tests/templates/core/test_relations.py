"""Relations: their meaning, their units, and what they refuse."""

import ast
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from templates.core.errors import FaultyText
from templates.core.units.nodes import kind_of
from templates.core.units.quantity import registry
from templates.core.units.relation import Kind, is_relation, parse
from templates.core.units.units import unit

LENGTH = Kind(registry.Unit("m"))
PURE = Kind()
TEMPERATURE, RISE, KELVIN = kind_of("degC"), kind_of("delta_degC"), kind_of("K")


def value(text, **names):
    return parse(text).value(names)


def kind(text, **names):
    return parse(text).kind(names)


def checked(text):
    """The relation and its kind, every name a pure number."""
    relation = parse(text)
    return relation, relation.kind(dict.fromkeys(relation.names, PURE))


class TestMeaning:
    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            ("= 2 + 3 * 4", 14),
            ("= (2 + 3) * 4", 20),
            ("= 2 - 3 - 4", -5),
            ("= 24 / 4 / 2", 3),
            ("= 2 ** 3 ** 2", 512),
            ("= -2 ** 2", -4),
            ("= (-2) ** 2", 4),
            ("= 2 ** -1", 0.5),
            ("= 2 * -3", -6),
            ("= --2", 2),
            ("= +2", 2),
            ("= .5 + 1. + 1e-1", 1.6),
            ("= 48 mm", 0.048),
            ("= 2*48 mm", 0.096),
            ("= 2 m**2", 2.0),
            ("= 5 N*m / 2 m", 2.5),
            ("= 1 1/mm", 1000.0),
            ("= 3000 rpm", 100 * math.pi),
            ("= 20 degC", 293.15),
            ("= -20 degC", 253.15),
            ("= -5 mm", -0.005),
            ("= 293.15 K + 5 delta_degC", 298.15),
            ("= pi", math.pi),
            ("= sqrt(16 mm**2)", 0.004),
            ("= abs(-3)", 3),
            ("= min(3, 1, 2) + max(4, 6)", 7),
            ("= min(20 degC, 300 K)", 293.15),
            ("= sin(30 deg)", 0.5),
            ("= cos(pi) + tan(45 deg)", 0),
            ("= asin(1) + acos(1) + atan(0)", math.pi / 2),
            ("= exp(log(7))", 7),
            ("2 + 3", 5),
            ("  =2+3  ", 5),
        ],
    )
    def test_analytic_value(self, text, expected):
        assert value(text) == pytest.approx(expected, rel=1e-14, abs=1e-15)

    def test_analytic_names(self):
        relation = parse("= scale * film.bearing_diameter + pi * model.mass ** 2")
        assert relation.names == {"scale", "film.bearing_diameter", "model.mass"}
        values = {"scale": 2.0, "film.bearing_diameter": 0.048, "model.mass": 3.0}
        assert relation.value(values) == pytest.approx(0.096 + math.pi * 9)

    def test_analytic_arrays_pass_through(self):
        np.testing.assert_allclose(value("= 2 * load + 1 N", load=np.array([1.0, 2.0])), [3, 5])
        with pytest.raises(FaultyText, match="different lengths") as refusal:
            value("= a + b", a=np.ones(2), b=np.ones(3))
        assert refusal.value.code == "shape"

    @pytest.mark.parametrize(
        "text", ["= 1 / 0", "= 0 / 0", "= log(0)", "= sqrt(-1)", "= 9**9**9**9", "= asin(2)"]
    )
    def test_analytic_impossible_arithmetic_is_not_finite_and_silent(self, text):
        assert not np.isfinite(value(text))

    @pytest.mark.parametrize(
        ("raw", "expected"), [("= a", True), ("  =a", True), ("48 mm", False), (5, False), (None, False)]
    )
    def test_property_is_relation(self, raw, expected):
        assert is_relation(raw) is expected


class TestUnits:
    @pytest.mark.parametrize(
        ("text", "measured"),
        [
            ("= scale * 48 mm", "m"),
            ("= d - 1 inch", "m"),
            ("= d ** 2", "m**2"),
            ("= d ** -1", "1/m"),
            ("= d ** 0.5 * d ** 1.5", "m**2"),
            ("= sqrt(d * d)", "m"),
            ("= 1 N / d ** 2", "Pa"),
            ("= d / d", "1"),
            ("= scale ** scale", "1"),
            ("= sin(d / d)", "1"),
            ("= atan(scale)", "rad"),
            ("= max(d, 2 mm)", "m"),
            ("= 25 kN * 2 m", "J"),
        ],
    )
    def test_analytic_kind(self, text, measured):
        result = kind(text, d=LENGTH, scale=PURE)
        assert registry.get_dimensionality(result.base) == registry.get_dimensionality(unit(measured).base)

    @pytest.mark.parametrize(
        ("text", "shown"),
        [
            ("= scale * d", "mm"),
            ("= d * d", "mm**2"),
            ("= d ** 3", "cm**3"),
            ("= 5 kN / d ** 2", "MPa"),
            ("= 5 kN / d", "kN/mm"),
            ("= 2 kg * d", "kg*mm"),
            ("= 2 N * scale", "N"),
            ("= 2 N * d", "N*m"),
            ("= scale", "1"),
        ],
    )
    def test_a_calculated_value_is_in_the_unit_that_engineers_use(self, text, shown):
        result = kind(text, d=LENGTH, scale=PURE)
        assert result.unit == shown
        assert unit(shown).base == result.base

    @pytest.mark.parametrize(
        ("text", "words"),
        [
            ("= d + 1", "+ needs equal units"),
            ("= d - 1 kN", "- needs equal units"),
            ("= max(d, 2)", "max needs equal units"),
            ("= 2 ** d", "exponent must be a pure number"),
            ("= d ** scale", "plain number"),
            ("= d ** 13", "at most 12"),
            ("= sin(d)", "sin takes an angle or a pure number"),
            ("= log(3 mm)", "log takes"),
            ("= 20 degC + 5 degC", "degC"),
            ("= 5 delta_degC - 20 degC", "write 20 delta_degC for a difference"),
            ("= T + 5 degF", "write 5 delta_degF for a difference"),
            ("= 2 * 20 degC", "write 293.15 K for a temperature, 20 delta_degC for a difference"),
            ("= scale / -40 degF", "write 233.15 K for a temperature, -40 delta_degF for a difference"),
            ("= sqrt(20 degC)", "write 293.15 K for a temperature"),
            ("= 3000 rpm + 50 1/s", "equal units"),
            ("= 3000 rpm + 50 Hz", "equal units"),
            ("= 3000 rad/s + 50 Hz", "equal units"),
        ],
    )
    def test_analytic_mismatch(self, text, words):
        with pytest.raises(FaultyText) as refusal:
            kind(text, d=LENGTH, scale=PURE, T=TEMPERATURE)
        assert refusal.value.code == "unit_mismatch"
        assert words in str(refusal.value)

    @pytest.mark.parametrize(
        ("text", "unit"),
        [
            ("= T", "degC"),
            ("= max(T, 20 degC)", "degC"),
            ("= 20 degC + 5 K", "degC"),
            ("= T - 5 delta_degC", "degC"),
            ("= T - 20 degC", "delta_degC"),
            ("= T - T", "delta_degC"),
            ("= max(dT, dT)", "delta_degC"),
            ("= scale * (T - 300 K) + dT", "delta_degC"),
            ("= 20 K", "K"),
            ("= T - 5 K", "K"),  # 5 K is a difference, or a temperature
            ("= 1 W / (1 W/K)", "K"),
        ],
    )
    def test_analytic_a_temperature_is_known_from_a_difference(self, text, unit):
        assert kind(text, T=TEMPERATURE, dT=RISE, scale=PURE).unit == unit

    @pytest.mark.parametrize("text", ["max(dT, 20 degC)", "max(20 degC, dT)", "min(dT, dT, 20 degC)"])
    def test_analytic_a_temperature_among_differences_is_refused(self, text):
        with pytest.raises(FaultyText, match="write 20 delta_degC for a difference"):
            kind(f"= {text}", dT=RISE)
        with pytest.raises(FaultyText, match="which may be a temperature or a difference"):
            kind(f"= 2 * {text}", dT=KELVIN)


ATTACKS = [
    "= (1).__class__",
    "= a.__class__",
    "= a.b.__init__",
    "= _a",
    "= __import__('os').system('id')",
    "= eval('1')",
    "= open(x)",
    "= print(1)",
    "= getattr(a, b)",
    "= 'text'",
    '= "text"',
    "= f'{a}'",
    "= b'1'",
    "= lambda: 1",
    "= (x := 1)",
    "= x = 1",
    "= x[0]",
    "= {1}",
    "= [a for a in b]",
    "= 1 if a else 2",
    "= a and b",
    "= not a",
    "= a == b",
    "= a < b",
    "= a // b",
    "= a % b",
    "= a @ b",
    "= ~a",
    "= a; b",
    "= a, b",
    "= a # comment",
    "= a\n+ b",
    "= a \\\n",
    "= 1j",
    "= 0x10",
    "= 1_000",
    "= ...",
    "= *a",
    "= f(*a)",
    "= sin(x=1)",
    "= sin()",
    "= sin(1, 2)",
    "= pi()",
    "= 1e999",
    "= 1e308 km",
    "= 5 m**99**99",
    "= 5 m**9**9**9" + "**9" * 300,
    "= 48 mm*scale",
    "= 5 foo",
    "= 5 \ud800",
    "= \ud800",
    "= \x00",
    "= ｘ + 1",  # full-width x
    "= а + 1",  # Cyrillic a
    "= ٣ + 1",  # Arabic digit
    "= a\u200b",  # zero-width space
    "= a − 1",  # minus sign
    "=",
    "",
    "==1",
    "= 1 +",
    "= (1",
    "= 1)",
    "= " + "(" * 999 + "1" + ")" * 999,
    "= " + "-" * 1500 + "1",
    "= " + "1+" * 900 + "1",
    "= " + "abs(" * 150 + "1" + ")" * 150,
    "= " + "1" * 5000,
    "= " + " " * 10**6 + "1",
    "= " + "a." * 900 + "a.",
]


class TestAttacks:
    @pytest.mark.parametrize("text", ATTACKS, ids=range(len(ATTACKS)))
    def test_property_attacks_are_refused(self, text):
        with pytest.raises(FaultyText) as refusal:
            checked(text)
        assert refusal.value.code in {
            "syntax",
            "unknown_unit",
            "unknown_function",
            "not_finite",
            "unit_mismatch",
            "no_truth",
        }
        assert len(str(refusal.value).encode("utf-8")) < 400

    def test_property_a_name_is_only_a_name(self):
        """Words with a meaning in Python have none here."""
        relation = parse("= lambda + eval + None + os.system")
        assert relation.names == {"lambda", "eval", "None", "os.system"}
        assert relation.value(dict.fromkeys(relation.names, 1.0)) == 4

    def test_property_as_deep_as_allowed_works(self):
        assert value("= " + "abs(" * 45 + "-1" + ")" * 45) == 1
        assert value("= " + "(" * 900 + "1" + ")" * 900) == 1


numbers = st.floats(0.1, 9.9).map(lambda x: f"{x:.3g}")
arithmetic = st.recursive(
    numbers,
    lambda inner: (
        st.builds("{} {} {}".format, inner, st.sampled_from(["+", "-", "*", "/"]), inner)
        | st.builds("({})".format, inner)
        | st.builds("-{}".format, inner)
        | st.builds("({}) ** {}".format, numbers, st.sampled_from(["2", "-1", "0.5"]))
    ),
    max_leaves=12,
)


def python_value(text):
    """The same arithmetic by Python, on a tree of numbers and operators only."""
    tree = ast.parse(text, mode="eval")
    allowed = (ast.Expression, ast.Constant, ast.BinOp, ast.UnaryOp, ast.operator, ast.unaryop)
    assert all(isinstance(node, allowed) for node in ast.walk(tree))
    return eval(compile(tree, "arithmetic", "eval"))


class TestFuzz:
    @settings(max_examples=examples(200))
    @given(arithmetic)
    def test_property_arithmetic_agrees_with_python(self, text):
        try:
            expected = python_value(text)
        except ZeroDivisionError:
            assert not np.isfinite(value(f"= {text}"))
        else:
            assert value(f"= {text}") == pytest.approx(expected, rel=1e-12, abs=1e-12)

    @settings(max_examples=examples(500))
    @given(st.text("ab.()[]+-*/ 019eE mkN°²_,=sincopimax\t", max_size=80) | st.text(max_size=60))
    def test_property_any_text_is_a_relation_or_refused(self, text):
        try:
            relation, result = checked(text)
            is_answered = isinstance(result, Kind)
            np.asarray(relation.value(dict.fromkeys(relation.names, 2.0)), float)  # such as that of [0]
        except FaultyText as refusal:
            is_answered = bool(str(refusal).encode("utf-8"))
        assert is_answered


def test_chained_comparisons_in_each_other_are_bounded():
    assert value("= if 1 < (if 1 < n < 9 then 2 else 3) < 9 then 4 else 5", n=1.0) == 4
    text = "if 1 < (" * 40 + "n" + ") < 9 then 2 else 3" * 40
    with pytest.raises(FaultyText) as error:
        parse(f"= {text}")
    assert error.value.code == "too_large"
