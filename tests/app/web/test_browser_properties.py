"""Every page makes no external request, raises no error, and is accessible and small."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import created, settled
from patience import patient
from playwright.sync_api import expect

from app.presentation.numbers import aligned, unit
from app.presentation.numbers import in_line as python_in_line

SERIOUS = ("serious", "critical")
NARROW = {"width": 390, "height": 844}
MOST_REQUESTS, MOST_BYTES = 8, 2 * 2**20


@pytest.fixture
def paths(http):
    """One page of every kind, and every template and model."""
    design = created(http, "shell")
    listed = [
        f"/{group}/{item['id']}/{item['version']}"
        for group in ("templates", "models")
        for item in http.get(f"/api/v1/{group}", params={"limit": 500}).json()["items"]
    ]
    explained = f"{design}/explain/model.inner_diameter"
    return ["/", "/designs", design, f"{design}/revisions/1", explained, *listed]


@pytest.fixture
def kinds(paths):
    """One page of every kind."""
    return [*paths[:5], "/templates/oil_film/1", "/models/plain_bearing/1"]


@pytest.fixture
def some(kinds):
    """A design, whose page has nearly every script."""
    return [kinds[2]]


SCROLL = """async () => {
    const shown = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    for (let place = 0; place < document.documentElement.scrollHeight; place += 600) {
        scrollTo(0, place);
        await shown();
    }
}"""
"""Scroll to the end; two frames at each place, in which the browser reports what has come into sight."""


def seen_whole(watched, path):
    """Open a page and look at all of it, so that everything that waits to be seen is drawn."""
    watched.open(path, wait_until="load")
    page = watched.page
    page.evaluate(SCROLL)
    page.wait_for_load_state("networkidle", timeout=60_000)
    expect(page.locator("[aria-busy]")).to_have_count(0, timeout=60_000)


@pytest.mark.usefixtures("plotted")
@pytest.mark.slow
def test_a_page_whose_plots_are_drawn_does_neither(watched, kinds):
    """As the next test, for one page of plots; in the slow lane that draws those of all pages."""
    seen_whole(watched, kinds[5])
    assert watched.page.locator(".js-plotly-plot svg").count() > 0
    assert watched.faults() == []
    assert watched.page.get_by_text("could not be drawn").count() == 0


@pytest.mark.parametrize("all_or_one", ["some", pytest.param("paths", marks=pytest.mark.slow)])
def test_no_page_asks_an_outside_address_fails_or_breaks_the_policy(watched, request, all_or_one):
    for path in request.getfixturevalue(all_or_one):
        seen_whole(watched, path)
        assert watched.faults() == [], path
        assert watched.page.get_by_text("could not be drawn").count() == 0, path


@pytest.mark.slow
@pytest.mark.parametrize("all_or_one", ["some", "paths"])
def test_no_page_is_wider_than_a_narrow_screen(browser, watched, http, kinds, request, all_or_one):
    paths = request.getfixturevalue(all_or_one)
    watched.page.set_viewport_size(NARROW)
    document = {"name": "unbroken" * 20, "parameters": {"k": "1"}}
    named = http.post("/api/v1/designs", json=document).json()["id"]
    reports = [f"/api/v1/designs/{id}/report.html" for id in (kinds[2].rpartition("/")[2], named)]
    for path in [*paths, f"/designs/{named}", f"/designs/{named}/revisions/1", *reports]:
        watched.open(path, wait_until="load")
        assert watched.page.evaluate("document.documentElement.scrollWidth") <= NARROW["width"], path


@pytest.mark.parametrize("is_all", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_pages_have_no_serious_fault_of_accessibility(watched, kinds, is_all):
    for path in (*kinds, "/nowhere") if is_all else kinds[2:3]:
        watched.open(path, wait_until="networkidle")
        violations = Axe().run(watched.page).response["violations"]
        serious = [
            (fault["id"], [node["target"] for node in fault["nodes"]][:3])
            for fault in violations
            if fault["impact"] in SERIOUS
        ]
        assert serious == [], path


@pytest.mark.slow
def test_the_keyboard_reaches_fields_and_save_in_the_order_of_the_page(watched, http):
    watched.open(created(http, "paper"))
    page = watched.page
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    page.get_by_label("scale", exact=True).focus()
    names = []
    for _ in range(60):
        page.keyboard.press("Tab")
        names.append(page.evaluate("document.activeElement.name || document.activeElement.textContent"))
    fields = [name for name in names if name.startswith("film.") or name == "note"]
    assert fields[:3] == ["film.radial_load", "film.diametral_clearance", "film.bearing_diameter"]
    assert fields.index("note") > fields.index("film.speed")


def test_what_the_first_page_names_is_light(http):
    """The same without a browser, of what the page names; not of what its scripts ask for."""
    page = http.get("/").text
    named = set(re.findall(r'(?:src|href)="(/static/[^"]+)"', page))
    assert 1 < len(named) < MOST_REQUESTS
    sent = sum(len(http.get(address).raise_for_status().content) for address in named)
    assert len(page) < sent + len(page) < MOST_BYTES
    assert not any("plotly" in address for address in named)


@pytest.mark.slow
@pytest.mark.usefixtures("plotted")
def test_the_first_page_is_light(watched, http):
    created(http, "paper")
    session = watched.page.context.new_cdp_session(watched.page)
    session.send("Network.enable")
    sizes = []
    session.on("Network.loadingFinished", lambda event: sizes.append(event["encodedDataLength"]))
    watched.open("/", wait_until="load")
    # Pictures that are not drawn yet are asked for again, and drawing all of them takes a slow machine long.
    watched.page.wait_for_load_state("networkidle", timeout=1e3 * patient(120))
    addresses = {address.partition("?again=")[0] for address in watched.requests}
    pictures = {address for address in addresses if address.endswith((".png", "/picture"))}
    assert len(addresses - pictures) < MOST_REQUESTS, addresses
    items = sum(len(http.get(f"/api/v1/{kind}").json()["items"]) for kind in ("designs", "models"))
    assert len(pictures) <= items, "one for each row"
    assert 0 < sum(sizes) < MOST_BYTES
    assert not any("plotly" in address for address in watched.requests)


def test_without_a_script_all_is_readable_and_a_form_saves(plain, http):
    place = created(http, "paper")
    page = plain.page
    plain.open(place)
    expect(page.locator('[data-output="film.minimum_film_thickness"] .number')).to_be_visible()
    expect(page.locator('[data-formula="film.minimum_film_thickness"] math').first).to_be_visible()
    expect(page.locator(".clearance svg").first).to_be_visible()
    page.get_by_label("scale", exact=True).fill("1")
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    settled(http, place)
    page.reload()
    expect(page.locator("[data-design-state]")).to_have_text("current")
    expect(page.locator('[data-parameter="model.inner_diameter"] .comes-to')).to_have_text("50 → 48 mm")
    page.get_by_label("Radial load").fill("25 mm")
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator("#film-radial_load-error")).to_contain_text("a force is wanted")
    plain.open("/templates/third/1")
    page.get_by_label("Whole length").fill("12 mm")
    page.get_by_role("button", name="Calculate").click()
    expect(page.locator('[data-output=".third_of_the_length"] .number')).to_have_text("4")


@pytest.mark.slow
def test_a_template_file_has_its_page_form_formulas_and_report(watched):
    page = watched.page
    watched.open("/")
    page.get_by_role("link", name=re.compile("A third of a length")).click()
    expect(page.locator('[data-formula=".third_of_the_length"] .numbers')).to_contain_text("9")
    expect(page.locator(".formulas").first).to_contain_text("Euclid, book 5")
    page.get_by_label("Whole length").fill("1 m")
    expect(page.locator('[data-output=".third_of_the_length"] .number')).to_have_text("333.33")
    expect(page.locator('[data-formula=".third_of_the_length"] .result')).to_contain_text("333.33")
    watched.open("/")
    if page.locator(".new-design").get_attribute("open") is None:  # it is open where there are no designs yet
        page.locator(".new-design summary").click()
    page.locator(".new-design input[name=name]").fill("thirds")
    page.locator("select[name=template]").select_option("third/1")
    page.locator(".new-design button").click()
    expect(page.get_by_role("heading", level=1)).to_contain_text("thirds: step third")
    expect(page.get_by_label("Whole length")).to_have_value("")  # no value of the example is taken over
    page.get_by_label("Whole length").fill("9 mm")
    page.get_by_role("button", name="Create the design").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("thirds")
    page.get_by_label("Whole length").fill("10 in")
    expect(page.locator('[data-output="third.third_of_the_length"] .number')).to_have_text("84.667")
    assert watched.faults() == []


NUMBERS = (3.2449116, 0.0, -50.0, 1.2e-7, 99999.9, 123456.0, 1e6, 2.5e9, 1e-4, 9.99999e-5, -0.00123456, 1e22)
UNITS = ("mm**2/s", "kJ/(m**3*K)", "degC", "1", "um", "N*s/m", "m**-1", "inch**2", "deg", "ureyn")
QUANTITIES = (
    {"value": 48.0, "unit": "mm"},
    {"value": None, "unit": "1", "reason": "no load"},
    {"value": [1.5, 2.5], "unit": "mm"},
    {"value": [float(n) for n in range(9)], "unit": "deg"},
    {"value": [float((7 * n) % 31) for n in range(31)], "unit": "N"},
    {"value": [[1.0] * 12, [2.0] * 12], "unit": "1"},
    "= scale * 48 mm",
)


@pytest.mark.slow
def test_the_browser_writes_numbers_as_the_server_does(watched):
    watched.open("/")
    script = "async ([numbers, units, quantities]) => { const m = await import('/static/shared/numbers.js');"
    script += "return [numbers.map(m.aligned), units.map(m.unit), quantities.map(m.quantityText)]; }"
    numbers, units, quantities = watched.page.evaluate(script, [list(NUMBERS), list(UNITS), list(QUANTITIES)])
    assert numbers == [list(aligned(number)) for number in NUMBERS]
    assert units == [unit(text) for text in UNITS]
    assert quantities == [python_in_line(quantity) for quantity in QUANTITIES]
