"""A key determines the principal of a request and its rights; an invalid key is refused."""

from datetime import UTC, datetime, timedelta

import httpx
import pytest

from app.identity.door import Door
from app.identity.keys import new_key
from app.identity.service import Changes
from app.storage.errors import DatabaseUnavailable
from templates.door import built_in

WRONG = {
    "unknown": new_key().text,
    "no key": "cw_",
    "short": new_key().text[:-1],
    "long": new_key().text + "a",
    "other scheme": "secret",
}


def answered(team, key, path="/api/v1/templates"):
    with team.http() as http:
        return http.get(path, headers={"Authorization": f"Bearer {key}"})


def test_without_a_key_the_answer_is_401(team):
    with team.http() as http:
        answer = http.get("/api/v1/templates")
    assert answer.status_code == 401
    assert answer.headers["www-authenticate"] == "Bearer"
    assert answer.json()["type"] == "/problems/not-signed-in"


@pytest.mark.parametrize("kind", WRONG)
def test_a_wrong_key_is_answered_as_none(team, kind):
    refused, without = answered(team, WRONG[kind]), answered(team, "none")
    assert refused.status_code == without.status_code == 401
    assert {**refused.json(), "request_id": ""} == {**without.json(), "request_id": ""}


def test_revoked_expired_and_disabled_keys_are_answered_alike_at_once(team):
    identity = team.identity
    row = identity.add("leaver", ["viewer"])
    revoked, expired, disabled = (identity.add_key(row.id)[0] for _ in range(3))
    late = identity.add_key(row.id, expires=datetime.now(UTC) - timedelta(seconds=1))[0]
    assert answered(team, revoked.text).status_code == 200
    identity.revoke(revoked.prefix)
    first = answered(team, revoked.text)
    assert answered(team, late.text).status_code == first.status_code == 401
    assert answered(team, disabled.text).status_code == answered(team, expired.text).status_code == 200
    identity.change(row.id, Changes(disabled=True))
    last = answered(team, disabled.text)
    assert {**first.json(), "request_id": ""} == {**last.json(), "request_id": ""}


@pytest.mark.parametrize(
    "path", ["/healthz", "/readyz", "/static/shared/icon.svg", "/problems/not-signed-in"]
)
def test_what_is_public_asks_nobody(team, path):
    with team.http() as http:
        assert http.get(path).status_code in (200, 503)  # is it ready?


@pytest.mark.parametrize("path", ["/nothing", "/api/v1/nothing", "/docs", "/openapi.json", "/metrics", "/"])
def test_everything_else_asks(team, path):
    with team.http() as http:
        assert http.get(path).status_code == 401
    with team.http("viewer") as http:
        assert http.get(path).status_code in (200, 404)


def test_a_403_names_the_role_that_is_needed_and_those_there_are(team):
    with team.http("viewer") as http:
        answer = http.post("/api/v1/designs", content=b"what does not matter, for nobody reads it")
    assert answer.status_code == 403
    assert answer.json()["type"] == "/problems/role-needed"
    assert "author" in answer.json()["detail"]
    assert "viewer has here: viewer" in answer.json()["detail"]


def test_an_administrator_needs_another_role_for_designs(team):
    with team.http("admin") as http:
        assert http.get("/api/v1/designs").status_code == 403
        assert http.get("/api/v1/jobs").status_code == 200


def test_an_administrator_evaluates_templates(team):
    inputs = built_in().get("journal_friction", 1).example
    with team.http("admin") as http:
        place = "/api/v1/templates/journal_friction/versions/1/evaluate"
        assert http.post(place, json={"inputs": inputs}).status_code == 200


def test_a_key_with_a_scope_does_no_more(team):
    key = team.identity.add_key(team.principals["checker"], scopes=["viewer"])[0].text
    with team.http() as http:
        headers = {"Authorization": f"bearer {key}"}
        assert http.get("/api/v1/designs", headers=headers).status_code == 200
        assert http.post("/api/v1/designs", headers=headers, json={}).status_code == 403


@pytest.mark.parametrize("address", ["/api/v1/designs/{}", "/?key={}", "/docs?x=%63w_{}", "/%63w_{}"])
def test_a_key_in_the_address_is_refused_with_a_hint(team, address):
    key = team.keys["viewer"]
    with team.http("viewer") as http:
        answer = http.get(address.format(key if "%" not in address else key.removeprefix("cw_")))
    assert answer.status_code == 400
    assert "revoke" in answer.json()["detail"]
    assert key not in answer.text


def test_one_key_is_verified_by_the_same_steps_whatever_its_prefix(team, monkeypatch):
    """The answer's time must not tell which prefixes there are: the same statements, the same comparison."""
    from app.identity import rows

    compared = []
    original = rows.is_same
    monkeypatch.setattr(
        rows, "is_same", lambda text, stored: compared.append(len(stored)) or original(text, stored)
    )
    forged = team.keys["viewer"][:14] + new_key().text[14:]
    revoked, row = team.identity.add_key(team.principals["viewer"])
    team.identity.revoke(row.prefix)
    for key in (forged, new_key().text, revoked.text, "nothing"):
        compared.clear()
        assert answered(team, key).status_code == 401
        assert compared == [64]


def test_a_page_calls_the_interface_as_the_one_who_asked(team):
    with team.http("viewer") as http:
        assert http.get("/designs").status_code == 200
    with team.http("admin") as http:
        assert http.get("/designs").status_code == 403


def test_without_principals_everybody_is_local(served):
    assert httpx.get(f"{served.url}/api/v1/designs", trust_env=False, timeout=90).status_code == 200


@pytest.fixture
def without_database(team, monkeypatch):
    """The gate finds no database when it looks who somebody is."""

    def away(*args):
        raise DatabaseUnavailable("it cannot be reached")

    monkeypatch.setattr(Door, "_any_principal", away)
    monkeypatch.setattr(Door, "_holder", away)
    return team


def test_a_gate_without_its_database_says_when_to_try_again(without_database):
    answer = answered(without_database, new_key().text)
    assert answer.status_code == 503
    assert answer.headers["retry-after"] == "5"
    assert answer.json()["type"] == "/problems/storage"


def test_health_is_answered_without_the_database_of_the_gate(without_database):
    assert answered(without_database, new_key().text, "/healthz").status_code == 200
