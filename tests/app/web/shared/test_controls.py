"""Form controls have labels and handle typed values, in a browser."""

import json
import re
from types import SimpleNamespace

import pytest
from browsing import from_example
from playwright.sync_api import expect

from app.web.shared.forms import patch_of

PATIENCE = 60_000  # for a design to be saved [ms]
HEADERS = {"Prefer": "wait=60"}
SUM = '[data-output="awkward.awkward_sum"] .number'
NAMES = ("length", "item", "constructor", "elements", "note", "dataset", "revision", "was", "level")


@pytest.fixture
def awkward(http):
    """The path of a design whose parameters and inputs are called like parts of a form of HTML."""
    inputs = {name: f"= {name}" for name in ("length", "dataset", "level", "elements")}
    document = {
        "name": "awkward",
        "parameters": {name: f"{place} mm" for place, name in enumerate(NAMES, 1)},
        "steps": {"awkward": {"template": "awkward", "version": 1, "inputs": inputs}},
    }
    response = http.post("/api/v1/designs", json=document, headers=HEADERS)
    assert response.status_code == 201, response.text
    return f"/designs/{response.json()['id']}"


def save(page, revision):
    page.get_by_role("button", name=re.compile("Save as revision")).click()
    expect(page.locator(".page-head")).to_contain_text(f"revision {revision}", timeout=PATIENCE)


@pytest.mark.slow
def test_parameters_called_like_parts_of_a_form_are_previewed_and_saved(watched, http, awkward):
    page = watched.page
    watched.open(awkward)
    expect(page.locator(SUM)).to_have_text("20")
    for name in NAMES:
        page.get_by_label(name, exact=True).first.fill("5 mm")
    expect(page.locator(SUM)).to_have_text("20")
    page.get_by_label("elements", exact=True).first.fill("6 mm")
    expect(page.locator(SUM)).to_have_text("21")
    expect(page.locator('[data-value="awkward.elements"]')).to_have_text("= 6 mm")
    save(page, 2)
    answer = http.get(f"/api/v1{awkward}").json()
    assert answer["parameters"] == {**dict.fromkeys(NAMES, "5 mm"), "elements": "6 mm"}
    assert watched.faults() == []


@pytest.mark.slow
def test_faults_stand_beside_inputs_with_awkward_names(watched, awkward):
    page = watched.page
    watched.open(awkward)
    page.locator('[name=".note"]').fill("3 mm +")
    expect(page.locator("[id='-note-error']")).to_be_visible()
    page.locator('[name=".note"]').fill("3 mm")
    page.locator('[name="awkward.level"]').fill("3 kN")
    expect(page.locator("[id='awkward-level-error']")).to_contain_text("a length is wanted")


@pytest.mark.slow
def test_faults_of_options_stand_beside_them(watched, http):
    place = from_example(http, "oil_film/2")
    for path in (place, "/templates/oil_film/2"):
        watched.open(path)
        watched.page.get_by_label("or largest error").fill("5")
        expect(watched.page.locator('[id$="@tolerance-error"]')).to_contain_text("less than 1")


def test_a_template_page_keeps_bare_names_of_inputs(watched):
    page = watched.page
    watched.open("/templates/awkward/1?length=1+mm&dataset=2+mm&level=3+mm&elements=5+mm")
    total = page.locator('[data-output=".awkward_sum"] .number')
    expect(total).to_have_text("11")
    page.get_by_label("Level", exact=True).fill("4 mm")
    expect(total).to_have_text("12")
    expect(page).to_have_url(re.compile("level=4"))
    assert watched.faults() == []


def test_options_of_a_template_are_kept_apart_from_its_inputs(http):
    page = http.get("/templates/oil_film/2?units=si").text
    assert 'name="@level"' in page
    refused = http.get("/templates/oil_film/2", params={"@level": "none such", "@tolerance": "[1]"})
    assert refused.status_code == 422
    assert re.search(r'id="@(level|tolerance)-error"><bdi>[^<]', refused.text)


def test_options_of_a_step_are_saved_and_their_faults_shown_beside_them(http):
    place = from_example(http, "oil_film/2")
    for typed in ("inf", "[1]", "small"):
        wrong = http.post(place, data={"revision": "1", "was": "{}", "oil_film@tolerance": typed})
        assert wrong.status_code == 422
        assert re.search(r'id="oil_film@tolerance-error"><bdi>[^<]', wrong.text), typed
        assert f'value="{typed}"' in wrong.text
    wrong = http.post(place, data={"revision": "1", "was": "{}", "oil_film@level": "fast"})
    assert re.search(r'id="oil_film@level-error"><bdi>[^<]', wrong.text)
    http.post(place, data={"revision": "1", "was": "{}", "oil_film@tolerance": "0.05"})
    assert http.get(f"/api/v1{place}").json()["steps"]["oil_film"]["tolerance"] == 0.05


