"""Actions of a design's forms other than saving, and the page that follows."""

import httpx
import pytest
from browsing import created
from playwright.sync_api import expect

ADDED = (("parameter", "scale"), ("parameter", "film"), ("template", "film"), ("model", "model"))


@pytest.fixture(scope="module")
def paper(served):
    """The address of a design that no test here changes."""
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        return created(http, "paper")


@pytest.mark.parametrize(("kind", "name"), ADDED)
def test_nothing_is_added_under_a_name_in_use(http, paper, kind, name):
    before = http.get(f"/api/v1{paper}").json()
    chosen = {"value": "7 mm", "template": "third/1", "model": "ball_bearing/1"}
    answer = http.post(f"{paper}/blocks", data={"revision": "1", "add": kind, "name": name, **chosen})
    assert answer.status_code == 422
    assert f"{name} is in use: choose another name" in answer.text
    assert http.get(f"/api/v1{paper}").json() == before


PLACES = ("blocks", "auto-map", "copy", "delete", "revisions/1/restore", "jobs/none/cancel")


@pytest.mark.parametrize("place", PLACES)
def test_the_address_of_a_form_shows_the_design_when_it_is_read(http, paper, place):
    answer = http.get(f"{paper}/{place}?units=us")
    assert (answer.status_code, answer.headers["location"]) == (303, f"{paper}?units=us")
    assert http.get(f"{paper}/{place}").headers["location"] == paper


def test_the_choice_of_units_keeps_the_rest_of_the_address(http, paper):
    for path in ("/templates/third/1?whole_length=7+mm", f"{paper}/revisions/1?with=1"):
        query = path.partition("?")[2]
        assert f'href="?{query}&amp;units=us"' in http.get(f"{path}&units=si").text
    assert 'href="?units=us"' in http.get("/").text


@pytest.mark.slow
def test_the_choice_of_units_keeps_what_is_typed(watched):
    watched.open("/templates/third/1")
    page = watched.page
    page.get_by_label("Whole length").fill("10 in")
    page.get_by_role("link", name="US").click()
    expect(page.get_by_label("Whole length")).to_have_value("10 in")
    expect(page.locator('[data-output=".third_of_the_length"] .unit')).to_have_text("in")
