"""Property: the estimated error bounds the true one, with fillets and sharp edges; two runs nearly agree."""

from types import SimpleNamespace
from typing import Any

import pytest

from benchmarks import torsion_levels
from benchmarks.shaft_truth import RATIO, extrapolated, truth
from benchmarks.torsion import THROW
from benchmarks.torsion_levels import random_throws, shaft_of
from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.levels import LEVELS
from cad.models.crankshaft_v1 import Crankshaft
from cad.regenerate import regenerate
from cad.shaft import Shaft

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
@pytest.mark.parametrize(
    "end",
    [
        {"nose_diameter": 0.020, "nose_length": 0.020},
        {"nose_diameter": 0.001, "nose_length": 0.001},
        {"flange_diameter": 0.020, "flange_thickness": 0.020},
    ],
    ids=["nose of 20 mm", "nose of 1 mm", "flange of 20 mm"],
)
def test_property_it_does_so_where_an_end_is_slender(end: dict[str, float]) -> None:
    """Nearly all of the compliance is then in that end, far smaller than the throw."""
    plain = {"nose_diameter": 0.8, "nose_length": 0.8, "flange_diameter": 0.9, "flange_thickness": 0.8}
    ends = {name: share * THROW["journal_diameter"] for name, share in plain.items()}
    parameters = {**THROW, "pin_angles": [0.0], **ends, **end}
    step, shaft = regenerate("crankshaft", 1, parameters).step, Crankshaft.from_si(parameters).shaft()
    assert shaft is not None
    true = truth(step, shaft, ["stiffness"])["stiffness"]
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


def test_extrapolation_finds_the_limit_of_a_geometric_series() -> None:
    found = [{"stiffness": 5.0 + 0.2**order} for order in (2, 3, 4)]
    assert extrapolated(found)["stiffness"] == pytest.approx(5.0, rel=1e-12)


def test_two_orders_are_extrapolated_by_the_ratio_of_sharp_edges() -> None:
    found = [{"stiffness": 5.0 + RATIO**order} for order in (2, 3)]
    assert extrapolated(found)["stiffness"] == pytest.approx(5.0, rel=1e-12)


def test_a_broken_off_run_goes_on_where_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a row has is not computed again; a change of one level's mesh costs that level only."""
    row: dict[str, Any] = {"model": "crank_throw", "parameters": {}}
    asked: list[int] = []

    def values(grid: Any, order: int, *_: Any) -> dict[str, float]:
        asked.append(order)
        return {"stiffness": float(order)}

    grid = SimpleNamespace(mesh=SimpleNamespace(ne=1), is_sharp=False, is_resolved=True)
    monkeypatch.setattr(torsion_levels, "drawn", lambda model, parameters: (b"", Shaft(0.0, 1.0)))
    monkeypatch.setattr(torsion_levels, "by_orders", lambda step, shaft: [{"stiffness": 1.0}])
    monkeypatch.setattr(torsion_levels, "read_solid", lambda step, shaft: None)
    monkeypatch.setattr(torsion_levels, "make_grid", lambda *_: grid)
    monkeypatch.setattr(torsion_levels, "outputs_by", values)
    torsion_levels.measure(row, LEVELS)
    assert sorted(asked) == [2, 2, 3, 3, 3, 4]
    torsion_levels.measure(row, LEVELS)
    assert len(asked) == 6
    row["coarse"]["mesh"] = "another"
    torsion_levels.measure(row, LEVELS)
    assert asked[6:] == [2, 3]
