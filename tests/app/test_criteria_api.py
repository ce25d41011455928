"""Evaluations, worksheets, designs, previews and revisions return criteria and verdicts over HTTP."""

import pytest
from bare_shells import BUSH
from serving import API, created, faults, patched, revision

from app.calculations.schemas.evaluations import Evaluation
from app.designs.schemas.designs import Revision
from templates.door import built_in

FILM = dict(built_in().get("oil_film", 2).example)
EVALUATE = f"{API}/templates/oil_film/versions/2/evaluate"
DESIGNS = f"{API}/designs"


def by_name(answer):
    return {criterion["name"]: criterion for criterion in answer["criteria"]}


def document(**more):
    step = {"template": "oil_film", "version": 2, "level": "fit", "inputs": FILM}
    return {
        "name": "judged",
        "steps": {"film": {**step, "limits": {"permissible_film": "2 um"}}},
        "criteria": {"own": {"require": "film.minimum_film_thickness >= 3 um", "source": "our handbook"}},
        **more,
    }


@pytest.fixture(scope="module")
def design(http):
    return created(http, document())


def test_an_evaluation_is_judged(http):
    body = {"inputs": FILM, "level": "fit", "limits": {"permissible_film": "2 um"}}
    answer = http.post(EVALUATE, json=body).json()
    Evaluation.model_validate(answer)
    own = by_name(answer)["own_film"]
    assert (own["verdict"], own["limit"]) == ("met", {"value": pytest.approx(2), "unit": "um"})
    assert own["band"]["value"] == pytest.approx([2.6234, 2.8822], abs=1e-4)
    assert own["error_stated"] is True
    assert answer["verdict"]["green"] is False
    assert answer["verdict"]["governing"] == answer["criteria"][0]["name"]
    assert answer["verdict"]["counts"]["met"] == sum(c["verdict"] == "met" for c in answer["criteria"])


def test_an_evaluation_of_few_outputs_judges_what_they_suffice_for(http):
    answer = http.post(EVALUATE, json={"inputs": FILM, "outputs": ["minimum_film_thickness"]}).json()
    assert {"own_film", "film_exists"} <= by_name(answer).keys()
    assert "pressure" not in by_name(answer)
    none = http.post(f"{API}/templates/oil_film/versions/1/evaluate", json={"inputs": {}}).json()
    assert "criteria" not in none


@pytest.mark.parametrize(
    ("limits", "name", "code"),
    [
        ({"permissible_film": "2 s"}, "limits.permissible_film", "wrong_unit"),
        ({"permissible_film": 2}, "limits.permissible_film", "missing_unit"),
        ({"thinnest": "2 um"}, "limits.thinnest", "unknown_name"),
        ({"bearing_material": ["x"]}, "limits.bearing_material", "not_a_row"),
    ],
)
def test_wrong_limits_are_refused(http, limits, name, code):
    assert faults(http.post(EVALUATE, json={"inputs": FILM, "limits": limits})) == {name: code}


def test_an_open_band_is_null_never_infinite(http):
    body = {"inputs": {**FILM, "radial_load": "500 kN"}, "level": "short_bearing"}
    answer = http.post(EVALUATE, json=body).json()
    bands = [c["band"]["value"] for c in answer["criteria"] if "band" in c]
    assert any(high is None for _, high in bands)


def test_a_worksheet_is_judged_in_its_units(http, client):
    body = {"inputs": FILM, "limits": {"permissible_film": "2 um"}}
    shown = http.post(f"{API}/templates/oil_film/versions/2/worksheet?units=us", json=body).json()
    own = by_name(shown)["own_film"]
    assert own["limit"] == {"value": pytest.approx(2 / 25.4), "unit": "thou"}
    assert own["band"]["unit"] == own["margin"]["unit"] == "thou"
    written = client.worksheet("oil_film", 2, FILM, limits={"permissible_film": "2 um"})
    assert written.verdict.governing in {criterion.name for criterion in written.criteria}


def test_a_calculation_in_a_process_is_judged_too(http):
    """20 points at the finest level leave the server's process."""
    loads = {"value": [20, 25], "unit": "kN"}
    body = {
        "inputs": {**FILM, "radial_load": loads},
        "level": "mass_conserving",
        "outputs": ["minimum_film_thickness"],
    }
    answer = http.post(EVALUATE, json={**body, "limits": {"permissible_film": "2.7 um"}}).json()
    own = by_name(answer)["own_film"]
    assert (own["points"], own["counts"]) == (2, {"not_met": 1, "met": 1})
    assert own["where"] == {"point": {"value": 2, "unit": "1"}}


