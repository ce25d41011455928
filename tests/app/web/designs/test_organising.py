"""Lists of designs in a browser: search, tags, names, archive; and two revisions side by side."""

import re
from uuid import uuid4

import pytest
from browsing import API, settled
from playwright.sync_api import expect


@pytest.fixture
def word():
    return f"w{uuid4().hex[:12]}"


@pytest.fixture
def design(http, word):
    """The newest design, without a part."""
    answer = http.post(f"{API}/designs", json={"name": f"{word} main bearing"})
    assert answer.status_code == 201, answer.text
    return answer.json()


def card(page, word):
    return page.locator("li.card", has_text=word)


def organise(place):
    """Open the forms of a design."""
    place.locator("details.organise > summary").click()


@pytest.mark.slow
def test_a_design_is_tagged_found_and_archived_from_the_home_page(watched, http, design, word):
    page, tag = watched.page, f"{word} V8"
    watched.open("/")
    organise(card(page, word))
    card(page, word).get_by_label(re.compile("^New tags of")).fill(f"{tag}, other {word}")
    card(page, word).get_by_role("button", name="Add tags").click()
    expect(card(page, word).get_by_role("link", name=tag, exact=True)).to_be_visible()
    page.locator("form.search").get_by_role("link", name=re.compile(tag)).click()
    expect(page).to_have_url(re.compile(r"/designs\?tag="))
    rows = page.locator("tbody tr")
    expect(rows).to_have_count(1)
    organise(rows.first)
    rows.first.get_by_role("button", name="Archive", exact=True).click()
    expect(page.get_by_text("No design fits the filter")).to_be_visible()
    watched.open("/")
    expect(card(page, word)).to_have_count(0)
    page.get_by_role("link", name="Archived designs").click()
    archived = page.locator("tbody tr", has_text=word)
    expect(archived.get_by_text("archived", exact=True)).to_be_visible()
    organise(archived)
    archived.get_by_role("button", name=f"Remove tag other {word}").click()
    expect(page.locator("tbody tr", has_text=word).get_by_role("link", name=f"other {word}")).to_have_count(0)
    organise(page.locator("tbody tr", has_text=word))
    page.locator("tbody tr", has_text=word).get_by_role("button", name="Restore from the archive").click()
    expect(page.locator("tbody tr", has_text=word)).to_have_count(0)
    assert http.get(f"{API}/designs/{design['id']}/labels").json() == {"tags": [tag], "archived": False}
    assert http.get(f"{API}/designs/{design['id']}").json() == design, "no revision was made"
    assert watched.faults() == []


@pytest.mark.slow
def test_a_deleted_design_is_restored_from_the_list_of_deleted_ones(watched, http, design, word):
    page = watched.page
    watched.open(f"/designs/{design['id']}")
    page.locator("details.confirm > summary").click()
    page.get_by_role("button", name="Delete this design").click()
    expect(card(page, word)).to_have_count(0)
    page.get_by_role("link", name="Deleted designs").click()
    page.get_by_role("button", name=f"Restore {word}").click()
    expect(page).to_have_url(re.compile(design["id"]))
    assert http.get(f"{API}/designs/{design['id']}").json() == design
    assert watched.faults() == []


@pytest.mark.slow
def test_a_page_that_is_no_longer_current_deletes_nothing(watched, http, design):
    page = watched.page
    watched.open(f"/designs/{design['id']}")
    place, changed = f"{API}/designs/{design['id']}", {"parameters": {"more": "1 mm"}}
    http.patch(place, json=changed, headers={"If-Match": "*"}).raise_for_status()
    page.locator("details.confirm > summary").click()
    page.get_by_role("button", name="Delete this design").click()
    expect(page.get_by_text("the design is at revision 2, not at")).to_be_visible()
    assert http.get(place).json()["revision"] == 2


@pytest.mark.slow
def test_a_design_is_renamed_and_found_by_its_new_name(watched, http, design, word):
    page = watched.page
    watched.open("/")
    organise(card(page, word))
    card(page, word).get_by_label(re.compile("^New name of")).fill(f"{word} renamed <b>&")
    card(page, word).get_by_role("button", name="Rename").click()
    expect(card(page, word).get_by_role("link", name=f"{word} renamed <b>&")).to_be_visible()
    page.get_by_label("Part of a name").fill(f"{word} REN")
    page.get_by_role("button", name="Search designs").click()
    expect(page.locator("tbody tr")).to_have_count(1)
    assert http.get(f"{API}/designs/{design['id']}").json()["revision"] == 2
    assert watched.faults() == []


