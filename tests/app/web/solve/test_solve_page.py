"""The page that solves a design, without scripts: solutions with verdicts, and buttons that save them."""

import re

import pytest
from patience import patient, until
from serving import API, created

from app.web.solve.page import FIELDS

FRICTION = {
    "journal_diameter": "50 mm", "bearing_width": "20 mm", "radial_clearance": "30 um", "speed": "= speed",
    "dynamic_viscosity": "10 mPa*s",
}  # fmt: skip
PETROFF = {
    "name": "Petroff",
    "parameters": {"speed": "3000 rpm"},
    "steps": {"idle": {"template": "journal_friction", "version": 1, "inputs": FRICTION}},
    "criteria": {"slow": {"require": "speed <= 4000 rpm"}},
}
ASKED = {
    "unknown": "speed",
    "low": "100 rpm",
    "high": "20000 rpm",
    "output": "idle.power_loss",
    "tolerance": "",
    "other": "",
    "other_value": "",
}
FORM = re.compile(r'<form method="post" action="(/designs/[^"]+)">(.*?)</form>', re.DOTALL)
HIDDEN = re.compile(r'name="([^"]+)" value="([^"]*)"')


def solved(http, design, **asked):
    """The page once its calculation has ended."""
    path = f"/designs/{design}/solve"

    def page():
        nonlocal query
        answer = http.get(path, params=query)
        if answer.status_code == 303:
            query = answer.headers["location"].removeprefix("?")
            answer = http.get(f"{path}?{query}")
        return answer

    query = {**ASKED, **asked}
    answer = until(page, lambda now: "data-job" not in now.text, patient(60))
    assert answer.status_code == 200
    return answer.text


def test_a_solution_becomes_a_revision(http):
    design = created(http, PETROFF)["id"]
    page = solved(http, design, value="50 W")
    [(action, inside)] = FORM.findall(page)
    fields = dict(HIDDEN.findall(inside))
    assert fields.keys() == {"revision", ".speed", "note"}
    saved = http.post(action, data=fields, headers={"Origin": str(http.base_url).rstrip("/")})
    assert saved.status_code == 303
    step = http.get(f"{API}/designs/{design}/revisions/2").json()["steps"]["idle"]
    assert abs(step["outputs"]["power_loss"]["value"] / 50 - 1) < 1e-12


def test_a_solution_that_misses_a_criterion_says_so(http):
    design = created(http, PETROFF)["id"]
    assert "slow: not met" in solved(http, design, value="150 W")
    assert "slow: not met" not in solved(http, design, value="50 W")


def test_a_criterion_that_is_met_by_a_value_of_unknown_error_is_counted_apart(http):
    """Petroff's power states no error without a load, and the speed is exact."""
    criteria = {**PETROFF["criteria"], "cool": {"require": "idle.power_loss <= 1 kW"}}
    design = created(http, {**PETROFF, "criteria": criteria})["id"]
    page = solved(http, design, value="50 W")
    assert re.search(r"3 met, \d+ not checked, error unknown of 2 met", page)


@pytest.mark.slow
def test_both_levels_are_drawn_and_named(http):
    """The tolerance of the design takes level short bearing, that of the question level map."""
    inputs = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    step = {"template": "oil_film", "version": 2, "tolerance": 0.05, "inputs": inputs}
    design = created(http, {"name": "film", "steps": {"film": step}})["id"]
    own = {"unknown": "film.diametral_clearance", "low": "40 um", "high": "60 um"}
    film = {"output": "film.side_flow", "value": "0.29 l/min"}
    figures = []
    for tolerance in ("", "0.001"):
        page = solved(http, design, **own, **film, tolerance=tolerance)
        figures.append(re.search(r'<figure class="chart">(.*?)</figure>', page, re.DOTALL)[1])
    one, both = figures
    assert "at level short bearing; the dashed line" in one
    assert ">level short bearing<" not in one
    said = "the curve at level short bearing was searched, and the curve at level map confirmed the solutions"
    assert said in both
    assert ">level short bearing<" in both
    assert ">level map<" in both
    assert both.count("<path") > one.count("<path")


def test_out_of_reach_says_what_can_be_reached(http):
    design = created(http, PETROFF)["id"]
    page = solved(http, design, value="1 GW")
    assert "out of reach: between the bounds idle.power_loss is" in page
    assert not FORM.findall(page)


def test_bounds_are_offered_for_the_value_that_is_chosen(http):
    design = created(http, PETROFF)["id"]
    page = http.get(f"/designs/{design}/solve", params={"unknown": "speed"}).text
    assert 'name="low" value="1500 rpm"' in page
    assert 'name="high" value="6000 rpm"' in page


def test_the_form_keeps_every_field(http):
    design = created(http, PETROFF)["id"]
    page = solved(http, design, value="1 kg", tolerance="0.01")
    for name in FIELDS:
        text = {**ASKED, "value": "1 kg", "tolerance": "0.01"}[name]
        assert f'value="{text}"' in page, name
    assert "W" in page


def test_a_solution_is_saved_with_the_other_value(http):
    design = created(http, PETROFF)["id"]
    page = solved(http, design, value="50 W", other="idle.bearing_width", other_value="40 mm")
    [(action, inside)] = FORM.findall(page)
    fields = dict(HIDDEN.findall(inside))
    assert fields["idle.bearing_width"] == "40 mm"
    saved = http.post(action, data=fields, headers={"Origin": str(http.base_url).rstrip("/")})
    assert saved.status_code == 303
    step = http.get(f"{API}/designs/{design}/revisions/2").json()["steps"]["idle"]
    assert step["inputs"]["bearing_width"]["value"] == 40
    assert abs(step["outputs"]["power_loss"]["value"] / 50 - 1) < 1e-12


def test_values_that_a_relation_sets_are_named_with_it(http):
    design = created(http, PETROFF)["id"]
    for path in (f"/designs/{design}/solve", f"/designs/{design}/studies/new"):
        assert "<code>idle.speed = speed</code>" in http.get(path).text, path
