"""The worksheet of a design in its page: lines are typed, previewed, marked, saved, plotted and completed."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import created
from playwright.sync_api import expect
from serving import API

from templates.core.sheets.design_lines import NOT_IN_DESIGNS

LINE = 'r [1] = film.minimum_film_thickness / 2 um "film ratio"'


@pytest.fixture
def design(http):
    return created(http, "paper")


def text_of(page):
    return page.locator("#own-lines-text")


def opened(watched, design):
    watched.open(design)
    expect(watched.page.locator("[data-state]").first).not_to_have_text("saving …")
    section = watched.page.locator("[data-own-lines]")
    if section.get_attribute("open") is None:
        section.locator("summary").first.click()
    return watched.page


@pytest.mark.slow
def test_lines_are_previewed_saved_and_in_the_verdict(watched, http, design):
    page = opened(watched, design)
    text_of(page).fill(f'{LINE}\ncheck r >= 3 "enough film"')
    rows = page.locator("[data-own-lines] .typeset-line")
    expect(rows).to_have_count(2)
    expect(rows.first.locator(".line-value")).to_contain_text("1.73")
    expect(rows.nth(1).locator(".tag")).to_have_text("not met")
    expect(page.locator("[data-draft]")).to_be_visible()
    page.locator("[data-save]").click()
    expect(page.locator("h1 ~ p a").first).to_have_text("revision 2")
    expect(text_of(page)).to_have_value(f'{LINE}\ncheck r >= 3 "enough film"')
    expect(page.locator("[data-draft]")).to_be_hidden()
    answer = http.get(f"{API}{design}", headers={"Accept": "application/json"}).json()
    assert answer["worksheet"].startswith(LINE)
    assert "worksheet.film_ratio" in answer["results"]["outputs"]
    page.locator('[data-verdict-inside] a[href="#step-worksheet"]').first.evaluate("link => link.click()")
    expect(text_of(page)).to_be_in_viewport()
    assert watched.faults() == []
    assert Axe().run(page).response["violations"] == []


@pytest.mark.slow
def test_a_fault_is_marked_in_its_line_and_goes_when_it_is_mended(watched, design):
    page = opened(watched, design)
    text_of(page).fill(f'{LINE}\nq [mm] = film.minimum_film_thickness * r + 1 N "sum"')
    fault = page.locator("[data-own-lines] .typeset-line .field-error")
    expect(fault).to_contain_text("Line 2, column")
    expect(page.locator("[data-lines-faults]")).to_have_text("1 fault")
    expect(page.locator("[data-own-lines] .underline")).to_have_count(1)
    assert Axe().run(page, "[data-own-lines]").response["violations"] == []
    text_of(page).fill(LINE)
    expect(fault).to_have_count(0)
    expect(page.locator("[data-lines-faults]")).to_have_text("")
    expect(page.locator("[data-own-lines] .line-value")).to_have_count(1)


@pytest.mark.slow
def test_names_of_the_design_are_completed_in_a_line(watched, design):
    page = opened(watched, design)
    area = text_of(page)
    expect(area).to_have_attribute("aria-controls", "completions")
    area.press_sequentially("r [1] = film.minimum")
    option = page.locator("#completions [role=option]").first
    expect(option).to_contain_text("film.minimum_film_thickness")
    area.press("Enter")
    expect(area).to_have_value("r [1] = film.minimum_film_thickness")


@pytest.mark.slow
def test_completion_offers_the_statements_that_a_design_takes(watched, design):
    page = opened(watched, design)
    area, options = text_of(page), page.locator("#completions [role=option]")
    for statement in ("check", "curve", "plot", "solve"):
        area.fill("")
        area.press_sequentially(statement[:2])
        expect(options.first).to_contain_text(statement)
    for statement in NOT_IN_DESIGNS:
        area.fill("")
        area.press_sequentially(statement[:3])
        expect(page.locator("#completions"), statement).to_be_hidden()
    area.fill("")
    for typed in ("plot film.minimum_film", " ov", " film.minimum_film"):
        area.press_sequentially(typed)
        expect(page.locator("#completions"), typed).to_be_visible()
        area.press("Enter")
    expect(area).to_have_value("plot film.minimum_film_thickness over film.minimum_film_thickness")


@pytest.mark.slow
def test_nothing_is_wider_than_a_narrow_screen(watched, design):
    watched.page.set_viewport_size({"width": 390, "height": 844})
    page = opened(watched, design)
    text_of(page).fill(f"{LINE}\nplot r over film.minimum_film_thickness")
    expect(page.locator("[data-line-plots] figcaption")).to_contain_text("no plot, because")
    width = page.evaluate("document.documentElement.scrollWidth")
    assert width <= 390


@pytest.mark.slow
def test_without_scripts_the_form_saves_the_lines(plain, http, design):
    plain.open(design)
    page = plain.page
    page.locator("[data-own-lines] summary").first.click()
    text_of(page).fill(LINE)
    page.locator("[data-save]").click()
    expect(page.locator("[data-own-lines] .line-value")).to_contain_text("1.73")
    text_of(page).fill("q [mm] = nothing_here")
    page.locator("[data-save]").click()
    expect(page.locator("body")).to_contain_text("Nothing was saved")
    expect(text_of(page)).to_have_value("q [mm] = nothing_here")
