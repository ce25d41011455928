"""Literature: the reference throw of shared/references, with stiffness from converged elements."""

import pytest

from cad.analysis.analyse import _ELASTIC as ELASTIC
from cad.analysis.analyse import AnalysisRequest, AnalysisResult, analyse
from cad.analysis.elastic import Response
from cad.errors import AnalysisError
from cad.regenerate import regenerate
from cad.shaft import Shaft

THROW = {
    "journal_diameter": 0.055,
    "journal_length": 0.040,
    "pin_diameter": 0.048,
    "pin_length": 0.032,
    "web_thickness": 0.018,
    "web_width": 0.080,
    "throw": 0.042,
    "fillet": 0.003,
}


@pytest.fixture(scope="session")
def step() -> bytes:
    return regenerate("crank_throw", 1, THROW).step


def stiffness(step: bytes, asked: AnalysisRequest) -> AnalysisResult:
    return analyse(step, Shaft(-54.0, 54.0), asked, ["stiffness"], lambda done, what: None)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("level", "within"), [("default", 5e-3), pytest.param("fine", 1e-3, marks=pytest.mark.slow)]
)
def test_the_reference_throw_is_as_stiff_as_it_should_be(step: bytes, level: str, within: float) -> None:
    result = stiffness(step, AnalysisRequest(level=level)).outputs["stiffness"]
    assert result["value"] == pytest.approx(456_600, rel=within)
    assert abs(result["value"] / 456_600 - 1) <= result["error"] <= 2 * within
    assert result["mesh"]["mirror_plane"] == "xz"


@pytest.mark.slow
def test_a_guided_end_is_stiffer(step: bytes) -> None:
    result = stiffness(step, AnalysisRequest(boundary="guided_end")).outputs["stiffness"]
    assert result["value"] == pytest.approx(511_600, rel=5e-3)


@pytest.mark.slow
def test_one_output_that_is_refused_leaves_the_others(step: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(response: Response) -> None:
        raise AnalysisError("not_converged", "no mode stands out")

    monkeypatch.setattr("cad.analysis.analyse.torsional_mode", refuse)
    wanted, seen = ["stiffness", "torsional_frequency"], []
    result = analyse(
        step,
        Shaft(-54.0, 54.0),
        AnalysisRequest(tolerance=0.01),
        wanted,
        lambda done, what: seen.append(done),
    )
    assert result.outputs["torsional_frequency"]["value"] is None
    assert result.outputs["torsional_frequency"]["reason"] == "no mode stands out"
    assert result.outputs["stiffness"]["error"] <= 0.01
    assert seen == sorted(seen)
    assert seen[-1] == 1


@pytest.mark.slow
def test_no_value_where_elements_are_folded(step: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    """Orders that differ by a factor of two, or a stiffness below zero, are not answer."""
    values = iter([2e6, 1e6, 1e5, -1e5])
    monkeypatch.setitem(ELASTIC, "stiffness", lambda response: next(values))
    for _ in range(2):
        result = stiffness(step, AnalysisRequest(level="coarse")).outputs["stiffness"]
        assert result["value"] is None
        assert "finer" in result["reason"]
