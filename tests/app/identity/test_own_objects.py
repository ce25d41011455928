"""Principals own their jobs, reviews and revisions, and no key appears anywhere."""

import logging

import pytest
import sheets
from serving import API

from app.client import Problem
from app.observation import logs

SIZE = {"parameters": {"inner_diameter": "51 mm", "outer_diameter": "60 mm", "width": "20 mm"}}

CSV = {"Content-Type": "text/csv"}


def test_a_revision_names_its_author(team):
    with team.client("author") as client, team.client("viewer") as viewer:
        design = client.create({"name": "signed", "parameters": {"scale": "1"}})
        author = viewer.revision(design.id, 1).author
    assert (author.id, author.name) == (team.principals["author"], "author")


def test_without_keys_the_author_is_local(http):
    response = http.post(f"{API}/designs", json={"name": "of nobody", "parameters": {"scale": "1"}})
    revision = http.get(f"{API}/designs/{response.json()['id']}/revisions/1").json()
    assert revision["author"] == {"id": "local", "name": "local"}


def test_the_page_names_the_author(team):
    with team.client("author") as client:
        design = client.create({"name": "signed", "parameters": {"scale": "1"}})
    with team.http("viewer", headers={"Accept": "text/html"}) as http:
        assert "· author" in http.get(f"/designs/{design.id}/revisions/1").text.replace("<bdi>", "")


def test_a_job_is_cancelled_by_its_principal_or_an_administrator_alone(team):
    jobs = team.server.app.state.services.jobs
    own = f"principal:{team.principals['author']}"
    database = team.server.app.state.services.database
    ids = [
        database.write(lambda session, n=n: jobs.enqueue(session, "of_no_kind", {"n": n}, client=own))
        for n in range(2)
    ]
    with team.http("author2") as http:
        refused = http.delete(f"{API}/jobs/{ids[0]}")
    assert (refused.status_code, refused.json()["type"]) == (403, "/problems/not-own")
    with team.http("admin") as http:
        assert http.delete(f"{API}/jobs/{ids[0]}").json()["state"] == "cancelled"
    with team.http("author") as http:
        assert http.delete(f"{API}/jobs/{ids[1]}").json()["state"] == "cancelled"


def test_a_worksheet_is_reviewed_by_another_principal_whatever_is_typed(team):
    with team.client("author") as client:
        sheet = client.create_worksheet("signed_duty", sheets.BUSH, author="somebody else")
        sheet = client.test_worksheet(sheet)
    assert sheet.author == "author"
    team.identity.change(team.principals["author"], _roles("checker"))
    try:
        with team.client("author") as client, pytest.raises(Problem, match="is the author"):
            client.review_worksheet(sheet, "B. Klein")
    finally:
        team.identity.change(team.principals["author"], _roles("author"))
    with team.client("checker") as client:
        reviewed = client.review_worksheet(sheet, "B. Klein")
    assert (reviewed.reviewer, reviewed.review_verified) == ("checker", True)


def _roles(*roles):
    from app.identity.service import Changes

    return Changes(roles=roles)


@pytest.mark.parametrize("form", [logs.TextFormatter(), logs.JsonFormatter()])
def test_no_line_of_the_log_and_no_answer_holds_a_key(team, caplog, form):
    """A key in every place of a request, on paths that answer and on paths that refuse."""
    caplog.set_level(logging.DEBUG)
    key = team.keys["author"]
    secret = key[-43:]
    sent = {
        "X-Request-ID": key, "Crankwright-Client": key, "Idempotency-Key": key, "If-Match": key,
        "Prefer": key, "User-Agent": key, "Cookie": f"a={key}", "Accept-Language": key,
    }  # fmt: skip
    with team.http("author", headers=sent) as http:
        answers = [
            http.get("/api/v1/me"),
            http.get(f"/api/v1/designs/{key}"),
            http.get("/api/v1/designs", params={"name": key, "cursor": key}),
            http.post("/api/v1/designs", json={key: key}),
            http.post("/api/v1/designs", json={"name": "a", "parameters": {"a": key}}),
            http.post("/api/v1/designs", content=key.encode()),
            http.patch("/api/v1/designs/nothing", json={"name": key}),
            http.post(
                "/api/v1/curves", content=f"{key},b\n1,2\n".encode(), headers={"Content-Type": "text/csv"}
            ),
            http.request(key[:20], "/api/v1/designs"),
        ]
    refused = [answer for answer in answers if answer.is_error]
    assert len(refused) >= 6
    assert not [answer.text for answer in refused if secret in answer.text]
    assert not [value for answer in answers for value in answer.headers.values() if secret in value]
    assert caplog.records
    assert not [line for line in map(form.format, caplog.records) if secret in line]


def test_no_row_of_the_audit_holds_a_key(team):
    from sqlalchemy import text

    with team.server.app.state.services.database.read() as session:
        rows = [str(row) for row in session.execute(text("select * from audit"))]
    assert any("key.add" in row for row in rows)
    assert not [row for row in rows for key in team.keys.values() if key[-43:] in row]
