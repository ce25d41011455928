"""Assumptions of an answer: defaults that make a part look safer are listed while they apply."""

import pytest

from templates import get
from templates.core.language.evaluate import assumed, evaluate
from templates.core.language.spec import Choice
from templates.door import built_in


def listed(id, version, changes=None, *, outputs=None, **options):
    cls = get(id, version).template
    raw = {name: value for name, value in {**cls.example, **(changes or {})}.items() if value is not None}
    result = evaluate(cls, raw, outputs=outputs, **options)
    return {one.name or one.detail for one in assumed(result.template, result.outputs, result.criteria)}


def test_a_default_is_listed_until_it_is_given():
    assert {"tilt_along_load", "oil_grade"} <= listed("oil_film", 2)
    assert "tilt_along_load" not in listed("oil_film", 2, {"tilt_along_load": "0 mrad"})
    assert "journal_roughness" in listed("oil_film", 2, {"journal_roughness": None})


def test_what_an_answer_does_not_use_is_not_listed():
    film = ["minimum_film_thickness"]
    assert "oil_grade" in listed("oil_film", 2, outputs=film)
    assert "oil_grade" not in listed("oil_film", 2, {"dynamic_viscosity": "10 mPa*s"}, outputs=film)
    assert "oil_grade" not in listed("oil_film", 2, outputs=["relative_clearance"])


def test_a_model_lists_what_it_leaves_out():
    assert {"journal and bore are rigid and round", "the film has one temperature"} <= listed("oil_film", 2)


def test_a_default_limit_is_listed_until_its_user_gives_one():
    assert "hot_oil" in listed("oil_film", 2)
    assert "hot_oil" not in listed("oil_film", 2, limits={"permissible_oil_temperature": "110 degC"})


@pytest.mark.parametrize("id", ["bearing_load", "engine", "flywheel"])
def test_the_reference_of_pressures_is_reported_alike(id):
    """Crankcase pressure absolute or gauge: where nobody says it, every answer of an engine says which."""
    cls = get(id, 1).template
    changes = {"crankcase_pressure": None, "gas_cycle": "none"}
    raw = {name: value for name, value in {**cls.example, **changes}.items() if value is not None}
    result = evaluate(cls, raw)
    details = {one.name: one.detail for one in assumed(result.template, result.outputs)}
    assert "gauge" in details["crankcase_pressure"]
    given = evaluate(cls, {**raw, "crankcase_pressure": "1 bar"})
    assert "crankcase_pressure" not in {one.name for one in assumed(given.template, given.outputs)}


def test_property_every_assumption_is_a_sentence_of_a_default():
    stated = 0
    for cls in built_in():
        for name, declared in cls.inputs.items():
            if declared.meaning.assumed:
                stated += 1
                has_default = isinstance(declared, Choice) or declared.default is not None
                assert has_default or declared.optional, (cls.id, name)
                assert not declared.meaning.assumed.endswith(".")
    assert stated > 20
