"""Grades of oil as they are printed, and radial clearances, in a design."""

from serving import API, created, faults, revision

from templates.oil_film.oil_film_v2 import OilFilm


def step(**changes):
    inputs = {name: value for name, value in {**OilFilm.example, **changes}.items() if value is not None}
    return {"template": "oil_film", "version": 2, "inputs": inputs}


def test_a_printed_grade_gives_the_results_of_its_option(http):
    steps = {"film": step(oil_grade="ISO VG 46"), "same": step(oil_grade="iso_vg_46")}
    design = created(http, {"name": "grades", "steps": steps})
    results = revision(http, design)["steps"]
    assert results["film"]["outputs"] == results["same"]["outputs"]


def test_a_radial_clearance_is_offered_as_half_the_diametral_one(http):
    body = {"name": "radial", "steps": {"film": step(diametral_clearance=None, radial_clearance="30 um")}}
    refused = faults(http.post(f"{API}/designs", json=body))
    assert "film.radial_clearance" in refused
