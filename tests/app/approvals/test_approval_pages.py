"""The pages offer approval, comments and audit as forms without scripts."""

import re

import pytest
from approving import Room, signed, signing
from serving import API, created, moody, patched

FORM = {"Content-Type": "application/x-www-form-urlencoded", "Accept": "text/html"}


@pytest.fixture(scope="module")
def room(team):
    with Room.of(team) as room:
        yield room


def page_of(http, path):
    answer = http.get(path, headers={"Accept": "text/html"})
    assert answer.status_code == 200, answer.text[:300]
    return answer.text


def seen(page):
    return re.search(r'name="seen" value="([0-9a-f]{64})"', page)[1]


def test_a_form_signs_and_the_page_says_what_comes_next(room):
    design = created(room.author, moody("20 mm"))
    place = f"/designs/{design['id']}"
    page = page_of(room.author, place)
    assert "Hand over for checking" in page
    data = {"step": "calculated", "seen": seen(page), "page": "design"}
    answer = room.author.post(f"{place}/revisions/1/approvals", data=data, headers=FORM)
    assert (answer.status_code, answer.headers["location"]) == (303, f"{place}#approval")
    assert "this needs the role checker" in page_of(room.author, place)
    assert "Sign as checked" in page_of(room.checker, f"{place}/revisions/1")


def test_a_form_that_is_refused_says_why(room):
    design = created(room.author, moody("21 mm"))
    place = f"/designs/{design['id']}"
    data = {"step": "calculated", "seen": "0" * 64, "page": "design"}
    answer = room.author.post(f"{place}/revisions/1/approvals", data=data, headers=FORM)
    assert answer.status_code == 412
    assert "Not signed: the content to sign is not that of If-Match" in answer.text


def test_lists_and_history_show_what_is_released(room):
    design = created(room.author, moody("22 mm"))
    signed(room, design)
    newer = patched(room.author, design, {"models": {"model": {"parameters": {"size": "23 mm"}}}})
    place = f"/designs/{design['id']}"
    listed = room.author.get(f"{API}/designs").json()["items"]
    assert next(one for one in listed if one["id"] == design["id"])["released"] == 1
    assert 'data-released="1"' in page_of(room.author, "/designs")
    page = page_of(room.author, place)
    assert f'It replaces <a href="{place}/revisions/1">released revision 1</a>' in page
    assert 'data-approval="released"' in page
    assert "Withdraw the release" in page_of(room.checker, f"{place}/revisions/1")
    signing(room.author, newer, "calculated", 2)
    assert 'data-approval="calculated"' in page_of(room.author, place)


def test_comments_are_written_shown_escaped_and_resolved(room):
    design = created(room.author, moody("24 mm"))
    place = f"/designs/{design['id']}"
    data = {"text": "first\r\n<b>second</b>", "subject": "model.size", "page": "design"}
    answer = room.checker.post(f"{place}/revisions/1/comments", data=data, headers=FORM)
    assert (answer.status_code, answer.headers["location"]) == (303, f"{place}#comments")
    page = page_of(room.author, place)
    assert "&lt;b&gt;second&lt;/b&gt;" in page
    assert "<b>second" not in page
    comment = re.search(r'data-comment="([0-9a-f]+)"', page)[1]
    resolve = f"{place}/revisions/1/comments/{comment}/resolve"
    assert room.author.post(resolve, data={"page": "revision"}, headers=FORM).status_code == 303
    assert "resolved by" in page_of(room.author, f"{place}/revisions/1")
    refused = room.author.post(f"{place}/revisions/1/comments", data={"text": ""}, headers=FORM)
    assert refused.status_code == 422
    assert "Not commented" in refused.text


def test_the_audit_page_filters(room):
    design = created(room.author, moody("25 mm"))
    page = page_of(room.admin, f"/audit?object=designs/{design['id']}")
    assert page.count(">design.create<") == 1
    assert "No change fits the filter." in page_of(room.admin, "/audit?action=nothing")
