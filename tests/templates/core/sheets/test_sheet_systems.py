"""`solve` of several unknowns in linear equations: results, singular systems, and what is refused."""

import numpy as np
import pytest
from seeds import seeded

from templates.core.language.evaluate import evaluate
from templates.core.sheets import SheetRefused, read, run_tests
from templates.core.sheets.linear import solved

SHAFT = """# Shaft on two bearings
given F [kN] "load" (example 12 kN)
given a [mm] "left arm" (example 100 mm)
given b [mm] "right arm" (example 200 mm)
solve A [kN] "left reaction", B [N] "right reaction" (source "statics")
  so that A + B == F and A * a == b * B
share [1] = A / F "share of the left bearing"
test "by hand" gives A = 8 kN, B = 4 kN within 1e-12 kN
test "by hand, otherwise" with a = 200 mm gives A = 6 kN, B = 6 kN within 1e-9 %
"""


@pytest.fixture(scope="module")
def shaft():
    return read(SHAFT).template("shaft", 1)


def test_a_system_gives_all_its_unknowns(shaft):
    assert [test.message for test in run_tests(shaft) if not test.passed] == []
    outputs = evaluate(shaft, shaft.example).outputs
    assert outputs["left_reaction"].value == pytest.approx(8, rel=1e-12)
    assert outputs["right_reaction"].value == pytest.approx(4000, rel=1e-12)
    assert outputs["share_of_the_left_bearing"].value == pytest.approx(2 / 3, rel=1e-12)
    assert shaft.formulas["right_reaction"].meaning.source == "statics"


def test_a_system_is_one_statement_on_paper(shaft):
    (statement,) = (one for one in shaft.sheet.statements if one.kind == "solve")
    assert (statement.name, statement.words, statement.last_line - statement.line) == (
        "A",
        "left reaction",
        1,
    )
    assert statement.latex == r"A, B=\text{solution of }\ A+B=F\ \text{and}\ A\,a=b\,B"
    assert {"A", "B"} <= {one.name for one in shaft.sheet.names}


def test_a_singular_system_has_no_value_and_the_answer_says_why(shaft):
    arms = {"value": [100, -200, 50], "unit": "mm"}
    outputs = evaluate(shaft, {**shaft.example, "left_arm": arms}).outputs
    why = "the equations do not determine A, B"
    for name, right in (("left_reaction", [8, 9.6]), ("right_reaction", [4000, 2400])):
        assert outputs[name].value[[0, 2]] == pytest.approx(right, rel=1e-12)
        assert outputs[name].reasons.tolist() == [None, why, None]
    assert outputs["share_of_the_left_bearing"].reasons.tolist() == [None, why, None]
    alone = evaluate(shaft, {**shaft.example, "left_arm": "-200 mm"}).outputs["left_reaction"]
    assert (alone.value, alone.reason) == (None, why)


def test_functions_quotients_signs_and_conditions_may_hold_what_is_known():
    text = """given k [N/mm] "stiffness" (example 2 N/mm)
given F [N] "load" (example 6 N)
half(q [mm]) [mm] = q / 2
solve x [mm] "first way", y [um] "second way", z [mm] "third way" so that
  k * (x - half(y)) == F and -(x - y) / 2 + z == 1 mm and
  (if F > 1 N then 2 else 3) * z == x + 0 mm
"""
    cls = read(text).template("springs", 1)
    outputs = evaluate(cls, cls.example).outputs
    right = np.linalg.solve([[1, -0.5, 0], [-0.5, 0.5, 1], [-1, 0, 2]], [3, 1, 0])
    for name, value, size in zip(("first_way", "second_way", "third_way"), right, (1, 1000, 1), strict=True):
        assert outputs[name].value == pytest.approx(value * size, rel=1e-12)


@pytest.mark.parametrize("count", [2, 3, 6])
def test_units_and_order_of_the_equations_do_not_matter(count):
    random = np.random.default_rng(seeded(count))
    matrices, wanted = random.normal(size=(200, count, count)), random.normal(size=(200, count))
    matrices += 3 * np.eye(count)
    rows, columns = (10.0 ** random.uniform(-15, 15, (200, 1, count)) for _ in range(2))
    right = np.einsum("pij,pj->pi", matrices, wanted)
    order = random.permutation(count)
    scaled = (matrices * np.swapaxes(rows, -1, -2) * columns)[:, order]
    plain, never = solved(matrices, right)
    solution, singular = solved(scaled, (right * rows[:, 0])[:, order])
    assert not singular.any()
    assert not never.any()
    conditions = np.linalg.cond(matrices)[:, None]
    largest = np.abs(wanted).max(axis=-1, keepdims=True)
    assert (np.abs(solution * columns[:, 0] - wanted) <= 1e-14 * count * conditions * largest).all()
    assert (np.abs(plain - wanted) <= 1e-14 * count * conditions * largest).all()


