"""Light and dark theme: by the system or the switch, kept between pages; reports stay white."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import Watched, from_example
from playwright.sync_api import expect

WHITE, DARK = "rgb(255, 255, 255)", "rgb(24, 32, 41)"
PAPER = "getComputedStyle(document.querySelector('.sheet, .panel')).backgroundColor"


@pytest.fixture
def dark(browser, served):
    """A page for somebody whose system is dark."""
    context = browser.new_context(color_scheme="dark", viewport={"width": 1440, "height": 900})
    yield Watched(context.new_page(), served.url).page
    context.close()


@pytest.mark.slow
def test_the_system_decides_unless_somebody_chose(dark, served, http):
    place = served.url + from_example(http, "oil_film/1")
    dark.goto(place)
    assert dark.evaluate(PAPER) == DARK
    dark.get_by_role("button", name="Light").click()
    expect(dark.get_by_role("button", name="Light")).to_have_attribute("aria-pressed", "true")
    assert dark.evaluate(PAPER) == WHITE
    dark.goto(served.url + "/templates/oil_film/1")
    assert dark.evaluate(PAPER) == WHITE
    dark.get_by_role("button", name="Auto").click()
    expect(dark.get_by_role("button", name="Auto")).to_have_attribute("aria-pressed", "true")
    assert dark.evaluate(PAPER) == DARK


@pytest.mark.slow
@pytest.mark.usefixtures("plotted")
def test_the_dark_scheme_can_be_chosen_and_a_report_stays_white(watched, http):
    place = from_example(http, "oil_film/1")
    watched.open(place)
    page = watched.page
    assert page.evaluate(PAPER) == WHITE
    page.get_by_role("button", name="Dark").click()
    expect(page.get_by_role("button", name="Dark")).to_have_attribute("aria-pressed", "true")
    assert page.evaluate(PAPER) == DARK
    plot = page.locator(".picture.pressure")
    plot.scroll_into_view_if_needed()
    expect(plot.locator(".js-plotly-plot").first).to_be_attached(timeout=60_000)
    assert plot.locator("svg.main-svg").first.evaluate("(svg) => svg.style.background") == DARK
    watched.open(f"/api/v1{place}/report.html")
    assert page.evaluate(PAPER) == WHITE
    assert watched.faults() == []


@pytest.mark.slow
def test_dark_pages_have_enough_contrast(dark, served, http):
    for path in (from_example(http, "oil_film/2"), "/templates/oil_film/1"):
        dark.goto(served.url + path, wait_until="networkidle")
        violations = Axe().run(dark, options={"runOnly": ["color-contrast"]}).response["violations"]
        assert [node["target"] for rule in violations for node in rule["nodes"]] == [], path
