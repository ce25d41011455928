"""The page of a long design shows few steps in full and fetches the others when opened."""

import re

import pytest
from playwright.sync_api import expect
from serving import API, created

from app.calculations.bodies import OIL_FILM
from app.web.design.sections import MOST_IN_FULL


def films(http, count):
    step = {"template": "oil_film", "version": 1}
    steps = {
        f"film_{n}": {**step, "inputs": {**OIL_FILM, "radial_load": f"{20 + n} kN"}} for n in range(count)
    }
    return f"/designs/{created(http, {'name': f'{count} films', 'steps': steps})['id']}"


@pytest.fixture
def long(http):
    return films(http, MOST_IN_FULL + 1)


def sections(http, place, **query):
    """The sections of a page by their steps."""
    page = http.get(place, params=query).raise_for_status().text
    parts = re.split(r'(?=<section class="sheet step")', page)[1:]
    return {re.search('data-step="([^"]*)"', part)[1]: part.partition("</section>")[0] for part in parts}


def is_full(section):
    return 'name="' in section and 'class="formulas"' in section


def test_up_to_twelve_steps_are_all_in_full(http):
    assert all(map(is_full, sections(http, films(http, MOST_IN_FULL)).values()))


def test_a_folded_step_has_its_main_results_and_a_link(http, long):
    shown = sections(http, long)
    assert set(shown) == {f"film_{n}" for n in range(MOST_IN_FULL + 1)}
    (first,) = [name for name, section in shown.items() if is_full(section)]
    for name, section in shown.items():
        assert f'data-key="{name}.' in section
        if name != first:
            assert f'<a href="{long}?step={name}#step-{name}">' in section
            assert "<input" not in section


def test_the_link_has_its_step_in_full_as_the_script_fetches_it(http, long):
    (alone,) = sections(http, f"{long}/step", name="film_7").values()
    page = sections(http, long, step="film_7")
    assert [name for name, section in page.items() if is_full(section)] == ["film_7"]
    assert page["film_7"] == alone
    assert 'value="27 kN"' in alone
    assert re.search(r'<details data-fold="film_7" open>', alone)


def test_a_form_of_one_step_changes_no_other(http, long):
    id, texts = long.rpartition("/")[2], {"revision": "1", "was": '{"film_7.radial_load": "27 kN"}'}
    answer = http.post(long, data={**texts, "film_7.radial_load": "33 kN"})
    assert answer.status_code == 303
    steps = http.get(f"{API}/designs/{id}").json()["steps"]
    assert {name: step["inputs"]["radial_load"] for name, step in steps.items()} == {
        f"film_{n}": "33 kN" if n == 7 else f"{20 + n} kN" for n in range(MOST_IN_FULL + 1)
    }


def test_a_refused_field_stands_in_its_step(http, long):
    texts = {"revision": "1", "was": '{"film_7.radial_load": "27 kN"}', "film_7.radial_load": "33 kg"}
    answer = http.post(long, data=texts)
    assert answer.status_code == 422
    section = answer.text.partition('data-step="film_7"')[2].partition("</section>")[0]
    assert 'value="33 kg"' in section
    assert "aria-invalid" in section


def test_there_is_no_other_step(http, long):
    assert http.get(f"{long}/step", params={"name": "film_99"}).status_code == 404
    assert sections(http, long, step="film_99") == sections(http, long)
    id = long.rpartition("/")[2]
    assert http.get(f"{API}/designs/{id}/worksheet?step=film_99").status_code == 404


def test_a_worksheet_without_formulas_is_the_same_otherwise(http, long):
    place = f"{API}/designs/{long.rpartition('/')[2]}/worksheet"
    whole = http.get(place).json()
    bare = http.get(place, params={"formulas": False}).json()
    only = http.get(place, params={"step": "film_7"}).json()
    assert only["steps"] == {"film_7": whole["steps"]["film_7"]}
    assert whole["steps"]["film_7"]["formulas"]
    for step in whole["steps"].values():
        step["formulas"] = []
    assert bare == whole


@pytest.mark.slow
def test_a_step_is_fetched_edited_kept_as_a_draft_and_saved(watched, http, long):
    page = watched.page
    watched.open(long)
    fold, load = page.locator('[data-fold="film_7"]'), page.locator('[name="film_7.radial_load"]')
    expect(load).to_have_count(0)
    page.locator("[data-pick-for$='.radial_load']").wait_for(state="attached")  # the scripts are there
    fold.locator("summary h2").first.click()
    expect(load).to_have_value("27 kN")
    expect(page.locator('[data-pick-for="film_7.radial_load"]')).to_have_count(1)
    before = page.locator('[data-key^="film_7."]').first.inner_text()
    load.fill("45 kN")
    expect(page.locator('[data-key^="film_7."]').first).not_to_have_text(before)
    expect(page.locator("[data-state]")).to_contain_text("previewed")
    page.evaluate("document.querySelector('[data-fold=film_7]').open = false")
    page.reload()
    expect(page.locator("[data-draft-text]")).to_contain_text("radial load")  # though its field is not there
    if fold.get_attribute("open") is None:
        fold.locator("summary h2").first.click()
    expect(load).to_have_value("45 kN")
    fold.locator(".formula-list summary").click()
    expect(fold.locator(".formulas math").first).to_be_visible()
    page.locator("[data-save]").click()
    expect(page.locator(f'a[href="{long}/revisions/2"]').first).to_be_visible()
    saved = http.get(f"{API}{long}").json()
    assert saved["steps"]["film_7"]["inputs"]["radial_load"] == "45 kN"
    assert watched.faults() == []
