"""The pages with tables of results are accessible and fit a phone: new study, study, compared revisions."""

import httpx
import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import from_example
from patience import patient, until
from playwright.sync_api import expect
from serving import API

FILM, WIDTH = "oil_film.minimum_film_thickness", "oil_film.bearing_width"
SIZES = {1440: 900, 390: 844}


@pytest.fixture(scope="module")
def pages(served):
    """The addresses of the three pages, for one design with two revisions."""
    with httpx.Client(base_url=served.url, timeout=patient(90), trust_env=False) as http:
        design = from_example(http, "oil_film/2")
        change = {"steps": {"oil_film": {"inputs": {"bearing_width": "24 mm"}}}}
        headers = {"If-Match": '"1"', "Prefer": "wait=30"}
        assert http.patch(f"{API}{design}", json=change, headers=headers).status_code < 300
        vary = {WIDTH: {"between": ["12 mm", "40 mm"]}}
        body = {"design": design.rpartition("/")[2], "method": "optimise", "vary": vary, "outputs": [FILM]}
        answer = http.post(f"{API}/studies", json={**body, "minimise": ["oil_film.power_loss"]})
        study = f"/studies/{answer.json()['id']}"
        until(lambda: http.get(f"{API}{study}").json()["state"] == "done")
    return {
        "study": study,
        "new study": f"{design}/studies/new",
        "comparison": f"{design}/compare?revision=1&with=2",
    }


@pytest.mark.slow
@pytest.mark.parametrize("width", SIZES)
@pytest.mark.parametrize("name", ["study", "new study", "comparison"])
def test_axe_finds_no_violation_and_nothing_scrolls_sideways(watched, pages, name, width):
    page = watched.page
    page.set_viewport_size({"width": width, "height": SIZES[width]})
    watched.open(pages[name], wait_until="networkidle")
    expect(page.locator("h1")).to_be_visible()
    for fold in page.locator("main details:not([open]) > summary").all():
        if fold.is_visible():
            fold.click()
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    results = Axe().run(page, options={"resultTypes": ["violations"]})
    assert results.violations_count == 0, results.generate_report()
    assert watched.faults() == []