TYPED = {
    ".scale": "1",
    "film@level": "fast",
    "film@tolerance": "0.01",
    "film.level": "3 mm",
    "film.length": "",
    "model.inner_diameter": "[1, 2] mm",
}


def test_the_browser_makes_the_same_patch_as_the_server(watched):
    design = SimpleNamespace(parameters={"scale"}, steps={"film"}, models={"model"})
    watched.open("/worksheets/new")  # a page that draws no pictures of designs
    script = (
        "async ([typed, models]) => (await import('/static/shared/typed.js')).patchOf(typed, new Set(models))"
    )
    for typed in (TYPED, {"film@tolerance": "[1]"}, {"film@tolerance": "inf"}, {"film@level": ""}):
        was = json.dumps(dict.fromkeys((name for name, text in typed.items() if not text), "before"))
        assert watched.page.evaluate(script, [typed, ["model"]]) == patch_of(design, {**typed, "was": was})


@pytest.mark.slow
def test_a_fault_is_a_link_to_its_field(watched, http):
    watched.open(from_example(http, "oil_film/1"))
    page = watched.page
    page.get_by_label("Radial load").fill("25 mm")
    link = page.locator("[data-state] a")
    expect(link).to_have_text("oil film.radial load")
    page.evaluate("scrollTo(0, document.body.scrollHeight)")
    page.locator('[data-fold="oil_film"]').evaluate("(fold) => { fold.open = false; }")
    link.click()
    expect(page.get_by_label("Radial load")).to_be_focused()
    expect(page.get_by_label("Radial load")).to_be_in_viewport()


@pytest.mark.slow
def test_a_decimal_comma_is_accepted_where_the_language_of_the_browser_has_one(browser, served):
    context = browser.new_context(locale="de-DE")
    page = context.new_page()
    page.goto(f"{served.url}/templates/third/1")
    length, third = (
        page.get_by_label("Whole length"),
        page.locator('[data-output=".third_of_the_length"] .number'),
    )
    length.fill("10,5 mm")
    expect(third).to_have_text("3.5")
    page.get_by_role("button", name="Calculate").click()
    expect(length).to_have_value("10.5 mm")
    expect(third).to_have_text("3.5")
    points = "(texts) => import('/static/shared/typed.js').then(({ withPoints }) => texts.map(withPoints))"
    texts = ["0,5 ± 0,1 kN", "0,5 0,6 mm", "= max(0,5)", "[1,2] mm", "1,000,000 N", "1,5.2", "SAE 30"]
    assert page.evaluate(points, texts) == ["0.5 ± 0.1 kN", "0.5 0.6 mm", *texts[2:]]
    context.close()


@pytest.mark.slow
def test_the_decimal_sign_is_chosen_at_the_top_and_the_next_page_keeps_it(watched):
    page = watched.page
    watched.open("/templates/third/1")
    length = page.get_by_label("Whole length")
    third = page.locator('[data-output=".third_of_the_length"] .number')
    expect(page.get_by_role("button", name="0.5")).to_have_attribute("aria-pressed", "true")
    page.get_by_role("button", name="0,5").click()
    expect(page.get_by_role("button", name="0,5")).to_have_attribute("aria-pressed", "true")
    length.fill("10,5 mm")
    expect(third).to_have_text("3.5")
    watched.open("/templates/third/1")
    page.get_by_label("Whole length").fill("0,6 mm")
    expect(third).to_have_text("0.2")
    points = "(texts) => import('/static/shared/typed.js').then(({ withPoints }) => texts.map(withPoints))"
    lists = ["[0,5; 0,7] mm", "0 0,5 1 mm", "0,5; -0,7 mm", "1-3-4-2", "[1,2] mm", "1,500 kg"]
    read = ["[0.5; 0.7] mm", "0 0.5 1 mm", "0.5; -0.7 mm", "1-3-4-2", "[1,2] mm", "1.500 kg"]
    assert page.evaluate(points, lists) == read
    page.get_by_role("button", name="0.5").click()
    assert page.evaluate(points, lists) == lists
    assert watched.faults() == []
