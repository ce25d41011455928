"""Every refusal is a problem of its own kind, and every kind has an explanation."""

import re

import pytest
from serving import API, problem

from app.http.problem_kinds import HTTP, INTERNAL, TABLE, kind_of
from app.http.problems import describe
from app.http.strict_requests import StrictRoute
from app.storage.errors import StorageError

KINDS = {kind.slug: kind for kind in (*TABLE.values(), *HTTP.values(), INTERNAL)}


@pytest.mark.parametrize("slug", KINDS)
def test_every_kind_answers_with_its_meaning_and_remedy(http, slug):
    answer = http.get(f"/problems/{slug}").json()
    assert answer["slug"] == slug
    assert answer["title"]
    assert answer["remedy"]
    assert answer["status"] == KINDS[slug].status


def test_slugs_and_titles_are_distinct():
    kinds = set(TABLE.values()) | set(HTTP.values())
    assert len({kind.slug for kind in kinds}) == len({kind.title for kind in kinds}) == len(kinds)


def test_only_a_fault_of_the_program_is_a_500():
    team = {"files-unreachable", "program-missing"}
    storage = {"storage", "artifact-damaged", "database-damaged", "rebuilding", "disk-full"}
    assert {kind.slug for kind in KINDS.values() if kind.status >= 500} == {
        "internal",
        "stopping",
        "too-many-connections",
        *storage,
        *team,
    }
    assert kind_of(RuntimeError()) is INTERNAL
    assert "secret" not in describe(RuntimeError("secret"))["detail"]
    assert describe(StorageError("the disk is full"))["status"] == 503


def test_an_unknown_kind(http):
    problem(http.get("/problems/none"), 404, "no-such-path")


def test_an_unknown_path(http):
    assert "/api/v1/nothing" in problem(http.get(f"{API}/nothing"), 404, "no-such-path")["detail"]


@pytest.mark.parametrize(
    ("method", "path", "allowed"),
    [
        ("PUT", f"{API}/designs", "POST"),
        ("POST", f"{API}/templates", "GET"),
        ("DELETE", f"{API}/models/ball_bearing/versions/1", "GET"),
        ("POST", "/healthz", "GET"),
    ],
)
def test_an_unknown_method(http, method, path, allowed):
    answer = http.request(method, path)
    problem(answer, 405, "method-not-allowed")
    assert allowed in re.split(r",\s*", answer.headers["allow"])


@pytest.mark.parametrize(
    "media", ["text/plain", "application/xml", "multipart/form-data; boundary=x", "", "json"]
)
@pytest.mark.parametrize(
    "path", ["designs", "templates/oil_film/versions/1/evaluate", "models/ball_bearing/versions/1/build"]
)
def test_a_body_that_does_not_say_that_it_is_json(http, path, media):
    answer = http.post(f"{API}/{path}", content=b"{}", headers={"Content-Type": media})
    assert "application/json" in problem(answer, 415, "unsupported-media-type")["detail"]


@pytest.mark.parametrize("media", ["application/json", "application/json; charset=utf-8", "Application/JSON"])
def test_a_body_that_says_so(http, media):
    answer = http.post(f"{API}/designs", content=b'{"name": "typed"}', headers={"Content-Type": media})
    assert answer.status_code == 201


@pytest.mark.parametrize("path", ["designs", "verify"])
def test_a_body_too_large_is_413_with_and_without_its_length_declared(http, path):
    media = "application/json" if path == "designs" else "model/step"
    headers = {"Content-Type": media}
    piece = b" " * 2**20
    response = http.post(f"{API}/{path}", content=piece * 50, headers=headers)
    assert "16 MiB" in problem(response, 413, "body-too-large")["detail"]
    chunked = http.post(f"{API}/{path}", content=(piece for _ in range(18)), headers=headers)
    assert "16 MiB" in problem(chunked, 413, "body-too-large")["detail"]


def test_every_route_with_a_body_is_strict(served):
    routes = [route for route in served.app.routes if getattr(route, "body_field", None)]
    assert all(isinstance(route, StrictRoute) for route in routes)
