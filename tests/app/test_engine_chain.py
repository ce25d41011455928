"""One design leads from gas pressure to geometry over HTTP: load, film over the cycle, bearing shell.

The throw that carries the bearing feeds its measured mass and centre of gravity back into the load.
"""

import numpy as np
import pytest
from serving import API, created, patched, revision

from templates.bearing_load.bearing_load_v1 import BearingLoad

THROW = {
    "journal_diameter": "55 mm",
    "pin_diameter": "48 mm",
    "pin_length": "32 mm",
    "journal_length": "40 mm",
    "web_thickness": "18 mm",
    "web_width": "80 mm",
    "throw": "= stroke / 2",
}
LOAD = {
    **{n: v for n, v in BearingLoad.example.items() if not n.startswith(("crank", "counter"))},
    "stroke": "= stroke",
    "crankpin_mass": "0 kg",
    "crank_mass": "= throw.mass",
    "crank_centre": "= throw.centre_x",
    "crankcase_pressure": "1 bar",
    "crank_angle_step": "5 deg",
}
FILM = {
    "crank_angle": "= load.crank_angle",
    "load_x": "= load.crankpin_load_x",
    "load_y": "= load.crankpin_load_y",
    "speed": "= load.speed",
    "sleeve_speed": "= load.rod_angular_velocity",
    "bearing_diameter": "= throw.pin_diameter + 0.055 mm",
    "bearing_width": "20 mm",
    "diametral_clearance": "0.055 mm",
    "dynamic_viscosity": "10 mPa*s",
    "oil_supply": "flooded_ends",
}
CHAIN = {
    "name": "big end",
    "parameters": {"stroke": "86 mm"},
    "steps": {
        "load": {"template": "bearing_load", "version": 1, "inputs": LOAD},
        "film": {"template": "oil_film_cycle", "version": 1, "level": "mobility", "inputs": FILM},
    },
    "models": {
        "throw": {"id": "crank_throw", "version": 1, "parameters": THROW},
        "shell": {
            "id": "plain_bearing",
            "version": 1,
            "parameters": {"inner_diameter": "= film.bearing_diameter", "width": "= film.bearing_width"},
        },
    },
}


@pytest.fixture(scope="module")
def chain(http):
    design = created(http, CHAIN)
    assert design["state"] == "current", design
    return design


def outputs(http, design, step):
    return revision(http, design)["steps"][step]["outputs"]


def measured(http, design):
    return http.get(f"{API}/designs/{design['id']}/measurements").json()


def test_measured_mass_and_centre_feed_the_load(http, chain):
    throw, load = measured(http, chain)["throw"], revision(http, chain)["steps"]["load"]
    mass, centre = throw["mass"]["value"], throw["centre"]["value"][0]
    assert mass > 1
    assert load["inputs"]["crank_mass"]["value"] == pytest.approx(mass, rel=1e-9)
    assert load["inputs"]["crank_centre"]["value"] == pytest.approx(centre, rel=1e-9)
    rotating = load["outputs"]["rotating_mass"]["value"] - load["outputs"]["rod_mass_at_crankpin"]["value"]
    assert rotating == pytest.approx(mass * centre / 43, rel=1e-9)


def test_whole_curves_pass_through_the_relations(http, chain):
    steps = revision(http, chain)["steps"]
    assert steps["film"]["inputs"]["load_x"]["value"] == pytest.approx(
        steps["load"]["outputs"]["crankpin_load_x"]["value"], rel=1e-12, abs=1e-9
    )
    film = steps["film"]["outputs"]
    assert len(film["film_thickness"]["value"]) == 144
    assert 0 < film["minimum_film_thickness"]["value"] < 27.5


def test_film_of_the_design_is_that_of_the_templates(http, chain):
    """The same two templates called one after the other, the curves pasted by hand."""
    load = revision(http, chain)["steps"]["load"]
    curves = {name: load["outputs"][name] for name in
              ("crank_angle", "crankpin_load_x", "crankpin_load_y", "rod_angular_velocity")}  # fmt: skip
    inputs = {
        **FILM,
        "crank_angle": curves["crank_angle"],
        "load_x": curves["crankpin_load_x"],
        "load_y": curves["crankpin_load_y"],
        "sleeve_speed": curves["rod_angular_velocity"],
        "speed": "3000 rpm",
        "bearing_diameter": "48.055 mm",
    }
    body = {"inputs": inputs, "level": "mobility", "outputs": ["minimum_film_thickness"]}
    alone = http.post(f"{API}/templates/oil_film_cycle/versions/1/evaluate", json=body).json()
    film = outputs(http, chain, "film")
    thickness = alone["outputs"]["minimum_film_thickness"]["value"]
    assert film["minimum_film_thickness"]["value"] == pytest.approx(thickness, rel=1e-9)


