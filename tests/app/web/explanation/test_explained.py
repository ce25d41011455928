"""In a browser, links lead from a verdict to its origin, and from a fault to related fields."""

import re

import pytest
from bare_shells import BUSH
from browsing import settled
from judging import CRITERIA, verdict
from playwright.sync_api import expect
from serving import API


@pytest.fixture
def shell(http):
    """A shell with a film of its own whose smallest film is limited by a relation."""
    film = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    step = {"template": "oil_film", "version": 2, "inputs": film, "limits": {"permissible_film": "= least"}}
    document = {
        "name": "explained",
        "parameters": {"least": "2 um"},
        "steps": {"film": step},
        "model": {"id": "plain_bearing", "version": 1, "parameters": {**BUSH, "inner_diameter": "48 mm"}},
    }
    design = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"}).json()
    settled(http, f"/designs/{design['id']}")
    return f"/designs/{design['id']}"


@pytest.mark.slow
def test_a_verdict_leads_to_value_and_limit_and_who_gave_it(watched, shell):
    page = watched.page
    watched.open(shell)
    page.locator("[data-all-criteria] > summary").click()
    page.locator('tr[data-criterion="film.own_film"] .why').click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Where the verdict of film.own_film comes from")
    tree = page.locator(".tree")
    expect(tree).to_contain_text("value: film.minimum_film_thickness")
    expect(tree).to_contain_text("limit: film.limits.permissible_film = 2 µm = least")
    expect(tree).to_contain_text("least = 2")
    assert watched.faults() == []


def test_the_table_of_sensitivities_shows_slopes_and_what_helps(watched, http, shell):
    page = watched.page
    watched.open(f"{shell}/explain/film.own_film")
    page.get_by_role("link", name="How much each typed value matters").click()
    expect(page).to_have_url(re.compile("#changes$"))
    rows = page.locator("table.sensitivities tbody tr")
    answer = http.get(f"{API}{shell}/explain/film.own_film").json()["sensitivities"]
    expect(rows.locator("th")).to_have_text([one["name"] for one in answer])
    sizes = [abs(one["elasticity"]) for one in answer if one.get("elasticity")]
    assert sizes == sorted(sizes, reverse=True)
    load = rows.filter(has=page.get_by_role("rowheader", name="film.radial_load", exact=True))
    expect(load).to_contain_text("µm/N")
    expect(load).to_contain_text("lower it")
    bar = load.get_by_role("img", name=re.compile("^elasticity [-−]"))
    expect(bar).to_have_class("bar falls")
    longest = rows.first.locator("rect.used")
    assert float(longest.get_attribute("width")) == 50
    assert float(bar.locator("rect.used").get_attribute("width")) <= 50
    assert watched.faults() == []


@pytest.mark.slow
def test_the_table_of_sensitivities_in_american_units_on_a_narrow_page(watched, shell):
    page = watched.page
    page.set_viewport_size({"width": 390, "height": 800})
    watched.open(f"{shell}/explain/film.own_film?units=us#changes")
    region = page.get_by_role("region", name="Sensitivities")
    expect(region).to_contain_text("mil/lbf")
    region.focus()
    expect(region).to_be_focused()
    wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0
    assert watched.faults() == []


@pytest.mark.slow
def test_a_verdict_that_the_browser_writes_leads_there_too(watched, shell):
    watched.open(shell, wait_until="networkidle")
    payload = {"criteria": CRITERIA, "verdict": verdict(*CRITERIA)}
    script = "async (payload) => (await import('/static/verdict/verdict.js')).showVerdict(payload)"
    watched.page.evaluate(script, payload)
    expect(watched.page.locator(".governing .why")).to_have_attribute("href", f"{shell}/explain/film.film")


@pytest.mark.slow
def test_a_fault_names_its_related_places(watched, shell):
    page = watched.page
    watched.open(shell)
    depth = page.locator('[name="model.oil_groove_depth"]')
    depth.evaluate("(field) => { field.value = '3 mm'; }")
    depth.dispatch_event("input")
    beside = page.locator("#model-oil_groove_depth-error")
    expect(beside).to_contain_text(re.compile(r"at most 80 % of the wall.*See also model\.wall"))


def test_a_refused_form_names_the_related_places_without_scripts(http, shell):
    typed = {"revision": "1", "was": "{}", "model.oil_groove_depth": "3 mm"}
    refused = http.post(shell, data=typed)
    assert refused.status_code == 422
    assert re.search(r'id="model-oil_groove_depth-error"><bdi>[^<]*See also model\.wall<', refused.text)
