"""Slopes of a design through its solids: against differences of designs whose solids are all built.

The solids are measured as in the service, but without their STEP files.
"""

from functools import cache

import pytest
from row_designs import CATALOGUES

from app.designs.document import Document
from app.designs.engine.calculate import calculate, resume
from app.designs.explanation import explained
from app.designs.graph import build_graph, starts
from app.reference import Reference
from cad.catalogue import models
from cad.inspect import bounding_box, measure, summarise
from cad.regenerate import as_text
from cad.step import Body


def model(id, **parameters):
    return {"id": id, "version": 1, "parameters": parameters}


def design(**parts):
    return {"name": "Solids", "parameters": {"bore": "50 mm", "wall": "2.5 mm", "play": "0.1 mm"}, **parts}


@cache
def _measures(id, texts):
    parts = models().get(id, 1).from_quantities(dict(texts)).build()
    bodies = [Body(part.name, part.solid, part.colour, part.places, part.called) for part in parts]
    densities = {part.name: part.density for part in parts}
    return summarise(bodies, [measure(body) for body in bodies], densities, bounding_box(bodies))


def measured(shape):
    return _measures(shape.id, tuple(sorted(as_text(shape).items())))


def analysed(_shape, _question, outputs):
    return {name: {"value": 1e5, "reason": None} for name in outputs}


def calculated(raw):
    """The calculation of a design with all its solids; measures through which it iterates have converged."""
    document = Document.model_validate(raw)
    graph, faults = build_graph(document, CATALOGUES)
    assert not faults, faults
    assumed, rounds = starts(document), 0
    while True:
        calculation = calculate(graph, measured, analysed, assumed)
        assert not calculation.faults, calculation.faults
        while calculation.pending:
            before = len(calculation.pending)
            calculation = resume(calculation, measured, analysed)
            assert len(calculation.pending) < before
        found = {name: float(calculation.measure(name)) for name in assumed}
        if found == pytest.approx(assumed, rel=1e-10):
            return calculation
        assumed, rounds = found, rounds + 1
        assert rounds < 30


def value(raw, name):
    return float(calculated(raw).value(Reference.parse(name)))


def items(raw, name, calculation=None):
    chain = explained(Document.model_validate(raw), calculation or calculated(raw), CATALOGUES, name)
    assert chain.reason is None, chain.reason
    return {item.name: item for item in chain.sensitivities}


def difference(raw, place, output, step=2e-3):
    """The elasticity of an output by differences of the fourth order, with all solids built."""

    def at(factor):
        number, unit = raw["parameters"][place].split()
        moved = {**raw["parameters"], place: f"{float(number) * factor:.12g} {unit}"}
        return value({**raw, "parameters": moved}, output)

    near, far = (at(1 + n * step) - at(1 - n * step) for n in (1, 2))
    return (8 * near - far) / 12 / step / at(1.0)


WEIGHED = design(
    models={
        "shell": model("plain_bearing", inner_diameter="= bore", wall="= wall"),
        "bush": model("flanged_bush", inner_diameter="= bore / 2 + 40 * play * shell.mass / (1 kg)"),
    },
    criteria={"light": {"require": "shell.mass + bush.mass <= 1 kg"}},
)


@pytest.mark.parametrize("place", ["bore", "wall", "play"])
def test_slopes_of_a_mass_pass_through_one_solid_and_through_two(place):
    raw = {**WEIGHED, "parameters": {**WEIGHED["parameters"], "weight": "= shell.mass + bush.mass"}}
    slopes = items(WEIGHED, "light")
    assert slopes[place].reason is None
    assert slopes[place].elasticity == pytest.approx(difference(raw, place, "weight"), rel=1e-6, abs=1e-8)
    assert slopes["play"].helps == "decrease"


