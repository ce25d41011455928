"""Tolerances on the design page: the section, the button, the table and the pictures; nothing is saved."""

import re

import pytest
from browsing import CHROMIUM
from patience import patient, until
from playwright.sync_api import expect
from serving import API

JSON = {"Accept": "application/json"}
FILM = "film.minimum_film_thickness"


def design(http, **changes):
    inputs = {**http.get(f"{API}/templates/oil_film/versions/2").json()["example"], **changes}
    step = {"template": "oil_film", "version": 2, "level": "map", "inputs": inputs}
    criteria = {"thick_enough": {"require": f"{FILM} >= 2.6 um"}}
    document = {"name": "toleranced", "steps": {"film": step}, "criteria": criteria}
    answer = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"}).json()
    return f"/designs/{answer['id']}"


@pytest.fixture
def toleranced(http):
    return design(http, diametral_clearance="55 ± 10 um", radial_load="25 ± 1 kN")


def job_of(http, design):
    """The path of a job that has analysed the tolerances of a design."""
    later = http.post(f"{API}{design}/tolerance", json={}, headers={"Prefer": "respond-async"})
    job = later.headers["Location"]
    until(lambda: http.get(job, headers=JSON).json()["state"] == "done")
    return job


def finished(http, design):
    """The analysis of a design."""
    return http.get(job_of(http, design).replace("/jobs/", "/evaluations/"), headers=JSON).json()


@pytest.mark.slow
@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
def test_the_button_shows_yields_limits_and_pictures(watched, toleranced, http):
    page = watched.page
    watched.open(toleranced)
    page.locator("[data-tolerances] summary").first.click()
    page.get_by_role("button", name="Analyse tolerances").click()
    expect(page.locator("[data-analysed]")).to_have_text("Nothing was saved.", timeout=patient(60_000))
    analysis = finished(http, toleranced)
    shown = page.locator(f'[data-scattered="{FILM}"]')
    expect(shown).to_contain_text("2.6573")
    result = page.locator("[data-scatter]")
    value = next(one["value"] for one in analysis[FILM]["yields"] if one["of"] == "thick_enough")
    expect(result).to_contain_text(f"{100 * value:.2f} %")
    assert result.locator("svg").count() >= 2
    expect(result.locator("svg").first).to_be_visible()
    assert http.get(f"{API}{toleranced}").json()["revision"] == 1
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert watched.faults() == []


def pressed_before(watched, toleranced, release):
    """The button is pressed while a script of the page is on its way; then the script is released."""
    page, held = watched.page, []
    page.route("**/static/tolerances/tolerances.js", lambda route: held.append(route))
    with page.expect_request("**/static/tolerances/tolerances.js"):
        watched.open(toleranced, wait_until="commit")
    page.locator("[data-tolerances] summary").first.click()
    page.get_by_role("button", name="Analyse tolerances").click()
    expect(page.locator('form[data-waits="asked"]')).to_have_count(1)
    release(held[0])
    return page


@pytest.mark.slow
@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
def test_the_button_works_in_place_before_its_script_is_there(watched, toleranced):
    page = pressed_before(watched, toleranced, lambda route: route.continue_())
    expect(page.locator("[data-analysed]")).to_have_text("Nothing was saved.", timeout=patient(60_000))
    assert page.url.endswith(toleranced)
    expect(page.locator(f'[data-scattered="{FILM}"]')).to_contain_text("2.6573")


@pytest.mark.slow
@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
def test_the_button_opens_its_page_where_its_script_never_comes(watched, toleranced):
    page = pressed_before(watched, toleranced, lambda route: route.abort())
    page.wait_for_url(f"**{toleranced}/tolerances*", timeout=patient(60_000))


@pytest.mark.slow
@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
def test_what_is_not_saved_is_not_analysed(watched, toleranced):
    page = watched.page
    watched.open(toleranced)
    page.locator('[name="film.radial_load"]').fill("26 kN")
    page.locator("[data-tolerances] summary").first.click()
    page.get_by_role("button", name="Analyse tolerances").click()
    expect(page.locator("[data-analysed]")).to_have_text("save your changes first")


def test_a_design_without_tolerances_has_no_section(http):
    assert "data-tolerances" not in http.get(design(http)).text


@pytest.mark.slow
def test_without_a_script_the_analysis_is_a_page(http, toleranced):
    assert "data-tolerances" in http.get(toleranced).text
    page = http.get(f"{toleranced}/tolerances")
    assert page.status_code == 200
    while link := re.search(r'href="([^"]+job=[^"]+)"', page.text):  # on a busy machine it goes on as a job
        until(lambda place=link[1]: "Worst low" in http.get(place).text)
        page = http.get(link[1])
    assert "Worst low" in page.text
    assert page.text.count("<svg") >= 2
    assert "thick_enough" in page.text


def test_a_design_that_cannot_be_analysed_says_why(http):
    page = http.get(f"{design(http)}/tolerances")
    assert page.status_code == 422
    assert "write it like `55 ± 5 um`" in page.text


@pytest.mark.slow
def test_a_finished_job_is_a_part_of_the_page(http, toleranced):
    job = job_of(http, toleranced)
    part = http.get(f"{toleranced}/tolerances", params={"part": "1", "job": job.rpartition("/")[2]})
    assert part.status_code == 200
    assert "<html" not in part.text
    assert "Worst low" in part.text
