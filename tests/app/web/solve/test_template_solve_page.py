"""The page that solves a template: table of roots, curve, and values passed to the form."""

import re
from html import unescape

import pytest
from patience import patient, until
from playwright.sync_api import expect
from serving import API

from app.calculations.schemas.evaluations import Jump

PAGE = "/templates/journal_friction/1/solve"
INPUTS = {
    "journal_diameter": "50 mm", "bearing_width": "20 mm", "radial_clearance": "30 um", "speed": "3000 rpm",
    "dynamic_viscosity": "10 mPa*s",
}  # fmt: skip
ASKED = {
    "?unknown": "speed",
    "?low": "100 rpm",
    "?high": "20000 rpm",
    "?output": "power_loss",
    "?value": "50 W",
}


def page_of(http, path=PAGE, **query):
    """The page once its calculation has ended."""

    def page():
        nonlocal query
        answer = http.get(path, params=query)
        if answer.status_code == 303:
            query = None
            answer = http.get(path + answer.headers["location"])
        return answer

    answer = until(page, lambda now: "data-job" not in now.text, patient(60))
    assert answer.status_code == 200
    return answer.text


def solved_by_the_interface(http):
    inputs = {name: text for name, text in INPUTS.items() if name != "speed"}
    body = {"inputs": inputs, "unknown": "speed", "between": ["100 rpm", "20000 rpm"]}
    answer = http.post(
        f"{API}{PAGE.replace('/1/', '/versions/1/')}", json={**body, "target": {"power_loss": "50 W"}}
    )
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_the_page_shows_the_roots_and_the_curve_of_the_interface(http):
    page = page_of(http, **INPUTS, **ASKED)
    [root] = solved_by_the_interface(http)["roots"]
    assert "1 solution<" in page
    [link] = re.findall(r'href="([^"]+)">Calculate with it', page)
    tried = http.get(unescape(link))
    assert tried.status_code == 200
    assert f'value="{root["value"]!r} rpm"' in tried.text
    figure = re.search(r'<figure class="chart">(.*?)</figure>', page, re.DOTALL)[1]
    assert "<polyline" in figure or "<path" in figure
    assert "wanted" in figure
    assert "speed [rpm]" in unescape(figure)
    assert "style=" not in figure


def test_the_template_page_leads_to_it_with_what_is_typed(http):
    assert f'formaction="{PAGE}"' in http.get("/templates/journal_friction/1").text
    page = page_of(http, **{**INPUTS, "speed": "", "bearing_width": "21 mm"})
    assert '<input type="hidden" name="bearing_width" value="21 mm">' in page
    assert "data-roots" not in page


def test_it_starts_from_the_example_and_offers_bounds(http):
    example = http.get(f"{API}/templates/journal_friction/versions/1").json()["example"]
    page = page_of(http, **{"?unknown": "bearing_width"})
    assert "Fill in the empty fields" in page
    number, unit = example["bearing_width"].split()
    assert f'name="?low" value="{float(number) / 2:g} {unit}"' in page


def test_out_of_reach_and_faults_are_said(http):
    assert "out of reach" in page_of(http, **INPUTS, **{**ASKED, "?value": "1 GW"})
    wrong = page_of(http, **INPUTS, **{**ASKED, "?value": "1 kg"})
    assert 'role="alert"' in wrong
    assert "data-roots" not in wrong
    unknown = page_of(http, **INPUTS, **{**ASKED, "?unknown": "colour"})
    assert 'role="alert"' in unknown


def test_every_root_is_listed_and_none_preferred(http):
    example = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    typed = {name: text for name, text in example.items() if isinstance(text, str)}
    bounds, target = ["2 um", "0.5 mm"], {"minimum_film_thickness": "2 um"}
    inputs = {name: text for name, text in typed.items() if name != "diametral_clearance"}
    body = {"inputs": inputs, "unknown": "diametral_clearance", "between": bounds, "target": target}
    path = f"{API}/templates/oil_film/versions/2/solve"
    answer = http.post(path, json={**body, "level": "map"}, headers={"Prefer": "wait=30"}).json()
    assert len(answer["roots"]) > 1
    asked = {"?unknown": "diametral_clearance", "?low": "2 um", "?high": "0.5 mm"}
    asked |= {"?output": "minimum_film_thickness", "?value": "2 um", "@level": "map"}
    page = page_of(http, "/templates/oil_film/2/solve", **typed, **asked)
    assert page.count("Calculate with it") == len(answer["roots"]) + len(answer["touching"])


@pytest.mark.slow
def test_points_of_a_level_that_takes_few_are_drawn_and_named(http):
    """Level map is searched; level reynolds confirms two solutions, with a point to both sides of each."""
    example = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    typed = {name: text for name, text in example.items() if isinstance(text, str)}
    asked = {"?unknown": "diametral_clearance", "?low": "3 um", "?high": "0.5 mm", "@level": "reynolds"}
    asked |= {"?output": "minimum_film_thickness", "?value": "2 um"}
    page = page_of(http, "/templates/oil_film/2/solve", **typed, **asked)
    figure = re.search(r'<figure class="chart">(.*?)</figure>', page, re.DOTALL)[1]
    assert "level map was searched, and points at level reynolds confirmed the solutions" in figure
    assert figure.count("<circle") == 6 + 2
    assert ">level reynolds<" in figure


def test_a_jump_is_shown_in_american_units():
    side = {"value": 25.4, "unit": "um"}
    jump = Jump.model_validate({"value": 25.4, "unit": "mm", "before": side, "after": side}).in_units("us")
    assert (jump.value, jump.unit) == (pytest.approx(1), "inch")
    assert (jump.after.value, jump.after.unit) == (pytest.approx(1), "thou")


@pytest.mark.slow
def test_by_keyboard_in_the_dark_on_a_narrow_page(watched):
    page = watched.page
    page.emulate_media(color_scheme="dark")
    page.set_viewport_size({"width": 390, "height": 800})
    watched.open("/templates/journal_friction/1")
    page.get_by_role("button", name="Solve for an input").press("Enter")
    expect(page.get_by_role("heading", level=1)).to_have_text("Solve")
    form = page.get_by_role("form", name="What is solved")
    form.get_by_label("Vary").select_option("speed")
    form.get_by_label("until").select_option("power_loss")
    for label, text in (("from", "100 rpm"), ("to", "20000 rpm"), ("is", "50 W")):
        form.get_by_label(label, exact=True).fill(text)
    form.get_by_label("is", exact=True).press("Enter")
    expect(page.locator("[data-roots] tbody tr")).to_have_count(1)
    expect(page.locator("figure.chart svg")).to_be_visible()
    wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0
    assert watched.faults() == []
