"""The table of results: a row for the design and each variant, equal on page, in files and in the report."""

import pytest
from equal_tables import PDF_TO_TEXT, assert_equal_in_print, assert_equal_on_page_and_in_files
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


def test_page_files_client_and_interface_show_equal_numbers(served, http, design):
    assert_equal_on_page_and_in_files(http, served.url, design["id"])


@pytest.mark.slow
@pytest.mark.skipif(not PDF_TO_TEXT, reason="needs Debian's package poppler-utils, which reads the PDF")
def test_the_first_page_of_the_report_has_the_numbers_of_the_table(http, design, tmp_path):
    assert_equal_in_print(http, design["id"], tmp_path)


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
