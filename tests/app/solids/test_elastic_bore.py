"""A relation passes the matrix of a housing's analysis to the step of its elastic film.

The solver is replaced by a matrix that it wrote once; a slow test goes the whole way.
"""

import pytest
from serving import created, revision

from app.solids import analysis_rows as repository
from app.solids.questions import Options, question
from cad.analysis.kinds import KINDS, TABLES
from templates.core.language.evaluate import evaluate
from templates.door import built_in
from tests.recorded_bore import BORE_WIDTH, MODULUS, POISSON_RATIO, recorded_bore

FILM = built_in().get("elastic_film", 1)
MESH = {"elements": 10, "degrees_of_freedom": 90, "order": 2, "mirror_plane": "xy"}
RELATED = {
    "compliance": "= housing.bore_compliance.compliance",
    "bore_width": "= housing.bore_compliance.bore_width",
    "housing_modulus": "= housing.bore_compliance.modulus",
    "housing_poisson_ratio": "= housing.bore_compliance.poisson_ratio",
    "load_angle": "180 deg",
}


def housing(bore, level):
    analyses = {"analyses": {"bore_compliance": {"level": level}}} if level else {}
    return {"id": "bearing_housing", "version": 1, "parameters": {"housing_bore": bore}, **analyses}


def design(bore, level):
    inputs = {**FILM.example, **RELATED}
    return {
        "name": "elastic film",
        "models": {"housing": housing(bore, level)},
        "steps": {"film": {"template": "elastic_film", "version": 1, "level": "elastic", "inputs": inputs}},
    }


def answered_by_stub(http, served, bore):
    """Build the housing, then write what a solver would have answered about it."""
    alone = {"name": "housing", "models": {"housing": housing(bore, None)}}
    build = revision(http, created(http, alone))["models"]["housing"]["build"]
    values = {
        "compliance": recorded_bore(), "modulus": MODULUS, "poisson_ratio": POISSON_RATIO,
        "bore_width": BORE_WIDTH,
    }  # fmt: skip
    outputs = {
        name: {"value": values[name], "unit": unit, "error": 0.0, "level": "coarse", "mesh": MESH,
               "seconds": 0.5, **({"columns": [*TABLES[name]]} if name in TABLES else {})}
        for name, unit in KINDS["bore_compliance"].items()
    }  # fmt: skip
    asked = question("bore_compliance", Options(level="coarse"))
    served.app.state.services.database.write(lambda session: repository.add(session, build, asked, outputs))


def test_the_matrix_reaches_the_film(http, served):
    answered_by_stub(http, served, "52.8 mm")
    done = created(http, design("52.8 mm", "coarse"))
    assert done["state"] == "current", done["problem"]
    outputs = revision(http, done)["steps"]["film"]["outputs"]
    given = {
        "compliance": {"value": recorded_bore(), "unit": "um/GPa"}, "housing_modulus": f"{MODULUS} GPa",
        "housing_poisson_ratio": POISSON_RATIO, "bore_width": f"{BORE_WIDTH} mm", "load_angle": "180 deg",
    }  # fmt: skip
    alone = evaluate(FILM, {**FILM.example, **given}, level="elastic").outputs
    for name in ("minimum_film_thickness", "maximum_pressure", "largest_deformation"):
        assert outputs[name]["value"] == pytest.approx(alone[name].value, rel=1e-6), name


@pytest.mark.slow
def test_the_solver_itself_reaches_the_film(http):
    """A bore of another size, so nothing is stored: its film gives way as that of the recorded one."""
    done = created(http, design("53 mm", "coarse"))
    assert done["state"] == "current", done["problem"]
    outputs = revision(http, done)["steps"]["film"]["outputs"]
    assert outputs["compliance_modes"]["value"] == 38
    assert outputs["largest_deformation"]["value"] > outputs["minimum_film_thickness"]["value"]
