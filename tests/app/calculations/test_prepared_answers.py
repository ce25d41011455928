"""Answers put together from prepared parts are, byte for byte, those of the general way."""

import re

import pytest
from pydantic_core import to_json

from app.calculations.bodies import OIL_FILM, EvaluateIn
from app.calculations.cost import is_quick
from app.calculations.prepared import prepared
from app.calculations.service import run_evaluate
from app.catalogue.discovery import find_templates
from templates.core.errors import InvalidInputs
from templates.oil_film.oil_film_v1 import OilFilm

SECONDS = re.compile(rb'"seconds":[0-9.e+-]+}$')
QUICK = {
    f"{id} {version}": cls for (id, version), cls in find_templates(()).versions.items() if is_quick(cls)
}
THICKNESS = ["minimum_film_thickness"]


def generally(cls, inputs, outputs=None):
    asked = EvaluateIn.model_validate({"inputs": inputs, "outputs": outputs})
    return SECONDS.sub(b"", to_json(run_evaluate(cls, asked)))


def from_parts(cls, inputs, outputs=None):
    ready = prepared(cls, outputs)
    content = ready and ready.answer(inputs)
    return content and SECONDS.sub(b"", content)


def texts(cls):
    """The example, its numbers and lists left out."""
    return {name: given for name, given in cls.example.items() if isinstance(given, str)}


@pytest.mark.parametrize("name", QUICK)
def test_each_output_of_every_quick_version(name):
    cls = QUICK[name]
    inputs, answered = texts(cls), 0
    for outputs in (None, [], *([output] for output in cls.formulas)):
        try:
            wanted = generally(cls, inputs, outputs)
        except InvalidInputs:
            with pytest.raises(InvalidInputs):
                from_parts(cls, inputs, outputs)
            continue
        content = from_parts(cls, inputs, outputs)
        assert content in (None, wanted)
        answered += content is not None
    assert answered or inputs != dict(cls.example)


@pytest.mark.parametrize(
    "changed",
    [
        {"radial_load": "1 kN"},
        {"radial_load": "400000 lbf"},
        {"radial_load": "-0 kN"},
        {"radial_load": "1e-300 N"},
        {"diametral_clearance": "0.2 um"},
        {"radial_load": "5000 kN"},
        {"bearing_width": "30 mm"},
        {"temperature_1": "50 degC", "reference_density": "0.9 g/cm**3"},
    ],
)
@pytest.mark.parametrize("outputs", [None, THICKNESS, ["width_ratio", *THICKNESS, "width_ratio"], []])
def test_other_inputs(changed, outputs):
    inputs = {**OIL_FILM, **changed}
    assert from_parts(OilFilm, inputs, outputs) == generally(OilFilm, inputs, outputs)


def test_an_answer_is_calculated_each_time():
    loads = ["20 kN", "21 kN", "20 kN"]
    answers = [from_parts(OilFilm, {**OIL_FILM, "radial_load": load}, THICKNESS) for load in loads]
    assert answers[0] == answers[2] != answers[1]


def test_a_number_that_does_not_exist_leaves_nothing_behind(monkeypatch):
    monkeypatch.setattr("app.calculations.prepared._prepared", {})
    for load in ("1e308 N", "25 kN"):
        inputs = {**OIL_FILM, "radial_load": load}
        assert from_parts(OilFilm, inputs, ["width_ratio"]) == generally(OilFilm, inputs, ["width_ratio"])


def test_a_warning_of_a_criterion_is_there():
    content = from_parts(OilFilm, {**OIL_FILM, "radial_load": "5000 kN"}, THICKNESS)
    assert content is not None
    assert b'"code":"film_too_thin"' in content


@pytest.mark.parametrize(
    ("inputs", "outputs"),
    [
        ({**OIL_FILM, "speed": "5000 ± 10 rpm"}, THICKNESS),
        (OIL_FILM, ["none"]),
        (OIL_FILM, ["x" * 101]),
    ],
)
def test_what_needs_a_further_look_is_left_to_the_general_way(inputs, outputs):
    content = from_parts(OilFilm, inputs, outputs)
    assert content is None or content == generally(OilFilm, inputs, outputs)


def test_what_is_wrong_is_refused():
    with pytest.raises(InvalidInputs):
        from_parts(OilFilm, {**OIL_FILM, "radial_load": "25 mm"}, THICKNESS)
