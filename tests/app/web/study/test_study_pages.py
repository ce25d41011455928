"""Studies by mouse: a refused form, a contour whose rows become revisions, the limit in a histogram."""

import csv
import io
import re
from html.parser import HTMLParser

import pytest
from browsing import CHROMIUM
from openpyxl import load_workbook
from patience import patient, until
from playwright.sync_api import expect
from serving import API

FILM = "film.minimum_film_thickness"
CLEARANCE, WIDTH = "film.diametral_clearance", "film.bearing_width"
ENDED = ("done", "failed", "cancelled")
KEPT = {f"outputs.{FILM}": "on"}


@pytest.fixture
def bearing(http):
    """The address of a design of one oil film with a criterion of its own."""
    inputs = http.get(f"{API}/templates/oil_film/versions/2").json()["example"]
    step = {"template": "oil_film", "version": 2, "level": "map", "inputs": inputs}
    criteria = {"thick_enough": {"require": f"{FILM} >= 2.6 um"}}
    document = {"name": "studied", "steps": {"film": step}, "criteria": criteria}
    response = http.post(f"{API}/designs", json=document, headers={"Prefer": "wait=30"})
    return f"/designs/{response.json()['id']}"


@pytest.fixture
def grid(http, bearing):
    """The address of a finished grid over two inputs, and its design."""
    vary = {CLEARANCE: {"between": ["30 um", "90 um"]}, WIDTH: {"between": ["18 mm", "26 mm"]}}
    body = {"design": bearing.rpartition("/")[2], "method": "grid", "steps": 5, "vary": vary}
    body |= {"outputs": [FILM, "film.power_loss"], "hold": ["thick_enough"]}
    study = http.post(f"{API}/studies", json=body).json()["id"]
    until(lambda: http.get(f"{API}/studies/{study}").json()["state"] in ENDED)
    return f"/studies/{study}", bearing


@pytest.mark.slow
def test_a_study_that_ends_shows_its_results_without_a_reload(watched, http, bearing):
    """A mark in the page is lost if it is loaded again; badge, rows and charts come as the job ends."""
    id = bearing.rpartition("/")[2]
    change = {"steps": {"film": {"level": "reynolds"}}}
    http.patch(f"{API}/designs/{id}", json=change, headers={"If-Match": "*"}).raise_for_status()
    vary = {CLEARANCE: {"between": ["30 um", "90 um"]}, WIDTH: {"between": ["18 mm", "26 mm"]}}
    body = {"design": id, "method": "sample", "points": 600, "vary": vary}
    body |= {"outputs": [FILM], "hold": ["thick_enough"]}
    study = http.post(f"{API}/studies", json=body).json()["id"]
    page = watched.page
    watched.open(f"/studies/{study}")
    badge = page.locator("[data-study-state]")
    assert badge.inner_text() in ("queued", "running")
    page.evaluate("() => { window.isKept = true; }")
    expect(badge).to_have_text("done", timeout=patient(120_000))
    expect(page.locator("[data-progress]")).to_be_hidden()
    expect(page.locator(".page-head")).to_contain_text("600 of 600 rows")
    expect(page.get_by_role("region", name="Table of rows").locator("tbody tr")).to_have_count(20)
    expect(page.locator("[data-charts]")).to_be_visible(timeout=patient(60_000))
    assert page.evaluate("() => window.isKept")
    assert watched.faults() == []


def test_a_refused_form_keeps_what_was_typed_and_names_the_fault(http, bearing):
    typed = {"method": "grid", "place.0": CLEARANCE, "low.0": "30 kN", "high.0": "60 um", "steps.0": "7"}
    typed[f"outputs.{FILM}"] = "on"
    answer = http.post(f"{bearing}/studies", data=typed)
    assert answer.status_code == 422
    assert 'value="30 kN"' in answer.text
    assert 'role="alert"' in answer.text
    assert "kN" in answer.text.partition('role="alert"')[2].partition("</p>")[0]
    again = http.get(f"{bearing}/studies")
    assert again.headers["location"] == f"{bearing}/studies/new"


def fieldset(page, legend):
    """The part of the form below a legend."""
    return page.partition(f"<legend>{legend}</legend>")[2].partition("</fieldset>")[0]


@pytest.mark.parametrize(
    ("typed", "legend", "words"),
    [
        ({"method": "optimise", "high.0": "60 um"}, "Goals", "name an output to minimise or maximise"),
        ({"method": "grid", "high.0": "60 kN", "steps.0": "7"}, "Varied quantities", "kN measures a force"),
        ({"method": "sample", "high.0": "60 um", "points": "0"}, "Rows", "greater than or equal to 1"),
    ],
)
def test_each_fault_stands_beside_its_fields(http, bearing, typed, legend, words):
    answer = http.post(f"{bearing}/studies", data={"place.0": CLEARANCE, "low.0": "30 um", **typed, **KEPT})
    assert answer.status_code == 422
    assert answer.text.count("data-fault>") == 1
    assert words in fieldset(answer.text, legend).partition("data-fault>")[2]


