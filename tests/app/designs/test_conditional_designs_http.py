"""Over HTTP, a condition on the film sets a width; variants, studies, explanations and reports show it."""

import pytest
from serving import API, created
from study_helpers import FILM, done, rows
from test_report import on_paper, read

from templates.core.paper.expressions import DEEPEST_ON_PAPER
from templates.core.units.evaluation import depth_of
from templates.core.units.relation import parse

DESIGNS = f"{API}/designs"
WIDTH = "= if film.minimum_film_thickness < 3 um then 22 mm else 20 mm"
DEEP = "= 12 mm * (1 + abs(sqrt(1 / (diameter / 48 mm) ** 2)))"  # as deep as is set on paper
WALL = '= if film.viscosity_law is "walther" and not (diameter > 1 m or diameter < 1 mm) then 3 mm else 4 mm'


@pytest.fixture(scope="module")
def design(http):
    shell = {"inner_diameter": "= diameter", "width": WIDTH, "wall": WALL}
    film = {
        **FILM["steps"]["film"],
        "inputs": {**FILM["steps"]["film"]["inputs"], **{"radial_load": "= load", "bearing_width": DEEP}},
    }
    document = {
        **FILM,
        "name": "decided",
        "parameters": {**FILM["parameters"], "load": "25 kN"},
        "steps": {"film": film},
        "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": shell}},
        "variants": {"light": {"load": "2 kN"}},
    }
    return created(http, document)


def test_a_film_drives_the_width_of_a_solid(http, design):
    measured = http.get(f"{DESIGNS}/{design['id']}/measurements").json()
    assert measured["shell"]["dimensions"]["width"]["value"] == pytest.approx(22)
    assert measured["shell"]["dimensions"]["wall"]["value"] == pytest.approx(3)


def test_each_variant_decides_by_itself(http, design):
    answer = http.get(f"{DESIGNS}/{design['id']}/variants")
    assert answer.status_code == 200, answer.text
    models = {row["name"]: row["models"]["shell"] for row in answer.json()["rows"]}
    widths = {name: model["parameters"]["width"]["value"] for name, model in models.items()}
    assert widths == {"light": pytest.approx(20)}


def test_a_study_decides_in_each_row(http, design):
    vary = {"load": {"between": ["1 kN", "25 kN"]}}
    outputs = ["shell.width", "film.minimum_film_thickness"]
    study = done(http, design, method="grid", steps={"load": 9}, vary=vary, outputs=outputs)
    values = [row["values"] for row in rows(http, study)["items"]]
    assert {round(row["shell.width"]) for row in values} == {20, 22}
    for row in values:
        film, width = row["film.minimum_film_thickness"], row["shell.width"]
        assert width == pytest.approx(22 if film < 3 else 20)


def test_the_decision_is_explained(http, design):
    chain = http.get(f"{DESIGNS}/{design['id']}/explain/shell.width").json()
    assert (chain["kind"], chain["relation"]) == ("relation", WIDTH)
    assert r"\begin{cases}22~\text{mm} & \text{if }" in chain["latex"]
    assert "<mtable>" in chain["mathml"]
    chain = http.get(f"{DESIGNS}/{design['id']}/explain/shell.wall").json()
    law = next(link for link in chain["because"] if link["name"] == "film.viscosity_law")
    assert (law["kind"], law["value"]) == ("default", {"value": "walther"})


def test_the_network_has_the_choice_that_is_tested(http, design):
    relations = http.get(f"{DESIGNS}/{design['id']}/network").json()["relations"]
    ends = {(one["source"], one["target"]) for one in relations}
    assert {("film.viscosity_law", "shell.wall"), ("diameter", "shell.wall")} <= ends


@pytest.mark.slow
def test_the_report_writes_relations_as_formulas(http, design):
    page = read(http, design).text
    assert WIDTH.replace("<", "&lt;") in page
    assert page.count("<mtable>") == 2
    assert depth_of(parse(DEEP).tree) == DEEPEST_ON_PAPER
    text, _ = on_paper(http, design)
    assert "otherwise" in text
