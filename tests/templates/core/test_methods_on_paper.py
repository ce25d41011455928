"""Property: each line of a report is a formula or states its method; none is a tautology."""

from itertools import product

import pytest

from app.catalogue.discovery import find_templates
from cad.catalogue import models
from templates.core.language.evaluate import evaluate
from templates.core.paper.mathml import mathml, symbol, symbols
from templates.core.paper.methods import right_side
from templates.core.paper.report import rows
from templates.core.paper.schema import describe

TEMPLATES = find_templates(())
EVERY = [*TEMPLATES, *models()]


@pytest.mark.parametrize("cls", EVERY, ids=lambda cls: f"{cls.id}_{cls.version}")
def test_no_line_is_a_tautology(cls):
    for formula, level in product(cls.formulas.values(), cls.levels or ("",)):
        letter = symbol(formula)
        side, is_words = right_side(cls, formula, symbols(cls), level)
        assert side != letter, formula.name
        assert not side.startswith(rf"{letter}\left("), formula.name
        assert is_words or side.count(r"\mathrm{attitude}") != 1 or "+" in side, formula.name
        mathml(f"{letter}={side}")


@pytest.mark.parametrize(
    ("id", "version", "name", "level", "method"),
    [
        ("oil_film", 2, "attitude_angle", "short_bearing", "Ocvirk's short bearing"),
        ("oil_film", 2, "relative_eccentricity", "map", "splines in a map"),
        ("oil_film", 2, "relative_eccentricity", "reynolds", "finite volumes"),
        ("oil_film_cycle", 1, "eccentricity_x", "mobility", "Newton's method"),
        ("torsional_vibration", 1, "mode_shapes", "", "singular values"),
    ],
)
def test_a_numerical_step_names_its_method(id, version, name, level, method):
    cls = TEMPLATES.get(id, version)
    side, is_words = right_side(cls, cls.formulas[name], symbols(cls), level)
    assert is_words
    assert side.startswith(r"\text{solved numerically by ")
    assert method in side


def test_a_report_names_the_method_of_its_level_and_repeats_no_numbers():
    cls = TEMPLATES.get("oil_film", 2)
    template = evaluate(cls, cls.example, outputs=["attitude_angle"], level="map").template
    row = next(row for row in rows(template) if row.name == "attitude_angle")
    assert "splines in a map" in row.expression
    assert row.numbers == ""
    assert row.latex.endswith(row.result)


def test_without_a_level_the_page_of_a_template_says_that_the_method_depends_on_it():
    formulas = {formula["name"]: formula for formula in describe(TEMPLATES.get("oil_film", 2))["formulas"]}
    assert "solved numerically, by a method that depends on the level" in formulas["attitude_angle"]["latex"]
