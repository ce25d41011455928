"""The design page begins with the verdict: its text, its position, the length of the page."""

import re

import pytest
from bare_shells import BUSH
from browsing import settled
from judging import CRITERIA, MET, UNCHECKED, UNDECIDED, WORST, verdict
from playwright.sync_api import expect
from serving import API

from app.presentation.criteria import limit_of, line, margin, subject_of, tone
from app.schemas.criteria import Criterion, Verdict
from app.web.shared.responses import jinja
from app.web.verdict import banner as verdict_of_page
from app.web.verdict.banner import banner, key_outputs

LONGEST = 3100  # pixels of a page with two steps, of which one shows 44 results, 1440 wide


def criterion(plain, **changes):
    return Criterion.model_validate({**plain, **changes})


def judged(*criteria):
    """What a page asks of a revision."""
    summary = Verdict.model_validate(verdict(*criteria))

    class Revision:
        verdict, state = summary, "current"

    Revision.criteria = [criterion(one) for one in criteria]
    return Revision


def html_of(shown, design=""):
    module = jinja.get_template("verdict/verdict.html").module
    return str(module.banner(shown, design))


def text_of(html):
    return " ".join(re.sub(r"<[^>]+>", " ", html.replace("&lt;", "<").replace("&gt;", ">")).split())


@pytest.fixture
def two_steps(http):
    """A design whose film takes the largest load of an engine's cycle, with a shell."""
    inputs = {
        name: http.get(f"{API}/templates/{name}/versions/{version}").json()["example"]
        for name, version in (("bearing_load", 1), ("oil_film", 2))
    }
    document = {
        "name": "two steps",
        "steps": {
            "load": {"template": "bearing_load", "version": 1, "inputs": inputs["bearing_load"]},
            "film": {
                "template": "oil_film",
                "version": 2,
                "inputs": {**inputs["oil_film"], "radial_load": "= load.main_load_max"},
            },
        },
        "model": {
            "id": "plain_bearing",
            "version": 1,
            "parameters": {**BUSH, "inner_diameter": "= film.bearing_diameter"},
        },
    }
    design = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"}).json()
    place = f"/designs/{design['id']}"
    settled(http, place)
    return place


def test_a_violated_limit_is_worded_as_violated():
    assert line(criterion(WORST)).sentence == (
        "minimum film thickness 1.53 µm is below smallest permissible film 2 µm: not met"
    )
    assert margin(criterion(WORST)) == "−0.47 µm (−0.52 … −0.42)"
    above = criterion(
        MET,
        verdict="not_met",
        value={"value": 120.0, "unit": "degC"},
        margin={"value": -10.0, "unit": "delta_degC"},
    )
    assert margin(above) == "−10 K"
    assert margin(above.in_units("us")) == "−18 Δ°F"
    assert line(above).sentence.startswith("film temperature 120 °C is above 110 °C: not met")
    assert line(above).title == "film temperature"


def test_a_value_just_below_its_limit_is_not_shown_equal_to_it():
    near = {"value": 2.0 - 1e-7, "unit": "um"}
    sentence = line(criterion(WORST, value=near)).sentence
    assert "1.9999999 µm is below smallest permissible film 2 µm" in sentence


def test_the_sentence_follows_the_units_that_are_shown():
    american = criterion(WORST).in_units("us")
    assert american.sentence == line(american).sentence
    assert "0.06024 mil is below smallest permissible film 0.07874 mil: not met" in american.sentence


def test_two_criteria_of_one_value_are_told_apart():
    exists = criterion(WORST, name="film.film_exists", require="minimum_film_thickness >= 0.05 um")
    assert line(criterion(WORST)).title == "minimum film thickness"
    assert line(exists).title == "minimum film thickness (film exists)"


@pytest.mark.parametrize("one", [WORST, MET])
def test_an_unknown_error_stands_in_the_verdict_and_is_not_green(one):
    shown = line(criterion(one, error_known=False, relative_error=None, level="mobility"))
    assert shown.verdict_words == f"{one['verdict'].replace('_', ' ')}; error unknown"
    assert (shown.error, shown.is_open) == ("unknown", True)
    assert "error-unknown" in shown.tag


def test_a_criterion_belongs_to_the_step_whose_value_it_judges():
    assert [line(criterion(one)).step for one in CRITERIA] == ["film"] * 4
    assert line(criterion(UNDECIDED, require="scale >= 1")).step == ""


def test_what_was_not_checked_says_what_to_give():
    assert line(criterion(UNCHECKED)).missing == "give permissible pressure"
    assert line(criterion(UNDECIDED)).missing == "needs an error below 1.9 %"


