"""Plain creates and changes of designs pass by the framework; answers, rows and errors are the same."""

import pytest
from components import ON_POSTGRESQL
from serving import API, moody

from app.calculations.bodies import OIL_FILM

DESIGNS = f"{API}/designs"
GENERAL = {"Cookie": "theme=dark"}
"""A header that means nothing here: such a request goes the general way."""
PLAIN = {"name": "plain", "parameters": {"a": "2 mm", "b": "= 2 * a"}, "note": "why"}
FILM = {
    "name": "film",
    "steps": {"film": {"template": "oil_film", "version": 1, "inputs": {**OIL_FILM, "radial_load": "= F"}}},
    "parameters": {"F": "20 kN"},
    "criteria": {"thick": {"require": "film.minimum_film_thickness >= 1 um"}},
}


@pytest.fixture
def served_generally(monkeypatch):
    """The requests that FastAPI's router answers."""
    from app.designs.service import Designs

    seen = []
    for name in ("create", "change"):
        general = getattr(Designs, name)
        monkeypatch.setattr(
            Designs, name, lambda self, *a, _g=general, _n=name, **k: (seen.append(_n), _g(self, *a, **k))[1]
        )
    return seen


def lasting(answer):
    """What does not differ between two designs."""
    changing = {"date", "x-request-id", "content-length", "location"}
    headers = {name: value for name, value in answer.headers.items() if name.lower() not in changing}
    body = answer.json()
    if answer.is_success:
        assert answer.headers["Location"] == f"{DESIGNS}/{body['id']}"
    ignored = {"id", "created", "changed", "request_id", "instance"}
    return answer.status_code, headers, {name: value for name, value in body.items() if name not in ignored}


def stored(http, design):
    """The revision and the events of a design, without what differs between two."""
    number = design["revision"]
    revision = http.get(f"{DESIGNS}/{design['id']}/revisions/{number}").raise_for_status().json()
    return {name: value for name, value in revision.items() if name not in ("design", "created", "seconds")}


@pytest.mark.parametrize("document", [PLAIN, FILM, {"name": "empty"}])
def test_same_answers_and_rows(http, served_generally, document):
    http.cookies.clear()  # of pages that other tests have read: with a cookie a request goes the general way
    express, general = (http.post(DESIGNS, json=document, headers=h) for h in ({}, GENERAL))
    assert lasting(express) == lasting(general)
    assert express.status_code == 201
    patch = {"parameters": {"F": "21 kN", "a": "3 mm"}, "note": "next"}
    tag = {"If-Match": '"1"'}
    changes = [
        http.patch(f"{DESIGNS}/{one.json()['id']}", json=patch, headers={**tag, **more})
        for one, more in ((express, {}), (general, GENERAL))
    ]
    assert lasting(changes[0]) == lasting(changes[1])
    assert changes[0].headers["ETag"] == '"2"'
    assert served_generally == ([] if not ON_POSTGRESQL else ["create", "change"]) + ["create", "change"]
    first, second = (stored(http, change.json()) for change in changes)
    assert first == second
    assert first["note"] == "next"
    assert http.get(f"{DESIGNS}/{express.json()['id']}").json() == changes[0].json()


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
def test_same_refusals(http, document):
    express, general = (http.post(DESIGNS, json=document, headers=h) for h in ({}, GENERAL))
    assert lasting(express) == lasting(general)
    assert express.status_code == 422


def test_same_refusals_of_changes(http):
    id = http.post(DESIGNS, json=PLAIN).json()["id"]
    place = f"{DESIGNS}/{id}"
    for patch, tag, where in (
        ({"parameters": {"a": "1 mm"}}, '"9"', place),
        ({"parameters": {"a": "1 mm"}}, "nonsense", place),
        ({"parameters": {"a": "= nothing"}}, '"1"', place),
        ({"name": None}, '"1"', place),
        ({"parameters": {"a": "1 mm"}}, '"1"', f"{DESIGNS}/{'0' * 24}"),
    ):
        ways = [http.patch(where, json=patch, headers={"If-Match": tag, **more}) for more in ({}, GENERAL)]
        assert lasting(ways[0]) == lasting(ways[1])
        assert ways[0].status_code in (404, 412, 422)
    assert http.patch(place, json={"note": "x"}).status_code == 428
    assert http.get(place).headers["ETag"] == '"1"'


def test_a_change_of_nothing_makes_no_revision(http):
    made = http.post(DESIGNS, json=PLAIN).json()
    same = {"parameters": {"a": "2 mm"}}
    answer = http.patch(f"{DESIGNS}/{made['id']}", json=same, headers={"If-Match": "*"})
    assert (answer.status_code, answer.json()["revision"]) == (200, 1)


def test_a_key_saves_once_and_is_not_reused(http, request):
    headers = {"Idempotency-Key": f"express {request.node.name}"}
    first, again = (http.post(DESIGNS, json=PLAIN, headers=headers) for _ in range(2))
    assert first.json() == again.json()
    assert (first.status_code, again.status_code) == (201, 201)
    other = http.post(DESIGNS, json={**PLAIN, "name": "other"}, headers=headers)
    assert other.status_code == 422
    place = f"{DESIGNS}/{first.json()['id']}"
    headers = {"Idempotency-Key": "express change", "If-Match": '"1"'}
    patch = {"parameters": {"a": "7 mm"}}
    changes = [http.patch(place, json=patch, headers=headers) for _ in range(2)]
    assert changes[0].json() == changes[1].json()
    assert changes[0].json()["revision"] == 2


@pytest.mark.parametrize(
    "document",
    [
        moody("21 mm"),
        {"name": "list", "parameters": {"a": {"value": [1, 2], "unit": "mm"}}},
        {
            "name": "many",
            "steps": {f"f{n}": {"template": "oil_film", "version": 1, "inputs": OIL_FILM} for n in range(5)},
        },
        {
            "name": "slow",
            "steps": {"f": {"template": "oil_film", "version": 2, "inputs": OIL_FILM, "outputs": []}},
        },
    ],
)
def test_what_is_not_quick_goes_the_general_way(http, served_generally, document):
    http.post(DESIGNS, json=document)
    assert served_generally == ["create"]


def test_a_viewer_saves_nothing(team):
    with team.http("viewer") as viewer, team.http("author") as author:
        assert viewer.post(DESIGNS, json=PLAIN).status_code == 403
        made = author.post(DESIGNS, json=PLAIN)
        revision = author.get(f"{DESIGNS}/{made.json()['id']}/revisions/1").json()
        assert revision["author"] == {"id": team.principals["author"], "name": "author"}
