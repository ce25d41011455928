"""Checks of a calculation state bounds and rules in words, with the right values."""

import numpy as np
import pytest

from templates.core.language.evaluate import evaluate
from templates.core.language.template import Array, Template, Truth, formula, given, require
from templates.core.paper.verdicts import checks


def reserve(limit: Array, value: Array) -> Truth:
    """Whether a value is not below a limit; a limit that is missing asks for nothing."""
    none = np.isnan(limit)
    return none | (value >= limit)


class Beam(Template):
    """A beam that is checked."""

    b: Array = given("mm", "width", gt=0)
    h: Array = given("mm", "height", ge=10, le=200)
    s: Array = given("mm", "span", published=(100, 1000))
    m: Array = given("mm", "least height", optional=True)
    T: Array = given("degC", "temperature", default="20 degC", ge=-40, le=100)

    @require("width", "height", remedy="make it higher")
    def upright(self) -> Truth:
        """The beam is at least as high as wide."""
        return self.b <= self.h

    @require("height", remedy="make it higher", warning="low")
    def high(self) -> Truth:
        """The height is not below the least one."""
        return reserve(self.m, self.h)

    @require("height", "span", remedy="make it higher", warning="slender")
    def stout(self) -> Truth:
        """A beam of any width is short, or high."""
        return (self.s <= 200e-3) | (self.h >= self.s / 10)

    @require("height", "width", remedy="make it higher")
    def not_flat(self) -> Truth:
        """The height exceeds the width, or equals it."""
        return self.h - self.b >= 0

    @formula("mm**2", "area", symbol="A", lt=1e5)
    def A(self) -> Array:
        return self.b * self.h


def reported(**inputs):
    evaluation = evaluate(Beam, {"width": "20 mm", "height": "50 mm", "span": "400 mm", **inputs})
    return {(check.kind, check.words): check for check in checks(evaluation.template)}


def test_share_of_an_upper_and_a_lower_limit():
    result = reported()
    assert result["domain", "height"].used == pytest.approx(50 / 200)
    assert result["domain", "area"].used == pytest.approx(1000 / 1e5)
    assert reported(height="11 mm", width="5 mm")["domain", "height"].used == pytest.approx(10 / 11)


def test_a_sign_is_no_check_and_a_temperature_uses_no_share():
    result = reported()
    assert ("domain", "width") not in result
    assert result["domain", "temperature"].used is None
    assert result["domain", "temperature"].holds


def test_of_a_sign_no_share_is_used():
    check = reported()["rule", "The height exceeds the width, or equals it"]
    assert check.used is None
    assert check.demand == r"h-b\ge 0"


def test_a_published_range_that_is_left_does_not_hold():
    check = reported(span="2 m")["published", "span"]
    assert not check.holds
    assert check.used == pytest.approx(2)
    assert check.demand == r"100\,\text{mm}\le s\le 1000\,\text{mm}"


def test_a_rule_is_written_out_with_symbols_and_numbers():
    check = reported()["rule", "The beam is at least as high as wide"]
    assert check.demand == r"b\le h"
    assert check.numbers == r"20\,\text{mm}\le 50\,\text{mm}"
    assert check.used == pytest.approx(0.4)
    assert check.holds


def test_a_rule_within_a_function_is_written_out_once_it_applies():
    words = "The height is not below the least one"
    assert ("warning", words) not in reported()
    check = reported(least_height="60 mm")["warning", words]
    assert check.demand == r"h\ge m"
    assert check.used == pytest.approx(60 / 50)
    assert not check.holds
    assert check.numbers == r"50\,\text{mm}<60\,\text{mm}"
    assert check.violation == "height 50 mm is below least height 60 mm"


def test_a_violated_rule_never_prints_its_opposite():
    many = {"value": [30, 10, 190], "unit": "mm"}
    check = reported(height=many, least_height="20 mm")["warning", "The height is not below the least one"]
    assert check.violation == "height 10 mm is below least height 20 mm (worst of 1 among 3 values)"
    flat = reported(height="12 mm", width="5 mm", span="900 mm")[
        "warning", "A beam of any width is short, or high"
    ]
    assert not flat.holds
    assert flat.violation == "span 900 mm is above 200 mm; height 12 mm is below span / 10 = 90 mm"


class Limited(Template):
    """A beam with a limit that may be left out."""

    h: Array = given("mm", "height", ge=0)
    m: Array = given("mm", "least height", alternative=True, ge=0)

    @require("least_height", remedy="make it higher", warning="low")
    def high(self) -> Truth:
        """The height is not below the least one."""
        return reserve(self.m, self.h)

    @formula("mm", "twice", symbol="t")
    def t(self) -> Array:
        return 2 * self.h


def test_a_rule_whose_limit_was_not_given_is_no_check():
    def rules(**inputs):
        template = evaluate(Limited, {"height": "50 mm", **inputs}).template
        return [check.holds for check in checks(template) if check.kind == "warning"]

    assert rules() == []
    assert rules(least_height="40 mm") == [True]
    assert rules(least_height="60 mm") == [False]


def test_of_alternatives_that_counts_which_applies():
    words = "A beam of any width is short, or high"
    assert reported()["warning", words].used == pytest.approx(40 / 50)
    short = reported(span="150 mm")["warning", words]
    assert short.used is None
    assert short.holds


def test_of_many_points_the_worst_counts():
    check = reported(height={"value": [30, 50, 190], "unit": "mm"})["domain", "height"]
    assert check.used == pytest.approx(190 / 200)
    assert check.points == 3
    bad = reported(height={"value": [30, 10, 190], "unit": "mm"})[
        "rule", "The beam is at least as high as wide"
    ]
    assert (bad.holds, bad.broken, bad.points) == (False, 1, 3)
    assert bad.numbers == ""


class Cube(Template):
    """A cube that has to fit, by rules with a function that paper does not know."""

    a: Array = given("m", "edge", gt=0)
    V: Array = given("m**3", "space", gt=0)

    @require("edge", "space", remedy="make it smaller")
    def fits(self) -> Truth:
        """The edge is no longer than that of the space."""
        return self.a <= np.cbrt(self.V)

    @require("edge", "space", remedy="make it smaller")
    def is_held(self) -> Truth:
        """The edge of the space is no shorter than the cube's."""
        return np.cbrt(self.V) >= self.a

    @formula("m", "same edge")
    def same(self) -> Array:
        return self.a


def test_a_side_that_cannot_be_written_leaves_the_sentence_alone():
    evaluation = evaluate(Cube, {"edge": "1 m", "space": "8 m**3"})
    rules = [check for check in checks(evaluation.template) if check.kind == "rule"]
    assert [(rule.demand, rule.holds) for rule in rules] == [("", True), ("", True)]
    assert [rule.used for rule in rules] == pytest.approx([0.5, 0.5])
