"""Over HTTP, three principals sign a revision one after another, each the content that they saw."""

import hashlib
import re

import pytest
from approving import Room, signed, signing
from serving import API, created, faults, moody, patched, problem, revision

from app.storage.tables import canonical_json


@pytest.fixture(scope="module")
def room(team):
    with Room.of(team) as room:
        yield room


@pytest.fixture
def design(room):
    return created(room.author, moody("10 mm"))


def approvals(http, design, number=1):
    answer = http.get(f"{API}/designs/{design['id']}/revisions/{number}/approvals")
    assert answer.status_code == 200, answer.text
    assert answer.headers["etag"] == f'"{answer.json()["to_sign"]}"'
    return answer.json()


def test_a_revision_is_calculated_checked_and_released(room, design):
    assert approvals(room.author, design)["state"] == "unsigned"
    released = signed(room, design)
    assert [(one["step"], one["name"]) for one in released["steps"]] == [
        ("calculated", "author"), ("checked", "checker"), ("released", "releaser"),
    ]  # fmt: skip
    assert (released["state"], released["next"], released["obstacle"]) == ("released", None, None)


def test_the_title_block_names_who_signed(room, design):
    """ISO 7200: who created, checked and approved the drawing, and its state."""

    def field(name):
        url = f"{API}/designs/{design['id']}/model.drawing.svg"
        answer = room.author.get(url, headers={"Prefer": "wait=60"})
        assert answer.status_code == 200, answer.text
        return re.search(rf'<text data-stamp="iso-{name}"[^>]*>([^<]*)</text>', answer.text)[1]

    assert [field(name) for name in ("author", "checker", "approver", "status")] == [
        "author", "", "", "unsigned",
    ]  # fmt: skip
    signed(room, design)
    assert [field(name) for name in ("author", "checker", "approver", "status")] == [
        "author", "checker", "releaser", "released",
    ]  # fmt: skip
    assert field("mass").endswith(" kg")


def test_each_digest_is_that_of_the_content_and_chains_to_the_step_before(room, design):
    steps = signed(room, design)["steps"]
    for step in steps:
        text = canonical_json(step["content"])
        assert hashlib.sha256(text.encode()).hexdigest() == step["digest"]
    assert [step["content"]["previous"] for step in steps] == [None, steps[0]["digest"], steps[1]["digest"]]
    held = revision(room.author, design)
    assert steps[0]["content"]["files"]["model"]["step"] == held["models"]["model"]["artifacts"]["step"]


def test_a_checker_does_not_release_what_they_checked(room, design):
    signing(room.author, design, "calculated")
    signing(room.checker, design, "checked")
    refused = problem(sign(room.checker, design, "released"), 409, "same-principal")
    assert "checker took the step checked" in refused["detail"]
    assert "checker took the step checked" in approvals(room.checker, design)["obstacle"]


def test_a_checker_does_not_check_what_they_calculated(room):
    own = created(room.checker, moody("11 mm"))
    signing(room.checker, own, "calculated")
    assert "is the author" in problem(sign(room.checker, own, "checked"), 409, "same-principal")["detail"]
    signing(room.releaser, own, "checked")
    problem(sign(room.checker, own, "released"), 409, "same-principal")


def test_the_author_hands_over_their_own_revision_alone(room, design):
    refused = problem(sign(room.checker, design, "calculated"), 409, "same-principal")
    assert "saved by another principal" in refused["detail"]


def test_roles_are_needed(room, design):
    problem(sign(room.viewer, design, "calculated"), 403, "role-needed")
    signing(room.author, design, "calculated")
    problem(sign(room.author2, design, "checked"), 403, "role-needed")


@pytest.mark.parametrize("step", ["checked", "released", "withdrawn"])
def test_steps_come_one_after_another(room, design, step):
    reason = {"reason": "wrong"} if step == "withdrawn" else {}
    refused = problem(sign(room.checker, design, step, **reason), 409, "step-out-of-order")
    assert "must be calculated before" in refused["detail"]


def test_a_step_is_taken_once(room, design):
    signing(room.author, design, "calculated")
    refused = problem(sign(room.author, design, "calculated"), 409, "step-out-of-order")
    assert "was calculated by author at 20" in refused["detail"]


def test_a_repeated_request_signs_once(room, design):
    key = {"Idempotency-Key": f"sign-{design['id']}"}
    first = sign(room.author, design, "calculated", headers=key)
    again = sign(room.author, design, "calculated", headers={**key, "If-Match": first.headers["etag"]})
    assert first.status_code == again.status_code == 201
    assert first.json()["steps"] == again.json()["steps"]


def test_what_is_signed_is_what_was_seen(room, design):
    refused = sign(room.author, design, "calculated", headers={"If-Match": f'"{"0" * 64}"'})
    assert approvals(room.author, design)["to_sign"] in problem(refused, 412, "other-digest")["detail"]
    problem(sign(room.author, design, "calculated", headers={"If-Match": "*"}), 412, "other-digest")
    place = f"{API}/designs/{design['id']}/revisions/1/approvals"
    problem(room.author.post(place, json={"step": "calculated"}), 428, "precondition-required")


def test_a_failed_revision_is_not_signed(room):
    failed = created(room.author, moody("10 mm", mood="raises"))
    refused = problem(sign(room.author, failed, "calculated"), 409, "not-ready-to-sign")
    assert "failed" in refused["detail"]
    bare = created(room.author, {"name": "bare", "model": {"id": "ball_bearing", "version": 1}})
    refused = problem(sign(room.author, bare, "calculated"), 409, "not-ready-to-sign")
    assert "model has no solid" in refused["detail"]


def test_a_later_change_supersedes_the_released_revision(room, design):
    signed(room, design)
    newer = patched(room.author, design, {"models": {"model": {"parameters": {"size": "12 mm"}}}})
    assert approvals(room.author, newer, 2)["supersedes"] == 1
    place = f"{API}/designs/{design['id']}/released"
    answer = room.author.get(place).json()
    assert (answer["revision"], answer["approval"]["name"]) == (1, "releaser")
    assert room.author.get(answer["files"]["model"]["step"]).status_code == 200
    signed(room, newer, 2)
    assert approvals(room.author, newer, 1)["superseded_by"] == 2
    assert room.author.get(place).json()["revision"] == 2


def test_a_release_is_withdrawn_with_a_reason(room, design):
    signed(room, design)
    problem(sign(room.author, design, "withdrawn", reason="wrong load"), 403, "role-needed")
    assert set(faults(sign(room.checker, design, "withdrawn"))) == {"body"}
    answer = sign(room.checker, design, "withdrawn", reason="wrong load").json()
    assert (answer["state"], answer["steps"][-1]["content"]["reason"]) == ("withdrawn", "wrong load")
    problem(room.author.get(f"{API}/designs/{design['id']}/released"), 404, "not-found")
    problem(sign(room.releaser, design, "withdrawn", reason="again"), 409, "step-out-of-order")


def test_without_keys_one_principal_cannot_release(http):
    alone = created(http, moody("13 mm"))
    signing(http, alone, "calculated")
    refused = problem(sign(http, alone, "checked"), 409, "same-principal")
    assert "crankwright keys add" in refused["detail"]


def sign(http, design, step, headers=None, **more):
    place = f"{API}/designs/{design['id']}/revisions/1/approvals"
    seen = http.get(place).headers["etag"]
    return http.post(place, json={"step": step, **more}, headers={"If-Match": seen, **(headers or {})})