def test_a_design_is_judged_with_its_revision(http, design):
    assert design["criteria"] == document()["criteria"]
    assert design["steps"]["film"]["limits"] == {"permissible_film": "2 um"}
    stored = revision(http, design)
    Revision.model_validate(stored)
    criteria = by_name(stored)
    assert (criteria["own"]["verdict"], criteria["own"]["source"]) == ("not_met", "our handbook")
    assert criteria["film.own_film"]["verdict"] == "met"
    assert criteria["film.pressure"]["give"] == ["film.permissible_pressure"]
    assert stored["verdict"]["verdict"] == "not_met"
    assert "criteria" not in stored["steps"]["film"]
    worksheet = http.get(f"{DESIGNS}/{design['id']}/worksheet.json").json()
    assert worksheet["criteria"] == stored["criteria"]
    in_inches = http.get(f"{DESIGNS}/{design['id']}/worksheet.json?units=us").json()
    assert by_name(in_inches)["own"]["limit"] == {"value": pytest.approx(3 / 25.4), "unit": "thou"}


def test_a_preview_is_judged_as_the_revision_would_be(http, client, design):
    patch = {"criteria": {"own": {"require": "film.minimum_film_thickness >= 1 um"}}}
    shown = http.post(f"{DESIGNS}/{design['id']}/preview?units=us", json=patch).json()
    own = by_name(shown)["own"]
    assert (own["verdict"], own["limit"]["unit"]) == ("met", "thou")
    typed = client.preview(design["id"], patch)
    assert {c.name: c.verdict for c in typed.criteria}["own"] == "met"
    assert typed.verdict.counts["met"] >= 1


def test_a_patch_waives_and_removes(http, design):
    waived = {"criteria": {"film.film": {"waived": "accepted in test 12"}, "own": None}}
    changed = patched(http, design, waived)
    assert changed["criteria"] == {"film.film": {"waived": "accepted in test 12"}}
    criteria = by_name(revision(http, changed))
    assert criteria["film.film"]["waived"] == "accepted in test 12"
    assert "own" not in criteria
    cleared = patched(http, changed, {"criteria": None, "steps": {"film": {"limits": None}}})
    assert "criteria" not in cleared
    assert "limits" not in cleared["steps"]["film"]
    old = revision(http, design, design["revision"])
    assert "own" in by_name(old)  # as it was judged


def test_a_wrong_criterion_is_refused_and_nothing_is_saved(http, design):
    body = {"criteria": {"own": {"require": "film.minimum_film_thickness >= 3 s"}}}
    number = http.get(f"{DESIGNS}/{design['id']}").json()["revision"]
    answer = http.patch(f"{DESIGNS}/{design['id']}", json=body, headers={"If-Match": f'"{number}"'})
    assert faults(answer) == {"criteria.own": "unit_mismatch"}
    assert http.get(f"{DESIGNS}/{design['id']}").json()["revision"] == number
    too_many = {f"c{n}": {"require": "film.power_loss <= 1 kW"} for n in range(101)}
    assert http.post(DESIGNS, json=document(criteria=too_many)).status_code == 422
    shapeless = http.post(DESIGNS, json=document(criteria={"own": {"require": 3}}))
    assert set(faults(shapeless)) == {"criteria.own.require"}


def test_a_criterion_of_a_solid_is_judged_once_it_is_built(http):
    shell = {
        "shell": {"id": "plain_bearing", "parameters": {**BUSH, "inner_diameter": "= film.bearing_diameter"}}
    }
    mass = {"mass": {"require": "shell.mass <= 1 kg"}}
    design = created(http, document(models=shell, criteria=mass))
    judged = by_name(revision(http, design))["mass"]
    assert judged["verdict"] == "met"
    assert 0 < judged["value"]["value"] < 1
    assert judged["value"]["unit"] == "kg"


def test_a_design_without_criteria_has_no_verdict(http):
    step = {"template": "slider_bearing", "version": 1, "outputs": ["squeeze_number"]}
    step["inputs"] = dict(built_in().get("slider_bearing", 1).example)
    stored = revision(http, created(http, {"name": "plain", "steps": {"pad": step}}))
    names = {criterion["name"] for criterion in stored.get("criteria", [])}
    assert all(name.startswith("pad.") for name in names)
    assert ("verdict" in stored) == bool(names)
