"""Without scripts, every worksheet page is a form, and faults are shown below their lines."""

import re

from playwright.sync_api import expect

HOSTILE = "<script>alert(1)</script>&\"'"
FAULTY = 'given F [kN] "load" (example 25 kN)\nq [MPa] = F + 1 mm "wrong"\n'
SOUND = 'given F [kN] "load" (example 25 kN)\nq [kN] = 2 * F "right"\n'


def saved(page, text):
    page.get_by_role("textbox", name="Text").fill(text)
    page.get_by_role("button", name="Save").click()


def test_a_worksheet_lives_its_life_by_forms_alone(plain):
    page = plain.page
    plain.open("/worksheets/new")
    page.get_by_label("Name", exact=True).fill("by_forms")
    page.get_by_role("textbox", name="Title").fill("By forms")
    page.get_by_role("button", name="Create the worksheet").click()
    expect(page.get_by_role("textbox", name="Text")).to_have_value("# By forms\n")

    saved(page, FAULTY)
    under = page.locator(".listing li", has_text="q [MPa]").locator(".under")
    expect(under).to_contain_text("^")
    expect(under).to_contain_text("+ needs equal units")
    expect(page.get_by_role("button", name="Run the tests")).to_be_disabled()

    saved(page, SOUND)
    expect(page.locator(".listing")).to_have_count(0)
    expect(page.locator(".typeset-line").nth(1)).to_contain_text("= 50 kN")
    page.get_by_role("button", name="Run the tests").click()
    page.get_by_label("Name of the reviewer").fill("A colleague")
    page.get_by_role("button", name="Mark as reviewed").click()
    page.get_by_role("button", name="Release", exact=True).click()
    expect(page.locator("[data-sheet-state]")).to_have_text("released")

    saved(page, f"{SOUND}> more\n")
    expect(page.locator("[data-sheet-state]")).to_have_text("draft")
    page.get_by_text("Delete this draft").click()
    page.get_by_role("button", name="Delete version 2").click()
    expect(page.locator("[data-sheet-state]")).to_have_text("released")
    page.get_by_role("button", name="Use it in a design").click()
    start = f"{plain.url}/designs/new?design_name=by_forms&template=by_forms%2F1&model=plain_bearing%2F"
    expect(page).to_have_url(re.compile(rf"{re.escape(start)}\d+"))


def test_a_text_that_somebody_else_changed_is_kept_beside_theirs(http):
    http.post("/api/v1/worksheets", json={"id": "stale_form", "text": "# One\n"}).raise_for_status()
    tag = http.get("/api/v1/worksheets/stale_form").headers["etag"]
    changed = http.patch("/api/v1/worksheets/stale_form", json={"text": "# Two\n"}, headers={"If-Match": tag})
    changed.raise_for_status()
    again = http.post("/worksheets/stale_form", data={"text": "# Mine\r\n", "tag": tag})
    assert again.status_code == 412
    assert "Somebody else saved this worksheet meanwhile" in again.text
    assert "\n# Mine\n</textarea>" in again.text
    assert '<pre class="listing-text"># Two\n</pre>' in again.text
    assert http.get("/api/v1/worksheets/stale_form").json()["text"] == "# Two\n"


def test_what_is_wrong_with_a_new_worksheet_stands_in_its_form(http):
    for id, said in (("oil_film", "belongs to"), ("Not This", "")):
        refused = http.post("/worksheets", data={"id": id, "title": "Kept", "start": ""})
        assert refused.status_code in (409, 422)
        assert said in refused.text
        assert f'value="{id}"' in refused.text
        assert 'value="Kept"' in refused.text


def test_an_example_and_a_copy_begin_with_their_text(http):
    page = http.get("/worksheets/new").text
    assert 'value="example:' in page
    example = page.partition('value="example:')[2].partition('"')[0]
    first = http.post("/worksheets", data={"id": "from_example", "start": f"example:{example}"})
    assert first.headers["location"] == "/worksheets/from_example"
    http.post("/worksheets", data={"id": "from_copy", "start": "copy:from_example"})
    texts = [http.get(f"/api/v1/worksheets/{id}").json() for id in ("from_example", "from_copy")]
    assert texts[0]["text"] == texts[1]["text"] != ""
    assert texts[0]["faults"] == []


def test_an_action_out_of_order_says_what_is_missing(http):
    http.post("/api/v1/worksheets", json={"id": "too_soon", "text": SOUND}).raise_for_status()
    refused = http.post("/worksheets/too_soon/release", data={})
    assert refused.status_code == 409
    assert 'role="alert"' in refused.text
    assert http.get("/worksheets/too_soon/release").headers["location"] == "/worksheets/too_soon"


def test_the_list_is_searched_and_shows_state_and_review(http):
    http.post("/api/v1/worksheets", json={"id": "listed_one", "text": f"# {HOSTILE}\n"}).raise_for_status()
    page = http.get("/worksheets", params={"name": "LISTED_"}).text
    assert page.count('<th scope="row">') == 1
    assert "&lt;script&gt;" in page
    assert HOSTILE not in page
    assert "No worksheet fits the search." in http.get("/worksheets?name=nothing_like_it").text
    assert HOSTILE not in http.get("/worksheets/listed_one").text
    assert http.get("/worksheets/none_such").status_code == 404
