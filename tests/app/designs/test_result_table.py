"""The table of results: a row for the design and each variant, equal on page, in files and in the report."""

import csv
import io
from html.parser import HTMLParser

import pytest
from openpyxl import load_workbook
from serving import API, created, paper, patched

from app.designs.result_table import EQUAL
from templates.core.catalogue.discovery import find
from templates.core.language.template import Calculation

DESIGNS = f"{API}/designs"
FILM = "film.minimum_film_thickness"
RATIOS = {"narrow": "0.4", "wide": "0.6"}


def document(**more):
    """The paper's bearing with two widths; nothing is built."""
    whole = paper(**more)
    del whole["model"]
    whole["parameters"] = {"ratio": "0.5"}
    inputs = {
        **whole["steps"]["film"]["inputs"],
        "bearing_diameter": "48 mm",
        "bearing_width": "= ratio * 48 mm",
    }
    whole["steps"] = {"film": {**whole["steps"]["film"], "inputs": inputs}}
    whole["criteria"] = {"thick": {"require": f"{FILM} >= 3 um"}}
    whole["variants"] = {name: {"ratio": ratio} for name, ratio in RATIOS.items()}
    return whole


@pytest.fixture(scope="module")
def design(http):
    return created(http, document())


def table(http, design, **params):
    return http.get(f"{DESIGNS}/{design['id']}/variants", params=params).json()["table"]


def column(shown, name):
    at = [one["name"] for one in shown["columns"]].index(name)
    return {row["name"]: row["values"][at] for row in shown["rows"]}


def test_the_default_has_the_main_results_of_the_template(http, design):
    shown = table(http, design)
    assert [one["name"] for one in shown["columns"]] == [
        "film.radial_load", "film.speed", "film.relative_eccentricity", FILM
    ]  # fmt: skip
    assert [row["name"] for row in shown["rows"]] == ["base", "narrow", "wide"]
    assert column(shown, "film.speed") == dict.fromkeys(("base", "narrow", "wide"), 5000)
    for name in ("base", *RATIOS):
        params = {"output": FILM}
        one = http.get(f"{DESIGNS}/{design['id']}/variants/{name}", params=params).json()
        assert column(shown, FILM)[name] == one["outputs"][FILM]["value"]


def test_the_governing_row_is_marked_with_its_criterion(http, design):
    shown = table(http, design)
    marked = [row["name"] for row in shown["rows"] if row.get("governs")]
    films = column(shown, FILM)
    assert marked == ["narrow"] == [min(films, key=films.get)]
    row = shown["rows"][1]
    assert row["criterion"] == "thick"
    assert row["utilisation"] == pytest.approx(3 / films["narrow"])
    assert shown["governing"].startswith("narrow governs; ")


def test_rows_that_are_equally_bad_are_counted(http):
    same = {name: {"ratio": "0.4"} for name in ("one", "two", "three")}
    shown = table(http, created(http, {**document(), "variants": same}))
    assert [row["name"] for row in shown["rows"] if row.get("governs")] == ["one", "three", "two"]
    assert f"(3 equal within {100 * EQUAL:g} %)" in shown["governing"]


def test_chosen_columns_and_changes_from_the_first_row(http, design):
    choice = {"columns": [FILM, "ratio", "film.viscosity"], "changes": True}
    refused = http.post(DESIGNS, json={**document(), "table": choice})
    assert refused.status_code == 422
    [fault] = refused.json()["errors"]
    assert fault["name"] == "table.columns"
    assert "film.dynamic_viscosity" in fault["detail"]
    choice["columns"][2] = "film.dynamic_viscosity"
    shown = table(http, created(http, {**document(), "table": choice}))
    assert [one["name"] for one in shown["columns"]] == choice["columns"]
    base, narrow, wide = (row["values"][0] for row in shown["rows"])
    assert [row["changes"][0] for row in shown["rows"]] == [0, narrow / base - 1, wide / base - 1]
    assert [row["changes"][1] for row in shown["rows"]] == pytest.approx([0, -0.2, 0.2])


