"""Literature: a shoulder fillet's stress concentration; what counts as converged."""

import pytest

from benchmarks.shoulder_fillet import END, LOADS, factors, peaks, peterson, shoulder
from cad.analysis.analyse import Asked, analyse
from cad.analysis.elastic import Load
from cad.analysis.stress import CONVERGED, SMALL, Peak, Peaks
from cad.model import Shaft


@pytest.mark.slow
@pytest.mark.parametrize("load", LOADS)
def test_a_shoulder_fillet_concentrates_stress_as_peterson_says(load: Load) -> None:
    found = peaks(load)
    assert found.converged
    assert factors(load, found)[-1] == pytest.approx(peterson(load), rel=0.05)


@pytest.mark.slow
def test_a_sharp_corner_has_no_greatest_stress() -> None:
    found = analyse(shoulder(0.0), Shaft(0.0, END), Asked(), ["maximum_stress"], lambda done, what: None)
    stress = found.outputs["maximum_stress"]
    assert stress["value"] is None
    assert "sharp inner corner" in stress["reason"]


def meshes(*values: float) -> Peaks:
    return Peaks(tuple(Peak(value, (0.0, 0.0, 0.0), 1, 1) for value in values))


@pytest.mark.parametrize(
    ("values", "converged"),
    [
        ((1.0,), False),
        ((1.0, 1.0), False),
        ((1.0, 1.3, 1.3), False),
        ((1.0, 1.3, 1.3, 1.3), True),
        ((1.0, 1.0, 1.0 + 2 * CONVERGED), False),
        ((1.0, 1.0 + 0.9 * SMALL, 1.0 + 0.9 * SMALL), True),
        ((1.0, 1.0 + 1.1 * SMALL, 1.0 + 1.1 * SMALL), False),
    ],
)
def test_one_small_change_is_no_convergence(values: tuple[float, ...], converged: bool) -> None:
    assert meshes(*values).converged == converged
