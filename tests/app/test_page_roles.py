"""A page shows and does what the interface allows the same principal; its errors are pages."""

import pytest
from serving import API, created, paper

HTML = {"Accept": "text/html"}


@pytest.fixture(scope="module")
def design(team):
    with team.http("author") as http:
        document = paper()
        document["model"]["parameters"] = {"inner_diameter": "50 mm"}
        return created(http, document)


def test_a_viewer_sees_the_page_of_a_design_with_a_model(team, design):
    with team.http("viewer", headers=HTML) as http:
        page = http.get(f"/designs/{design['id']}")
        assert page.status_code == 200
        assert design["name"] in page.text
        assert http.post(f"{API}/designs/{design['id']}/auto-map").status_code == 403


def test_a_viewer_builds_no_model_by_its_page(team):
    with team.http("viewer", headers=HTML) as http:
        page = http.get("/models/ball_bearing/1", params={"inner_diameter": "31 mm"})
        build = http.post(f"{API}/models/ball_bearing/versions/1/build", json={"parameters": {}})
        assert (page.status_code, build.status_code) == (403, 403)
        assert "<title>" in page.text


def test_a_form_is_read_as_strictly_as_a_body(team, design):
    with team.http("author", headers=HTML) as http:
        place = f"/designs/{design['id']}"
        answer = http.post(f"{place}/rename", data={"name": "a\0b", "revision": "1"})
        assert answer.status_code == 422
        assert "U+0000" in answer.text
        assert http.get(f"{API}{place}").json()["name"] == design["name"]


def test_a_stale_form_changes_nothing(team, design):
    with team.http("author", headers=HTML) as http:
        place = f"/designs/{design['id']}"
        for revision in ("0", "99", "nothing", ""):
            assert (
                http.post(f"{place}/rename", data={"name": "late", "revision": revision}).status_code == 412
            )
        assert http.get(f"{API}{place}").json()["name"] == design["name"]


def test_an_unexpected_error_of_a_page_is_a_page(team, monkeypatch):
    def fails(*_, **__):
        raise RuntimeError("what only the log holds")

    services = team.server.app.state.services
    monkeypatch.setattr(type(services.designs), "show", fails)
    with team.http("viewer", headers=HTML) as http:
        answer = http.get("/designs/any")
        assert answer.status_code == 500
        assert answer.headers["content-type"].startswith("text/html")
        assert "what only the log holds" not in answer.text
