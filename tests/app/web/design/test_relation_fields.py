"""Relation fields complete names, a picker offers all values, and a drawing shows what drives what."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import settled
from playwright.sync_api import expect
from serving import API

BORE, LIST = "[name='model.inner_diameter']", "#completions"
BESIDE = f"""() => {{
  const list = document.querySelector("{LIST}").getBoundingClientRect();
  const field = document.querySelector("{BORE}").getBoundingClientRect();
  return list.top >= field.bottom || list.bottom <= field.top;
}}"""
OPTION = f"{LIST} [role=option]"


def field(page, name):
    return page.locator(f"[name='{name}']")


@pytest.fixture
def opened(watched, paper):
    """The paper's design, open and ready."""
    watched.open(paper)
    expect(watched.page.locator(f"{BORE}[role=combobox]")).to_be_visible()
    yield watched.page
    # The service refuses what is half typed (422), and the browser reports that.
    assert [fault for fault in watched.faults() if "422" not in str(fault)] == []


@pytest.mark.slow
def test_a_relation_completes_its_names_by_keyboard(opened):
    bore = field(opened, "model.inner_diameter")
    bore.fill("")
    expect(bore).to_have_attribute("aria-expanded", "false")
    bore.press_sequentially("= film.bearing")
    expect(bore).to_have_attribute("aria-expanded", "true")
    first = opened.locator(OPTION).first
    expect(first).to_contain_text("film.bearing_diameter")
    expect(first).to_contain_text("mm")
    expect(first).to_have_attribute("aria-selected", "true")
    assert bore.get_attribute("aria-activedescendant") == first.get_attribute("id")
    bore.press("ArrowDown")
    expect(opened.locator(OPTION).nth(1)).to_have_attribute("aria-selected", "true")
    bore.press("ArrowUp")
    bore.press("Enter")
    expect(bore).to_have_value("= film.bearing_diameter")
    expect(opened.locator(LIST)).to_be_hidden()
    bore.press_sequentially(" + 2 mm")
    expect(opened.locator(LIST)).to_be_hidden()
    bore.press_sequentially(" + mod")
    expect(opened.locator(OPTION).first).to_contain_text("model.")
    bore.press("Escape")
    expect(opened.locator(LIST)).to_be_hidden()
    expect(bore).to_have_value("= film.bearing_diameter + 2 mm + mod")
    expect(bore).to_be_focused()
    bore.press_sequentially("e")
    bore.press("Tab")
    expect(bore).to_have_value(re.compile(r"\+ 2 mm \+ model\.\w+$"))


@pytest.mark.slow
def test_names_of_the_same_kind_come_first_and_a_click_takes_one(opened):
    load = field(opened, "film.radial_load")
    load.fill("= ")
    expect(opened.locator(OPTION).first).to_be_visible()
    classes = opened.locator(OPTION).evaluate_all("(all) => all.map((one) => one.className)")
    assert classes == sorted(classes)
    names = opened.locator(f"{OPTION} code").all_inner_texts()
    assert "film.minimum_film_thickness" not in names, "the step itself computes it"
    assert "film.radial_load" not in names
    load.fill("= sca")
    opened.locator(OPTION).first.click()
    expect(load).to_have_value("= scale")
    expect(load).to_be_focused()


@pytest.mark.slow
def test_no_list_appears_where_no_name_may_stand(opened):
    texts = {"25 kN": -1, "= 48 m": -1, "= 4": -1, "= scale ": -1, "= sc": 2, "= 2 * f": 6, "= max(": 6}
    script = "async (text) => (await import('/static/design/names.js')).startOfName(text, text.length)"
    assert {text: opened.evaluate(script, text) for text in texts} == texts
    load = field(opened, "film.radial_load")
    load.fill("25 kN")
    expect(opened.locator(LIST)).to_be_hidden()


