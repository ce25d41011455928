"""From a verdict to where it comes from, and from a fault to its related places, in a browser."""

import re

import pytest
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
        "model": {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": "48 mm"}},
    }
    made = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"}).json()
    settled(http, f"/designs/{made['id']}")
    return f"/designs/{made['id']}"


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


def test_a_verdict_that_the_browser_writes_leads_there_too(watched, shell):
    watched.open(shell, wait_until="networkidle")
    payload = {"criteria": CRITERIA, "verdict": verdict(*CRITERIA)}
    script = "async (payload) => (await import('/static/verdict.js')).showVerdict(payload)"
    watched.page.evaluate(script, payload)
    expect(watched.page.locator(".governing .why")).to_have_attribute("href", f"{shell}/explain/film.film")


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
