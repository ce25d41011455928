"""Over REST, administrators see all principals, keys and usage; other users see their own."""

import time

import pytest
from bare_shells import BUSH

from app.client import Client, Problem
from app.identity.limits import LimitReached, Limits
from app.identity.usage import PrincipalUsage, check, note, used
from templates.door import built_in


def test_everybody_learns_who_they_are(team):
    with team.client("author") as client:
        me = client.me()
    assert (me.name, me.roles) == ("author", ["author"])
    assert me.usage.limits.processor_seconds == 30


def test_without_keys_everybody_is_local_and_unlimited(client):
    me = client.me()
    assert (me.id, me.usage.limits) == ("local", None)
    assert me.roles == ["viewer", "author", "checker", "admin"]


def test_an_administrator_adds_disables_and_renames(team):
    with team.client("admin") as client:
        row = client.add_principal("Grace", ["author"])
        key = client.add_key(row.id, expires_days=1)
        with Client(team.server.url, key=key.key) as graces:
            assert graces.me().name == "Grace"
            client.change_principal(row.id, name="Grace H.", roles=["checker"])
            assert (graces.me().name, graces.me().roles) == ("Grace H.", ["checker"])
            client.change_principal(row.id, disabled=True)
            with pytest.raises(Problem, match="401"):
                graces.me()
        assert "Grace H." in [one.name for one in client.principals()]
        with pytest.raises(Problem, match="409"):
            client.add_principal("Grace H.", ["author"])


def test_own_keys_are_made_and_revoked_by_oneself(team):
    id = team.principals["author"]
    with team.client("author") as client:
        laptop = client.add_key(id, name="laptop", scopes=["viewer"])
        assert laptop.prefix in [key.prefix for key in client.keys(id)]
        with Client(team.server.url, key=laptop.key) as limited:
            assert limited.me().roles == ["viewer"]
            with pytest.raises(Problem, match="403"):
                limited.add_key(id, scopes=["author"])
            assert limited.add_key(id).scopes == ["viewer"]
        client.revoke_key(id, laptop.prefix)
        with Client(team.server.url, key=laptop.key) as revoked, pytest.raises(Problem, match="401"):
            revoked.me()


def test_what_is_anothers_is_refused_in_the_same_words_whether_it_exists_or_not(team):
    with team.http("checker") as http:
        for id in (team.principals["author"], "nobody"):
            for answer in (
                http.get(f"/api/v1/principals/{id}/keys"),
                http.post(f"/api/v1/principals/{id}/keys", json={}),
                http.get(f"/api/v1/principals/{id}/usage"),
            ):
                assert answer.status_code == 403
                assert answer.json()["type"] == "/problems/not-own"
        assert http.get("/api/v1/principals").status_code == 403


def test_a_key_of_another_cannot_be_revoked_by_way_of_oneself(team):
    prefix = team.keys["author"][3:13]
    with team.http("checker") as http:
        own = team.principals["checker"]
        assert http.delete(f"/api/v1/principals/{own}/keys/{prefix}").status_code == 404
    with team.client("author") as client:
        client.me()


def test_jobs_are_counted_and_the_limit_of_the_day_is_kept(team):
    id = team.principals["author2"]
    with team.client("author2") as client, team.client("admin") as admin:
        build = {"parameters": {}}
        with team.http("author2") as http:
            first = http.post("/api/v1/models/plain_bearing/versions/1/build", json=build)
            assert first.status_code in (200, 202, 422), first.text
        admin.change_principal(id, limits={"calculation_seconds": 0})
        assert client.me().usage.limits.calculation_seconds == 0
        with team.http("author2") as http:
            refused = http.post(
                "/api/v1/models/plain_bearing/versions/1/build",
                json={"parameters": {**BUSH, "inner_diameter": "47 mm"}},
            )
        assert refused.status_code == 429, refused.text
        assert 0 < int(refused.headers["retry-after"]) <= 86400
        assert "calculation today" in refused.json()["detail"]
        admin.change_principal(id, limits={"calculation_seconds": None})
        assert client.usage(id).limits.calculation_seconds == 36000


def test_requests_beyond_the_rate_get_429(team):
    row = team.identity.add("hasty", ["viewer"])
    key = team.identity.add_key(row.id)[0].text
    with team.client("admin") as admin:
        admin.change_principal(row.id, limits={"processor_seconds": 0.001})
        with team.http() as http:
            headers = {"Authorization": f"Bearer {key}"}
            first = http.get("/api/v1/me", headers=headers)
            admin.me()
            second = http.get("/api/v1/me", headers=headers)
    assert (first.status_code, second.status_code) == (200, 429)
    assert 1 <= int(second.headers["retry-after"]) <= 10
    assert second.json()["type"] == "/problems/limit-reached"
    assert "0.001 s of processor time a minute while others" in second.json()["detail"]


@pytest.mark.slow
def test_a_loop_of_evaluations_is_not_limited_while_nobody_else_waits(team):
    row = team.identity.add("loop", ["viewer"])
    key = team.identity.add_key(row.id)[0].text
    with team.client("admin") as admin:
        admin.change_principal(row.id, limits={"processor_seconds": 0.001})
    time.sleep(2.1)  # the administrator has left
    with Client(team.server.url, key=key, patience=0) as client:
        for _ in range(1000):
            client.evaluate("journal_friction", 1, built_in().get("journal_friction", 1).example)


def test_usage_adds_up(database):
    def unit(session):
        note(session, "someone", jobs=1, bytes=3)
        note(session, "someone", seconds=2.5, bytes=4)
        note(session, "local", jobs=1)

    database.write(unit)
    with database.read() as session:
        assert used(session, "someone") == PrincipalUsage(0, 1, 2.5, 7)
        assert used(session, "local") == PrincipalUsage(0, 0, 0.0, 0)


def test_the_limit_of_calculation_ends_at_midnight():
    with pytest.raises(LimitReached, match="11 s of 10 s") as caught:
        check(Limits(60, 2, 10, 5), PrincipalUsage(0, 0, 11.0, 0), "Ada")
    assert int(caught.value.headers["Retry-After"]) > 0


def test_storage_does_not_come_back_so_no_time_is_named():
    with pytest.raises(LimitReached, match="2 MiB of 2 MiB of storage; neither") as caught:
        check(Limits(60, 2, 10, 5), PrincipalUsage(0, 0, 0, 2**21), "Ada")
    assert caught.value.headers == {}


def test_the_first_principal_is_left_to_the_operator(client):
    with pytest.raises(Problem, match="crankwright keys add"):
        client.add_principal("Ada", ["admin"])
    assert client.me().id == "local"
