"""During a long calculation, a template's page shows progress, allows cancellation, and shows the result."""

import browsing  # noqa: F401 - makes the tests of the service importable
import pytest
from test_workers import eventually

pytest.importorskip("playwright")
from playwright.sync_api import expect

PLACE = "/templates/sleeper/1"


def parts(watched):
    page = watched.page
    return page.locator("[data-progress]"), page.locator('[data-output=".process"] td.value')


def test_a_long_calculation_says_how_far_it_is_and_shows_its_answer(watched, alarm):
    watched.open(PLACE)
    progress, value = parts(watched)
    expect(progress).to_be_hidden()
    value.evaluate("cell => cell.textContent = 'not yet'")
    watched.page.get_by_label("duration").first.fill("60.1 s")
    expect(progress).to_contain_text("half asleep")
    alarm.touch()
    expect(progress).to_be_hidden()
    expect(parts(watched)[1]).not_to_have_text("not yet")
    assert watched.faults() == []


@pytest.mark.slow
def test_it_can_be_stopped(watched, served):
    watched.open(PLACE)
    progress, _ = parts(watched)
    watched.page.get_by_label("duration").first.fill("60 s")
    expect(progress).to_contain_text("half asleep")
    progress.get_by_role("button", name="Cancel").click()
    expect(progress).to_be_hidden()
    expect(watched.page.locator("[data-state]")).to_contain_text("cancelled")
    assert eventually(lambda: served.app.state.services.calculations.running == 0)


@pytest.mark.slow
def test_who_types_something_else_stops_it(watched, served):
    watched.open(PLACE)
    progress, _ = parts(watched)
    watched.page.get_by_label("duration").first.fill("60 s")
    expect(progress).to_contain_text("half asleep")
    watched.page.get_by_label("duration").first.fill("1 ms")
    expect(progress).to_be_hidden()
    expect(watched.page.locator("[data-state]")).to_have_text("")
    assert eventually(lambda: served.app.state.services.calculations.running == 0)


@pytest.mark.slow
def test_who_leaves_the_page_stops_it(watched, served):
    watched.open(PLACE)
    progress, _ = parts(watched)
    watched.page.get_by_label("duration").first.fill("60 s")
    expect(progress).to_contain_text("half asleep")
    watched.open("/templates/third/1")
    assert eventually(lambda: served.app.state.services.calculations.running == 0)


@pytest.mark.slow
def test_a_page_whose_address_asks_for_a_long_calculation_follows_it(watched, alarm):
    watched.open(f"{PLACE}?duration=60.2+s")
    progress, value = parts(watched)
    expect(progress).to_be_visible()
    alarm.touch()
    expect(progress).to_be_hidden()
    expect(value).not_to_contain_text("calculated")
    assert watched.faults() == []


@pytest.mark.slow
def test_without_scripts_a_page_links_the_job(plain):
    plain.open(f"{PLACE}?duration=5+s")
    expect(plain.page.get_by_role("link", name="a job")).to_be_visible()
    expect(plain.page.locator('[data-output=".process"]')).to_contain_text("is being calculated")
