"""Keys: whatever changes bytes or results is part of the key under which they are stored."""

from importlib.metadata import version

import pytest

from app.solids import questions
from app.solids.questions import Options, question
from cad import regenerate
from cad.catalogue import models
from cad.regenerate import build_key

BALL = models().get("ball_bearing", 1)
BUILD = "0" * 64


def ball(**parameters):
    return BALL.from_quantities({"inner_diameter": "50 mm", **parameters})


def test_property_equal_parameters_have_one_key():
    assert build_key(ball()) == build_key(BALL.from_quantities({"inner_diameter": "0.05 m"}))
    assert build_key(ball()) != build_key(ball(width="21 mm"))


@pytest.mark.parametrize(("name", "other"), [("RECIPE", regenerate.RECIPE + 1), ("KERNEL", "another kernel")])
def test_property_a_build_depends_on_kernel_and_recipe(monkeypatch, name, other):
    before = build_key(ball())
    monkeypatch.setattr(regenerate, name, other)
    assert build_key(ball()) != before


@pytest.mark.parametrize(("name", "other"), [("version", 2), ("id", "roller_bearing")])
def test_property_a_build_depends_on_the_version_of_its_model(monkeypatch, name, other):
    before = build_key(ball())
    monkeypatch.setattr(BALL, name, other)
    assert build_key(ball()) != before


def test_property_the_kernel_is_named_with_its_version():
    assert version("cadquery-ocp") in regenerate.KERNEL


def test_property_an_analysis_depends_on_its_solver_and_recipe(monkeypatch):
    asked = question("torsion", Options())
    before = asked.key(BUILD)
    assert version("ngsolve") in questions._MADE_BY
    assert f"recipe {questions.RECIPE}" in questions._MADE_BY
    monkeypatch.setattr(questions, "_MADE_BY", "another solver")
    assert asked.key(BUILD) != before


@pytest.mark.parametrize(
    "other",
    [
        question("bending", Options()),
        question("torsion", Options(boundary="guided_end")),
        question("torsion", Options(level="fine")),
        question("torsion", Options(tolerance=0.01)),
    ],
    ids=["kind", "boundary", "level", "tolerance"],
)
def test_property_an_analysis_depends_on_its_question(other):
    asked = question("torsion", Options())
    assert other.key(BUILD) != asked.key(BUILD)
    assert asked.key("1" * 64) != asked.key(BUILD)


def test_property_an_analysis_does_not_depend_on_its_load():
    assert question("torsion", Options(load="500 N*m")).key(BUILD) == question("torsion", Options()).key(
        BUILD
    )


def test_a_question_without_a_load_is_one_of_a_newton_metre():
    outputs = {
        "maximum_stress": {"value": 3.0, "convergence": [{"value": 2.0}, {"value": 3.0}]},
        "torsional_stiffness": {"value": 5.0, "convergence": []},
    }
    asked = question("torsion", Options())
    for one in (asked, questions.Question("torsion", "free_end", None, None), asked.whatever_level()):
        assert questions.under_load(one, outputs) == outputs
    doubled = questions.under_load(question("torsion", Options(load="2 N*m")), outputs)
    assert doubled["maximum_stress"] == {"value": 6.0, "convergence": [{"value": 4.0}, {"value": 6.0}]}
    assert doubled["torsional_stiffness"] == outputs["torsional_stiffness"]


@pytest.mark.parametrize(
    ("load", "codes"),
    [
        (None, []),
        ("1 N*m", []),
        ("0 N*m", ["out_of_range"]),
        ("-1 N*m", ["out_of_range"]),
        ("1 N", ["wrong_unit"]),
    ],
)
def test_only_a_load_that_is_given_can_be_wrong(load, codes):
    assert [(fault.name, fault.code) for fault in questions.faults("torsion", Options(load=load))] == [
        ("load", code) for code in codes
    ]