@pytest.mark.slow
def test_the_picker_shows_values_by_block_and_inserts_at_the_caret(opened):
    bore = field(opened, "model.inner_diameter")
    bore.fill("48 mm")
    opened.locator("[data-pick-for='model.inner_diameter']").click()
    dialog = opened.locator("[data-picker]")
    expect(dialog).to_be_visible()
    expect(dialog.get_by_label("Filter by name or words")).to_be_focused()
    assert dialog.locator("h3").all_inner_texts()[0] == "film"
    expect(dialog.locator("[data-pick='model.low_x']")).to_have_count(0)  # it follows from the field
    shown = dialog.locator("[data-pick='film.bearing_diameter']")
    expect(shown).to_contain_text(re.compile(r"^bearing_diameter50 mm"))
    expect(dialog.locator("[data-pick='film.radial_load']")).to_have_count(0)
    dialog.get_by_label("only what fits").uncheck()
    expect(dialog.locator("[data-pick='film.radial_load']")).to_have_count(1)
    dialog.get_by_label("Filter by name or words").fill("bearing_diam")
    expect(dialog.locator("[data-pick]")).to_have_count(1)
    shown.click()
    expect(dialog).to_be_hidden()
    expect(bore).to_have_value("= film.bearing_diameter")
    expect(bore).to_be_focused()
    bore.fill("= 2 *  + 1 mm")
    bore.evaluate("(one) => one.setSelectionRange(6, 6)")
    bore.press("Alt+ArrowDown")
    dialog.get_by_label("Filter by name or words").fill("bearing_diam")
    dialog.get_by_label("Filter by name or words").press("Enter")
    expect(bore).to_have_value("= 2 * film.bearing_diameter + 1 mm")
    bore.press("Alt+ArrowDown")
    expect(dialog).to_be_visible()
    opened.keyboard.press("Escape")
    expect(dialog).to_be_hidden()
    expect(bore).to_have_value("= 2 * film.bearing_diameter + 1 mm")


@pytest.mark.slow
def test_values_of_the_picker_are_those_of_the_last_preview(opened):
    field(opened, "film.radial_load").fill("12.5 kN")
    expect(opened.locator("[data-state]")).to_contain_text("not saved")
    field(opened, ".scale").focus()
    opened.keyboard.press("Alt+ArrowDown")
    expect(opened.locator("[data-pick='film.radial_load']")).to_contain_text("12.5 kN")
    expect(opened.locator("[data-pick='model.low_x']")).to_contain_text(re.compile(r"−45(\.\d+)? mm"))


@pytest.mark.slow
def test_the_drawing_links_to_steps_and_says_the_same_as_a_list(opened):
    panel = opened.locator("[data-drives]")
    assert panel.get_attribute("open") is None
    panel.locator("summary").click()
    listed = panel.locator(".drives-list li").all_inner_texts()
    assert "model.inner_diameter ← film.bearing_diameter" in listed
    assert panel.locator("path.wire").count() == len(listed)
    opened.locator("[data-fold=film] > summary").click()
    expect(opened.locator("[data-fold=film]")).not_to_have_attribute("open", "")
    panel.locator("[data-block=film] a").click()
    expect(opened.locator("[data-fold=film]")).to_have_attribute("open", "")


@pytest.mark.slow
def test_a_narrow_page_scrolls_the_drawing_inside_its_panel(browser, served, paper):
    context = browser.new_context(viewport={"width": 390, "height": 844}, color_scheme="dark")
    page = context.new_page()
    page.goto(served.url + paper)
    expect(page.locator(f"{BORE}[role=combobox]")).to_be_attached()
    page.locator("[data-drives] summary").click()
    region = page.locator("[data-drives] .scroll")
    assert region.evaluate("(one) => one.scrollWidth > one.clientWidth")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    bore = page.locator(BORE)
    bore.fill("= film.")
    expect(page.locator("[id='model-inner_diameter-error']")).to_be_visible()  # it moves the field
    page.wait_for_function(BESIDE)
    box = page.locator(LIST).bounding_box()
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 390
    violations = Axe().run(page, options={"runOnly": ["wcag2a", "wcag2aa"]}).response["violations"]
    assert [(rule["id"], [node["target"] for node in rule["nodes"]]) for rule in violations] == []
    bore.press("Alt+ArrowDown")
    box = page.locator("[data-picker]").bounding_box()
    assert box["x"] + box["width"] <= 390
    violations = Axe().run(page, options={"runOnly": ["wcag2a", "wcag2aa"]}).response["violations"]
    assert [(rule["id"], [node["target"] for node in rule["nodes"]]) for rule in violations] == []
    context.close()


@pytest.mark.slow
def test_a_design_without_relations_has_no_drawing(http):
    design = http.post(f"{API}/designs", json={"name": "alone", "parameters": {"scale": "1"}}).json()
    settled(http, f"/designs/{design['id']}")
    assert "data-drives" not in http.get(f"/designs/{design['id']}").text
