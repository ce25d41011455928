"""A person who checks or releases a revision with unconfirmed criteria must justify it."""

import io
import re

import pypdf
import pytest
from approving import Room, signing
from serving import API, created, moody

from app.approvals.rules import unconfirmed
from app.schemas.criteria import Criterion

FORM = {"Content-Type": "application/x-www-form-urlencoded", "Accept": "text/html"}
REASON = "held on test bench 7"


@pytest.fixture(scope="module")
def room(team):
    with Room.of(team) as room:
        yield room


def design_of(room, size, least):
    """A design with one criterion of its own, handed over for checking."""
    criteria = {"large": {"require": f"model.size >= {least}", "words": "the part is large"}}
    design = created(room.author, {**moody(size), "criteria": criteria})
    signing(room.author, design, "calculated")
    return design


def sent(http, design, body):
    place = f"{API}/designs/{design['id']}/revisions/1/approvals"
    return http.post(place, json=body, headers={"If-Match": http.get(place).headers["etag"]})


def test_a_violated_criterion_is_acknowledged_signed_and_printed(room):
    design = design_of(room, "31 mm", "50 mm")
    refused = sent(room.checker, design, {"step": "checked"})
    assert (refused.status_code, refused.json()["type"].rpartition("/")[2]) == (409, "acknowledgement")
    assert "large: size 31 mm is below 50 mm: not met" in refused.json()["detail"]
    signing(room.checker, design, "checked", acknowledged=REASON)
    assert sent(room.releaser, design, {"step": "released"}).status_code == 409
    content = signing(room.releaser, design, "released", acknowledged=REASON)["steps"][-1]["content"]
    assert content["acknowledged"] == REASON
    assert content["unconfirmed"] == ["large: size 31 mm is below 50 mm: not met"]
    place = f"{API}/designs/{design['id']}/revisions/1/report"
    report = room.viewer.get(f"{place}.pdf").content
    text = " ".join(
        " ".join(page.extract_text() for page in pypdf.PdfReader(io.BytesIO(report)).pages).split()
    )
    assert text.count(f"1 criterion not confirmed: {REASON}") == 2


def test_a_confirmed_design_needs_no_acknowledgement_and_takes_none(room):
    design = design_of(room, "32 mm", "10 mm")
    refused = sent(room.checker, design, {"step": "checked", "acknowledged": REASON})
    assert refused.status_code == 409
    assert "every criterion of revision 1 is confirmed" in refused.json()["detail"]
    content = sent(room.checker, design, {"step": "checked"}).json()["steps"][-1]["content"]
    assert content.keys().isdisjoint({"acknowledged", "unconfirmed"})


def test_the_page_asks_for_the_acknowledgement(room):
    design = design_of(room, "33 mm", "50 mm")
    place = f"/designs/{design['id']}"
    page = room.checker.get(f"{place}/revisions/1", headers={"Accept": "text/html"}).text
    assert re.search(r'<textarea name="acknowledged"[^>]* required>', page)
    assert "large: size 33 mm is below 50 mm: not met" in page
    seen = re.search(r'name="seen" value="([0-9a-f]{64})"', page)[1]
    data = {"step": "checked", "seen": seen, "page": "revision"}
    refused = room.checker.post(f"{place}/revisions/1/approvals", data=data, headers=FORM)
    assert refused.status_code == 409
    assert "Not signed: criteria of revision 1 are not confirmed" in refused.text
    signed = room.checker.post(
        f"{place}/revisions/1/approvals", data={**data, "acknowledged": REASON}, headers=FORM
    )
    assert signed.status_code == 303
    page = room.viewer.get(f"{place}/revisions/1", headers={"Accept": "text/html"}).text
    assert REASON in page
    assert "1 not confirmed" in page


@pytest.mark.parametrize(
    ("changes", "is_confirmed"),
    [
        ({"verdict": "met"}, True),
        ({"verdict": "met", "error_known": False}, False),
        ({"verdict": "undecided"}, False),
        ({"verdict": "not_checked"}, False),
        ({"verdict": "not_met"}, False),
        ({"verdict": "not_met", "waived": "accepted in test 12"}, True),
    ],
)
def test_only_met_with_a_known_error_is_confirmed(changes, is_confirmed):
    one = Criterion.model_validate({"name": "a", "words": "a", "require": "x >= 1 mm", **changes})
    assert (unconfirmed([one]) == []) == is_confirmed