def test_the_forms_work_without_scripts(plain, http, design, word):
    page = plain.page
    plain.open(f"/designs?name={word}")
    organise(page.locator("tbody tr").first)
    page.get_by_role("button", name="Archive", exact=True).click()
    expect(page).to_have_url(re.compile(f"/designs\\?name={word}"))
    assert http.get(f"{API}/designs/{design['id']}/labels").json()["archived"] is True


def test_a_form_leads_to_no_other_site(http, design):
    for back in ("https://example.com/", "//example.com", "/designs?a\r\nX: y", "/\\example.com", ""):
        answer = http.post(
            f"/designs/{design['id']}/labels", data={"add_tags": "back", "back": back}, follow_redirects=False
        )
        assert (answer.status_code, answer.headers["location"]) == (303, "/"), back
    answer = http.post(f"/designs/{design['id']}/labels", data={"add_tags": "a" * 50, "back": "/"})
    assert answer.status_code == 422


@pytest.mark.slow
def test_the_history_leads_to_any_two_revisions(watched, http, paper):
    page, id = watched.page, paper.rpartition("/")[2]
    for number, speed in ((1, "6000 rpm"), (2, "7000 rpm")):
        patch = {"steps": {"film": {"inputs": {"speed": speed}}}}
        http.patch(f"{API}{paper}", json=patch, headers={"If-Match": f'"{number}"'}).raise_for_status()
    settled(http, paper)
    watched.open(paper)
    page.get_by_role("link", name="compare any two").click()
    expect(page.get_by_role("heading", name="Compare")).to_be_visible()
    speed = page.locator('[data-compared="film.speed"]')
    expect(speed).to_contain_text("6000")
    page.get_by_label("Revision of this design").select_option("1")
    page.get_by_role("button", name="Compare").click()
    expect(speed).to_contain_text("5000")
    expect(speed).to_contain_text("7000")
    expect(speed).to_contain_text("+40 %")
    films = page.get_by_role("region", name="Results of both revisions")
    expect(films.get_by_role("columnheader", name="Minimum film thickness [µm]")).to_be_visible()
    expect(films.locator("tbody tr")).to_have_count(2)
    expect(page.locator('[data-compared="film.minimum_film_thickness"]')).to_have_count(0)
    copy = http.post(f"{API}{paper}/copy", json={"name": "the other one"}).json()
    other = http.patch(
        f"{API}/designs/{copy['id']}",
        json={"steps": {"film": {"inputs": {"speed": "9000 rpm"}}}},
        headers={"If-Match": '"1"'},
    )
    other.raise_for_status()
    page.reload()
    page.get_by_label("With the design").select_option(copy["id"])
    expect(speed).to_contain_text("9000")
    expect(page.get_by_label("Its revision")).to_have_value("2")
    assert f"/designs/{id}/compare" in page.url
    assert watched.faults() == []


@pytest.mark.parametrize("query", ["design=none", "design=a/revisions/1", "with=99", "revision=99"])
def test_what_cannot_be_compared_is_said(http, design, query):
    page = http.get(f"/designs/{design['id']}/compare?{query}")
    assert page.status_code == 404
    assert "There is no" in page.text or "does not exist" in page.text or "has no revision" in page.text


@pytest.mark.parametrize("query", ["", "?revision=&with=&design=&of=", "?with=x&revision=-1", "?units=us"])
def test_odd_queries_show_the_page(http, design, query):
    assert http.get(f"/designs/{design['id']}/compare{query}").status_code == 200


@pytest.mark.slow
def test_narrow_pages_do_not_scroll_sideways(browser, served, http, paper):
    context = browser.new_context(viewport={"width": 390, "height": 844})
    page = context.new_page()
    http.post(f"{API}{paper}/labels", json={"add_tags": ["a rather long tag of forty letters or so"[:40]]})
    for path in ("/", "/designs", f"{paper}/compare", "/templates/faults"):
        page.goto(served.url + path)
        for summary in page.locator("details.organise > summary").all()[:2]:
            summary.click()
        width = page.evaluate("document.documentElement.scrollWidth")
        assert width <= 390, path
    context.close()
