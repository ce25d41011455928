"""An equation that is satisfied at both bounds has no value, because any root would be arbitrary."""

import numpy as np
import pytest

from templates.core.language.evaluate import evaluate
from templates.core.sheets import read

SHEET = 'given a [1] "factor" (example 1)\nsolve x [1] from 0 to 10 so that {} == 0 "root"'


def roots(equation, factor):
    cls = read(SHEET.format(equation)).template("duty", 1)
    return evaluate(cls, {"factor": factor}).outputs["root"]


@pytest.mark.parametrize("equation", ["a * x * (x - 10)", "a * x * 0"])
def test_an_equation_that_holds_at_both_bounds_has_no_value(equation):
    answer = roots(equation, 1)
    assert answer.value is None
    assert "holds at both bounds" in answer.reason


def test_other_points_keep_their_root():
    answer = roots("(x - a) * x", [5.0, 10.0])
    assert answer.value[0] == 0
    assert np.isnan(answer.value[1])
    assert roots("(x - a) / (1 + x)", [5.0, 10.0]).value == pytest.approx([5, 10])


def test_a_root_at_one_bound_is_one():
    assert roots("x - 10 * a", 1).value == 10
    assert roots("sin(x) - 0 * a", 1).value == 0
