"""`POST /answer` over HTTP: origins of designs, files, saving, roles, jobs, refusals."""

import json
import re
import time
from pathlib import Path

import pytest
from patience import patient, until
from serving import API, created, faults, problem

from app.answers.bodies import PAPER_BEARING

ANSWER = f"{API}/answer"
BLOCK = {
    "name": "block",
    "parameters": {"length": "5 mm"},
    "models": {"block": {"id": "moody", "version": 1, "parameters": {"size": "= length"}}},
}
FREE = {"length": {"between": ["5 mm", "9 mm"], "step": "0.5 mm"}}
SIZED = {"free": FREE, "require": ["length >= 6.2 mm"], "minimise": "length"}


def asked(http, body, **options):
    headers = {"Prefer": "wait=60", **options.pop("headers", {})}
    return http.post(ANSWER, json=body, headers=headers, **options)


def test_the_example_of_the_interface_is_answered(http):
    answer = asked(http, PAPER_BEARING)
    assert answer.status_code == 200, answer.text
    assert answer.json()["state"] == "confirmed"
    assert "saved" not in answer.json()


def test_the_line_of_the_readme_is_answered(http):
    """The paper's bearing: a film of at least 3 um, the least power, the width in steps of 0.5 mm."""
    readme = (Path(__file__).parents[3] / "README.md").read_text(encoding="utf-8")
    path, body = re.search(
        r"^curl -s http://127.0.0.1:8000(\S+) --json '(.*)'$", readme, re.MULTILINE
    ).groups()
    answer = http.post(path, json=json.loads(body), headers={"Prefer": "wait=60"}).json()
    assert answer["state"] == "confirmed", answer
    width = answer["values"]["film.bearing_width"]["value"]
    assert width["unit"] == "mm"
    assert 2 * width["value"] == pytest.approx(round(2 * width["value"]))


def test_a_saved_design_is_answered_by_its_id_and_stays_as_it_is(http):
    design = created(http, BLOCK)
    answer = asked(http, {"design": design["id"], **SIZED}).json()
    assert answer["revision"] == 1
    assert answer["values"]["length"]["value"] == {"value": 6.5, "unit": "mm"}
    assert http.get(f"{API}/designs/{design['id']}").json()["revision"] == 1


def test_an_answer_is_saved_once_with_if_match_and_its_files(http):
    design = created(http, BLOCK)
    body = {"design": design["id"], **SIZED, "save": True, "files": ["step", "report"]}
    needed = asked(http, body)
    assert needed.status_code == 428
    stale = asked(http, body, headers={"If-Match": '"7"'})
    assert stale.status_code == 412
    headers = {"If-Match": '"1"', "Idempotency-Key": f"answer-{design['id']}"}
    first = asked(http, body, headers=headers).json()
    again = asked(http, body, headers=headers).json()
    assert first["saved"] == {"design": design["id"], "revision": 2, "state": "current"}
    assert again["saved"] == first["saved"]
    kept = http.get(f"{API}/designs/{design['id']}").json()
    assert kept["revision"] == 2
    assert kept["parameters"]["length"] == "6.5 mm"
    assert kept["results"]["verdict"]["verdict"] == "met"
    step = http.get(first["links"]["step"])
    assert step.status_code == 200
    assert step.content.startswith(b"ISO-10303-21")


def test_a_document_is_saved_as_a_new_design(http):
    saved = asked(http, {"design": BLOCK, **SIZED, "save": True}).json()["saved"]
    assert http.get(f"{API}/designs/{saved['design']}").json()["parameters"]["length"] == "6.5 mm"


def test_an_infeasible_request_saves_nothing(http):
    design = created(http, BLOCK)
    body = {
        "design": design["id"],
        **SIZED,
        "require": ["length >= 6.2 mm", "length <= 5.9 mm"],
        "save": True,
    }
    answer = asked(http, body, headers={"If-Match": '"1"'}).json()
    assert answer["state"] == "infeasible"
    assert "saved" not in answer
    assert http.get(f"{API}/designs/{design['id']}").json()["revision"] == 1


def test_files_of_an_answer_that_is_not_saved_are_those_of_its_build(http):
    answer = asked(http, {"design": BLOCK, **SIZED, "files": ["step"]}).json()
    assert http.get(answer["links"]["step"]).status_code == 200


def test_a_solid_that_fails_is_refused_by_name_and_nothing_is_saved(http):
    parameters = {"size": "= length", "mood": "raises"}
    bad = {**BLOCK, "models": {"block": {"id": "moody", "version": 1, "parameters": parameters}}}
    answer = asked(http, {"design": bad, **SIZED, "files": ["step"], "save": True})
    assert faults(answer) == {"files": "solid_failed"}
    assert "omit `files`" in answer.json()["detail"]


@pytest.mark.parametrize(
    ("more", "name"),
    [
        ({"files": ["report"]}, "files.report"),
        ({"design": {**BLOCK, "models": {}}, "files": ["step"]}, "files"),
        ({"design": 7}, "design"),
        ({"design": {"name": ""}}, "design.name"),
        ({"free": {"block.mood": {"between": ["1", "2"]}}}, "free.block.mood"),
    ],
)
def test_a_request_that_cannot_be_answered_is_refused_by_name(http, more, name):
    assert name in faults(asked(http, {"design": BLOCK, **SIZED, **more}))


def test_an_unknown_design_is_not_found(http):
    problem(asked(http, {"design": "nothing", **SIZED}), 404, "not-found")


def test_a_viewer_may_ask_but_not_save(team):
    body = {"design": {**BLOCK, "models": {}}, **SIZED}
    with team.http("viewer") as http:
        assert asked(http, body).json()["feasible"]
        problem(asked(http, {**body, "save": True}), 403, "role-needed")
    with team.http("author") as http:
        assert asked(http, {**body, "save": True}).json()["saved"]["revision"] == 1


def test_a_client_that_does_not_wait_gets_a_job_with_progress(http):
    body = {**PAPER_BEARING, "require": [f"film.minimum_film_thickness >= {3 + time.time() % 0.1:.6f} um"]}
    later = http.post(ANSWER, json=body, headers={"Prefer": "respond-async"})
    assert later.status_code == 202
    job = until(lambda: _ended(http, later.headers["location"]), seconds=patient(60))
    assert job["state"] == "done"
    assert http.get(job["result"]).json()["state"] == "confirmed"


def _ended(http, place):
    job = http.get(place).json()
    return job if job["state"] not in ("queued", "running") else None
