"""Messages of worksheets about faults give remedies and warnings, and by how much a test failed."""

import pytest
from test_sheet_attacks import ATTACKS, SHEET, faults

from templates.core.language.evaluate import evaluate
from templates.core.paper import report
from templates.core.sheets import read, run_tests


@pytest.mark.parametrize("attack", ATTACKS)
def test_every_fault_has_a_remedy(attack):
    assert all(fault.remedy for fault in faults(SHEET + ATTACKS[attack][0]))


@pytest.mark.parametrize(
    ("text", "code", "remedy"),
    [
        ('q [N] = F + W "q"', "unit_mismatch", "write both in the same unit; F is in N, W in mm"),
        ('q [N] = max(F, W) "q"', "unit_mismatch", "write both in the same unit; F is in N, W in mm"),
        ('q [N] = if F > W then F else F "q"', "unit_mismatch", "write both in the same unit; F"),
        ('q [m] = F / W**2 "q"', "unit_mismatch", "declare q in MPa, or correct the formula"),
        ('q [m] = F * W * 1 s "q"', "unit_mismatch", "declare q in kg*m**2/s, or correct the formula"),
        ('q [1] = sin(W) "q"', "unit_mismatch", "divide by a unit first, for example `sin(x / 1 mm)`"),
        ('given y [mm] "y" (example 3 N)', "unit_mismatch", "write it in mm or another unit of"),
        ('f(w [mm]) [mm] = w + F', "unit_mismatch", "write both in the same unit; w is in m, F in N"),
        ('q [bar] = max(sum(F), 1 bar) "q"', "axis_mismatch", "give a list, for example `max([a, b])`"),
        ('q [bar] = g "q"', "axis_mismatch", "declare it over cycle, or take `max(…)` of it"),
        ('q [1] over cycle = x "q"', "axis_mismatch", "omit `over` and the name after it"),
        ('q [N] = if F then F else F "q"', "no_truth", "write a comparison behind `if`"),
        ('q [N] = laws * F "q"', "unknown_name", "did you mean law?"),
        ('q [N] = F "q"\ntest "t" with FF = 1 N gives q = 1 N within 1 %', "unknown_name", "did you mean F?"),
        ('given y [1] = 1 / 0 "y"', "limit", "write a number below 1e308"),
        ('q [1] = r "q"\nr [1] = q "r"', "loop", "let one of them follow from something else"),
    ],
)  # fmt: skip
def test_a_remedy_says_what_would_be_right(text, code, remedy):
    (fault,) = faults(SHEET + text)
    assert fault.code == code
    assert fault.remedy.startswith(remedy)


@pytest.mark.parametrize("argument", ["T - T", "T + T", "0 K * x", "dT"])
@pytest.mark.parametrize("declared", ["f(t [degC]) [K] = t - 273.15 K", 'f(t [degC]) [K] "f": 1 -> 2 2 -> 3'])
def test_a_parameter_in_degc_refuses_what_is_no_temperature(argument, declared):
    text = f'{SHEET}{"" if "=" in declared else "curve "}{declared}\ndT [K] = T - 280 K "cooling"\n'
    given = 'dT [K] = T - T "difference"\n'
    text = text.replace('dT [K] = T - 280 K "cooling"\n', given)
    (fault,) = faults(f'{text}r [K] = f({argument}) "r"')
    assert fault.code == "unit_mismatch"
    assert fault.remedy == "give a temperature, or declare the parameter in K"
    read(f'{text}r [K] = f((T + T) / 2) "r"\ns [K] = f(20 degC) "s"\nu [K] = f(T - 2 K) "u"')


def test_a_filled_in_test_of_a_choice_names_the_choice():
    cls = read(SHEET + 'q [N] = if law is a then F else 2 * F "q"').template("choices", 1)
    template = evaluate(cls, {**cls.example, "law": "b"}).template
    (row,) = report.rows(template)
    assert row.expression.count(r"\mathrm{law}=\text{a}") == row.numbers.count(r"\mathrm{law}=\text{a}") == 1
    assert r"\text{b}=" not in row.latex


def test_a_check_of_lists_of_different_lengths_warns_with_the_reason():
    text = SHEET + 'q [bar] over cycle = [1, 2, 3] * 1 bar "short"\ncheck g <= q "it is carried"'
    cls = read(text).template("uneven", 1)
    evaluation = evaluate(cls, {**cls.example, "law": "a"})
    assert [(warning.code, warning.name) for warning in evaluation.warnings] == [
        ("check_not_judged", "pressure")
    ]
    assert "different lengths" in evaluation.warnings[0].detail


@pytest.mark.parametrize(
    ("expected", "missed"),
    [
        ("2 N", "p is 1000 N, not 2 N within 1 %: 998 N (4.99e+04 %) too high"),
        ("2 kN", "p is 1000 N, not 2 kN within 1 %: 1000 N (50 %) too low"),
    ],
)
def test_a_test_that_fails_says_by_how_much(expected, missed):
    cls = read(f'{SHEET}p [N] = F "p"\ntest "t" with law = a gives p = {expected} within 1 %').template(
        "t", 1
    )
    (result,) = run_tests(cls)
    assert (result.line, result.passed) == (SHEET.count("\n") + 2, False)
    assert result.message == missed
