"""How a design page tells what is wrong and where, in a browser."""

import re

import pytest
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


def test_a_narrow_screen_shows_why_nothing_was_saved_and_goes_to_the_fault(open_design):
    page = open_design
    page.set_viewport_size(NARROW)
    save(page)
    expect(page.locator("[data-state]")).to_have_text("nothing has changed")
    expect(page.locator("[data-state]")).to_be_visible()
    page.get_by_label("Radial load").fill("25 mm")
    save(page)
    expect(page.locator("[data-state]")).to_contain_text("not possible so")
    expect(page.locator("[data-state]")).to_be_visible()
    expect(page.get_by_label("Radial load")).to_be_focused()
    expect(page.get_by_label("Radial load")).to_be_in_viewport()
