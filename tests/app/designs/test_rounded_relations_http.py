"""A rounded relation over HTTP: the solid has the chosen size, and every answer and sheet states both."""

import csv
import io

import ezdxf
import pytest
from bare_shells import BUSH
from serving import API, created, faults, moody, revision
from study_helpers import done

DESIGNS = f"{API}/designs"
WIDTH = "= 0.31 * bore rounded up to 0.5 mm"
SHOWN = "calculated 14.942 mm → chosen 15 mm"
ROUNDED = {
    "name": "shell.width",
    "rule": "rounded up to 0.5 mm",
    "calculated": {"value": 14.942, "unit": "mm"},
    "chosen": {"value": 15.0, "unit": "mm"},
}


def document(**more):
    sizes = {**BUSH, "inner_diameter": "= bore", "width": WIDTH}
    return {
        "name": "rounded shell",
        "parameters": {"bore": "48.2 mm"},
        "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": sizes}},
        "criteria": {"wide": {"require": "shell.width >= 14.95 mm"}},
        "variants": {"big": {"bore": "50 mm"}, "free": {"shell.width": "= 0.31 * bore"}},
        **more,
    }


@pytest.fixture(scope="module")
def design(http):
    made = created(http, document())
    assert made["state"] == "current", made["problem"]
    return made


def place(design):
    return f"{DESIGNS}/{design['id']}"


def test_the_solid_measures_the_chosen_size(http, design):
    measured = http.get(f"{place(design)}/measurements").json()["shell"]["dimensions"]["width"]
    assert measured["value"] == pytest.approx(15, abs=1e-6)


def test_the_revision_lists_both_values_and_judges_the_chosen_one(http, design):
    shown = revision(http, design)
    assert shown["rounded"] == [ROUNDED]
    assert shown["models"]["shell"]["parameters"]["width"] == {"value": 15.0, "unit": "mm"}
    table = http.get(f"{place(design)}/variants").json()
    rows = {row["name"]: row.get("rounded") for row in table["rows"]}
    assert rows["free"] is None
    verdicts = {row["name"]: row["criteria"][0]["verdict"] for row in (table["base"], *table["rows"])}
    assert verdicts == {"base": "met", "big": "met", "free": "not_met"}
    assert rows["big"][0]["calculated"]["value"] == rows["big"][0]["chosen"]["value"] == 15.5
    detail = http.get(f"{place(design)}/variants/big").json()
    assert detail["rounded"][0]["chosen"] == {"value": 15.5, "unit": "mm"}


def test_a_preview_states_both_values(http, design):
    shown = http.post(f"{place(design)}/preview", json={"parameters": {"bore": "52 mm"}}).json()
    assert shown["rounded"][0]["calculated"] == {"value": 16.12, "unit": "mm"}
    assert shown["model_parameters"]["shell.width"]["new"] == {"value": 16.5, "unit": "mm"}
    american = http.post(f"{place(design)}/preview?units=us", json={}).json()["rounded"][0]
    assert american["chosen"]["unit"] == "inch"
    assert american["chosen"]["value"] == pytest.approx(15 / 25.4)


def test_an_explanation_states_both_values(http, design):
    chain = http.get(f"{place(design)}/explain/shell.width").json()
    assert chain["rounded"] == ROUNDED
    assert r"\text{rounded up to 0.5 mm}" in chain["latex"]
    (slope,) = chain["sensitivities"]
    assert (slope["name"], "slope" in slope) == ("bore", False)
    assert "rounded up to 0.5 mm" in slope["reason"]


def test_a_step_of_another_dimension_is_refused(http):
    wrong = document()
    wrong["models"]["shell"]["parameters"]["width"] = "= 0.31 * bore rounded to 0.5 N"
    answer = http.post(DESIGNS, json=wrong)
    assert faults(answer) == {"shell.width": "unit_mismatch"}
    assert answer.json()["errors"][0]["detail"].endswith("give the step in mm, such as 0.5 mm")