@pytest.mark.parametrize(
    ("criteria", "expected"),
    [
        ([WORST, MET], "bad"),
        ([UNDECIDED], "open"),
        ([UNCHECKED], "open"),
        ([MET], "plain"),  # met, but with an error that is not stated
        ([{**UNDECIDED, "verdict": "met"}], "green"),
    ],
)
def test_only_a_green_verdict_is_green(criteria, expected):
    shown = banner(judged(*criteria))
    assert (shown.tone, tone(judged(*criteria).verdict)) == (expected, expected)
    assert ("green" in html_of(shown)) is False  # the colour comes with the tone alone


def test_a_revision_without_a_verdict_says_so():
    class Old:
        verdict, criteria, state = None, None, "current"

    assert "save to judge" in text_of(html_of(banner(Old)))


def test_the_fold_line_shows_what_is_judged_or_drives_a_part():
    class Output:
        value = 1.0

    outputs = dict.fromkeys(["minimum_film_thickness", "density", "bearing_diameter", "power_loss"], Output)
    criteria = [criterion(WORST)]
    keys = key_outputs("film", outputs, criteria, ["bearing_diameter"])
    assert keys == ["minimum_film_thickness", "bearing_diameter"]
    assert key_outputs("other", outputs, [], []) == ["density", "bearing_diameter", "power_loss"]


def test_a_fold_line_shows_values_and_first_those_that_were_checked():
    """Not a pressure that nobody limited before the film, nor a result that does not exist."""
    output = type("Output", (), {"value": 1.0})
    none = type("Output", (), {"value": None})
    outputs = {"maximum_pressure": output, "minimum_film_thickness": output, "film_parameter": none}
    rough = criterion(UNCHECKED, name="film.rough", require="film_parameter >= 1")
    assert key_outputs("film", outputs, [rough, criterion(UNCHECKED), criterion(WORST)], []) == [
        "minimum_film_thickness",
        "maximum_pressure",
    ]


def test_without_criteria_a_fold_line_shows_the_last_results_that_have_a_value():
    output = type("Output", (), {"value": 1.0})
    none = type("Output", (), {"value": None})
    outputs = {"rms_film_difference": output, "largest_film_difference": output, "strain_difference": none}
    assert key_outputs("bench", outputs, [], []) == ["rms_film_difference", "largest_film_difference"]
    assert key_outputs("bench", {"strain_difference": none}, [], []) == ["strain_difference"]  # is awaited


def test_the_browser_writes_the_verdict_as_the_server_does(watched, paper):
    watched.open(paper, wait_until="networkidle")  # no preview comes between
    expect(watched.page.locator("[data-state]")).to_be_attached()
    for criteria in (CRITERIA, [MET], [UNCHECKED, {**UNCHECKED, "name": "film.b"}]):
        payload = {"criteria": criteria, "verdict": verdict(*criteria)}
        script = "async (payload) => (await import('/static/verdict/verdict.js')).showVerdict(payload)"
        watched.page.evaluate(script, payload)
        inside = watched.page.locator("[data-verdict-inside]").inner_html()
        expected = html_of(banner(judged(*criteria)), paper.rpartition("/")[2])
        assert text_of(inside) == text_of(expected)
        links = re.compile(r'data-give="([^"]+)"|href="(#step-[^"]+|/designs[^"]+)"|class="tag (\w+)"')
        assert links.findall(inside) == links.findall(expected)
    assert watched.faults() == []


@pytest.mark.slow
def test_a_preview_without_its_steps_leaves_the_verdict_of_the_revision(watched, http, two_steps):
    """A server that began anew has no results in memory; the page then shows those that are saved."""
    page = watched.page
    saved = re.search(r'id="verdict">([^<]+)', http.get(two_steps).text)[1]

    def without_steps(route):
        answer = route.fetch()
        payload = answer.json()
        payload["steps"] = {name: {**step, "state": "pending"} for name, step in payload["steps"].items()}
        payload["verdict"] = {**payload["verdict"], "headline": "Nothing is known"}
        route.fulfill(response=answer, json=payload)

    page.route("**/preview?**", without_steps)
    watched.open(two_steps, wait_until="networkidle")
    headline = page.locator("#verdict")
    expect(headline).to_have_text(saved)
    page.locator('[name="film.bearing_width"]').fill("19 mm")
    expect(headline).to_have_text("Nothing is known")  # of the draft


def in_view(page, selector):
    return page.evaluate(
        "(selector) => { const box = document.querySelector(selector).getBoundingClientRect();"
        " return box.height > 0 && box.top >= 0 && box.top < innerHeight / 2 && box.bottom > 0; }",
        selector,
    )


SCROLLERS = """() => [...document.querySelectorAll(".worksheet > .aside, .worksheet > .aside *")]
    .filter((box) => /auto|scroll/.test(getComputedStyle(box).overflowY))
    .filter((box) => box.scrollHeight > box.clientHeight + 1).map((box) => box.outerHTML.slice(0, 80))"""
