"""A design accepts oil grades as printed, and radial clearances."""

import pytest
from serving import API, created, faults, patched, revision

from templates.oil_film.oil_film_v2 import OilFilm


def step(**changes):
    inputs = {name: value for name, value in {**OilFilm.example, **changes}.items() if value is not None}
    return {"template": "oil_film", "version": 2, "inputs": inputs}


def test_a_printed_grade_gives_the_results_of_its_option(http):
    steps = {"film": step(oil_grade="ISO VG 46"), "same": step(oil_grade="iso_vg_46")}
    design = created(http, {"name": "grades", "steps": steps})
    results = revision(http, design)["steps"]
    assert results["film"]["outputs"] == results["same"]["outputs"]


@pytest.mark.parametrize(
    ("radial", "diametral"),
    [
        ("30 um", "60 um"),
        ("= gap / 2 + 1 um", "= 2 * (gap / 2 + 1 um)"),
        ({"value": 30, "unit": "um"}, {"value": 60.0, "unit": "um"}),
    ],
)
def test_a_radial_clearance_is_half_the_diametral_one(http, radial, diametral):
    inputs = step(diametral_clearance=None, radial_clearance=radial)
    variants = {"wide": {"film.radial_clearance": "40 um"}}
    body = {"name": "radial", "parameters": {"gap": "58 um"}, "steps": {"film": inputs}, "variants": variants}
    design = created(http, body)
    kept = http.get(f"{API}/designs/{design['id']}").json()
    assert kept["steps"]["film"]["inputs"]["diametral_clearance"] == diametral
    assert kept["variants"] == {"wide": {"film.diametral_clearance": "80 um"}}
    outputs = revision(http, design)["steps"]["film"]["outputs"]
    assert outputs["relative_clearance"]["value"] == pytest.approx(0.060 / 48)


def test_a_change_may_name_the_radial_clearance_too(http):
    design = created(http, {"name": "patched", "steps": {"film": step()}})
    inputs = {"diametral_clearance": None, "radial_clearance": "40 um"}
    patched(http, design, {"steps": {"film": {"inputs": inputs}}})
    kept = http.get(f"{API}/designs/{design['id']}").json()["steps"]["film"]["inputs"]
    assert kept["diametral_clearance"] == "80 um"


def test_two_clearances_that_differ_are_refused(http):
    inputs = step(radial_clearance="20 um")
    refused = faults(http.post(f"{API}/designs", json={"name": "both", "steps": {"film": inputs}}))
    assert "film.radial_clearance" in refused


def test_grades_and_radial_clearances_stand_in_a_table_of_variants(http):
    """As people type them: `SAE 20` in one column, a radial clearance in another."""
    design = created(http, {"name": "table", "steps": {"film": step(oil_grade="sae_15w_40")}})
    grades = ["SAE 20", "sae_20", "ISO VG 46", "iso_vg_46", "sae 10w-40", "sae_10w_40"]
    table = [
        "variant,film.oil_grade,film.radial_clearance",
        ",,um",
        *(f"v{n},{g},30" for n, g in enumerate(grades)),
    ]
    headers = {"Content-Type": "text/csv", "If-Match": '"1"', "Prefer": "wait=30"}
    place = f"{API}/designs/{design['id']}/variants"
    answer = http.put(place, content="\n".join(table), headers=headers)
    assert answer.status_code == 200, answer.text
    rows = http.get(place, params={"output": "film.minimum_film_thickness"}).json()["rows"]
    assert {row["values"]["film.diametral_clearance"]["value"] for row in rows} == {60.0}
    films = [row["outputs"]["film.minimum_film_thickness"]["value"] for row in rows]
    assert films[::2] == films[1::2]
    assert len(set(films)) == 3
