"""Property: the error told bounds the true one, filleted or sharp; two runs tell the same, nearly."""

import pytest

from benchmarks.torsion_levels import random_throws, shaft_of, truth
from cad.analysis.analyse import Asked, analyse

OTHER_SEED = 7  # not that of the throws from which the factors were read


@pytest.mark.slow
def test_property_the_error_told_bounds_the_true_one_on_ten_throws() -> None:
    wrong = {}
    for number, parameters in enumerate(random_throws(10, OTHER_SEED)):
        step, shaft = shaft_of(parameters)
        told = analyse(step, shaft, Asked(), ["stiffness"], lambda done, what: None).outputs["stiffness"]
        off = abs(told["value"] / truth(step, shaft, ["stiffness"])["stiffness"] - 1)
        if off > told["error"]:
            wrong[number] = (off, told["error"])
    assert wrong == {}


def test_two_runs_tell_the_same() -> None:
    step, shaft = shaft_of(next(random_throws(1, OTHER_SEED)))
    asked = Asked(level="coarse")
    one, other = (analyse(step, shaft, asked, ["stiffness"], lambda done, what: None) for _ in range(2))
    first, second = one.outputs["stiffness"], other.outputs["stiffness"]
    assert first["mesh"] == second["mesh"]
    assert first["value"] == pytest.approx(second["value"], rel=1e-10)  # but for rounding