@pytest.mark.slow
def test_the_levels_of_a_search_show_the_output_that_a_criterion_judges(http, bearing):
    body = {"design": bearing.rpartition("/")[2], "method": "optimise", "minimise": ["film.power_loss"]}
    body |= {"vary": {CLEARANCE: {"between": ["30 um", "90 um"]}}, "hold": ["thick_enough"]}
    study = http.post(f"{API}/studies", json={**body, "confirm": {"tolerance": 0.001}}).json()["id"]
    until(lambda: http.get(f"{API}/studies/{study}").json()["state"] in ENDED)
    levels = http.get(f"/studies/{study}").text.partition('aria-label="Levels"')[2].partition("</table>")[0]
    promise = levels.partition("<tbody>")[2].split("<td>")[2]
    assert "minimum film thickness " in promise
    assert "of thick_enough" in promise


@pytest.mark.slow
def test_a_front_is_listed_with_what_its_levels_promise(http, bearing):
    body = {
        "design": bearing.rpartition("/")[2],
        "method": "sample",
        "points": 64,
        "minimise": ["film.power_loss"],
    }
    body |= {
        "maximise": [FILM],
        "vary": {CLEARANCE: {"between": ["30 um", "90 um"]}},
        "hold": ["thick_enough"],
    }
    body |= {"explore": {"tolerance": 0.2}, "confirm": {"tolerance": 0.001}}
    study = http.post(f"{API}/studies", json=body).json()["id"]
    ended = until(lambda: http.get(f"{API}/studies/{study}").json(), lambda now: now["state"] in ENDED)
    front, (trade,) = ended["result"]["front"], ended["result"]["trade"]
    page = http.get(f"/studies/{study}").text
    listed = page.partition('aria-label="Table of the front"')[2].partition("</table>")[0]
    assert listed.count("<tr data-result=") == len(front) > 1
    assert f'name="row" value="{front[-1]["row"]}"' in listed
    promised = page.partition("<details data-trade>")[2].partition("</details>")[0]
    assert f"{len(trade['front'])} points of its front, 64 rows" in promised
    assert promised.count("<tr>") == 1 + len(trade["front"])


class Table(HTMLParser):
    """A table of results on a page: units and sorting addresses of the heads, numbers of the rows."""

    def __init__(self, text):
        super().__init__()
        self.heads, self.links, self.rows = [], [], {}
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if tag == "th" and "title" in attrs:
            self.heads.append(attrs["title"])
        elif tag == "a" and attrs["href"].startswith("?sort="):
            self.links.append(attrs["href"])
        elif "data-result" in attrs:
            self.row = self.rows.setdefault(attrs["data-result"], [])
        elif "data-number" in attrs:
            self.row.append(float(attrs["data-number"]))


def test_the_rows_on_the_page_and_in_the_files_have_equal_numbers(http, grid):
    study, _ = grid
    page = http.get(study).text
    table = Table(page.partition('aria-label="Table of rows"')[2].partition("</table>")[0])
    assert table.heads == [CLEARANCE, WIDTH, FILM, "film.power_loss"]
    assert 'Minimum film thickness</a> <span class="head-unit">[µm]</span>' in page
    items = http.get(f"{API}{study}/rows?limit=20").json()["items"]
    assert table.rows == {str(one["row"]): [one["values"][name] for name in table.heads] for one in items}
    lines = list(csv.reader(io.StringIO(http.get(f"{API}{study}/rows.csv").text)))
    assert lines[0][1:5] == [
        "Diametral clearance [mm]",
        "Bearing width [mm]",
        "Minimum film thickness [µm]",
        "Power loss [W]",
    ]
    assert lines[1][1:5] == table.heads
    assert (lines[0][5], lines[1][5]) == ("Film: minimum film thickness (thick enough)", "thick_enough")
    assert [[float(cell) for cell in line[1:5]] for line in lines[2:22]] == list(table.rows.values())
    sheet = load_workbook(io.BytesIO(http.get(f"{API}{study}/rows.xlsx").content)).active
    assert [cell.value for cell in sheet[1]] == lines[0]
    cells = sheet.iter_rows(min_row=3, max_row=22, min_col=2, max_col=5, values_only=True)
    assert [list(row) for row in cells] == [pytest.approx(row, rel=1e-15) for row in table.rows.values()]
    down = http.get(f"{study}{table.links[2]}").text
    up = Table(down.partition('aria-label="Table of rows"')[2].partition("</table>")[0])
    films = [row[2] for row in up.rows.values()]
    assert films == sorted(films)
    assert up.links[2].startswith("?sort=-")