def test_an_item_of_a_list_is_a_column_and_a_list_is_not(http):
    lists = {"parameters": {"ratio": "0.5", "widths": [20, 24]}}
    choice = {"columns": ["widths[2]", "widths", "widths[3]", "ratio[1]"]}
    shown = table(http, created(http, {**document(), **lists, "table": choice}))
    row = shown["rows"][0]
    assert row["values"] == [24, None, None, None]
    assert "choose one of its items" in row["reasons"]["widths"]
    assert "has 2 values" in row["reasons"]["widths[3]"]
    assert "not a list" in row["reasons"]["ratio[1]"]


def test_the_columns_are_changed_and_removed_by_a_patch(http):
    design = created(http, document())
    chosen = patched(http, design, {"table": {"columns": [FILM]}})
    assert chosen["table"] == {"columns": [FILM]}
    assert [one["name"] for one in table(http, chosen)["columns"]] == [FILM]
    assert "table" not in patched(http, chosen, {"table": None})


def test_us_units_convert_the_columns(http, design):
    si, us = table(http, design), table(http, design, units="us")
    units = {one["name"]: one.get("unit") for one in us["columns"]}
    assert units[FILM] == "thou"
    assert column(us, FILM)["wide"] == pytest.approx(column(si, FILM)["wide"] / 25.4)


class Results(HTMLParser):
    """The cells of the table of results on a page."""

    def __init__(self):
        super().__init__()
        self.rows = {}

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if "data-result" in attrs:
            self.row = self.rows.setdefault(attrs["data-result"], [])
        elif tag == "td" and "data-number" in attrs and self.rows:
            self.row.append(float(attrs["data-number"]))


def test_page_csv_xlsx_and_interface_show_equal_numbers(http, design):
    shown, place = table(http, design), f"{DESIGNS}/{design['id']}/variants"
    lines = list(csv.reader(io.StringIO(http.get(f"{place}.csv").text)))
    sheet = load_workbook(io.BytesIO(http.get(f"{place}.xlsx").content)).active
    page = Results()
    page.feed(http.get(f"/designs/{design['id']}", headers={"Accept": "text/html"}).text)
    wanted = {row["name"]: [*row["values"], row["utilisation"]] for row in shown["rows"]}
    assert page.rows == {name: pytest.approx(values) for name, values in wanted.items()}
    heads = [f"results: {one['words']}" for one in shown["columns"]]
    at = [lines[0].index(head) for head in heads]
    units = [one["unit"] for one in shown["columns"]]
    assert [lines[1][i] for i in at] == units
    for line, cells in zip(lines[2:], sheet.iter_rows(min_row=3, values_only=True), strict=True):
        values = wanted[line[0]][: len(heads)]
        assert [float(line[i]) for i in at] == values
        assert [cells[i] for i in at] == pytest.approx(values, rel=1e-15)


def test_the_report_begins_with_the_table(http, design):
    text = http.get(f"{DESIGNS}/{design['id']}/variants/report.html").text
    films = column(table(http, design), FILM)
    for value in films.values():
        assert f"{value:.5g}" in text
    assert text.index("Results of the variants") < text.index("Inputs in which the variants differ")
    assert "Criteria of narrow, which governs" in text
    assert '<h2 id="step-film">' not in text
    whole = http.get(f"{DESIGNS}/{design['id']}/variants/report.html?appendix=true").text
    step = whole[whole.index('<h2 id="step-film">') :]
    assert (
        f"{films['narrow']:.5g}" in step
    )  # the worksheet of the governing variant, not of the design itself
    assert f"{films['base']:.5g}" not in step


def test_main_results_are_inputs_or_outputs_of_their_template(pytestconfig):
    catalogue = find([pytestconfig.rootpath / "templates"], Calculation)
    named = [(cls, name) for cls in catalogue.versions.values() for name in cls.main_results]
    assert len(named) > 80
    for cls, name in named:
        assert name.partition("[")[0] in {*cls.inputs, *cls.formulas}, (cls.id, name)
