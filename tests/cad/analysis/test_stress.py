"""Literature: a shoulder fillet's stress concentration; what counts as converged."""

import pytest
from cadquery import Shape, Workplane

from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.kinds import Kind
from cad.analysis.solid import read_solid
from cad.analysis.stress import CONVERGED, SMALL, Peak, Peaks, searched
from cad.errors import AnalysisError
from cad.header import Header
from cad.model import Part
from cad.shaft import Shaft
from cad.step import write_step
from tests.references.shoulder_fillet import (
    END,
    FILLET,
    LOADS,
    NARROW,
    SHOULDER,
    factors,
    peaks,
    peterson,
    shoulder,
)


@pytest.mark.slow
@pytest.mark.parametrize("load", LOADS)
def test_a_shoulder_fillet_concentrates_stress_as_peterson_says(load: Kind) -> None:
    result = peaks(load)
    assert result.converged
    assert factors(load, result)[-1] == pytest.approx(peterson(load), rel=0.05)


@pytest.mark.slow
def test_a_sharp_corner_has_no_greatest_stress() -> None:
    result = analyse(
        shoulder(0.0), Shaft(0.0, END), AnalysisRequest(), ["maximum_stress"], lambda done, what: None
    )
    stress = result.outputs["maximum_stress"]
    assert stress["value"] is None
    assert "sharp inner corner" in stress["reason"]


def test_a_shaft_without_a_free_length_is_refused() -> None:
    disc = disc_of(2.0)
    with pytest.raises(AnalysisError, match="so short"):
        analyse(disc, Shaft(0.0, 2.0), AnalysisRequest(), ["maximum_stress"], lambda done, what: None)


def test_a_fillet_close_to_an_end_is_looked_at() -> None:
    """A shaft's plain ends are left out by 0.3 radii, but not beyond where something begins."""
    low, high = searched(read_solid(shoulder(FILLET), Shaft(0.0, END)))
    assert low == pytest.approx(0.3 * NARROW / 2)
    assert high == pytest.approx(END - 0.3 * NARROW / 2)
    near = read_solid(shoulder(FILLET, SHOULDER + FILLET + 2.0), Shaft(0.0, SHOULDER + FILLET + 2.0))
    assert SHOULDER + FILLET < searched(near)[1] < SHOULDER + FILLET + 2.0


def disc_of(thickness: float) -> bytes:
    shape = Workplane().circle(30).extrude(thickness).val()
    assert isinstance(shape, Shape)
    return write_step((Part("disc", shape, 1.0),), Header("disc", 1, {}, "0" * 64))


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