def test_the_form_lists_judged_and_main_results_first(http, bearing):
    """Judged ones are ticked; others may need a more expensive level."""
    first = http.get(f"{bearing}/studies/new").text.partition("<summary>More outputs")[0]
    listed = re.findall(r'name="outputs\.([^"]+)"( checked)?', first)
    assert FILM in http.get(f"{API}{bearing}/network").json()["table"]
    assert (FILM, " checked") in listed
    assert ("film.total_oil_flow", "") in listed


def test_the_form_studies_the_variant_that_is_chosen(http, bearing):
    patch = {"variants": {"main_10": {WIDTH: "20 mm"}, "main_2": {WIDTH: "26 mm"}}}
    headers = {"If-Match": '"1"', "Content-Type": "application/merge-patch+json", "Prefer": "wait=30"}
    assert http.patch(f"{API}{bearing}", json=patch, headers=headers).status_code == 200
    form = http.get(f"{bearing}/studies/new?variant=main_2").text
    choice = form.partition('<select name="variant"')[2].partition("</select>")[0]
    assert choice.index("main_2") < choice.index("main_10")
    assert '<option value="main_2" selected>' in choice
    typed = {
        "method": "grid",
        "place.0": CLEARANCE,
        "low.0": "30 um",
        "high.0": "60 um",
        "steps.0": "2",
        **KEPT,
    }
    begun = http.post(f"{bearing}/studies", data={**typed, "variant": "main_2"})
    assert begun.status_code == 303
    study = begun.headers["location"]
    assert http.get(f"{API}{study}").json()["variant"] == "main_2"
    assert "variant main_2" in http.get(study).text
    refused = http.post(f"{bearing}/studies", data={**typed, "variant": "main_3"})
    assert refused.status_code == 422
    assert "its variants are main_2, main_10" in fieldset(refused.text, "Varied quantities")


@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
@pytest.mark.slow
def test_many_outputs_are_grouped_by_step_and_narrowed_by_words(watched, bearing):
    page = watched.page
    watched.open(f"{bearing}/studies/new")
    page.get_by_text("More outputs").click()
    shown, narrowed = page.locator("[data-more] label[data-words]:visible"), page.locator("[data-narrowed]")
    count = shown.count()
    assert count > 12
    page.get_by_role("checkbox", name="film.sommerfeld_number").check()
    page.get_by_role("searchbox", name="Filter by").fill("Temperature")
    expect(narrowed).to_have_text(f"{shown.count()} of {count}")
    names = shown.all_inner_texts()
    assert 1 < len(names) < count
    assert all("temperature" in name.lower() for name in names if "sommerfeld" not in name)
    assert any("sommerfeld" in name for name in names)  # it is ticked
    page.get_by_role("searchbox", name="Filter by").press("Enter")
    expect(page).to_have_url(f"{watched.url}{bearing}/studies/new")  # it starts no study
    page.get_by_role("searchbox", name="Filter by").fill("")
    assert shown.count() == count
    assert page.locator('[name="objective.0"] optgroup[label="film"] option').count() > 12
    assert watched.faults() == []


@pytest.mark.slow
@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
def test_a_grid_of_two_shows_a_contour_and_a_chosen_row_becomes_a_revision(plotted, watched, http, grid):
    study, design = grid
    page = watched.page
    watched.open(study)
    expect(page.locator("[data-chart]")).to_have_value("contour", timeout=patient(20_000))
    page.locator("[data-by]").select_option("thick_enough")
    expect(page.locator("[data-drawing] .js-plotly-plot, [data-drawing].js-plotly-plot")).to_be_visible()
    rows = page.get_by_role("region", name="Table of rows")
    rows.get_by_role("button", name="Use row 7", exact=True).click()
    page.wait_for_url(f"**{design}")
    row = http.get(f"{API}{study}/rows?limit=25").json()["items"][7]["values"]
    sheet = http.get(f"{API}{design}").json()
    assert sheet["revision"] == 2
    assert sheet["steps"]["film"]["inputs"]["bearing_width"] == {"value": row[WIDTH], "unit": "mm"}
    assert watched.faults() == []


@pytest.mark.skipif(not CHROMIUM, reason="needs Debian's package chromium")
def test_histogram_and_parallel_coordinates(plotted, watched, grid):
    page = watched.page
    watched.open(grid[0])
    page.locator("[data-x]").select_option(FILM)
    page.locator("[data-chart]").select_option("histogram")
    expect(page.locator("[data-charted]")).to_contain_text("dashed: the limit of a criterion")
    page.locator("[data-chart]").select_option("parallel")
    expect(page.locator("[data-charted]")).to_contain_text("25 of 25 rows kept")
    box = page.locator(".parallel .track").first.bounding_box()
    middle = box["x"] + box["width"] / 2
    page.mouse.move(middle, box["y"] + 2)
    page.mouse.down()
    page.mouse.move(middle, box["y"] + box["height"] * 0.4)
    page.mouse.up()
    expect(page.locator("[data-charted]")).to_contain_text("5 of 25 rows kept")
    assert watched.faults() == []
