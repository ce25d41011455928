"""The most frequent routes read their requests themselves: `PlainRoute`."""

import pytest
from serving import API

from app.calculations.bodies import OIL_FILM

EVALUATE = f"{API}/templates/oil_film/versions/1/evaluate"
DESIGNS = f"{API}/designs"
PLAIN = {"name": "plain", "parameters": {"a": "2 mm", "b": "= 2 * a"}, "note": "why"}


def faults(answer):
    """The names and codes of what is wrong."""
    assert answer.status_code == 422
    return {(fault["name"], fault["code"]) for fault in answer.json()["errors"]}


@pytest.mark.parametrize(
    ("body", "wrong"),
    [
        ({"inputs": {**OIL_FILM, "radial_load": "25 mm"}}, {("radial_load", "wrong_unit")}),
        ({"inputs": OIL_FILM, "outputs": ["none"]}, {("none", "unknown_name")}),
        ({"inputs": OIL_FILM, "outputs": "film"}, {("outputs", "list_type")}),
        (
            {"inputs": OIL_FILM, "more": 1, "level": 5},
            {("more", "extra_forbidden"), ("level", "string_type")},
        ),
        ({"inputs": {**OIL_FILM, "radial_load": "25\0kN"}}, {("inputs.radial_load", "nul")}),
        ([], {("body", "model_attributes_type")}),
    ],
)
def test_all_that_is_wrong_with_a_body_is_named(http, body, wrong):
    assert faults(http.post(EVALUATE, json=body)) == wrong


def test_a_body_is_required_and_is_json(http):
    typed = {"Content-Type": "application/json"}
    assert faults(http.post(EVALUATE, headers=typed)) == {("body", "missing")}
    assert faults(http.post(EVALUATE, content=b"{", headers=typed)) == {("body", "json_invalid")}


def test_path_headers_and_body_are_refused_together(http):
    path = f"{API}/templates/{'o' * 65}/versions/none/evaluate"
    wrong = {("id", "string_too_long"), ("number", "int_parsing"), ("inputs", "missing")}
    assert faults(http.post(path, json={})) == wrong
    answer = http.post(DESIGNS, json=5, headers={"Idempotency-Key": "k" * 201})
    assert {name for name, _ in faults(answer)} == {"idempotency-key", "body"}


def test_requests_are_counted_by_their_route(http):
    def count():
        lines = http.get("/metrics").text.splitlines()
        route = 'route="/api/v1/templates/{id}/versions/{number}/evaluate"'
        figures = [line for line in lines if "_count" in line or "_total" in line]
        return sum(float(line.split()[-1]) for line in figures if route in line)

    before = count()
    http.post(EVALUATE, json={"inputs": OIL_FILM})
    assert count() > before


def test_other_methods_are_refused(http):
    answer = http.get(EVALUATE)
    assert (answer.status_code, answer.headers["Allow"]) == (405, "POST")
    assert set(http.put(DESIGNS).headers["Allow"].split(", ")) == {"GET", "POST"}


def test_without_a_key_nothing_is_evaluated(team):
    with team.http() as http:
        assert http.post(EVALUATE, json={"inputs": OIL_FILM}).status_code == 401


def test_a_viewer_saves_nothing(team):
    with team.http("viewer") as viewer, team.http("author") as author:
        assert viewer.post(DESIGNS, json=PLAIN).status_code == 403
        made = author.post(DESIGNS, json=PLAIN)
        assert viewer.patch(made.headers["Location"], json={}, headers={"If-Match": "*"}).status_code == 403
        revision = author.get(f"{DESIGNS}/{made.json()['id']}/revisions/1").json()
        assert revision["author"] == {"id": team.principals["author"], "name": "author"}


def test_a_save_answers_what_is_stored(http):
    made = http.post(DESIGNS, json=PLAIN)
    place = made.headers["Location"]
    assert (made.status_code, made.headers["ETag"], place) == (201, '"1"', f"{DESIGNS}/{made.json()['id']}")
    assert http.get(place).json() == made.json()
    patch = {"parameters": {"a": "3 mm", "c": "1"}, "note": "next"}
    changed = http.patch(place, json=patch, headers={"If-Match": '"1"'})
    assert (changed.status_code, changed.headers["ETag"], changed.headers["Location"]) == (200, '"2"', place)
    assert changed.json()["parameters"] == {"a": "3 mm", "b": "= 2 * a", "c": "1"}
    assert http.get(place).json() == changed.json()
    assert http.get(f"{place}/revisions/2").json()["note"] == "next"


@pytest.mark.parametrize(
    "document",
    [
        {"name": ""},
        {"name": "x", "parameters": {"a": "= b"}},
        {"name": "x", "parameters": {"a": "3 furlongs per"}},
        {"name": "x", "more": 1},
        {"name": "x", "note": 5},
        {"name": "x", "criteria": 5},
        {"name": "x", "steps": {"film": {"template": "oil_film", "inputs": {"radial_load": "25 mm"}}}},
        {"name": "x", "steps": {"film": {"template": "none"}}},
        {"name": "x", "parameters": {"a": "1\0"}},
        [],
    ],
)
def test_a_wrong_design_is_not_created(http, document):
    answer = http.post(DESIGNS, json=document)
    assert answer.status_code == 422
    assert answer.json()["errors"]


@pytest.mark.parametrize(
    ("patch", "tag", "status"),
    [
        ({"parameters": {"a": "1 mm"}}, '"9"', 412),
        ({"parameters": {"a": "1 mm"}}, "nonsense", 412),
        ({"parameters": {"a": "= nothing"}}, '"1"', 422),
        ({"name": None}, '"1"', 422),
        ({"note": 5}, '"1"', 422),
        ({"note": "x"}, None, 428),
    ],
)
def test_a_wrong_change_stores_nothing(http, patch, tag, status):
    place = http.post(DESIGNS, json=PLAIN).headers["Location"]
    headers = {"If-Match": tag} if tag else {}
    assert http.patch(place, json=patch, headers=headers).status_code == status
    assert http.get(place).headers["ETag"] == '"1"'


def test_a_change_of_no_design_is_not_found(http):
    missing = http.patch(f"{DESIGNS}/{'0' * 24}", json={"parameters": {}}, headers={"If-Match": "*"})
    assert missing.status_code == 404


def test_a_change_of_nothing_makes_no_revision(http):
    place = http.post(DESIGNS, json=PLAIN).headers["Location"]
    answer = http.patch(place, json={"parameters": {"a": "2 mm"}}, headers={"If-Match": "*"})
    assert (answer.status_code, answer.json()["revision"]) == (200, 1)


def test_a_key_saves_once_and_is_not_reused(http):
    headers = {"Idempotency-Key": "plain create"}
    first, again = (http.post(DESIGNS, json=PLAIN, headers=headers) for _ in range(2))
    assert first.json() == again.json()
    assert (first.status_code, again.status_code) == (201, 201)
    assert http.post(DESIGNS, json={**PLAIN, "name": "other"}, headers=headers).status_code == 422
    place, patch = first.headers["Location"], {"parameters": {"a": "7 mm"}}
    headers = {"Idempotency-Key": "plain change", "If-Match": '"1"'}
    changes = [http.patch(place, json=patch, headers=headers) for _ in range(2)]
    assert changes[0].json() == changes[1].json()
    assert changes[0].json()["revision"] == 2
