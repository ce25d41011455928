"""Tolerances of dimensions act through the solid on its mass, to the first order."""

import pytest
from row_designs import CATALOGUES

from app.designs.document import Document
from app.tolerances.analysis import Analysis
from app.tolerances.answer import answer
from app.tolerances.question import Question
from cad.catalogue import models
from cad.slopes.operands import operands

BUSH = {"wall": "6 mm", "width": "50 mm", "flange_diameter": "74 mm", "flange_thickness": "5 mm"}
BUSH |= {"oil_hole_diameter": "0 mm", "inner_chamfer": "0.5 mm", "outer_chamfer": "1 mm"}


MODEL = {"id": "flanged_bush", "version": 1}


def analysed(**parts):
    document = {
        "name": "Weight",
        "parameters": {"bore": "50 ± 0.05 mm"},
        "models": {
            "bush": {"id": "flanged_bush", "version": 1, "parameters": {"inner_diameter": "= bore", **BUSH}}
        },
        "criteria": {"light": {"require": "bush.mass <= 0.5 kg"}},
        **parts,
    }
    analysis = Analysis.of(Document.model_validate(document), CATALOGUES, Question(points=1024))
    return answer(analysis, analysis.carried_out(), 1).model_dump(mode="json", exclude_unset=True)


def mass(bore):
    shape = models().get("flanged_bush", 1).from_quantities({"inner_diameter": f"{bore} mm", **BUSH})
    return sum(part.volume * part.density for part in operands(shape)) * 1e-9


def test_a_mass_has_its_limits_and_its_scatter():
    result = analysed()
    weight, low, high = result["bush.mass"], mass(49.95), mass(50.05)
    assert weight["nominal"] == pytest.approx(mass(50), rel=1e-9)
    assert weight["worst"]["low"]["value"] == pytest.approx(low, rel=1e-6)  # the curvature is left out
    assert weight["worst"]["high"]["value"] == pytest.approx(high, rel=1e-6)
    deviation = 0.98663 * (high - low) / 6  # of a normal distribution cut off at three standard deviations
    assert weight["standard_deviation"] == pytest.approx(deviation, rel=5e-3)
    assert weight["shares"]["bore"]["total"] == pytest.approx(1)
    (warning,) = result["analysis"]["warnings"]
    assert (warning["code"], warning["name"]) == ("first_order", "bush.mass")
    assert "slopes of the nominal solid" in warning["detail"]


def test_a_yield_depends_on_the_tolerance_of_the_solid():
    at_half = f"{mass(50)!r} kg"
    result = analysed(criteria={"light": {"require": f"bush.mass <= {at_half}"}})
    assert result["analysis"]["criteria"]["light"]["value"] == pytest.approx(0.5, abs=0.02)


def test_a_tolerance_of_a_parameter_of_the_model_counts_beside_those_of_the_design():
    parameters = {**BUSH, "inner_diameter": "= bore", "wall": "6 ± 0.1 mm"}
    result = analysed(models={"bush": {**MODEL, "parameters": parameters}})
    shares = {name: share["total"] for name, share in result["bush.mass"]["shares"].items()}
    assert shares["bush.wall"] > 0.99
    assert sum(shares.values()) == pytest.approx(1, abs=0.02)


def test_the_products_of_a_feature_that_just_appears_have_no_mass():
    parameters = {**BUSH, "inner_diameter": "= bore", "oil_hole_diameter": "= 20 * (bore - 50 mm)"}
    result = analysed(models={"bush": {**MODEL, "parameters": parameters}})
    assert result["analysis"]["refused"]["rows"] > 0
    assert result["bush.mass"]["nominal"] == pytest.approx(mass(50), rel=1e-9)
