"""A hostile user with a viewer's key gains nothing by headers of another identity or by races."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest
from approving import Room, signing
from serving import API, created, moody, problem

from app.http.access import HEADER, SIGN_IN

ADMIN = "admin"


@pytest.fixture(scope="module")
def room(team):
    with Room.of(team) as room:
        yield room


def claims(team):
    """Headers by which services behind a proxy learn who somebody is, for the administrator."""
    id, key = team.principals[ADMIN], team.keys[ADMIN]
    return {
        "X-Forwarded-User": ADMIN, "X-Remote-User": id, "Remote-User": ADMIN, "X-Principal": id, "X-User": id,
        "X-Roles": "admin", "Crankwright-Principal": id, HEADER: f"principal:{id}", "X-Api-Key": key,
        "Proxy-Authorization": f"Bearer {key}", "X-Forwarded-For": "127.0.0.1", "Forwarded": "for=127.0.0.1",
        "X-Original-URL": "/healthz", "X-Rewrite-URL": "/healthz", "X-HTTP-Method-Override": "GET",
        "crankwright.principal": id, "crankwright.caller": f"principal:{id}", "Connection": "authorization",
    }  # fmt: skip


def test_no_header_makes_a_viewer_somebody_else(team):
    with team.http("viewer", headers=claims(team)) as http:
        me = http.get(f"{API}/me").json()
        assert (me["name"], me["roles"]) == ("viewer", ["viewer"])
        assert http.get(f"{API}/principals").status_code == 403
        assert http.post(f"{API}/designs", json={"name": "mine"}).status_code == 403
        assert http.get("/docs/../api/v1/principals").status_code == 403


def test_no_header_makes_nobody_somebody(team):
    with team.http(headers=claims(team)) as http:
        for path in ("/me", "/designs", "/principals", "/audit"):
            assert http.get(API + path).status_code == 401, path


def test_of_two_keys_the_first_counts_and_a_wrong_one_is_not_passed_over(team):
    good, wrong = (f"Bearer {team.keys[name]}" for name in ("viewer", ADMIN))
    with team.http() as http:
        both = [("Authorization", good), ("Authorization", wrong)]
        assert http.get(f"{API}/me", headers=both).json()["name"] == "viewer"
        for first in ("Bearer nothing", "Bearer", f"{good}, {wrong}"):
            sent = [("Authorization", first), ("Authorization", good)]
            assert http.get(f"{API}/me", headers=sent).status_code == 401, first


def test_a_wrong_key_is_not_made_good_by_a_cookie(team):
    with team.http() as http:
        http.post("/sign-in", data={"key": team.keys["viewer"]})
        assert http.get(f"{API}/me").status_code == 200
        assert http.get(f"{API}/me", headers={"Authorization": "Bearer nothing"}).status_code == 401


@pytest.mark.parametrize(
    "cookie", ["", "a", "A" * 42, "A" * 43, "A" * 44, "' OR 1=1 --", "%00" * 14, '"' * 43]
)
def test_a_cookie_that_nobody_got_is_nobody(team, cookie):
    with team.http(headers={"Cookie": f"{SIGN_IN}={cookie}"}) as http:
        assert http.get(f"{API}/me").status_code == 401


def test_many_wrong_keys_do_not_keep_the_others_out(team):
    """There is no limit by address, which would let one person lock out all behind the same proxy."""
    with team.http() as stranger, team.http("viewer") as http:
        for number in range(50):
            assert stranger.post("/sign-in", data={"key": f"cw_{number}"}).status_code == 401
        assert http.get(f"{API}/me").status_code == 200
        assert stranger.post("/sign-in", data={"key": team.keys["viewer"]}).status_code == 303


def sign_together(https, design, step):
    """The answers to several who take a step at the same time, having seen the same."""
    place = f"{API}/designs/{design['id']}/revisions/1/approvals"
    seen, together = https[0].get(place).headers["etag"], Barrier(len(https))

    def sign(http):
        together.wait()
        return http.post(place, json={"step": step}, headers={"If-Match": seen})

    with ThreadPoolExecutor(len(https)) as pool:
        return list(pool.map(sign, https))


def test_of_two_checkers_at_once_one_signs(room):
    design = created(room.author, moody("14 mm"))
    signing(room.author, design, "calculated")
    answers = sign_together([room.checker, room.releaser], design, "checked")
    assert sorted(answer.status_code for answer in answers) == [201, 409]
    steps = room.author.get(f"{API}/designs/{design['id']}/revisions/1/approvals").json()["steps"]
    assert [step["step"] for step in steps] == ["calculated", "checked"]


def test_two_keys_are_one_principal(team, room):
    """Who is author and checker cannot check by another key, nor take two steps by two keys at once."""
    with team.http(headers=another_key(team, "checker")) as second:
        own = created(room.checker, moody("15 mm"))
        signing(room.checker, own, "calculated")
        [refused] = sign_together([second], own, "checked")
        problem(refused, 409, "same-principal")
        design = created(room.author, moody("16 mm"))
        signing(room.author, design, "calculated")
        answers = sign_together([room.checker, second], design, "checked")
        assert sorted(answer.status_code for answer in answers) == [201, 409]
        [refused] = sign_together([second], design, "released")
        problem(refused, 409, "same-principal")


def another_key(team, name):
    return {"Authorization": f"Bearer {team.identity.add_key(team.principals[name])[0].text}"}


def test_a_viewer_neither_signs_nor_withdraws(room):
    design = created(room.author, moody("18 mm"))
    for step in ("calculated", "checked", "released", "withdrawn"):
        place = f"{API}/designs/{design['id']}/revisions/1/approvals"
        seen = room.viewer.get(place).headers["etag"]
        body = {"step": step, **({"reason": "no"} if step == "withdrawn" else {})}
        problem(room.viewer.post(place, json=body, headers={"If-Match": seen}), 403, "role-needed")