def test_what_is_missing_or_singular_spoils_no_other_point():
    matrices = np.array(
        [np.eye(2), [[1, 2], [2, 4]], [[np.nan, 1], [1, 0]], np.zeros((2, 2)), 1e-300 * np.eye(2)]
    )
    solution, singular = solved(matrices, np.ones((5, 2)))
    assert singular.tolist() == [False, True, False, True, False]
    assert np.isnan(solution).all(axis=-1).tolist() == [False, True, True, True, False]
    assert solution[[0, 4]] == pytest.approx(np.array([[1, 1], [1e300, 1e300]]))


GIVEN = 'given F [N] "load" (example 1 N)\ngiven g [N] over cycle "loads" (example [1, 2] * 1 N)\n'
TWO = 'solve x [N] "first", y [N] "second" so that '


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        (TWO + "x * y == F * F and x == y", "equation", "the equations are not linear in x, y"),
        (TWO + "x / y == 2 and x == y", "equation", "the equations are not linear in x, y"),
        (TWO + "x**2 == F**2 and x == y", "equation", "the equations are not linear in x, y"),
        (TWO + "(if x > F then x else y) == F and x == y", "equation", "the equations are not linear"),
        (TWO + "x + y == F", "equation", "2 unknowns need 2 equations, not 1"),
        (TWO + "x == y == F and y == 2 * F", "equation", "2 unknowns need 2 equations, not"),
        (TWO + "x + y == F and x > y", "equation", "only equations can be joined by `and` here"),
        (TWO + "x + y == F or x == y", "equation", "only equations can be joined by `and` here"),
        (TWO + "x + y", "equation", "only equations can be joined by `and` here"),
        (TWO + "x == F and 2 * x == F", "equation", "y does not occur in the equations"),
        (TWO + "x + y == g and x == y", "axis_mismatch", "the equations contain a list over cycle"),
        (TWO + "x + y == F and x == 2 mm", "unit_mismatch", "== needs equal units, not N and m"),
        (TWO.replace("y [N]", "y [mm]") + "x + y == F and x == F", "unit_mismatch", "+ needs equal units"),
        (TWO.replace("second", "first") + "x + y == F and x == y", "name", "two unknowns have"),
        (TWO.replace("y [N]", "x [N]") + "x == F and x == F", "name", "x is already declared above"),
        (TWO.replace("y [N]", "F [N]") + "x == F and x == F", "name", "F is already declared above"),
        (TWO + 'x + y == k and x == y\nk [N] = 2 * x "k"', "loop", "x, k follow from each other"),
        ('solve x [N] so that x == F "x"', "syntax", "not understood"),
    ],
)  # fmt: skip
def test_what_is_no_linear_system_is_refused(text, code, message):
    with pytest.raises(SheetRefused) as refused:
        read(GIVEN + text)
    (fault, *_) = refused.value.faults
    assert (fault.code, fault.line >= 3) == (code, True)
    assert fault.message.startswith(message)
    assert fault.remedy


def test_what_uses_an_unknown_of_a_faulty_system_is_no_fault_of_its_own():
    with pytest.raises(SheetRefused) as refused:
        read(GIVEN + TWO + 'x * y == F * F and x == y\np [N] = x "p"\nq [N] = 2 * y "q"')
    assert [fault.code for fault in refused.value.faults] == ["equation"]


def test_a_system_has_at_most_ten_unknowns():
    names = [f"x{n}" for n in range(11)]
    unknowns = ", ".join(f'{name} [N] "{name}"' for name in names)
    with pytest.raises(SheetRefused, match="at most 10 unknowns"):
        read(f"{GIVEN}solve {unknowns} so that {' and '.join(f'{name} == F' for name in names)}")


def test_names_may_stand_in_a_line_below():
    text = 'given\n F [N] "load" (example 2 N)\n'
    text += 'solve\n x [N] "first", y [N] "second" so that x + y == F and x == y'
    cls = read(text).template("lines", 1)
    assert evaluate(cls, cls.example).outputs["second"].value == pytest.approx(1)
