"""In a browser, a newcomer gets from the gallery to a STEP file."""

import re
import shutil
import subprocess
from math import hypot

import pytest
from browsing import created as created_by_http
from playwright.sync_api import expect
from serving import moody

from cad.inspect import look_at
from cad.step import read_step
from cad.surfaces import Z

PART = "document.querySelector('.solid .js-plotly-plot')"
PDF_TO_TEXT = shutil.which("pdftotext")
PATIENCE = 60_000  # for a part to be built [ms]


def created(watched, example="paper"):
    """The design page of an example, its part drawn."""
    page = watched.page
    watched.open("/")
    page.locator(f'button[data-example="{example}"]').click()
    expect(page.locator("[data-design-state]")).to_have_text("current", timeout=PATIENCE)
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    return page


def width(page):
    """How wide the part is that is drawn [mm]."""
    script = f"Array.from({PART}.data).flatMap((trace) => Array.from(trace.x))"
    across = page.evaluate(script)
    return max(across) - min(across)


def film(page):
    return page.locator('[data-output="film.minimum_film_thickness"] .number').text_content()


def parameter(page, name):
    return page.locator(f'[data-parameter="{name}"] .comes-to')


def save(page, revision):
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator(".page-head")).to_contain_text(f"revision {revision}", timeout=PATIENCE)
    expect(page.locator("[data-design-state]")).to_have_text("current", timeout=PATIENCE)


@pytest.mark.parametrize("is_drawn", [False, pytest.param(True, marks=pytest.mark.slow)])
@pytest.mark.skipif(not PDF_TO_TEXT, reason="needs Debian's package poppler-utils, which reads the PDF")
def test_the_paper_in_a_browser(watched, tmp_path, is_drawn):
    assert watched.plotted == is_drawn
    page = created(watched)
    expect(parameter(page, "model.inner_diameter")).to_have_text("50 mm")
    assert abs(width(page) - 90) < 0.2
    before = film(page)

    page.get_by_label("scale", exact=True).fill("1")
    expect(parameter(page, "model.inner_diameter")).to_contain_text("50 → 48 mm")
    expect(page.locator("[data-draft]")).to_be_visible()
    expect(page.locator('[data-output="film.minimum_film_thickness"] .number')).not_to_have_text(before)
    assert film(page) == "3.2449"
    expect(page.locator('[data-formula="film.minimum_film_thickness"] .result')).to_contain_text("3.2449")

    load = page.get_by_label("Radial load")
    load.fill("25 mm")
    message = page.locator("#film-radial_load-error")
    expect(message).to_contain_text("a force is wanted")
    assert load.get_attribute("aria-describedby") == "film-radial_load-error"
    load.fill("25 kN")
    expect(message).to_be_hidden()

    page.get_by_placeholder("reason for the change").fill("the size of the paper")
    save(page, 2)
    expect(parameter(page, "model.inner_diameter")).to_have_text("50 → 48 mm")
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    assert abs(width(page) - 88) < 0.2
    expect(page.locator(".history")).to_contain_text("the size of the paper")

    with page.expect_download() as download:
        page.get_by_role("link", name="STEP", exact=True).click()
    download.value.save_as(tmp_path / "bearing.step")
    step = (tmp_path / "bearing.step").read_bytes()
    assert step_diameters(step) >= {48.0, 88.0}

    paper = page.request.get(
        watched.url + page.get_by_role("link", name="PDF", exact=True).get_attribute("href")
    ).body()
    for text in ("25 kN", "= scale * 48 mm", "Minimum film thickness", "= 47.945 mm", "= 3.2449 µm"):
        assert text in words_of(paper)
    page.get_by_role("link", name="Open the report").click()
    expect(page.locator("body")).to_contain_text("3.2449")
    expect(page.locator("math").first).to_be_visible()
    assert [fault for fault in watched.faults() if "422" not in str(fault)] == []


def words_of(pdf: bytes) -> str:
    """The text of a PDF, its blanks made one each."""
    assert PDF_TO_TEXT
    printed = subprocess.run([PDF_TO_TEXT, "-layout", "-", "-"], input=pdf, capture_output=True, check=True)
    return " ".join(printed.stdout.decode().split())


def step_diameters(step: bytes) -> set[float]:
    """The diameters of all cylinders about the shaft in a STEP file [mm]."""
    return {round(size, 6) for seen in look_at(read_step(step)).values() for size in seen.diameters(Z)}


@pytest.mark.slow
def test_what_is_not_saved_survives_a_reload_and_can_be_discarded(watched):
    page = created(watched)
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator("[data-state]")).to_have_text("nothing has changed")
    page.get_by_label("Radial load").fill("31 kN")
    page.keyboard.press("Enter")  # calculates, and saves nothing
    expect(page.locator("[data-draft-text]")).to_have_text("film.radial load")
    page.reload()
    expect(page.get_by_label("Radial load")).to_have_value("31 kN")
    expect(page.locator("[data-draft]")).to_be_visible()
    page.get_by_role("button", name="Discard").click()
    expect(page.get_by_label("Radial load")).to_have_value("25 kN")
    expect(page.locator("[data-draft]")).to_be_hidden()
    assert watched.faults() == []


