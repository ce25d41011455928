"""A page shows a rounded value beside its field: what is calculated, and what is chosen."""

import httpx
import pytest
from bare_shells import BUSH
from playwright.sync_api import expect
from serving import API

WIDTH = "[name='shell.width']"


@pytest.fixture(scope="module")
def rounded(served):
    sizes = {**BUSH, "inner_diameter": "= bore", "width": "= 0.31 * bore rounded up to 0.5 mm"}
    raw = {
        "name": "rounded shell",
        "parameters": {"bore": "48.2 mm", "pin": "= bore / 2 rounded down to 0.1 mm"},
        "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": sizes}},
    }
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        return http.post(f"{API}/designs", json=raw, headers={"Prefer": "wait=60"}).json()["id"]


def test_the_page_without_scripts_states_both_values(http, rounded):
    page = http.get(f"/designs/{rounded}").text
    assert "calculated 14.942 mm → chosen 15 mm" in page
    assert "calculated 24.1 mm → chosen 24.1 mm" in page
    sheet = http.get(f"/designs/{rounded}/revisions/1").text
    assert "Rounded values" in sheet
    assert "calculated 14.942 mm → chosen 15 mm" in sheet


@pytest.mark.slow
def test_the_page_follows_what_is_typed(watched, rounded):
    watched.open(f"/designs/{rounded}")
    page = watched.page
    line = page.locator("[data-parameter='shell.width'] .comes-to")
    expect(line).to_contain_text("calculated 14.942 mm → chosen 15 mm")
    page.locator("[name='.bore']").fill("50.2 mm")
    expect(line).to_contain_text("calculated 15.562 mm → chosen 16 mm")
    expect(page.locator("[data-value='.pin']")).to_have_text("calculated 25.1 mm → chosen 25.1 mm")
    page.locator(WIDTH).fill("= 0.31 * bore")
    expect(line).to_contain_text("15.562 mm")
    expect(line).not_to_contain_text("chosen")
    assert watched.faults() == []
