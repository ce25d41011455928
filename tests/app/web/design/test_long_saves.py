"""During a slow step, a design's page shows progress, allows cancellation, and shows the results."""

import browsing  # noqa: F401 - makes the tests of the service importable
import pytest
from patience import until
from serving import API

from app.calculations.cache import USUAL, results

pytest.importorskip("playwright")
from playwright.sync_api import expect

OUTPUT = '[data-output="s.process"] td.value'


@pytest.fixture
def place(http):
    """The address of a design with a step that can take long, calculated."""
    step = {"template": "sleeper", "version": 1, "inputs": {"duration": "1 ms"}}
    answer = http.post(f"{API}/designs", json={"name": "sleep", "steps": {"s": step}})
    assert answer.status_code == 201, answer.text
    return f"/designs/{answer.json()['id']}"


def saved_slowly(http, place, duration):
    """The address of the job that calculates a change."""
    headers = {"If-Match": '"1"', "Prefer": "respond-async"}
    patch = {"steps": {"s": {"inputs": {"duration": duration}}}}
    answer = http.patch(f"{API}{place}", json=patch, headers=headers)
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


def parts(watched):
    page = watched.page
    return page.locator("[data-progress]"), page.get_by_label("duration").first


def save(watched):
    watched.page.locator("[data-save]").click()


def idle(served):
    return until(lambda: served.app.state.services.calculations.running == 0)


@pytest.mark.slow
def test_a_slow_save_says_how_far_it_is_and_shows_its_results(watched, place, http, alarm):
    watched.open(place)
    progress, duration = parts(watched)
    expect(progress).to_be_hidden()
    duration.fill("60.5 s")
    save(watched)
    expect(progress).to_contain_text("half asleep")
    expect(progress.locator("progress")).to_have_attribute("value", "0.5")
    alarm.touch()
    expect(watched.page.locator("[data-design-state]")).to_have_text("current")
    expect(watched.page.get_by_role("link", name="revision 2", exact=True)).to_be_visible()
    expect(progress).to_be_hidden()
    process = http.get(f"{API}{place}/revisions/2").json()["steps"]["s"]["outputs"]["process"]["value"]
    expect(watched.page.locator(OUTPUT)).to_contain_text(str(int(process))[:2])
    expect(watched.page.locator("[data-formula='s.process'] .result")).not_to_be_empty()
    assert watched.faults() == []


@pytest.mark.slow
def test_a_slow_save_can_be_cancelled(watched, served, place):
    watched.open(place)
    progress, duration = parts(watched)
    duration.fill("60.1 s")
    save(watched)
    expect(progress).to_contain_text("half asleep")
    progress.get_by_role("button", name="Cancel").click()
    expect(watched.page.locator("[data-design-state]")).to_have_text("failed")
    expect(watched.page.get_by_role("alert").first).to_contain_text("cancelled")
    expect(watched.page.locator("[data-state]")).to_contain_text("s not calculated yet")
    expect(watched.page.locator(OUTPUT)).to_contain_text("is not calculated yet")
    expect(parts(watched)[1]).to_have_value("60.1 s")
    idle(served)
    assert watched.faults() == []


@pytest.mark.slow  # as a slow save does, which is in the quick lane
def test_a_slow_preview_says_how_far_it_is_and_shows_its_results(watched, place, alarm):
    watched.open(place)
    progress, duration = parts(watched)
    value = watched.page.locator(OUTPUT)
    value.evaluate("cell => cell.textContent = 'not yet'")
    duration.fill("60.6 s")
    expect(progress).to_contain_text("half asleep")
    expect(watched.page.locator("[data-step=s]")).to_have_class("sheet step outdated")
    alarm.touch()
    expect(progress).to_be_hidden()
    expect(watched.page.locator(OUTPUT)).not_to_have_text("not yet")
    expect(watched.page.locator("[data-step=s]")).to_have_class("sheet step")
    expect(watched.page.locator("[data-state]")).to_have_text("previewed, not saved")
    assert watched.faults() == []


@pytest.mark.slow
def test_who_types_something_else_stops_a_slow_preview(watched, served, place):
    watched.open(place)
    progress, duration = parts(watched)
    duration.fill("60.2 s")
    expect(progress).to_contain_text("half asleep")
    duration.fill("2 ms")
    expect(progress).to_be_hidden()
    expect(watched.page.locator("[data-state]")).to_have_text("previewed, not saved")
    idle(served)
    assert watched.faults() == []


@pytest.mark.slow
def test_a_slow_preview_can_be_cancelled(watched, served, place):
    watched.open(place)
    progress, duration = parts(watched)
    duration.fill("60.3 s")
    expect(progress).to_contain_text("half asleep")
    progress.get_by_role("button", name="Cancel").click()
    expect(progress).to_be_hidden()
    expect(watched.page.locator("[data-trouble]")).to_contain_text("cancelled")
    idle(served)


@pytest.mark.slow
def test_who_opens_the_page_meanwhile_sees_the_progress_and_then_the_results(watched, place, http, alarm):
    saved_slowly(http, place, "60.7 s")
    watched.open(place)
    progress, _ = parts(watched)
    expect(progress).to_contain_text("half asleep")
    expect(watched.page.locator(OUTPUT)).to_contain_text("is not calculated yet")
    alarm.touch()
    expect(watched.page.locator("[data-design-state]")).to_have_text("current")
    expect(watched.page.locator(OUTPUT)).not_to_contain_text("not calculated")
    assert watched.faults() == []


def test_a_page_calculates_nothing_again_that_its_revision_holds(watched, served, http, place, alarm):
    job = saved_slowly(http, place, "60.8 s")
    alarm.touch()
    until(lambda: http.get(job).json()["state"], lambda state: state == "done")
    results.limit(1)  # as after a restart of the server
    jobs = http.get(f"{API}/jobs").json()
    watched.open(place)
    watched.page.wait_for_load_state("networkidle")
    expect(watched.page.locator(OUTPUT)).not_to_contain_text("not calculated")
    expect(watched.page.locator("[data-step=s]")).to_have_class("sheet step")
    assert http.get(f"{API}/jobs").json() == jobs
    results.limit(USUAL)
    idle(served)


@pytest.mark.slow
def test_without_scripts_a_slow_save_is_shown_and_can_be_cancelled(plain, served, place):
    plain.open(place)
    parts(plain)[1].fill("60.4 s")
    save(plain)
    expect(plain.page.locator("[data-design-state]")).to_have_text("regenerating")
    expect(plain.page.locator(OUTPUT)).to_contain_text("is not calculated yet")
    plain.page.get_by_role("button", name="Cancel").click()
    expect(plain.page.locator("[data-design-state]")).to_have_text("failed")
    idle(served)