def test_a_table_has_the_calculated_value_as_a_remark(http, design):
    text = http.get(f"{place(design)}/worksheet.csv").text
    rows = [row for row in csv.DictReader(io.StringIO(text)) if row["name"] == "width"]
    assert [(row["value"], row["origin"], row["remark"]) for row in rows] == [("15.0", f"'{WIDTH}", SHOWN)]


def test_a_drawing_states_both_values(http, design):
    answer = http.get(f"{place(design)}/model.dxf", headers={"Prefer": "wait=60"})
    drawing = ezdxf.read(io.StringIO(answer.text))
    texts = [entity.dxf.text for entity in drawing.modelspace().query("TEXT")]
    assert f"width: {SHOWN}" in texts
    svg = http.get(f"{place(design)}/model.drawing.svg", headers={"Prefer": "wait=60"}).text
    assert f"width: {SHOWN}" in svg
    free = http.get(f"{place(design)}/variants/free/model.dxf", headers={"Prefer": "wait=60"}).text
    assert "calculated" not in free


def test_a_report_states_both_values(http, design):
    text = http.get(f"{place(design)}/report.html", headers={"Prefer": "wait=60"}).text
    assert SHOWN in text
    assert "<h2>Rounded values</h2>" in text


@pytest.mark.slow
def test_a_report_on_paper_is_typeset(http, design):
    answer = http.get(f"{place(design)}/report.pdf", headers={"Prefer": "wait=60"})
    assert answer.content.startswith(b"%PDF")


def test_an_iteration_that_alternates_between_two_multiples_names_the_rounding(http):
    """A cube of 20 mm weighs 63 g and asks for 30 mm; one of 30 mm weighs 212 g and asks for 20 mm."""
    document = moody("= 36 mm - model.mass * 85 mm/kg rounded to 10 mm")
    document["iterations"] = [{"through": "model.mass", "start": "63 g", "limit": 3}]
    design = created(http, document)
    assert design["state"] == "failed"
    detail = design["problem"]["detail"]
    assert "model.size (rounded to 10 mm) may alternate between two multiples: use a smaller step" in detail


def test_an_iteration_settles_on_a_chosen_size(http):
    document = moody("= 20 mm + model.mass * 10 mm/kg rounded up to 1 mm")
    document["iterations"] = [{"through": "model.mass", "start": "1 kg", "limit": 5}]
    design = created(http, document)
    assert design["state"] == "current", design["problem"]
    (row,) = revision(http, design)["rounded"]
    assert row["chosen"] == {"value": 21.0, "unit": "mm"}
    assert 20 < row["calculated"]["value"] < 21


def test_the_page_of_solve_states_the_target_with_the_chosen_values(http):
    sizes = {"bore": "48.2 mm", "wide": "= 0.31 * bore rounded up to 0.5 mm"}
    made = created(http, {"name": "to solve", "parameters": sizes})
    asked = {"unknown": "bore", "low": "40 mm", "high": "60 mm", "output": "wide", "value": "15.2 mm"}
    page = http.get(f"/designs/{made['id']}/solve", params=asked, headers={"Accept": "text/html"}).text
    assert "solved with the calculated values of wide (rounded up to 0.5 mm)" in page
    assert "15.5 mm with the chosen values" in page


def test_slopes_of_a_study_name_the_rounding(http):
    sizes = {"bore": "48.2 mm", "wide": "= 0.31 * bore rounded up to 0.5 mm", "free": "= 0.5 * bore"}
    made = created(http, {"name": "sizes alone", "parameters": sizes})
    vary = {"bore": {"between": ["47 mm", "49 mm"]}}
    study = done(http, made, method="sensitivity", kind="local", vary=vary, outputs=["wide", "free"])
    indices = study["result"]["indices"]
    assert "slope" not in indices["wide"]["bore"]
    assert indices["free"]["bore"]["slope"]["value"] == pytest.approx(0.5)  # mm/mm
    (note,) = [one for one in study["result"]["notes"] if "wide" in one]
    assert note == (
        "wide has no slope over bore, which acts through wide (rounded up to 0.5 mm): it changes in steps"
    )
