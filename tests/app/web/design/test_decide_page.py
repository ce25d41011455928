"""The button "Decide" uses finer levels where a criterion is undecided, and saves nothing."""

import pytest
from browsing import CHROMIUM
from patience import patient
from playwright.sync_api import expect
from serving import API

pytestmark = pytest.mark.skipif(
    not CHROMIUM, reason="needs Debian's package chromium-headless-shell or chromium"
)


@pytest.fixture
def undecided(http):
    """A design whose film at level fit is so near to its limit that its error hides the verdict."""
    inputs = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    step = {"template": "oil_film", "version": 2, "level": "fit", "inputs": inputs}
    asked = {"inputs": inputs, "level": "fit", "outputs": ["minimum_film_thickness"]}
    answer = http.post(f"{API}/templates/oil_film/versions/2/evaluate", json=asked).json()
    film = answer["outputs"]["minimum_film_thickness"]
    limit = film["value"] * (1 + answer["error"]["minimum_film_thickness"] / 2)
    criteria = {"thick_enough": {"require": f"film.minimum_film_thickness >= {limit} {film['unit']}"}}
    document = {"name": "near", "steps": {"film": step}, "criteria": criteria}
    design = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"}).json()
    return f"/designs/{design['id']}"


@pytest.mark.slow
def test_decide_decides_what_it_can_and_says_what_it_took(watched, undecided, http):
    page = watched.page
    watched.open(undecided)
    page.locator("[data-all-criteria] summary").click()
    own = page.locator('[data-criterion="thick_enough"] .tag')
    expect(own).to_have_text("undecided")
    page.get_by_role("button", name="Decide").click()
    expect(page.locator("[data-decided]")).to_contain_text("film at level", timeout=60_000)
    expect(page.locator("[data-decided]")).to_contain_text("Nothing was saved")
    expect(own).not_to_have_text("undecided")
    decided = http.post(f"{API}{undecided}/decide", json={}, headers={"Prefer": "wait=30"}).json()
    expected = next(one["verdict"] for one in decided["criteria"] if one["name"] == "thick_enough")
    expect(own).to_have_text(expected.replace("_", " "))
    assert http.get(f"{API}{undecided}").json()["revision"] == 1
    assert watched.faults() == []


@pytest.mark.slow
def test_decide_answers_in_the_units_of_the_page(watched, undecided):
    page = watched.page
    watched.open(f"{undecided}?units=us")
    page.locator("[data-all-criteria] summary").click()
    page.get_by_role("button", name="Decide").click()
    expect(page.locator("[data-decided]")).to_contain_text("Nothing was saved", timeout=60_000)
    own = page.locator('[data-criterion="thick_enough"]')
    expect(own.locator(".tag")).not_to_have_text("undecided")
    expect(own).to_contain_text(" mil ")
    assert watched.faults() == []


@pytest.mark.slow
def test_a_limit_that_is_missing_is_given_in_its_field(watched, undecided, http):
    page = watched.page
    watched.open(undecided)
    page.locator('[data-verdict] [data-give="film.permissible_film"]').first.click()
    field = page.locator('[name="film@limits.permissible_film"]')
    expect(field).to_be_focused()
    field.fill("3 kN")
    expect(page.locator('[id="film@limits-permissible_film-error"]')).to_contain_text("a length is wanted")
    field.fill("1 um")
    page.locator("[data-all-criteria] summary").click()
    expect(page.locator('[data-criterion="film.own_film"] .tag')).to_have_text("met")
    page.locator('[name="film@limits.bearing_material"]').select_option("tin_bronze")
    page.keyboard.press("Control+s")
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    limits = http.get(f"{API}{undecided}").json()["steps"]["film"]["limits"]
    assert limits == {"permissible_film": "1 um", "bearing_material": "tin_bronze"}


@pytest.mark.slow
def test_what_takes_long_states_its_cost_first_and_decides_every_variant(watched, http):
    """No mobility level states an error of the pressure; level supplied does, in a second or so a bearing."""
    inputs = http.get(f"{API}/templates/oil_film_cycle/versions/1").json()["example"]
    step = {"template": "oil_film_cycle", "version": 1, "level": "mobility_grooved", "inputs": inputs}
    criteria = {"own": {"require": "film.maximum_pressure <= 200 MPa"}}
    variants = {
        name: {"film.bearing_width": width} for name, width in (("main_1", "17 mm"), ("main_2", "19 mm"))
    }
    document = {"name": "bearings", "steps": {"film": step}, "criteria": criteria, "variants": variants}
    design = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"}).json()["id"]
    page = watched.page
    watched.open(f"/designs/{design}")
    page.locator("[data-all-criteria] summary").click()
    own = page.locator('[data-criterion="own"] .tag')
    expect(own).to_have_text("met; error unknown")
    page.get_by_role("button", name="Decide", exact=True).click()
    told = page.locator("[data-decided]")
    expect(told).to_contain_text("First film at level supplied (3 times): about", timeout=patient(60_000))
    expect(told).to_contain_text("No level begins after")
    expect(own).to_have_text("met; error unknown")
    page.get_by_role("button", name="Decide, about").click()
    expect(told).to_contain_text("Nothing was saved", timeout=patient(120_000))
    expect(own).to_have_text("met")
    headlines = page.locator("[data-decided-variants] li")
    expect(headlines).to_have_count(2)
    expect(headlines.first).to_contain_text("main_1: ")
    assert watched.faults() == []
