"""Ordinary calculations ignore tolerances, and warn wherever the result is shown."""

import pytest
from serving import API, created, paper, revision

from app.calculations.bodies import OIL_FILM
from templates import get

WIDTH = {"value": 18, "unit": "mm", "plus": 0.1, "minus": "0.05 mm"}
EVALUATE = f"{API}/templates/oil_film/versions/1/evaluate"


def unused(warnings):
    return [warning["name"] for warning in warnings if warning["code"] == "tolerance_unused"]


@pytest.mark.parametrize("width", [WIDTH, {"value": 18, "unit": "mm", "minus": 0}, ["18 mm", WIDTH]])
def test_an_evaluation_warns(http, width):
    answer = http.post(EVALUATE, json={"inputs": {**OIL_FILM, "bearing_width": width}}).json()
    assert unused(answer["warnings"]) == ["bearing_width"]
    assert "not used" in answer["warnings"][0]["detail"]
    assert not unused(http.post(EVALUATE, json={"inputs": OIL_FILM}).json()["warnings"])


@pytest.fixture(scope="module")
def design(http):
    document = paper(parameters={"scale": {"value": 1, "unit": "1", "plus": 0.01}})
    document["steps"]["film"]["inputs"]["bearing_width"] = WIDTH
    document["model"]["parameters"]["width"] = {"value": 20, "unit": "mm", "minus": 0.1}
    return created(http, document)


def test_a_revision_warns(http, design):
    shown = revision(http, design)
    assert unused(shown["steps"]["film"]["warnings"]) == ["bearing_width"]
    assert unused(shown["warnings"]) == ["scale", "model.width"]


def test_a_preview_warns(http, design):
    patch = {"steps": {"film": {"inputs": {"radial_load": {"value": 25, "unit": "kN", "plus": 1}}}}}
    shown = http.post(f"{API}/designs/{design['id']}/preview", json=patch).json()
    wanted = {"film.bearing_width", "film.radial_load", "scale", "model.width"}
    assert set(unused(shown["warnings"])) == wanted


@pytest.mark.slow
def test_a_report_says_so(http, design):
    text = http.get(f"{API}/designs/{design['id']}/report.html", headers={"Prefer": "wait=60"}).text
    assert "Note on model.width: the solid is built at the value" in text
    assert "Note on scale: its tolerance is kept" in text


def test_a_revision_without_tolerances_has_no_warnings_of_its_own(http):
    assert "warnings" not in revision(http, created(http, paper(name="exact")))


def test_the_door_of_python_warns():
    film = get("oil_film", 1)(**{**OIL_FILM, "bearing_width": WIDTH})
    assert film.minimum_film_thickness.magnitude > 0
    assert [warning.code for warning in film.warnings] == ["tolerance_unused"]


def test_the_page_of_a_design_says_so(http, design):
    place = f"/designs/{design['id']}"
    for path in (place, f"{place}/revisions/1"):
        page = http.get(path, headers={"Accept": "text/html"}).text
        for name in ("scale", "model.width", "bearing width"):
            assert page.count(f'<li class="warning"><strong>{name}</strong>') == 1, (path, name)


def test_an_analysis_of_steps_without_levels_names_none(http, design):
    answer = http.post(f"{API}/designs/{design['id']}/tolerance", headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    assert answer.json()["analysis"]["levels"] == {}
    assert "scale" in answer.json()["analysis"]["toleranced"]
