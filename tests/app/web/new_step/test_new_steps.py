"""A new design or step begins empty; suggested links apply only if the user chooses them."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import from_example, settled
from playwright.sync_api import expect
from serving import API

FILM = {
    "Radial load": "25 kN",
    "Diametral clearance": "0.055 mm",
    "Bearing diameter": "48 mm",
    "Bearing width": "18 mm",
    "Speed": "5000 rpm",
    "Oil inlet temperature": "80 degC",
    "Oil outlet temperature": "87.762 degC",
}


@pytest.mark.slow
def test_a_design_begins_empty_and_its_mapping_is_proposed(watched, http):
    page = watched.page
    watched.open("/designs/new?design_name=mine&template=oil_film/1&model=plain_bearing/1")
    values = page.locator("[data-new-step] input:not([type=hidden])").evaluate_all(
        "(all) => all.map((one) => one.value)"
    )
    assert set(values) == {""}
    for label, text in FILM.items():
        page.get_by_label(label, exact=True).fill(text)
    page.get_by_role("button", name="Create the design").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("mine")
    place = page.url.removeprefix(watched.url)
    assert http.get(f"{API}{place}").json()["models"]["model"]["parameters"] == {}
    proposals = page.locator("[data-proposals] li")
    expect(proposals).to_have_count(2)
    expect(proposals.first).to_contain_text("model.inner_diameter = oil_film.bearing_diameter")
    proposals.nth(1).get_by_role("checkbox").uncheck()
    page.get_by_role("button", name="Apply the chosen").click()
    expect(page.locator(".page-head")).to_contain_text("revision 2")
    parameters = settled(http, place)["models"]["model"]["parameters"]
    assert parameters == {"inner_diameter": "= oil_film.bearing_diameter"}
    # What is half typed is refused (422), and the browser reports that.
    assert [fault for fault in watched.faults() if "422" not in str(fault)] == []


def test_a_further_step_begins_empty_and_says_what_is_missing(http):
    place = from_example(http, "oil_film/1")
    chosen = {"add": "template", "template": "journal_friction/1", "revision": "1"}
    form = http.post(f"{place}/blocks", data=chosen).headers["location"]
    assert form.startswith(f"{place}/steps/new?")
    assert http.get(f"{API}{place}").json()["revision"] == 1
    page = http.get(form).text
    assert 'name="journal_friction.speed"' in page
    typed = {**chosen, "journal_friction.speed": "= oil_film.speed"}
    refused = http.post(f"{place}/blocks", data=typed)
    assert refused.status_code == 422
    assert 'value="= oil_film.speed"' in refused.text
    assert 'aria-describedby="journal_friction-journal_diameter-error"' in refused.text
    inputs = {
        "journal_diameter": "= oil_film.journal_diameter",
        "bearing_width": "18 mm",
        "radial_clearance": "27 um",
        "dynamic_viscosity": "= oil_film.dynamic_viscosity",
    }
    whole = {**typed, **{f"journal_friction.{name}": text for name, text in inputs.items()}}
    assert http.post(f"{place}/blocks", data=whole).headers["location"] == place
    assert http.get(f"{API}{place}").json()["steps"]["journal_friction"]["inputs"]["bearing_width"] == "18 mm"


@pytest.mark.slow
def test_a_new_step_takes_limits_and_rows_of_the_library(watched, http):
    page = watched.page
    watched.open("/designs/new?design_name=limited&template=oil_film/2")
    page.get_by_text("More inputs").click()
    for label, text in FILM.items():
        page.get_by_label(label, exact=True).fill(text)
    page.get_by_text("Limits of the criteria (7)").click()
    page.get_by_label("Bearing material", exact=True).select_option("tin_babbitt_b23_2")
    page.get_by_label("Smallest film that its user permits").fill("2 um")
    page.get_by_role("button", name="Create the design").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("limited")
    limits = {"bearing_material": "tin_babbitt_b23_2", "permissible_film": "2 um"}
    design = http.get(f"{API}{page.url.removeprefix(watched.url)}").json()
    assert design["steps"]["oil_film"]["limits"] == limits
    expect(page.locator("select[name='oil_film@limits.bearing_material']")).to_have_value("tin_babbitt_b23_2")
    assert '<option value="0.25 um">N4, Ra 0.2 um</option>' in page.content()
    assert [fault for fault in watched.faults() if "422" not in str(fault)] == []  # half typed


def test_a_refused_limit_of_a_new_step_keeps_what_was_typed(http):
    typed = {"design_name": "refused", "template": "oil_film/2", "oil_film@limits.permissible_film": "2 s"}
    refused = http.post("/designs", data=typed)
    assert refused.status_code == 422
    assert re.search(r'name="oil_film@limits.permissible_film"[^>]* value="2 s"', refused.text)
    assert re.search(r'id="oil_film@limits-permissible_film-error"><bdi>[^<]*measures', refused.text)
    assert '<details class="more" open><summary>Limits of the criteria (7)' in refused.text


@pytest.mark.slow
def test_a_new_step_has_the_dialogs_of_a_design_and_counts_its_faults_while_typing(watched, http):
    """Names of the other steps are completed; a fault goes when its value is mended."""
    place = from_example(http, "oil_film/1")
    page = watched.page
    watched.open(f"{place}/steps/new?add=template&template=journal_friction/1&name=friction")
    speed, state = page.locator("[name='friction.speed']"), page.locator("[data-new-step] [data-state]")
    speed.fill("25 kg")
    beside = page.locator("#friction-speed-error")
    expect(beside).to_contain_text("kg")
    expect(state).to_contain_text("1 wrong")
    speed.fill("= oil_film.spee")
    expect(page.locator("#completions")).to_contain_text("oil_film.speed")
    page.keyboard.press("Enter")
    expect(speed).to_have_value("= oil_film.speed")
    expect(beside).to_be_hidden()
    expect(state).not_to_contain_text("wrong")
    expect(state).to_contain_text("missing")
    page.locator("[data-pick-for='friction.speed']").click()
    expect(page.locator("[data-picker]")).to_be_visible()
    page.keyboard.press("Escape")


@pytest.mark.slow
def test_a_new_design_takes_lists_as_people_type_them(watched):
    page = watched.page
    watched.open("/designs/new?design_name=four&template=engine/1")
    page.locator("[name='engine.firing_order']").evaluate(
        "(field) => { field.value = '1-3-4-2'; field.dispatchEvent(new Event('input', { bubbles: true })); }"
    )
    state = page.locator("[data-new-step] [data-state]")
    expect(state).to_contain_text("missing")
    expect(page.locator("#engine-firing_order-error")).to_be_hidden()
    expect(page.locator("[data-list='engine.firing_order'] [data-paste-table]")).to_be_attached()
    assert Axe().run(page, options={"resultTypes": ["violations"]}).response["violations"] == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("positions", "shown"),
    [
        ("0 88 176 264 mm", "1-3-4-2 (in-line four)"),
        ("0 0 90 90 180 180 mm", "1-2-3-4-5-6 (V6, 60°"),
    ],
)
def test_a_firing_order_is_proposed_for_as_many_cylinders_as_are_typed(watched, positions, shown):
    page = watched.page
    watched.open("/designs/new?design_name=four&template=engine/1")
    order = page.locator("[name='engine.firing_order']")
    expect(order).to_have_attribute("placeholder", "such as [1, 2]")
    field = page.locator("[name='engine.cylinder_positions']")
    field.fill(positions)
    expect(order).to_have_attribute("placeholder", re.compile(re.escape(shown)))
    field.fill("")
    expect(order).to_have_attribute("placeholder", "such as [1, 2]")
