"""Small fillets are resolved for stresses only; the error of a stiffness includes what that changes."""

import json
from dataclasses import replace
from math import inf

import pytest

from benchmarks.small_fillets import CHEAP, RESULTS, judged, measured, summary
from cad.analysis import analyse as analysis
from cad.analysis.analyse import AnalysisRequest, analyse
from cad.analysis.corners import NONE
from cad.analysis.element_count import estimated_elements
from cad.analysis.levels import LEVELS, Level
from cad.analysis.mesh import Fineness, Grid, make_grid, sizes
from cad.analysis.solid import Solid, read_solid
from cad.analysis.stress import START
from cad.analysis.throw_tables import LEVELS as TABLE_LEVELS
from cad.shaft import Shaft
from tests.references.shoulder_fillet import END, FILLET, shoulder

SMALL, WIDE = 0.3, 6.0  # [mm]
COARSE = LEVELS[0].fineness


def filleted(fillet: float) -> Solid:
    return read_solid(shoulder(fillet), Shaft(0.0, END))


def test_a_small_fillet_costs_few_elements_and_the_mesh_says_so() -> None:
    solid = filleted(SMALL)
    limited = make_grid(solid, COARSE)
    resolved = sizes(solid, COARSE, (), NONE)
    assert not limited.is_resolved
    assert estimated_elements(solid.shape, resolved, COARSE.size * solid.scale, inf) > 4 * limited.mesh.ne


def test_a_wide_fillet_has_the_mesh_that_it_had() -> None:
    limited, full = (make_grid(filleted(WIDE), each) for each in (COARSE, replace(COARSE, least=0.0)))
    assert limited.is_resolved
    assert limited.mesh.ne == full.mesh.ne


@pytest.mark.parametrize("level", LEVELS, ids=lambda level: level.name)
def test_the_stated_error_includes_what_unresolved_fillets_change(level: Level) -> None:
    for is_sharp in (False, True):
        more = level.error(1.01, 1.0, is_sharp=is_sharp, is_resolved=False)
        assert more - level.error(1.01, 1.0, is_sharp=is_sharp) == pytest.approx(level.unresolved)
    assert (level.unresolved > 0) == (level.fineness.least > 0)


def test_stresses_are_computed_on_resolved_fillets() -> None:
    assert START.least == 0
    assert all(fineness.least == 0 for fineness, _ in TABLE_LEVELS.values())


class Meshed(Exception):
    """Ends an analysis before it meshes."""


@pytest.mark.parametrize(("output", "least"), [("stiffness", COARSE.least), ("surface", 0.0)])
def test_a_picture_of_stresses_has_resolved_fillets(
    output: str, least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_grid(solid: Solid, fineness: Fineness) -> Grid:
        assert fineness == replace(COARSE, least=least)
        raise Meshed

    monkeypatch.setattr(analysis, "make_grid", no_grid)
    with pytest.raises(Meshed):
        analyse(
            shoulder(FILLET),
            Shaft(0.0, END),
            AnalysisRequest(level="coarse"),
            [output],
            lambda done, what: None,
        )


def test_property_full_models_lie_within_the_stated_errors() -> None:
    """The ensemble is stored with its seed."""
    kept = json.loads(RESULTS.read_text())
    assert summary(kept["rows"]) == kept["summary"]
    assert all(judged(row, level)["share"] <= 1 for row in kept["rows"] for level in CHEAP)


@pytest.mark.slow
def test_the_stored_ensemble_is_that_of_its_seed() -> None:
    kept = json.loads(RESULTS.read_text())
    again, row = measured(kept["seed"], 0), kept["rows"][0]
    assert again["parameters"] == row["parameters"]
    for name in ("full", *(level.name for level in CHEAP)):
        assert again[name]["stiffness"] == pytest.approx(row[name]["stiffness"], rel=1e-5)
