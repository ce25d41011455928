"""Property: the estimated error bounds the true one, filleted or sharp; two runs give the same, nearly."""

from dataclasses import replace

import pytest

from benchmarks.torsion import THROW
from benchmarks.torsion_levels import TRUTH, outputs_by, random_throws, shaft_of, truth
from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.mesh import make_grid
from cad.analysis.solid import read_solid
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import regenerate

OTHER_SEED = 7  # not that of the throws from which the factors were read


@pytest.mark.slow
def test_property_the_stated_error_bounds_the_true_one_on_ten_throws() -> None:
    wrong = {}
    for number, parameters in enumerate(random_throws(10, OTHER_SEED)):
        step, shaft = shaft_of(parameters)
        reported = analyse(step, shaft, AnalysisRequest(), ["stiffness"], lambda done, what: None).outputs[
            "stiffness"
        ]
        off = abs(reported["value"] / truth(step, shaft, ["stiffness"])["stiffness"] - 1)
        if off > reported["error"]:
            wrong[number] = (off, reported["error"])
    assert wrong == {}


@pytest.mark.slow
@pytest.mark.parametrize("ends", [("front", 20, 20), ("front", 1, 1), ("rear", 20, 20)])
def test_property_it_does_so_where_an_end_is_slender(ends: tuple[str, float, float]) -> None:
    """Nearly all of the compliance is then in that end, far smaller than the throw."""
    end, diameter, length = ends
    parameters = {**THROW, f"{end}_diameter": diameter / 1e3, f"{end}_length": length / 1e3}
    step, shaft = regenerate("crankshaft", 1, parameters).step, Crankshaft.from_si(parameters).shaft()
    assert shaft is not None
    grid = make_grid(read_solid(step, shaft), replace(TRUTH, sharp=0.04))
    true = outputs_by(grid, 4, shaft, ["stiffness"])["stiffness"]
    for level in ("coarse", "default"):
        result = analyse(step, shaft, AnalysisRequest(level=level), ["stiffness"], lambda done, what: None)
        reported = result.outputs["stiffness"]
        assert abs(reported["value"] / true - 1) <= reported["error"] <= 0.05


@pytest.mark.slow
def test_two_runs_tell_the_same() -> None:
    step, shaft = shaft_of(next(random_throws(1, OTHER_SEED)))
    asked = AnalysisRequest(level="coarse")
    one, other = (analyse(step, shaft, asked, ["stiffness"], lambda done, what: None) for _ in range(2))
    first, second = one.outputs["stiffness"], other.outputs["stiffness"]
    assert first["mesh"] == second["mesh"]
    assert first["value"] == pytest.approx(second["value"], rel=1e-9)  # but for the residual of the solver
