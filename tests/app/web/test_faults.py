"""A design page shows each fault at its place, in a browser."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import created
from playwright.sync_api import expect

NARROW = {"width": 390, "height": 844}


@pytest.fixture
def open_design(watched, http):
    """The design page of the paper's example in the browser."""
    watched.open(created(http, "paper"))
    return watched.page


def save(page):
    page.get_by_role("button", name=re.compile("Save as revision")).click()


@pytest.mark.slow
def test_a_narrow_screen_shows_why_nothing_was_saved_and_goes_to_the_fault(open_design):
    page = open_design
    page.set_viewport_size(NARROW)
    save(page)
    expect(page.locator("[data-state]")).to_have_text("nothing has changed")
    expect(page.locator("[data-state]")).to_be_visible()
    page.get_by_label("Radial load").fill("25 mm")
    save(page)
    expect(page.locator("[data-state]")).to_contain_text("not accepted")
    expect(page.locator("[data-state]")).to_be_visible()
    expect(page.get_by_label("Radial load")).to_be_focused()
    expect(page.get_by_label("Radial load")).to_be_in_viewport()


@pytest.mark.slow
def test_a_fault_or_a_draft_within_closed_details_opens_them(open_design):
    page = open_design
    field = page.locator('.step details.more [name="film.reference_density"]')
    expect(field).to_be_hidden()
    field.evaluate("(field) => { field.value = '3 mm'; }")
    field.dispatch_event("input")
    expect(page.locator("#film-reference_density-error")).to_be_visible()
    field.fill("880 kg/m**3")
    expect(page.locator("[data-state]")).to_have_text("previewed, not saved")
    page.reload()
    expect(field).to_have_value("880 kg/m**3")
    expect(field).to_be_visible()


def test_a_changed_field_that_is_wrong_is_red(open_design):
    load = open_design.get_by_label("Radial load")
    load.fill("26 kN")
    expect(load).to_have_css("background-color", "rgb(253, 243, 223)")
    load.fill("26 mm")
    expect(load).to_have_css("background-color", "rgb(253, 236, 235)")


@pytest.mark.slow
def test_the_bar_for_saving_covers_no_field_that_has_the_focus(open_design):
    page = open_design
    hidden = "document.activeElement.getBoundingClientRect().bottom - "
    hidden += "document.querySelector('.save').getBoundingClientRect().top"
    for size in (NARROW, {"width": 1440, "height": 500}):
        page.set_viewport_size(size)
        page.evaluate("scrollTo(0, 0)")
        page.get_by_label("scale", exact=True).focus()
        for _ in range(12):
            page.keyboard.press("Tab")
            if page.evaluate("document.activeElement.matches('.typed input')"):
                assert page.evaluate(hidden) <= 0, page.evaluate("document.activeElement.name")


@pytest.mark.slow
def test_results_of_before_are_marked_until_the_input_is_possible_again(watched, open_design):
    page = open_design
    for path in (None, "/templates/oil_film/1"):
        if path:
            watched.open(path)
        value = page.locator("[data-output] td.value").first
        page.get_by_label("Radial load").fill("26 mm")
        expect(page.locator("main")).to_have_class("outdated")
        expect(page.locator("[data-state]")).to_contain_text("the last valid input")
        expect(value).to_have_css("color", "rgb(81, 96, 111)")
        assert Axe().run(page, options={"runOnly": ["color-contrast"]}).response["violations"] == []
        page.get_by_label("Radial load").fill("26 kN")
        expect(page.locator("main")).not_to_have_class("outdated")
        expect(page.locator("[data-state]")).not_to_contain_text("the last valid input")
        expect(value).to_have_css("color", "rgb(27, 39, 51)")


@pytest.mark.slow
def test_what_is_wrong_with_a_cell_of_a_model_is_said_in_words(open_design):
    cell = open_design.locator('[data-parameter="model.inner_diameter"] .comes-to')
    field = open_design.locator('[name="model.inner_diameter"]')
    field.fill("= film.radial_load")
    expect(cell.locator(".field-error")).to_contain_text("model.inner_diameter is in mm")
    field.fill("")
    expect(cell.locator(".tag")).to_have_text("missing")
    expect(cell.locator(".field-error")).to_have_text("set it, or link it to an output")
    field.fill("50 mm")
    expect(cell.locator(".field-error")).to_have_count(0)
