"""The page of a design is short, its bars leave the screen to the content, and folds show what they must."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import created, settled
from playwright.sync_api import expect
from serving import API

MAINS = {f"main_{n}": {"film.radial_load": f"{load} kN"} for n, load in enumerate((21, 24, 26, 24, 20), 1)}
SIZES = {1440: (900, 3500), 390: (844, 6000)}  # width: height of the screen and longest page [pixels]
SHARE = 8  # the bars together take at most this part of the screen
BARS = """() => [...document.querySelectorAll("*")]
    .filter((box) => ["sticky", "fixed"].includes(getComputedStyle(box).position))
    .filter((box) => !box.matches("th, td, thead, .part-view") && box.getBoundingClientRect().height > 0)
    .map((box) => box.getBoundingClientRect().height)"""


@pytest.fixture
def mains(http):
    """The page of a design with a shell for each of five main bearings."""
    place = created(http, "shell")
    headers = {"If-Match": '"1"', "Prefer": "wait=30"}
    assert http.patch(f"{API}{place}", json={"variants": MAINS}, headers=headers).status_code < 300
    settled(http, place)
    return place


@pytest.mark.slow
@pytest.mark.parametrize("width", SIZES)
def test_five_mains_are_a_short_page_whose_bars_are_low(browser, served, mains, width):
    height, longest = SIZES[width]
    context = browser.new_context(viewport={"width": width, "height": height})
    page = context.new_page()
    page.goto(served.url + mains)
    expect(page.locator("[data-governing-variant]")).to_contain_text("main_3", timeout=60_000)
    page.wait_for_load_state("networkidle")
    assert page.evaluate("document.documentElement.scrollHeight") < longest
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert sum(page.evaluate(BARS)) <= height / SHARE
    page.locator(".verdict [data-all-criteria] > summary").click()
    assert sum(page.evaluate(BARS)) <= height / SHARE, "the list of criteria opens in the page"
    found = Axe().run(page, options={"resultTypes": ["violations"]})
    assert found.response["violations"] == []
    context.close()


@pytest.mark.slow
def test_a_fold_hides_calculated_parameters_and_shows_what_is_typed_or_wrong(watched, mains):
    page = watched.page
    watched.open(mains, wait_until="networkidle")
    fold, depth = page.locator("[data-folded-parameters]"), page.locator('[name="model.oil_groove_depth"]')
    expect(page.locator('[name="model.width"]')).to_be_visible()  # it has a relation
    expect(depth).to_be_hidden()
    depth.evaluate("(field) => { field.value = '9 mm'; }")
    depth.dispatch_event("input")
    expect(page.locator("#model-oil_groove_depth-error")).to_be_visible(timeout=60_000)
    page.reload()
    expect(depth).to_have_value("9 mm")  # the draft opens the fold
    expect(depth).to_be_visible()
    expect(fold).to_have_attribute("open", "")
