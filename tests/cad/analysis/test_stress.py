"""Literature: a shoulder fillet's stress concentration; what counts as converged."""

import json

import pytest
from cadquery import Shape, Workplane

from benchmarks.random_shoulders import RESULTS, compared, drawn
from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.kinds import Kind
from cad.analysis.solid import read_solid
from cad.analysis.stress import CONVERGED, FLOOR, SMALL, Peak, Peaks, searched
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


def peaks_of(*values: tuple[int, float]) -> Peaks:
    """Peaks by order and value."""
    return Peaks(tuple(Peak(value, (0.0, 0.0, 0.0), 1, 1, order) for order, value in values))


FOUND = ((2, 1.3), (2, 1.0), (2, 1.0 + 0.9 * SMALL))


@pytest.mark.parametrize(
    ("values", "converged"),
    [
        ((), False),
        (((2, 1.0), (2, 1.0), (3, 1.0)), False),
        (FOUND, False),
        ((*FOUND, (3, FOUND[-1][1] * (1 + 0.9 * CONVERGED))), True),
        ((*FOUND, (3, FOUND[-1][1] * (1 + 1.1 * CONVERGED))), False),
        (((2, 1.3), (2, 1.0), (2, 1.0 + 1.2 * SMALL), (3, 1.0 + 1.2 * SMALL)), False),
        ((*FOUND, (3, 1.2), (2, 1.15), (3, 1.2 * (1 + 0.9 * CONVERGED))), True),
    ],
    ids=[
        "nothing",
        "two meshes",
        "one order",
        "order small",
        "order matters",
        "mesh matters",
        "confirmed twice",
    ],
)
def test_one_small_change_is_no_convergence(values: tuple[tuple[int, float], ...], converged: bool) -> None:
    assert peaks_of(*values).converged == converged


def test_the_stated_error_is_the_smaller_change_and_a_constant() -> None:
    assert peaks_of(*FOUND, (3, 1.1)).error == pytest.approx(abs(FOUND[-1][1] / 1.1 - 1) + FLOOR)
    assert peaks_of(*FOUND, (3, 1.2), (2, 1.1), (3, 1.212)).error == pytest.approx(0.012 / 1.212 + FLOOR)


@pytest.mark.slow
def test_property_the_stated_error_holds_for_random_shoulders() -> None:
    """The ensemble is stored with its seed; two of its shafts, one for each load, are computed again."""
    kept = json.loads(RESULTS.read_text())
    for number, row in enumerate(kept["shafts"][:2]):
        again = compared(drawn(kept["seed"], number), row["load"])
        assert again["difference"] == pytest.approx(row["difference"], abs=1e-4)
        assert abs(again["difference"]) <= again["stated error"]
