"""Tolerances of dimensions: declared on faces, part of a build, written in the STEP header."""

import pytest

from cad.catalogue import models
from cad.header import Header
from cad.model import Box, CadModel
from cad.regenerate import as_quantities, as_text, build_key
from cad.tolerances import Limits, carried, limits, limits_in
from templates.core.catalogue.digests import MARKS
from templates.core.language.template import Array, given

SHELL = models().get("plain_bearing", 1)


def shell(bore="48 mm", **others):
    return SHELL.from_quantities({"inner_diameter": bore, **others})


@pytest.mark.parametrize(
    ("typed", "written", "within"),
    [
        ("48 mm H7", "48 mm H7", Limits(48.0, 0.0, 0.025, "H7")),  # ISO 286-2: +25/0 um from 30 to 50 mm
        ("4.8 cm ± 5 um", "48 mm +0.005/-0.005 mm", Limits(48.0, -0.005, 0.005)),
        ("48 mm +50/+25 um", "48 mm +0.05/+0.025 mm", Limits(48.0, 0.025, 0.05)),
        ("48 0/-0.1 mm", "48 mm +0/-0.1 mm", Limits(48.0, -0.1, 0.0)),
        ({"value": 48, "unit": "mm", "plus": 0.01}, "48 mm +0.01/+0 mm", Limits(48.0, 0.0, 0.01)),
    ],
)
def test_limits_are_in_the_text_from_which_a_model_is_built(typed, written, within):
    one = shell(typed)
    texts = as_text(one)
    again = SHELL.from_quantities(texts)
    assert texts["inner_diameter"] == written
    assert limits(one) == limits(again) == {"inner_diameter": within}
    assert build_key(again) == build_key(one)
    assert limits_in(Header("plain_bearing", 1, texts, "")) == {"inner_diameter": within}


def test_limits_stand_beside_the_value_of_a_row_and_are_read_again():
    one = shell("48 mm H7", width={"value": 24, "unit": "mm", "minus": 0.1})
    rows = {n: p if "unit" in p else p["value"] for n, p in as_quantities(one).items()}
    assert rows["inner_diameter"] == {"value": 48.0, "unit": "mm", "upper": 0.025, "lower": 0.0, "zone": "H7"}
    assert as_text(SHELL.from_quantities(rows)) == as_text(one)


def test_a_key_holds_the_tolerances_that_faces_carry_and_no_others():
    plain = shell()
    assert build_key(shell("48 mm H7")) not in (build_key(plain), build_key(shell("48 mm H6")))
    spread = build_key(shell(free_spread="0.5 mm"))
    assert build_key(shell(free_spread="0.5 mm ± 0.1 mm")) == spread  # no face carries it
    assert build_key(shell(free_spread="0.5 mm ± 0.1 mm, in table")) != spread
    assert build_key(shell("48 mm ± 0 mm")) == build_key(plain)
    assert as_text(plain)["inner_diameter"] == "48 mm"


def test_a_key_of_a_toleranced_build_holds_what_the_model_declares(monkeypatch):
    plain, fitted = build_key(shell()), build_key(shell("48 mm H7"))
    other = {**SHELL.toleranced, "inner_diameter": {"datum": "A"}}
    monkeypatch.setattr(SHELL, "toleranced", other)
    assert build_key(shell()) == plain
    assert build_key(shell("48 mm H7")) != fitted


def test_a_released_model_may_declare_more_faces():
    assert "toleranced" in MARKS


def test_every_model_carries_its_diameters(model):
    missing = {n for n in model.inputs if n.endswith("_diameter")} - carried(model).keys()
    assert not missing or not carried(model)


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"depth": {}}, "only a parameter that is a length"),
        ({"size": {"colour": "red"}}, "valid keys are"),
        ({"size": {"perpendicularity": 1}}, "need a datum in `to`"),
        ({"size": {"perpendicularity": 1, "to": "A"}}, "no dimension declares the datum 'A'"),
        ({"size": {"cylindricity": 2}}, "fraction of the dimension.s tolerance, above 0 and at most 1"),
    ],
)
def test_a_declaration_that_makes_no_sense_is_refused_with_its_parameter(said, message):
    with pytest.raises(TypeError, match=message) as refused:

        class Cube(CadModel):
            """A cube."""

            toleranced = said
            a: Array = given("mm", "size", symbol="a", ge=1)

            def bounding_box(self):
                return Box((0, 0, 0), (1, 1, 1))

    assert f"Cube.toleranced, {next(iter(said))}" in str(refused.value)
