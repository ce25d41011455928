"""Create, PATCH and GET of a design return its outputs, criteria and verdict, unless asked for less."""

import pytest
from serving import API, created, moody, paper

DESIGNS = f"{API}/designs"
MINIMAL = {"return": "minimal"}
FILM = "film.minimum_film_thickness"


def bearing():
    document = paper(criteria={"thick": {"require": f"{FILM} >= 3 um"}})
    del document["model"]
    return document


def test_a_design_is_answered_with_outputs_criteria_and_verdict(http):
    answer = http.post(DESIGNS, json=bearing())
    design = answer.json()
    results = design["results"]
    assert results["outputs"][FILM]["unit"] == "um"
    assert results["verdict"]["verdict"] in ("met", "not_met", "undecided")
    assert "thick" in {one["name"] for one in results["criteria"]}
    patch = {"steps": {"film": {"inputs": {"radial_load": "50 kN"}}}}
    changed = http.patch(
        f"{DESIGNS}/{design['id']}", json=patch, headers={"If-Match": answer.headers["ETag"]}
    )
    thinner = changed.json()["results"]
    assert thinner["outputs"][FILM]["value"] < results["outputs"][FILM]["value"]
    assert thinner["verdict"]["verdict"] == "not_met"
    assert http.get(f"{DESIGNS}/{design['id']}").json()["results"] == thinner
    stored = http.get(f"{DESIGNS}/{design['id']}/revisions/2").json()
    assert stored["criteria"] == thinner["criteria"]
    assert stored["steps"]["film"]["outputs"]["minimum_film_thickness"] == thinner["outputs"][FILM]


def test_return_minimal_leaves_the_results_out(http):
    design = created(http, bearing())
    place = f"{DESIGNS}/{design['id']}"
    assert "results" not in http.get(place, params=MINIMAL).json()
    assert "results" not in http.post(DESIGNS, json=bearing(), params=MINIMAL).json()
    patch = {"parameters": {"a": "1"}}
    answer = http.patch(place, json=patch, params=MINIMAL, headers={"If-Match": '"1"'})
    assert (answer.status_code, "results" in answer.json()) == (200, False)
    assert http.get(place, params={"return": "half"}).status_code == 422


@pytest.mark.slow
def test_a_design_that_is_calculated_has_no_results_yet(http):
    answer = http.post(DESIGNS, json=moody(mood="loops"), headers={"Prefer": "respond-async"})
    assert answer.status_code == 202
    assert "results" not in answer.json()
    http.post(f"{API}/jobs/{answer.headers['Location'].rpartition('/')[2]}/cancel")


def test_lists_and_curves_are_in_the_revision_only(http):
    document = bearing()
    document["steps"]["film"]["inputs"]["radial_load"] = {"value": [20, 25], "unit": "kN"}
    del document["criteria"]
    design = http.post(DESIGNS, json=document).json()
    assert FILM not in design["results"]["outputs"]
    stored = http.get(f"{DESIGNS}/{design['id']}/revisions/1").json()["steps"]["film"]["outputs"]
    assert len(stored["minimum_film_thickness"]["value"]) == 2
