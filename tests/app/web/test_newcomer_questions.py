"""By mouse, a newcomer answers three questions from the gallery: a clearance, a tolerance, a width."""

import re

import pytest
from browsing import CHROMIUM
from patience import patient
from playwright.sync_api import expect
from serving import API

pytestmark = pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")

FILM, LOSS = "film.minimum_film_thickness", "film.power_loss"
WIDTH, RELATION = "film.bearing_width", "= ratio * film.bearing_diameter"


@pytest.fixture
def bearing(watched):
    """The page of a plain bearing from the gallery."""
    page = watched.page
    watched.open("/")
    page.locator('button[data-example="shell"]').click()
    expect(page.locator("[data-design-state]")).to_have_text("current", timeout=patient(60_000))
    return page


def design(page, http):
    return http.get(f"{API}/designs/{page.url.rpartition('/')[2]}").json()


@pytest.mark.slow
def test_which_clearance_gives_two_micrometres_at_7000_rpm(bearing, watched, http):
    page, place = bearing, bearing.url
    page.get_by_role("link", name="Solve for a wanted output").click()
    page.get_by_label("Vary").select_option("film.diametral_clearance")
    page.get_by_label("until").select_option(FILM)
    page.get_by_label("is", exact=True).fill("2 um")
    page.get_by_label("with another value of").select_option("film.speed")
    page.get_by_label("which is").fill("7000 rpm")
    page.get_by_role("button", name="Solve").click()
    expect(page.get_by_role("alert")).to_contain_text("2 um is out of reach")
    page.get_by_role(
        "link", name=re.compile("Search between 5.5 .* and 550 |Search between 0.0055 mm and 0.55 mm")
    ).click()
    roots = page.locator("[data-roots] tbody tr")
    expect(roots.first).to_be_visible(timeout=patient(30_000))
    roots.last.get_by_role("button", name="Save as revision 2").click()
    page.wait_for_url(place)
    sheet = http.get(f"{API}/designs/{place.rpartition('/')[2]}/revisions/2").json()["steps"]["film"]
    assert sheet["inputs"]["speed"]["value"] == 7000
    assert abs(sheet["outputs"]["minimum_film_thickness"]["value"] - 2) < 2e-3
    assert [fault for fault in watched.faults() if "422" not in str(fault)] == []


@pytest.mark.slow
def test_what_a_tolerance_of_the_clearance_does_to_the_film(bearing, watched):
    page = bearing
    page.get_by_label("Diametral clearance").fill("55 +/- 5 um")
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator(".page-head")).to_contain_text("revision 2", timeout=patient(30_000))
    page.wait_for_load_state("load")
    page.locator("[data-tolerances] summary").first.click()
    page.get_by_role("button", name="Analyse tolerances").click()
    shown = page.locator(f'[data-scattered="{FILM}"]')  # in the page, or on its own before the script runs
    expect(shown).to_be_visible(timeout=patient(60_000))
    low, high = (float(number) for number in re.findall(r"3\.[89]\d*|4\.0\d*", shown.inner_text())[1::3][:2])
    assert 3.8 < low < 3.9476 < high < 4.1
    expect(page.locator("main")).to_contain_text("film.diametral_clearance 60 µm")
    assert watched.faults() == []


@pytest.mark.slow
def test_which_width_costs_least_power(bearing, watched, http):
    page, place = bearing, bearing.url
    page.get_by_role("link", name="New study").click()
    page.get_by_label("Optimise").check()
    page.get_by_label("Vary").select_option(WIDTH)
    expect(page.locator("[data-aside]").first).to_contain_text(
        f"The relation {WIDTH} {RELATION} is set aside"
    )
    expect(page.get_by_role("button", name="Keep it, and vary ratio")).to_be_visible()
    page.locator('[name="objective.0"]').select_option(LOSS)
    estimate = page.locator("[data-estimate]")
    expect(estimate).to_contain_text("film level map", timeout=patient(20_000))
    expect(estimate).to_contain_text(f"Set aside in this study: {WIDTH} {RELATION}")
    expect(estimate).to_contain_text("The time depends on how soon the search converges")
    held = page.locator('[name^="hold."]:checked').evaluate_all("(boxes) => boxes.map(({ name }) => name)")
    assert "hold.film.film" in held
    assert "hold.film.whirl" not in held
    page.get_by_role("button", name="Start the study").click()
    answer = page.locator("[data-answer]")
    expect(answer).to_contain_text("Smallest power loss", timeout=patient(60_000))
    expect(answer).to_contain_text("bearing width = 36.367 mm")
    study = http.get(f"{API}/studies/{page.url.rpartition('/')[2]}").json()
    assert study["result"]["best"]["verdict"] == "met"
    assert study["set_aside"] == {WIDTH: RELATION}
    best = page.get_by_role("region", name="Table of the best row")
    best.get_by_role("button", name=re.compile("Use row")).click()
    page.wait_for_url(place)
    expect(page.locator(".page-head")).to_contain_text(f"replaces the relation of {WIDTH} ({RELATION})")
    saved = http.get(f"{API}/designs/{place.rpartition('/')[2]}").json()["steps"]["film"]["inputs"]
    assert abs(saved["bearing_width"]["value"] - 36.37) < 0.05
    assert watched.faults() == []


@pytest.mark.slow
def test_the_relation_is_kept_by_varying_what_it_depends_on(bearing, watched):
    page = bearing
    page.get_by_role("link", name="New study").click()
    page.get_by_label("Vary").select_option(WIDTH)
    page.get_by_role("button", name="Keep it, and vary ratio").click()
    expect(page.get_by_label("Vary")).to_have_value("ratio")
    expect(page.get_by_label("from").first).to_have_value("0.25")
    expect(page.locator("[data-aside]").first).to_be_hidden()
    expect(page.locator("[data-estimate]")).to_contain_text(
        re.compile("About|Less than 1 s"), timeout=patient(20_000)
    )
    expect(page.locator("[data-estimate]")).not_to_contain_text("Set aside")
    assert watched.faults() == []


def test_without_a_script_the_estimate_is_a_button(http, paper):
    typed = {
        "sent": "on",
        "method": "grid",
        "place.0": "film.bearing_width",
        "steps.0": "5",
        "explore": "5 %",
    }
    typed |= {"outputs.film.minimum_film_thickness": "on"}
    first = http.post(f"{paper}/studies/estimate", data=typed)
    assert first.status_code == 422
    assert 'value="9 mm"' in first.text  # what was left out is suggested
    second = http.post(f"{paper}/studies/estimate", data={**typed, "low.0": "9 mm", "high.0": "36 mm"})
    assert second.status_code == 200
    assert re.search("About .* s|Less than 1 s", second.text)
    assert "5 rows" in second.text
    assert http.get(f"{paper}/studies/estimate").headers["location"] == f"{paper}/studies/new"
