"""A page requests finite elements and shows progress, results and picture, also without scripts."""

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from browsing import settled
from playwright.sync_api import expect
from serving import API

from app.presentation.numbers import plain as plain_number
from app.solids.bodies import THROW

PATIENCE = 90_000  # for a solid to be built and analysed [ms]
SERIOUS = ("serious", "critical")
FIGURE = "document.querySelector('[data-elements] .js-plotly-plot')"
PAGE = "/models/crank_throw/1?" + "&".join(f"{name}={text.replace(' ', '+')}" for name, text in THROW.items())
ANALYSES = f"{API}/models/crank_throw/versions/1/analyses"


def analysed(page, **chosen):
    """Ask for an analysis, and wait until its picture is drawn."""
    panel = page.locator("[data-elements]")
    for name, value in {"level": "coarse", **chosen}.items():
        panel.locator(f'[data-ask="{name}"]').select_option(value)
    panel.get_by_role("button", name="Analyse").click()
    expect(panel.get_by_role("button", name="Analyse")).to_be_enabled(timeout=PATIENCE)
    expect(panel.locator("[data-refused]")).to_be_hidden()
    expect(panel.locator(".js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    return panel


def drawn(page):
    """The traces of the picture: of the solid its colours, their range and its extent along x."""
    script = f"(() => {{ const [solid, before] = {FIGURE}.data; return {{"
    script += (
        "colours: Array.from(solid.intensity), range: [solid.cmin, solid.cmax], moved: Array.from(solid.x),"
    )
    script += "lines: Array.from(before.x).filter((x) => x !== null)}; })()"
    return page.evaluate(script)


def serious(page):
    """What a check of accessibility finds that shuts somebody out."""
    violations = Axe().run(page).response["violations"]
    return [(fault["id"], fault["nodes"][0]["target"]) for fault in violations if fault["impact"] in SERIOUS]


def asked(http, kind="torsion", **more):
    body = {"parameters": THROW, "level": "coarse", **more}
    answer = http.post(f"{ANALYSES}/{kind}", json=body, headers={"Prefer": "wait=60", "Accept": "*/*"})
    assert answer.status_code == 200, answer.text
    return answer.json()


@pytest.mark.slow
@pytest.mark.usefixtures("plotted")
def test_a_throw_is_analysed_and_painted_in_its_page(watched, http):
    page = watched.page
    watched.open(PAGE)
    panel = analysed(page)
    torsion = asked(http)["outputs"]
    row = panel.locator('[data-analysis-output="stiffness"]')
    expect(row.locator(".number")).to_have_text(plain_number(torsion["stiffness"]["value"]))
    expect(row).to_contain_text("N·m/rad")
    expect(row.locator(".band")).to_contain_text(re.compile(r"^± .* %$"))
    mesh = torsion["stiffness"]["mesh"]
    expect(row.locator(".count")).to_have_text(f"{mesh['elements']} / {mesh['degrees_of_freedom']}")
    expect(panel.locator('[data-analysis-output="torsional_frequency"]')).to_contain_text("Hz")

    expect(panel.locator(".colours")).to_contain_text("MPa")
    expect(panel.locator(".size")).to_contain_text(
        re.compile("a torque of 1 N·m about z; deformation × [1-9]")
    )
    stress = drawn(page)
    assert min(stress["colours"]) >= 0 < max(stress["colours"]) == pytest.approx(stress["range"][1])
    size = max(stress["lines"]) - min(stress["lines"])
    assert size == pytest.approx(35 + 70, abs=40)  # mm: the throw and its webs
    panel.locator("[data-colour]").select_option("twist")
    expect(panel.locator(".colours")).to_contain_text("°")
    largest = max(drawn(page)["colours"])
    assert largest == pytest.approx(57.3 / torsion["stiffness"]["value"], rel=0.1)  # deg: the loaded end's
    assert watched.faults() == []


@pytest.mark.slow
def test_two_analyses_of_a_throw_stand_in_an_accessible_page(watched, http):
    page = watched.page
    watched.open(PAGE)
    analysed(page)
    assert serious(page) == []
    panel = analysed(page, kind="bending")
    expect(panel.locator("[data-analysis]")).to_have_count(2)
    expect(panel.locator(".size")).to_contain_text("a moment of 1 N·m about y")
    assert panel.locator("[data-colour] option").all_inner_texts() == ["stress", "deflection"]
    assert watched.faults() == []


def analyses(http):
    """How many analyses were asked for so far; pages also have pictures made."""
    jobs = http.get(f"{API}/jobs", params={"limit": 500}).json()["items"]
    return sum(job["kind"] == "analysis" for job in jobs)


@pytest.mark.slow
def test_nothing_is_found_twice_and_what_is_known_is_shown_without_a_script(watched, plain, http):
    answer = asked(http, outputs=["stiffness", "torsional_frequency", "surface"])
    jobs = analyses(http)
    watched.open(PAGE)
    analysed(watched.page)
    assert analyses(http) == jobs
    plain.open(PAGE)
    row = plain.page.locator(f'[data-analysis="{answer["id"]}"] [data-analysis-output="stiffness"]')
    expect(row).to_contain_text(plain_number(answer["outputs"]["stiffness"]["value"]))
    expect(plain.page.get_by_role("button", name="Analyse")).to_be_hidden()
    assert plain.page.locator('[data-analysis-output="surface"]').count() == 0


@pytest.mark.slow
def test_another_load_changes_the_stress_and_starts_no_job(watched, http):
    asked(http, outputs=["stiffness", "torsional_frequency", "surface"])
    watched.open(PAGE)
    analysed(watched.page)
    before = max(drawn(watched.page)["colours"])
    jobs = analyses(http)
    watched.page.locator('[data-ask="load"]').fill("0.5 kN·m")
    panel = analysed(watched.page)
    expect(panel.locator(".size")).to_contain_text("a torque of 500 N·m about z; deformation × ")
    caption = panel.locator("caption", has_text="Torsion").first
    expect(caption).to_contain_text("under 500 N·m")
    assert max(drawn(watched.page)["colours"]) == pytest.approx(500 * before, rel=1e-9)
    assert analyses(http) == jobs
    size = max(drawn(watched.page)["lines"])
    watched.open(f"{PAGE}&units=us")
    watched.page.locator('[data-ask="load"]').fill("0.5 kN·m")
    panel = analysed(watched.page)
    expect(panel.locator(".size")).to_contain_text("a torque of 368.78 lbf·ft about z")
    expect(panel.locator(".colours")).to_contain_text("psi")
    assert max(drawn(watched.page)["colours"]) == pytest.approx(145.0377 * 500 * before, rel=1e-6)
    assert max(drawn(watched.page)["lines"]) == pytest.approx(size / 25.4, rel=1e-6)
    watched.page.locator('[data-ask="load"]').fill("5 mm")
    panel.get_by_role("button", name="Analyse").click()
    expect(panel.locator("[data-refused]")).to_contain_text("N*m")


@pytest.mark.slow
def test_the_table_of_the_script_is_that_of_the_server(watched, http):
    asked(http, outputs=["stiffness", "torsional_frequency", "surface"])
    watched.open(PAGE)
    place = watched.page.locator("[data-analysis] table", has_text="Torsion").first
    expect(place).to_be_visible()
    written = place.inner_text()
    panel = analysed(watched.page)
    assert panel.locator("table", has_text="Torsion").first.inner_text() == written


@pytest.mark.slow
def test_a_job_that_is_cancelled_says_so(watched):
    page = watched.page
    watched.open("/models/crank_throw/1")
    page.locator('[data-ask="level"]').select_option("fine")
    page.get_by_label("largest stress").check()
    page.get_by_role("button", name="Analyse").click()
    expect(page.locator("[data-elements-progress] progress")).to_be_visible()
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator("[data-refused]")).to_contain_text("cancelled", timeout=PATIENCE)
    expect(page.get_by_role("button", name="Analyse")).to_be_enabled()


@pytest.mark.usefixtures("plotted")
@pytest.mark.slow
def test_the_view_has_room_about_the_part(watched):
    """WebGL drops what lies outside of the ranges: a flat face at their end was full of holes."""
    watched.open(PAGE)
    expect(watched.page.locator(".solid .js-plotly-plot")).to_be_visible(timeout=PATIENCE)
    room = """(() => { const { data, layout } = document.querySelector(".solid .js-plotly-plot");
      return ["x", "y", "z"].map((axis) => {
        const all = data.flatMap((trace) => Array.from(trace[axis]));
        const [low, high] = layout[data[0].scene][`${axis}axis`].range;
        const least = Math.min(...all), most = Math.max(...all);
        return [(least - low) / (most - least), (high - most) / (most - least)]; }); })()"""
    for below, above in watched.page.evaluate(room):
        assert below == pytest.approx(1e-3, rel=1e-6)
        assert above == pytest.approx(1e-3, rel=1e-6)


@pytest.mark.slow
def test_an_analysis_offers_only_what_it_takes(watched):
    page = watched.page
    watched.open(PAGE)
    panel = page.locator("[data-elements]")
    kind = panel.locator('[data-ask="kind"]')
    kind.wait_for(timeout=PATIENCE)
    of_stress = ("load", "boundary", "maximum_stress")
    for name in of_stress:
        expect(panel.locator(f'[data-ask="{name}"]')).to_be_visible()
    kind.select_option("unit_loads")
    for name in of_stress:
        expect(panel.locator(f'[data-ask="{name}"]')).to_be_hidden()
    expect(panel.locator('[data-ask="level"]')).to_be_visible()
    kind.select_option("bending")
    for name in of_stress:
        expect(panel.locator(f'[data-ask="{name}"]')).to_be_visible()


@pytest.mark.slow
def test_a_design_is_analysed_as_it_declares(watched, http):
    analyses = {"torsion": {"tolerance": 0.05, "boundary": "guided_end", "load": "500 N*m"}}
    wider = {**THROW, "web_width": "72 mm"}  # no other test asks about it
    document = {
        "name": "throw",
        "parameters": {"twice": "= 2 * throw.torsion.stiffness"},
        "models": {"throw": {"id": "crank_throw", "version": 1, "parameters": wider, "analyses": analyses}},
    }
    design = http.post(f"{API}/designs", json=document, headers={"Accept": "*/*"}).json()
    place = f"/designs/{design['id']}"
    assert settled(http, place)["state"] == "current"
    page = watched.page
    watched.open(place)
    panel = page.locator("[data-elements]")
    expect(panel.locator('[data-analysis-output="stiffness"]')).to_contain_text("N·m/rad")
    expect(panel.locator('[data-analysis-output="torsional_frequency"]')).to_have_count(0)
    expect(panel.locator('[data-ask="boundary"]')).to_have_value("guided_end")
    expect(panel.locator('[data-ask="level"]')).to_have_value("0.05")
    expect(panel.locator('[data-ask="load"]')).to_have_value("500 N*m")
    expect(panel.locator("caption").first).to_contain_text("under 500 N·m")
    stiffness = panel.locator('[data-analysis-output="stiffness"] .number').inner_text()
    panel = analysed(page, level="0.05")
    expect(panel.locator('[data-analysis-output="torsional_frequency"]')).to_contain_text("Hz")
    assert panel.locator('[data-analysis-output="stiffness"] .number').inner_text() == stiffness
    expect(panel.locator("[data-analysis]")).to_have_count(1)
    expect(page.locator("[data-draft]")).to_be_hidden()  # its fields are none of the worksheet
    ids = page.evaluate("Array.from(document.querySelectorAll('[id]'), (place) => place.id)")
    assert [id for id in ids if ids.count(id) > 1] == []
    assert serious(page) == []
    assert watched.faults() == []
    watched.open(f"{place}/revisions/1")
    expect(page.locator('[data-analysis-output="stiffness"] .number')).to_have_text(stiffness)


def test_a_ball_bearing_has_neither_elements_nor_an_oil_film_to_paint(http, paper):
    assert "data-paint" not in http.get(paper).text
    assert "Finite elements" not in http.get("/models/ball_bearing/1").text
    answer = http.get(f"{API}/models/ball_bearing/versions/1").json()
    assert (answer["analyses"], answer["film_bore"]) == ({}, None)
    assert http.get(f"{API}/models/plain_bearing/versions/1").json()["film_bore"] == "inner_diameter"
    throw = http.get(f"{API}/models/crank_throw/versions/1").json()["analyses"]
    assert throw["torsion"]["outputs"]["stiffness"] == "N*m/rad"