@pytest.mark.slow
def test_a_change_by_somebody_else_is_shown_and_ours_is_kept(watched, http):
    page = created(watched)
    place = page.url.removeprefix(watched.url)
    page.get_by_label("Radial load").fill("31 kN")
    patch = {"steps": {"film": {"inputs": {"speed": "4000 rpm"}}}}
    http.patch(f"/api/v1{place}", json=patch, headers={"If-Match": '"1"', "Prefer": "wait=30"})
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator("[data-trouble]")).to_contain_text("Somebody else saved")
    page.get_by_role("button", name="Show the newest").click()
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    expect(page.get_by_label("Speed", exact=True)).to_have_value("4000 rpm")
    expect(page.get_by_label("Radial load")).to_have_value("31 kN")
    page.keyboard.press("Control+s")
    expect(page.locator(".page-head")).to_contain_text("revision 3")
    inputs = http.get(f"/api/v1{place}").json()["steps"]["film"]["inputs"]
    assert (inputs["radial_load"], inputs["speed"]) == ("31 kN", "4000 rpm")


@pytest.mark.slow
@pytest.mark.usefixtures("plotted")
def test_the_pressure_is_painted_on_the_bore(watched):
    page = created(watched, "shell")
    page.get_by_label("show the film pressure").check()
    expect(page.locator(".solid .colours")).to_contain_text("MPa")
    x, y = (page.evaluate(f"{PART}.data.at(-1).{axis}[8].find((value) => value !== null)") for axis in "xy")
    assert "film pressure" in page.evaluate(f"{PART}.data.map((trace) => trace.name)")
    radius = hypot(x, y)
    assert abs(radius - 24) < 0.2
    page.get_by_label("show the film pressure").uncheck()
    expect(page.locator(".solid .colours")).to_have_count(0)
    assert "film pressure" not in page.evaluate(f"{PART}.data.map((trace) => trace.name)")
    most = f"Math.max(...{PART}.data.at(-1).surfacecolor.flat())"
    page.get_by_label("show the film pressure").check()
    expect(page.locator(".solid .colours")).to_be_visible()
    megapascals = page.evaluate(most)
    page.goto(f"{page.url}?units=us")
    page.get_by_label("show the film pressure").check()
    expect(page.locator(".solid .colours")).to_contain_text("psi")
    assert abs(page.evaluate(most) / megapascals - 145.0377) < 1e-3
    x, y = (page.evaluate(f"{PART}.data.at(-1).{axis}[8].find((value) => value !== null)") for axis in "xy")
    assert abs(hypot(x, y) - radius) < 0.1
    assert watched.faults() == []


@pytest.mark.slow
def test_the_pressure_is_painted_although_its_switch_was_pressed_before_its_script_came(watched, http):
    """A second press after the script came takes the pressure away again."""
    page, held = watched.page, []
    place = created_by_http(http, "shell")
    page.route("**/static/design/design.js", lambda route: held.append(route))
    with page.expect_request("**/static/design/design.js"):
        watched.open(place, wait_until="commit")
    switch = page.get_by_label("show the film pressure")
    switch.check()
    assert len(held) == 1
    for route in held:
        route.continue_()
    expect(page.locator(".solid .colours")).to_contain_text("MPa", timeout=PATIENCE)
    assert page.evaluate(f"{PART}.data.map((trace) => trace.name)").count("film pressure") == 1
    switch.uncheck()
    expect(page.locator(".solid .colours")).to_have_count(0)
    assert "film pressure" not in page.evaluate(f"{PART}.data.map((trace) => trace.name)")
    assert watched.faults() == []


@pytest.mark.slow
def test_a_pressure_that_cannot_be_shown_says_why(watched, http):
    page = watched.page
    watched.open(created_by_http(http, "shell"))
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    refusal = {"detail": "no answer today"}
    page.route("**/film-pressure*", lambda route: route.fulfill(status=503, json=refusal))
    page.get_by_label("show the film pressure").check()
    expect(page.locator("[data-said]")).to_have_text("The film pressure cannot be shown: no answer today")


@pytest.mark.slow
def test_the_back_button_and_deep_links(watched):
    page = created(watched)
    place = page.url
    page.get_by_role("link", name="revision 1", exact=True).click()
    expect(page.get_by_role("heading", level=1)).to_contain_text("Revision 1")
    page.go_back()
    assert page.url == place
    page.get_by_role("link", name="inner diameter", exact=True).click()
    expect(page.locator(".tree")).to_contain_text("= scale * 48 mm")
    watched.open("/templates/oil_film/1")
    page.get_by_label("Radial load").fill("12 kN")
    expect(page).to_have_url(re.compile("radial_load=12"))
    page.reload()
    expect(page.get_by_label("Radial load")).to_have_value("12 kN")
    assert watched.faults() == []


@pytest.mark.slow
def test_long_work_shows_its_progress_and_can_be_cancelled(watched, http):
    design = http.post("/api/v1/designs", json=moody(), headers={"Prefer": "wait=60"}).json()
    page = watched.page
    watched.open(f"/designs/{design['id']}")
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    page.get_by_label("Mood").select_option("loops")
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    progress = page.locator("[data-progress]")
    expect(progress).to_be_visible()
    expect(progress.locator("progress")).to_be_visible()
    progress.get_by_role("button", name="Cancel").click()
    expect(page.locator("[data-design-state]")).to_have_text("failed")
    expect(page.locator(".page-head")).to_contain_text("The last good part stays below")
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    assert watched.faults() == []
