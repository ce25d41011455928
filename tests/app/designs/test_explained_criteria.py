"""An explanation of a parameter names the criteria that depend on it, and the errors behind it."""

import pytest
from bare_shells import BUSH
from serving import API

DESIGNS = f"{API}/designs"


@pytest.fixture(scope="module")
def design(http):
    """A bush whose bore is that of the film, and whose wall follows from the smallest film."""
    film = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    step = {"template": "oil_film", "version": 2, "inputs": film, "level": "fit"}
    parameters = {
        **BUSH,
        "inner_diameter": "= film.bearing_diameter",
        "wall": "= 1000 * film.minimum_film_thickness",
        "width": "26 mm",
    }
    document = {
        "name": "explained criteria",
        "steps": {"film": step},
        "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": parameters}},
    }
    answer = http.post(DESIGNS, json=document, headers={"Prefer": "wait=60"})
    assert answer.status_code == 201, answer.text
    return answer.json()


def explained(http, design, name):
    answer = http.get(f"{DESIGNS}/{design['id']}/explain/{name}")
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_criteria_that_share_a_value_are_named_as_the_revision_judges_them(http, design):
    judged = {one["name"]: one for one in design["results"]["criteria"]}
    bore = explained(http, design, "shell.inner_diameter")["criteria"]
    assert "film.film" in [one["name"] for one in bore]
    for one in bore:
        assert one["verdict"] == judged[one["name"]]["verdict"]
    assert explained(http, design, "shell.width")["criteria"] == []
    assert "criteria" not in explained(http, design, "film.film")


def test_an_output_behind_a_parameter_has_the_error_of_its_step(http, design):
    wall = explained(http, design, "shell.wall")
    (film,) = (one for one in wall["because"] if one["name"] == "film.minimum_film_thickness")
    stored = http.get(f"{DESIGNS}/{design['id']}/revisions/1").json()["steps"]["film"]["error"]
    assert film["error"] == stored["minimum_film_thickness"]
    assert film["error"] > 0
    assert "error" not in wall


def test_the_panel_of_a_face_states_value_formula_error_and_criteria(http, design):
    place = f"/designs/{design['id']}/faces/shell.wall"
    page = http.get(place, headers={"Accept": "text/html"})
    assert page.status_code == 200
    assert 'data-face="shell.wall"' in page.text
    assert "1000 * film.minimum_film_thickness" in page.text
    assert "film.minimum_film_thickness ± " in page.text
    assert "/explain/film.film" in page.text
    assert http.get(f"/designs/{design['id']}/faces/shell.none").status_code == 404
