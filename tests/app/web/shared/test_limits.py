"""A template's page accepts limits typed by hand or from the library, and finishes for roughnesses."""

import re

import pytest
from browsing import from_example
from playwright.sync_api import expect
from serving import API

FILM = "/templates/oil_film/2"
HEADLINE = "[data-headline]"


def headline(http, **query):
    page = http.get(FILM, params=query).text
    return re.search(r"data-headline>([^<]*)<", page)[1]


def test_a_row_and_a_limit_in_the_address_are_judged(http):
    example = re.findall(r'<input name="([^"@.]+)"[^>]* value="([^"]+)"', http.get(FILM).text)
    inputs = {name: value for name, value in example if value}
    assert inputs["radial_load"] == "25 kN"
    assert headline(http) == headline(http, **inputs) == "8 met, 1 not met, 6 not checked"
    row = {"limits.bearing_material": "tin_babbitt_b23_2"}
    assert headline(http, **inputs, **row) == "9 met, 3 not met, 3 not checked"
    both = {**row, "limits.permissible_pressure": "200 MPa"}
    assert headline(http, **inputs, **both) == "10 met, 2 not met, 3 not checked"


def test_a_wrong_limit_is_refused_beside_its_field(http):
    answer = http.get(FILM, params={"radial_load": "25 kN", "limits.permissible_pressure": "20 mm"})
    assert answer.status_code == 422
    assert re.search(r'id="limits-permissible_pressure-error"><bdi>[^<]*measures', answer.text)
    assert '<details class="more" open><summary>Limits of the criteria (7)' in answer.text


def test_the_rows_are_named_in_words(http):
    page = http.get(FILM).text
    assert '<option value="tin_bronze">tin bronze</option>' in page
    assert '<option value="aluminium_bronze">' not in page  # has a pressure times speed alone
    assert 'list="-journal_roughness-rows"' in page
    assert '<option value="0.25 um">N4, Ra 0.2 um</option>' in page


@pytest.mark.slow
def test_a_chosen_row_is_judged_as_it_is_chosen(watched):
    page = watched.page
    watched.open(FILM)
    expect(page.locator(HEADLINE)).to_have_text("8 met, 1 not met, 6 not checked")
    pressure = page.locator('[data-criterion="pressure"]')
    pressure.locator("[data-give]").first.click()
    expect(page.get_by_label("Largest pressure of the film that the bearing material bears")).to_be_focused()
    page.get_by_label("Bearing material", exact=True).select_option("tin_babbitt_b23_2")
    expect(page.locator(HEADLINE)).to_have_text("9 met, 3 not met, 3 not checked")
    page.get_by_label("Largest pressure of the film that the bearing material bears").fill("200 MPa")
    expect(page.locator(HEADLINE)).to_have_text("10 met, 2 not met, 3 not checked")
    expect(pressure.locator(".tag")).to_have_text("met")
    assert "limits.bearing_material=tin_babbitt_b23_2" in page.url
    assert watched.faults() == []


def test_the_page_of_a_template_shows_every_criterion(http):
    page = http.get(FILM).text
    rows = dict(re.findall(r'<tr data-criterion="(\w+)">.*?<span class="tag (\w+)">', page, re.DOTALL))
    declared = http.get(f"{API}{FILM.replace('/2', '/versions/2')}").json()["criteria"]
    assert rows.keys() == {one["name"] for one in declared}
    assert list(rows.values()).count("not_checked") == 6


def test_both_pages_have_the_same_fields_of_limits(http):
    place = from_example(http, "oil_film/2")
    parts = [
        re.search(r"<summary>Limits of the criteria.*?</table>", http.get(path).text, re.DOTALL)[0]
        for path in (FILM, place)
    ]
    bare, of_step = (re.sub(r'(id|for|name|data-value|aria-label)="[^"]*"', "", part) for part in parts)
    captions = r'<caption class="hidden-words">.*?</caption>'
    assert re.sub(captions, "", bare) == re.sub(captions, "", of_step)
