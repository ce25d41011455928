"""The editor of worksheets: colours, faults, completion, drafts, conflicts; by keyboard alone, and narrow."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import Watched
from playwright.sync_api import expect

LIST, OPTION = "#completions", "#completions [role=option]"
SHEET = """# Journal bearing
> Steady load, **aligned** journal.
given F [kN] "radial load" (>= 0; example 25 kN)
given D [mm] "bearing diameter" (> 0; example 48 mm)
given B [mm] = 24 mm "bearing width" (> 0)
p [MPa] = F / (D * B) "projected pressure" (source "DIN 31652")
require B <= 2 * D "The bush is at most twice as long as wide" (remedy "use two")
check p <= 20 MPa "white metal carries it"
test "by hand" with F = 25 kN gives p = 21.7 MPa within 0.2 %
"""


def stored(http, id, text=SHEET, **more):
    """The address of a new worksheet."""
    http.post("/api/v1/worksheets", json={"id": id, "text": text, **more}).raise_for_status()
    return f"/worksheets/{id}"


def opened(watched, place):
    """The text of a worksheet, once the service has read it."""
    watched.open(place)
    area = watched.page.get_by_role("textbox", name="Text")
    expect(area).to_have_attribute("aria-controls", "completions")
    return area


def at_end(area, text):
    area.press("Control+End")
    area.press_sequentially(text)


@pytest.mark.slow
def test_each_line_stands_on_paper_beside_its_text(watched, http):
    opened(watched, stored(http, "beside"))
    rows = watched.page.locator(".typeset-line")
    expect(rows).to_have_count(9)
    expect(rows.nth(5).locator("mfrac")).to_have_count(1)
    expect(rows.nth(5)).to_contain_text("= 21.701 MPa")
    expect(rows.nth(5)).to_contain_text("projected pressure")
    expect(rows.nth(1).locator("strong")).to_have_text("aligned")
    expect(rows.nth(6).locator(".tag")).to_have_text("met")
    expect(rows.nth(7).locator(".tag")).to_have_text("not met")
    expect(rows.nth(8).locator(".tag")).to_have_text("passed")
    lines = watched.page.locator(".paper-lines .line")
    for place in (2, 3, 4):
        above, beside = lines.nth(place).bounding_box()["y"], rows.nth(place).bounding_box()["y"]
        assert abs(above - beside) < 12, "a line and what it says stand at one height"
    assert watched.faults() == []


@pytest.mark.slow
def test_the_letters_stand_where_those_of_the_textarea_are(watched, http):
    for width in (1440, 390):
        watched.page.set_viewport_size({"width": width, "height": 900})
        opened(watched, stored(http, f"wide_{width}"))
        heights = watched.page.evaluate("""() => {
          const area = document.getElementById("text");
          const last = document.querySelector("[data-lines]").lastElementChild;
          Object.assign(area.style, { position: "static", height: "10px" });
          return [area.scrollHeight, last.offsetTop + last.offsetHeight];
        }""")
        assert heights[0] == heights[1]


@pytest.mark.slow
def test_names_units_and_keywords_are_completed_by_keyboard_and_undone(watched, http):
    area = opened(watched, stored(http, "completed"))
    page = watched.page
    at_end(area, "pl")  # `plot` draws in designs only
    expect(page.locator(LIST)).to_be_hidden()
    area.press("Backspace")
    area.press("Backspace")
    at_end(area, "gi")
    expect(page.locator(OPTION).first).to_contain_text("given")
    area.press("Enter")
    at_end(area, " L [m")
    expect(page.locator(OPTION).first).to_contain_text("mm")
    assert area.get_attribute("aria-activedescendant") == "completion-0"
    area.press("Tab")
    expect(area).to_be_focused()
    at_end(area, '] "length" (example 3 k')
    expect(page.locator(OPTION).first).to_contain_text("kN")
    area.press("Escape")
    expect(page.locator(LIST)).to_be_hidden()
    at_end(area, "m)\nq [MPa] = proj")
    expect(page.locator(OPTION).first).to_contain_text("projected pressure")
    area.press("Enter")
    expect(area).to_have_value(SHEET + 'given L [mm] "length" (example 3 km)\nq [MPa] = p')
    area.press("Control+z")
    expect(area).to_have_value(re.compile("= proj$"))
    at_end(area, ' "words with giv')
    expect(page.locator(LIST)).to_be_hidden()
    area.press("Escape")
    area.press("Tab")
    expect(area).not_to_be_focused()
    assert watched.faults() == []


@pytest.mark.slow
def test_a_fault_is_explained_under_its_line_and_sound_lines_stay(watched, http):
    area = opened(watched, stored(http, "explained"))
    page = watched.page
    expect(page.locator(".typeset-line")).to_have_count(9)
    at_end(area, 'q [MPa] = F + D "wrong"')
    expect(page.locator(".note")).to_contain_text("+ needs equal units")
    expect(page.locator("[data-sheet-faults]")).to_have_text("1 fault, in line 10")
    expect(page.locator(".typeset-line")).to_have_count(10)
    expect(page.locator(".typeset-lines")).to_contain_text("21.701 MPa")
    expect(page.locator(".typeset-line.before")).to_have_count(0)  # calculated without the faulty line
    mark = page.locator(".underline").bounding_box()
    column = page.locator(".faulty .of-sign", has_text="+").bounding_box()
    assert mark["x"] < column["x"] + column["width"] < mark["x"] + mark["width"] + 20
    area.press("Control+a")
    page.keyboard.insert_text("# Only a title\n")
    expect(page.locator(".note")).to_have_count(0)
    assert watched.faults() == []


@pytest.mark.slow
def test_what_is_typed_survives_a_reload_and_can_be_discarded(watched, http):
    place = stored(http, "drafted")
    area = opened(watched, place)
    at_end(area, "> kept")
    expect(watched.page.locator("[data-draft]")).to_be_visible()
    area = opened(watched, place)
    expect(area).to_have_value(f"{SHEET}> kept")
    watched.page.get_by_role("button", name="Discard").click()
    expect(area).to_have_value(SHEET)
    expect(watched.page.locator("[data-draft]")).to_be_hidden()
    assert watched.faults() == []


@pytest.mark.slow
@pytest.mark.parametrize("choice", ["Keep mine", "Use theirs"])
@pytest.mark.sampled(1)
def test_somebody_elses_text_is_shown_and_nothing_is_lost(watched, http, choice):
    id = f"conflict_{choice[:4].strip().lower()}"
    area = opened(watched, stored(http, id))
    at_end(area, "> mine")
    headers = {"If-Match": http.get(f"/api/v1/worksheets/{id}").headers["etag"]}
    theirs = {"text": f"{SHEET}> theirs"}
    http.patch(f"/api/v1/worksheets/{id}", json=theirs, headers=headers).raise_for_status()
    area.press("Control+s")
    page = watched.page
    expect(page.locator(".diff .removed")).to_contain_text("> mine")
    expect(page.locator(".diff .added")).to_contain_text("> theirs")
    expect(area).to_have_value(f"{SHEET}> mine")
    page.get_by_role("button", name=choice).click()
    kept = f"{SHEET}> {'mine' if choice == 'Keep mine' else 'theirs'}"
    expect(page.locator("[data-theirs]")).to_be_hidden()
    expect(area).to_have_value(kept)
    expect(page.locator("[data-draft]")).to_be_hidden()
    assert http.get(f"/api/v1/worksheets/{id}").json()["text"] == kept
    assert [fault for fault in watched.faults() if "412" not in str(fault)] == []


@pytest.mark.slow
def test_the_next_version_is_held_against_the_released_one(watched, http):
    place = stored(http, "versioned", author="One")
    api = f"/api/v1{place}"
    digest = http.post(f"{api}/test").json()["digest"]
    http.post(f"{api}/review", json={"reviewer": "Two", "digest": digest}).raise_for_status()
    http.post(f"{api}/release").raise_for_status()
    area = opened(watched, place)
    page = watched.page
    at_end(area, "> more")
    page.get_by_role("button", name="Save as a draft of version 2").click()
    expect(page.locator("[data-sheet-state]")).to_have_text("draft")
    expect(page.get_by_role("button", name="Release")).to_be_disabled()
    page.get_by_text("Differences from version 1").click()
    expect(page.locator(".diff .added")).to_contain_text("> more")
    expect(page.locator(".diff .removed")).to_have_count(0)
    page.get_by_text("Withdraw version 1 …").click()
    page.get_by_label("Reason").fill("superseded")
    page.get_by_role("button", name="Withdraw", exact=True).click()
    expect(page.locator(".versions")).to_contain_text("withdrawn: superseded")
    expect(page.locator("[data-sheet-state]")).to_have_text("draft")
    assert watched.faults() == []


@pytest.mark.parametrize(
    ("width", "scheme"),
    [
        pytest.param(390, "dark", marks=pytest.mark.slow),
        pytest.param(1440, "light", marks=pytest.mark.slow),
        pytest.param(1440, "dark", marks=pytest.mark.slow),
        pytest.param(390, "light", marks=pytest.mark.slow),
    ],
)
def test_the_pages_are_accessible_wide_and_narrow_light_and_dark(browser, served, http, scheme, width):
    place = stored(http, f"axe_{scheme}_{width}", f'{SHEET}q [MPa] = F + D "wrong"\n')
    context = browser.new_context(viewport={"width": width, "height": 844}, color_scheme=scheme)
    watched = Watched(context.new_page(), served.url)
    for path in ("/worksheets", "/worksheets/new", place):
        watched.open(path)
        if path == place:
            expect(watched.page.locator(".note")).to_be_visible()
        assert watched.page.evaluate("document.documentElement.scrollWidth") <= width, path
        violations = Axe().run(watched.page).response["violations"]
        assert [(rule["id"], node["target"]) for rule in violations for node in rule["nodes"]] == [], path
    assert watched.faults() == []
    context.close()


def test_a_draft_is_previewed_in_a_design_and_nothing_is_saved(watched, http):
    place = stored(http, "tried_out", author="One")
    api = f"/api/v1{place}"
    digest = http.post(f"{api}/test").json()["digest"]
    http.post(f"{api}/review", json={"reviewer": "Two", "digest": digest}).raise_for_status()
    released = http.post(f"{api}/release")
    inputs = {"radial_load": "25 kN", "bearing_diameter": "48 mm"}
    step = {"template": "tried_out", "version": 1, "inputs": inputs}
    design = http.post("/api/v1/designs", json={"name": "uses it", "steps": {"duty": step}}).json()["id"]
    wider = SHEET.replace("= 24 mm", "= 48 mm")
    headers = {"If-Match": released.headers["etag"]}
    http.patch(api, json={"text": wider}, headers=headers).raise_for_status()
    opened(watched, place)
    page = watched.page
    page.get_by_label("Preview version 2 in a design").select_option("uses it")
    page.get_by_role("button", name="Preview").click()
    pressure = page.locator("[data-tried] tr", has_text="duty.projected_pressure")
    expect(pressure).to_contain_text("21.701 MPa")
    expect(pressure).to_contain_text("10.851 MPa")
    assert http.get(f"/api/v1/designs/{design}").json()["revision"] == 1
    other = http.post("/api/v1/designs", json={"name": "other"}).json()["id"]
    added = http.get(place, params={"design": other}).text
    assert "with one more step <code>tried_out</code>" in added
    assert http.get(place, params={"design": "none_such"}).status_code == 200
    assert watched.faults() == []
