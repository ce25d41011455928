"""The browser keeps typed but unsaved values."""

import re

import pytest
from browsing import Watched, created
from playwright.sync_api import expect

PATIENCE = 60_000  # for a part to be built [ms]


@pytest.fixture
def open_design(watched, http):
    """The design page of the paper's example in the browser."""
    watched.open(created(http, "paper"))
    return watched.page


def load(page):
    return page.get_by_label("Radial load")


@pytest.mark.slow
def test_two_tabs_keep_their_own_drafts(watched, open_design):
    one, other = open_design, Watched(watched.page.context.new_page(), watched.url).page
    other.goto(one.url)
    load(one).fill("31 kN")
    load(other).fill("32 kN")
    expect(other.locator("[data-draft]")).to_be_visible()
    one.keyboard.press("Control+s")
    expect(one.locator(".page-head")).to_contain_text("revision 2", timeout=PATIENCE)
    other.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(other.locator("[data-trouble]")).to_contain_text("Your changes are kept")
    other.get_by_role("button", name="Show the newest").click()
    expect(other.locator(".page-head")).to_contain_text("revision 2")
    expect(load(other)).to_have_value("32 kN")
    one.reload()
    expect(load(one)).to_have_value("31 kN")


@pytest.mark.slow
def test_what_is_saved_at_once_after_it_was_typed_is_no_draft_afterwards(open_design):
    page = open_design
    page.get_by_label("scale", exact=True).fill("1.01")
    page.keyboard.press("Control+s")
    expect(page.locator(".page-head")).to_contain_text("revision 2", timeout=PATIENCE)
    expect(page.get_by_label("scale", exact=True)).to_have_value("1.01")
    expect(page.locator("[data-trouble]")).to_be_hidden()
    assert page.evaluate("Object.keys(sessionStorage)") == []


@pytest.mark.slow
def test_a_revision_that_another_form_of_the_page_saved_is_no_news_to_its_user(open_design):
    page = open_design
    load(page).fill("31 kN")
    expect(page.locator("[data-draft]")).to_be_visible()
    page.get_by_text("Add a parameter, a template, a model").click()
    page.get_by_label("Name of the parameter").fill("gap")
    page.get_by_label("Value of the parameter").fill("55 um")
    page.get_by_role("button", name="Add parameter").click()
    expect(page.locator(".page-head")).to_contain_text("revision 2", timeout=PATIENCE)
    expect(load(page)).to_have_value("31 kN")
    expect(page.locator("[data-draft]")).to_be_visible(timeout=PATIENCE)
    expect(page.locator("[data-trouble]")).to_be_hidden()