HIDDEN = """() => {
    const top = (box) => { box.focus(); return box.getBoundingClientRect().top; };
    const end = () => document.querySelector(".part-view").getBoundingClientRect().bottom;
    const fields = [...document.querySelectorAll(".part-rest :is(a, input)")];
    return fields.filter((box) => box.offsetParent && top(box) < end()).map((box) => box.outerHTML);
}"""


@pytest.mark.slow
@pytest.mark.usefixtures("plotted")
@pytest.mark.parametrize("size", [pytest.param((1440, 900), marks=pytest.mark.slow), (1024, 768)])
def test_the_part_stays_in_view_and_hides_nothing_that_has_the_focus(watched, two_steps, size):
    """The picture alone stays; its parameters pass below it, without a scrollbar of their own."""
    page = watched.page
    page.set_viewport_size({"width": size[0], "height": size[1]})
    watched.open(two_steps)
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=60_000)
    assert page.evaluate(SCROLLERS) == []
    page.evaluate("scrollTo(0, 700)")
    page.wait_for_function("scrollY === 700")
    assert in_view(page, ".aside .solid")
    view = page.locator(".part-view").bounding_box()
    assert view["y"] + view["height"] < size[1], "the picture leaves room for its parameters"
    assert page.evaluate(HIDDEN) == []
    assert watched.faults() == []


@pytest.mark.slow
@pytest.mark.usefixtures("plotted")
def test_two_steps_are_short_and_verdict_and_part_stay_in_view(watched, two_steps):
    page = watched.page
    watched.open(two_steps)
    expect(page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=60_000)
    pressure = page.locator('[data-step="film"] .picture.pressure')
    pressure.scroll_into_view_if_needed()
    expect(pressure.locator(".js-plotly-plot").first).to_be_attached(timeout=60_000)
    assert page.evaluate("document.documentElement.scrollHeight") < LONGEST
    page.evaluate("scrollTo(0, 1000)")
    page.wait_for_function("scrollY === 1000")
    assert in_view(page, "[data-verdict] .headline")
    assert in_view(page, ".aside .solid")
    assert watched.faults() == []


@pytest.mark.slow
def test_a_link_of_the_verdict_unfolds_its_step_and_the_fold_is_kept(watched, two_steps):
    page = watched.page
    watched.open(two_steps, wait_until="networkidle")  # no preview comes between
    criteria = [{**WORST, "name": "load.load"}, UNCHECKED]
    payload = {"criteria": criteria, "verdict": verdict(*criteria)}
    page.locator('[data-fold="load"]').evaluate("(fold) => { fold.open = false; }")
    page.evaluate(
        "async (payload) => (await import('/static/verdict/verdict.js')).showVerdict(payload)", payload
    )
    page.locator('[data-verdict] a[href="#step-load"]').first.click()
    expect(page.locator('[data-fold="load"]')).to_have_attribute("open", "")
    film = page.locator('[data-fold="film"]')
    before = film.get_attribute("open")
    film.locator("summary h2").first.click()
    after = film.get_attribute("open")
    assert after != before
    page.reload()
    expect(page.locator("[data-decided], [data-verdict]").first).to_be_visible()
    page.wait_for_function(
        f"document.querySelector('[data-fold=film]').open === {str(after is not None).lower()}"
    )


@pytest.mark.slow
@pytest.mark.parametrize("size", [pytest.param((1440, 900), marks=pytest.mark.slow), (390, 844)])
def test_the_governing_criterion_stands_on_the_first_screen(browser, served, two_steps, size):
    width, height = size
    context = browser.new_context(viewport={"width": width, "height": height})
    page = context.new_page()
    page.goto(served.url + two_steps, wait_until="networkidle")
    payload = {"criteria": CRITERIA, "verdict": verdict(*CRITERIA)}
    page.evaluate(
        "async (payload) => (await import('/static/verdict/verdict.js')).showVerdict(payload)", payload
    )
    box = page.locator(".governing").bounding_box()
    assert box["y"] + box["height"] < height
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.locator("[data-all-criteria] summary").click()
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    context.close()


def test_relations_drive_the_outputs_that_they_name(monkeypatch):
    relations = {
        ".limit": "= 2 * film.density",
        "film.radial_load": "25 kN",
        "model.width": "= film.bearing_width + other.power_loss * 1 mm/W",
    }
    monkeypatch.setattr(verdict_of_page, "texts", lambda design: relations)
    assert verdict_of_page.driving_outputs(None) == {
        "film": ["density", "bearing_width"],
        "other": ["power_loss"],
    }


def test_a_criterion_is_named_in_words_with_its_limit():
    assert (
        subject_of("film.film", "minimum_film_thickness >= permissible_film")
        == "film: minimum film thickness"
    )
    assert subject_of("film.rigid", "bore_deflection <= gap / 2") == "film: bore deflection (rigid)"
    assert limit_of("bore_deflection <= minimum_film_thickness / 2") == "≤ minimum film thickness / 2"
    assert limit_of("film.minimum_film_thickness >= 3 um") == "≥ 3 µm"
