"""Relations and formulas of worksheets are printed rightly as LaTeX and MathML."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import pytest

from templates.core.paper.expressions import DEEPEST_ON_PAPER, latex, relation_latex
from templates.core.paper.mathml import mathml
from templates.core.units.relation import parse


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2 * D_1 + nu", r"2\,D_{1}+\nu"),
        ("a - (b - c)", r"a-\left(b-c\right)"),
        ("a / (b + c) * 3", r"\frac{a}{b+c}\cdot 3"),
        ("(a + b) ** 2", r"\left(a+b\right)^{2}"),
        ("-a ** -2", r"-a^{-2}"),
        ("(-2) ** 2", r"\left(-2\right)^{2}"),
        ("1e-3 mm * 20 %", r"1\cdot 10^{-3}~\text{mm}\cdot 20~\%"),
        ("25 kN / 3 N*m", r"\frac{25~\text{kN}}{3~\text{N·m}}"),
        ("loads.main_load_x[2]", r"\text{main load x}_{\text{loads},2}"),
        ("x[n] + x_1[3]", r"x_{n}+x_{1,3}"),
        ("[a, b][2]", r"\left[a, b\right]_{2}"),
        ("sqrt(abs(a)) + floor(b)", r"\sqrt{\left|a\right|}+\left\lfloor b\right\rfloor "),
        ("mean(a) + log10(b)", r"\overline{a}+\lg\left(b\right)"),
        ("if a < b then 1 else 2", r"\begin{cases}1 & \text{if } a<b\\ 2 & \text{otherwise}\end{cases}"),
        (
            "if a <= b and (c > 2 or d != 1) then 1 else 2",
            r"\begin{cases}1 & \text{if } a\le b\ \text{and}\ \left(c>2\ \text{or}\ d\ne 1\right)\\ "
            r"2 & \text{otherwise}\end{cases}",
        ),
        (
            "if not a == b then 1 else if law is vogel then 2 else 3",
            r"\begin{cases}1 & \text{if } \text{not}\ \left(a=b\right)\\ "
            r"2 & \text{if } \text{law}=\text{vogel}\\ 3 & \text{otherwise}\end{cases}",
        ),
    ],
)
def test_analytic_latex(text, expected):
    assert relation_latex(f"= {text}") == expected
    ElementTree.fromstring(mathml(expected))


def test_property_symbols_and_numbers_stand_for_names():
    tree = parse("= d ** 2 * nu").tree
    assert latex(tree, {"d": "D", "nu": r"\nu_{\mathrm{40}}"}) == r"D^{2}\,\nu_{\mathrm{40}}"
    assert latex(tree, {"d": r"3\,\text{mm}", "nu": "-4"}, r"\cdot ") == (
        r"\left(3\,\text{mm}\right)^{2}\cdot \left(-4\right)"
    )


@pytest.mark.parametrize("raw", ["= film.width", "48 mm", 5, None, ["= a"], "= (", "= 1 +"])
def test_property_names_and_values_are_no_formulas(raw):
    assert relation_latex(raw) == ""


def test_property_what_is_too_deep_for_paper_is_left_as_text():
    assert relation_latex("= " + "abs(" * (DEEPEST_ON_PAPER - 1) + "a" + ")" * (DEEPEST_ON_PAPER - 1))
    assert relation_latex("= " + "abs(" * DEEPEST_ON_PAPER + "a" + ")" * DEEPEST_ON_PAPER) == ""


def test_property_words_of_choices_break_no_markup():
    markup = mathml(relation_latex('= if oil is "<b> & \\frac{1} %$" then 1 else 2'))
    assert "<b>" not in markup
    ElementTree.fromstring(markup)
