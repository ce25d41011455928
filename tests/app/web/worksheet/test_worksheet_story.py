"""In a browser, a newcomer gets from three lines of a worksheet to a STEP file."""

import re

import pytest
from playwright.sync_api import expect
from test_newcomer import step_diameters

PATIENCE = 60_000  # for a part to be built [ms]
MISTAKEN = """given F [kN] "radial load" (example 25 kN)
given p [MPa] "permitted pressure" (example 12 MPa)
D [mm] = sqrt(F * p) "bearing diameter\""""


@pytest.mark.slow
def test_a_newcomer_writes_a_worksheet_that_drives_a_part(watched, tmp_path):
    page = watched.page
    watched.open("/")
    page.get_by_role("link", name="Worksheets", exact=True).click()
    page.get_by_role("link", name="New worksheet").click()
    page.get_by_label("Name", exact=True).fill("newcomers_bush")
    page.get_by_role("textbox", name="Title").fill("Size of a bush")
    page.get_by_role("button", name="Create the worksheet").click()

    text = page.get_by_role("textbox", name="Text")
    text.press("Control+End")
    page.keyboard.insert_text(MISTAKEN)
    note = page.locator(".note")
    expect(note).to_contain_text("D is declared in mm, but")
    line = page.locator(".paper-lines .line.faulty")
    expect(line).to_contain_text("D [mm] = sqrt(F * p)")
    assert 0 <= note.bounding_box()["y"] - line.bounding_box()["y"] < line.bounding_box()["height"]
    expect(page.locator(".typeset-line .field-error")).to_contain_text("Line 4, column")

    for _ in range(len(' p) "bearing diameter"')):
        text.press("ArrowLeft")
    text.press("Backspace")
    text.press_sequentially("/")
    expect(note).to_have_count(0)
    expect(page.locator(".typeset-line").last).to_contain_text("= 45.644 mm")

    page.get_by_role("button", name="Run the tests").click()
    page.get_by_label("Name of the reviewer").fill("A colleague")
    page.get_by_role("button", name="Mark as reviewed").click()
    page.get_by_role("button", name="Release", exact=True).click()
    expect(page.locator("[data-sheet-state]")).to_have_text("released")
    expect(page.locator(".page-head")).to_contain_text("reviewed by A colleague, review not verified")

    page.get_by_role("button", name="Use it in a design").click()
    page.get_by_label("Radial load").fill("25 kN")
    page.get_by_label("Permitted pressure").fill("12 MPa")
    page.get_by_role("button", name="Create the design").click()
    expect(page.locator("[data-proposals]")).to_contain_text(
        "model.inner_diameter = newcomers_bush.bearing_diameter"
    )
    expect(page.locator(".verdict .headline")).to_have_text(re.compile("^No criteria"))
    page.get_by_role("button", name="Apply the chosen").click()
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    expect(page.locator("[data-design-state]")).to_have_text("current", timeout=PATIENCE)
    with page.expect_download() as download:
        page.get_by_role("link", name="STEP", exact=True).click()
    download.value.save_as(tmp_path / "bush.step")
    assert round((25_000 / 12) ** 0.5, 6) in step_diameters((tmp_path / "bush.step").read_bytes())
    assert watched.faults() == []


@pytest.mark.slow
def test_a_released_worksheet_shows_its_text_and_its_review_on_its_template_page(watched, http):
    body = {"id": "shown_sheet", "text": '# Shown\nA [mm] = 2 mm * 3 "a length"\n', "author": "An author"}
    http.post("/api/v1/worksheets", json=body).raise_for_status()
    page = watched.page
    watched.open("/worksheets/shown_sheet")
    page.get_by_role("button", name="Run the tests").click()
    reviewer = page.get_by_label("Name of the reviewer")
    reviewer.fill("An author")
    page.get_by_role("button", name="Mark as reviewed").click()
    expect(page.locator("[data-life-trouble]")).to_contain_text("let another person review")
    reviewer.fill("A colleague")
    page.get_by_role("button", name="Mark as reviewed").click()
    page.get_by_role("button", name="Release", exact=True).click()
    page.get_by_role("link", name="Try version 1").click()
    expect(page.locator(".page-head")).to_contain_text("Worksheet by An author")
    expect(page.locator(".page-head")).to_contain_text("reviewed by A colleague (review not verified)")
    expect(page.locator("pre")).to_contain_text('A [mm] = 2 mm * 3 "a length"')
    page.get_by_role("link", name="Open the worksheet").click()
    expect(page.get_by_role("button", name=re.compile("Save as a draft of version 2"))).to_be_visible()
    page.get_by_text("Withdraw version 1 …").click()
    page.get_by_label("Reason").fill("the length was wrong")
    page.get_by_role("button", name="Withdraw", exact=True).click()
    expect(page.locator("[data-part=stages] .notice.bad").first).to_have_text(
        "Withdrawn: the length was wrong"
    )
    assert [fault for fault in watched.faults() if "403" not in str(fault)] == []