def test_bearing_is_built_to_the_pin(http, chain):
    dimensions = measured(http, chain)["shell"]["dimensions"]
    assert dimensions["inner_diameter"]["value"] == pytest.approx(48.055, rel=1e-9)
    assert dimensions["width"]["value"] == pytest.approx(20, rel=1e-9)


def test_swing_of_the_sleeve_matters(http, chain):
    """The preview shows another film if the big end is taken as standing still."""
    still = {**CHAIN["steps"]["film"], "inputs": {**FILM, "sleeve_speed": "0 rpm"}}
    change = {**CHAIN, "steps": {**CHAIN["steps"], "film": still}}
    response = http.post(f"{API}/designs/{chain['id']}/preview", json=change)
    assert response.status_code == 200, response.text
    film = response.json()["outputs"]["film.minimum_film_thickness"]
    assert film["new"]["value"] != pytest.approx(film["old"]["value"], rel=1e-3)


def test_a_longer_stroke_goes_through_the_whole_chain(http):
    """Another stroke: another throw, its mass, the load, the film; the shell stays the same build."""
    design = created(http, {**CHAIN, "name": "stroked"})
    before = revision(http, design)
    changed = patched(http, design, {"parameters": {"stroke": "90 mm"}})
    assert changed["state"] == "current", changed
    after = revision(http, changed)
    assert measured(http, changed)["throw"]["dimensions"]["throw"]["value"] == pytest.approx(45)
    assert after["models"]["throw"]["build"] != before["models"]["throw"]["build"]
    assert after["models"]["shell"]["build"] == before["models"]["shell"]["build"]
    for name in ("load", "film"):
        assert after["steps"][name]["outputs"] != before["steps"][name]["outputs"]


def test_a_curve_is_no_dimension(http):
    shell = {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": "= load.piston_travel"}}
    answer = http.post(f"{API}/designs", json={**CHAIN, "models": {**CHAIN["models"], "shell": shell}})
    assert answer.status_code == 422
    errors = {error["name"]: error for error in answer.json()["errors"]}
    assert "array" in errors["shell.inner_diameter"]["detail"]


def test_curves_scale_in_relations(http):
    """Twice the load by `= 2 * load.crankpin_load_x`; units are checked as for single values."""
    steps = {
        "load": {**CHAIN["steps"]["load"], "inputs": {**LOAD, "crank_mass": "1 kg", "crank_centre": "0 mm"}},
        "film": {
            **CHAIN["steps"]["film"],
            "inputs": {**FILM, "bearing_diameter": "48 mm",
                       "load_x": "= -2 * load.crankpin_load_x", "load_y": "= -2 * load.crankpin_load_y"},
        },
    }  # fmt: skip
    document = {"name": "twice", "parameters": CHAIN["parameters"], "steps": steps}
    design = created(http, document)
    results = revision(http, design)["steps"]
    single, twice = (np.array(results[s]["outputs" if s == "load" else "inputs"][n]["value"])
                     for s, n in (("load", "crankpin_load_x"), ("film", "load_x")))  # fmt: skip
    assert twice == pytest.approx(-2 * single, rel=1e-12)
    wrong = {**steps["film"], "inputs": {**steps["film"]["inputs"], "load_x": "= load.torque"}}
    answer = http.post(f"{API}/designs", json={**document, "steps": {**steps, "film": wrong}})
    assert answer.status_code == 422
    assert {error["name"] for error in answer.json()["errors"]} == {"film.load_x"}


def test_curves_that_are_too_many_for_a_design_are_refused(http):
    fine = {
        "template": "bearing_load",
        "version": 1,
        "inputs": {**BearingLoad.example, "crank_angle_step": "0.1 deg"},
    }
    answer = http.post(f"{API}/designs", json={"name": "fine", "parameters": {}, "steps": {"load": fine}})
    assert answer.status_code == 422
    assert "one place of a design may have at most 100000" in answer.json()["detail"]
    named = {**fine, "outputs": ["crankpin_load_max", "main_load_x"]}
    assert created(http, {"name": "fine", "parameters": {}, "steps": {"load": named}})["state"] == "current"


def test_curves_that_are_too_many_for_an_answer_are_refused(http):
    """A thousand speeds: all curves are too many, the greatest loads are not."""
    speeds = {"value": [3000.0 + i for i in range(1000)], "unit": "rpm"}
    body = {"inputs": {**BearingLoad.example, "speed": speeds, "crank_angle_step": "1 deg"}}
    address = f"{API}/templates/bearing_load/versions/1/evaluate"
    assert http.post(address, json=body).status_code == 413
    response = http.post(address, json={**body, "outputs": ["crankpin_load_max", "mean_torque"]})
    assert response.status_code == 200
    assert len(response.json()["outputs"]["crankpin_load_max"]["value"]) == 1000
