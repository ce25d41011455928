"""A stored step shows its formulas from its record; without a record it is calculated again."""

import json

import pytest
from pydantic_core import to_json

from app.calculations import json_values
from app.catalogue.discovery import find_templates
from app.designs import worksheet as worksheets
from app.designs.schemas.designs import Revision, RevisionStep
from templates.core.language.evaluate import evaluate
from templates.core.language.record import Record, record, restored
from templates.core.paper.verdicts import checks

EXPENSIVE = ("oil_film_cycle", "elastic", "thermo")  # parts of ids


@pytest.fixture(scope="module")
def templates():
    return find_templates(())


def stored(evaluation, **changed):
    """A step as the database holds it."""
    kept = record(evaluation.template)
    answer = {**json_values.evaluation(evaluation), "relations": {}, "record": vars(kept), **changed}
    del answer["seconds"]
    return json.loads(to_json(answer))


def revision(step):
    about = {"design": "d", "number": 1, "note": None, "created": "", "state": "current", "problem": None}
    return Revision.model_validate(
        {**about, "name": "n", "parameters": {}, "models": {}, "iterations": [], "steps": {"s": step}}
    )


def formulas(step, templates, system="si"):
    return worksheets.worksheet(revision(step), templates, system).steps["s"].formulas


@pytest.fixture(scope="module")
def film(templates):
    cls = templates.latest("oil_film")
    return evaluate(cls, cls.example)


@pytest.mark.parametrize("system", ["si", "us"])
def test_formulas_of_a_stored_step_are_those_of_its_evaluation(film, templates, system, monkeypatch):
    again = formulas(stored(film, record=None), templates, system)
    assert len(again) > 20
    monkeypatch.setattr(worksheets, "evaluated_step", None)  # whoever calculates fails
    assert formulas(stored(film), templates, system) == again


def test_checks_of_a_stored_step_are_those_of_its_evaluation(film, templates, monkeypatch):
    monkeypatch.setattr(worksheets, "evaluated_step", None)
    step = RevisionStep.model_validate(stored(film))
    assert worksheets.checked(step, templates) == list(checks(film.template))


def test_a_step_of_a_changed_version_is_calculated_again(film, templates):
    wrong = stored(film)
    name = type(film.template).formulas["minimum_film_thickness"].attribute
    wrong["record"]["computed"][name] = 1.0
    assert formulas(wrong, templates) != formulas(stored(film), templates)
    wrong["template"]["digest"] = "that of another text"
    assert formulas(wrong, templates) == formulas(stored(film), templates)


def test_a_step_with_arrays_is_calculated_again_only_for_its_checks(templates, monkeypatch):
    cls = templates.latest("oil_film")
    evaluation = evaluate(cls, {**cls.example, "radial_load": {"value": [2.0, 3.0], "unit": "kN"}})
    step = RevisionStep.model_validate(stored(evaluation))
    assert step.record.has_arrays
    of_the_evaluation = list(checks(evaluation.template))
    assert worksheets.checked(step, templates) == of_the_evaluation
    written = formulas(stored(evaluation, record=None), templates)
    monkeypatch.setattr(worksheets, "_evaluated", None)
    assert formulas(stored(evaluation), templates) == written
    with pytest.raises(TypeError):
        worksheets.checked(step, templates)


def test_the_record_is_not_served(film, templates):
    step = stored(film)
    served = revision(step).plain()["steps"]["s"]
    assert served.keys() == step.keys() - {"record"}
    assert "record" not in worksheets.worksheet(revision(step), templates, "us").plain()["steps"]["s"]
    assert "record" not in RevisionStep.model_json_schema(mode="serialization")["properties"]


@pytest.mark.slow
def test_a_record_restores_every_inexpensive_template(templates):
    restored_ones = 0
    for cls in templates:
        if any(part in cls.id for part in EXPENSIVE):
            continue
        evaluation = evaluate(cls, cls.example)
        kept = Record(**json.loads(json.dumps(vars(record(evaluation.template)), allow_nan=False)))
        level = evaluation.level if isinstance(evaluation.level, str) else None
        again = restored(cls, kept, level)
        assert again.level == evaluation.template.level
        for system in ("si", "us"):
            rows = [worksheets.formulas(t, system, evaluation.outputs) for t in (again, evaluation.template)]
            assert rows[0] == rows[1], cls.id
        if not kept.has_arrays:
            assert list(checks(again)) == list(checks(evaluation.template)), cls.id
            restored_ones += 1
    assert restored_ones >= 5