def test_a_design_that_iterates_through_a_solid_has_the_slopes_of_its_converged_values():
    raw = design(
        models={"bush": model("flanged_bush", inner_diameter="= bore + 30 * play * bush.mass / (1 kg)")},
        iterations=[{"through": "bush.mass", "start": "0.1 kg", "tolerance": 1e-9}],
        criteria={"light": {"require": "bush.mass <= 1 kg"}},
    )
    slopes = items(raw, "light")
    named = {**raw, "parameters": {**raw["parameters"], "weight": "= bush.mass"}}
    for place in ("bore", "play"):
        expected = difference(named, place, "weight")
        assert slopes[place].elasticity == pytest.approx(expected, rel=1e-6, abs=1e-8)
    alone = {**raw, "iterations": [], "models": {"bush": model("flanged_bush", inner_diameter="= bore")}}
    assert abs(slopes["bore"].elasticity - items(alone, "light")["bore"].elasticity) > 1e-3


def test_slopes_pass_through_a_solid_and_a_template():
    shaft = {"bearing_diameter": "= bore", "bearing_width": "25 mm", "diametral_clearance": "50 um"}
    shaft |= {"speed": "3000 rpm", "dynamic_viscosity": "15 mPa*s"}
    raw = design(
        models={"shell": model("plain_bearing", inner_diameter="= bore", wall="= wall")},
        steps={
            "film": {
                "template": "oil_film",
                "version": 2,
                "level": "short_bearing",
                "inputs": {**shaft, "radial_load": "= shell.mass * 20000 m/s^2"},
            }
        },
        criteria={"thick": {"require": "film.minimum_film_thickness >= 1 um"}},
    )
    slopes = items(raw, "thick")
    for place in ("bore", "wall"):
        expected = difference(raw, place, "film.minimum_film_thickness")
        assert slopes[place].elasticity == pytest.approx(expected, rel=1e-6)


def reasons(raw, name):
    """The reasons of the places whose slopes are missing or one-sided."""
    return {place: item for place, item in items(raw, name).items() if item.reason}


def test_what_has_no_slope_says_why():
    raw = design(
        models={"ball": model("ball_bearing", inner_diameter="50 mm", outer_diameter="90 mm", width="20 mm")},
        criteria={"light": {"require": "ball.mass <= 1 kg"}},
    )
    missing = reasons(raw, "light")
    assert {place.split(".")[1] for place in missing} == {"inner_diameter", "outer_diameter", "width"}
    for place, item in missing.items():
        assert item.slope is None
        assert f"ball.mass has no slope over {place}: its slope is another above" in item.reason


def test_a_feature_that_just_appears_gives_no_slope_and_one_at_a_rule_a_slope_on_one_side():
    shell = model("plain_bearing", inner_diameter="= bore", wall="= wall", crush_height="= play - 0.1 mm")
    raw = design(models={"shell": shell}, criteria={"light": {"require": "shell.mass <= 1 kg"}})
    item = items(raw, "light")["play"]
    assert item.slope is None
    assert item.reason.startswith("below: crush_height must be ≥ 0 mm")
    assert "; above: crush height is above 0 mm; required: The sizes of features are 0, or" in item.reason
    ring = model("ball_bearing", inner_diameter="= bore", outer_diameter="90 mm", width="18 mm")
    ring["parameters"] |= {"ball_diameter": "= bore * 0.35999999", "balls": 8}
    raw = design(models={"ball": ring}, criteria={"light": {"require": "ball.mass <= 1 kg"}})
    item = items(raw, "light")["bore"]
    assert item.slope.value < 0
    assert item.reason.startswith("above: ")


def test_a_finite_element_result_has_no_slope():
    raw = design(
        models={"throw": {**model("crank_throw", journal_diameter="= bore"), "analyses": {"torsion": {}}}},
        criteria={"stiff": {"require": "throw.torsion.stiffness >= 1 N*m/rad"}},
    )
    item = items(raw, "stiff")["bore"]
    assert item.slope is None
    assert "throw.torsion.stiffness has no slope over throw.journal_diameter: it is a finite-element" in (
        item.reason
    )
