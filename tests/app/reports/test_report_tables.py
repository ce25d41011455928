"""Worksheets as CSV and XLSX: numbers are numbers, units are separate, texts are not formulas."""

import csv
import io

import openpyxl
import pytest
from serving import API, created, paper, problem

DESIGNS = f"{API}/designs"
DIGITS = 1e-15  # as many as a spreadsheet keeps
XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"


@pytest.fixture(scope="module")
def bearing(http):
    speeds = {"value": [1000, 2000, 0], "unit": "rpm"}
    friction = {
        "template": "journal_friction",
        "version": 1,
        "inputs": {
            "journal_diameter": "48 mm",
            "bearing_width": "18 mm",
            "radial_clearance": "25 um",
            "speed": speeds,
            "dynamic_viscosity": "10 mPa*s",
        },
    }
    steps = {**paper()["steps"], "friction": friction}
    return created(http, paper(name="=1+1", steps=steps))


@pytest.fixture(scope="module")
def worksheet(http, bearing):
    return http.get(f"{DESIGNS}/{bearing['id']}/revisions/1").json()


def place(bearing):
    return f"{DESIGNS}/{bearing['id']}/worksheet"


@pytest.fixture(scope="module")
def lines(http, bearing):
    answer = http.get(place(bearing), headers={"Accept": "text/csv"})
    assert answer.headers["content-type"] == "text/csv; charset=utf-8"
    return list(csv.DictReader(io.StringIO(answer.text, newline="")))


@pytest.fixture(scope="module")
def book(http, bearing):
    answer = http.get(place(bearing), headers={"Accept": XLSX})
    assert answer.headers["content-type"] == XLSX
    return openpyxl.load_workbook(io.BytesIO(answer.content))


def values(book):
    rows = list(book["Values"].iter_rows(values_only=True))
    return {(row[0], row[2]): dict(zip(rows[0], row, strict=True)) for row in rows[1:]}


def test_csv_has_every_input_and_output(lines, worksheet):
    film = worksheet["steps"]["film"]
    by_place = {(line["block"], line["kind"], line["name"]): line for line in lines}
    for kind, part in (("input", "inputs"), ("output", "outputs")):
        for name, quantity in film[part].items():
            line = by_place["film", kind, name]
            assert float(line["value"]) == quantity["value"]
            assert line["unit"] == quantity["unit"]
    assert by_place["model", "dimension", "inner_diameter"]["value"] == "48.0"


def test_csv_counts_points_and_tells_reasons(lines, worksheet):
    ratios = worksheet["steps"]["friction"]["outputs"]["sommerfeld_number"]
    forces = [line for line in lines if line["name"] == "friction_force"]
    assert [line["index"] for line in forces] == ["1", "2", "3"]
    masked = [line for line in lines if line["name"] == "sommerfeld_number" and line["block"] == "friction"]
    assert [line["value"] == "" for line in masked] == [value is None for value in ratios["value"]]
    assert [line["remark"] for line in masked] == [reason or "" for reason in ratios["reasons"]]


def test_xlsx_numbers_are_numbers_and_units_stand_apart(book, worksheet):
    cells = values(book)
    for name, quantity in worksheet["steps"]["film"]["outputs"].items():
        row = cells["film", name]
        assert row["value"] == pytest.approx(quantity["value"], rel=DIGITS)
        assert isinstance(row["value"], (int, float))
        assert (row["unit"] or "") == quantity["unit"]
    assert cells["design", "scale"]["value"] == 1


def test_xlsx_curves_have_a_sheet_of_their_own(book, worksheet):
    sheet = book["friction"]
    columns = {column[0]: column for column in sheet.iter_cols(values_only=True)}
    force = worksheet["steps"]["friction"]["outputs"]["friction_force"]
    assert columns["friction_force"][1] == "N"
    assert list(columns["friction_force"][2:]) == pytest.approx(force["value"], rel=DIGITS)
    assert columns["speed"][1:] == ("rpm", 1000, 2000, 0)


def test_relations_are_texts_and_no_formulas(book, lines):
    assert not any(cell.data_type == "f" for sheet in book for row in sheet.iter_rows() for cell in row)
    origin = values(book)["film", "bearing_diameter"]["origin"]
    assert origin == "= scale * 48 mm"
    marked = [c for row in book["Values"].iter_rows() for c in row if c.value == "= scale * 48 mm"]
    assert all(cell.quotePrefix for cell in marked)
    texts = [cell for line in lines for cell in line.values() if cell and not _is_number(cell)]
    assert any(text == "'= scale * 48 mm" for text in texts)
    assert not any(text.startswith(("=", "+", "-", "@")) for text in texts)


def _is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


def test_us_units(http, bearing):
    table = csv.DictReader(io.StringIO(http.get(f"{place(bearing)}.csv", params={"units": "us"}).text))
    film = next(line for line in table if line["name"] == "minimum_film_thickness")
    assert film["unit"] == "thou"


def test_json_is_the_usual_kind(http, bearing):
    for accept in ("*/*", "application/json", "image/gif"):
        answer = http.get(place(bearing), headers={"Accept": accept}).json()
        assert answer["steps"]["film"]["formulas"]
    assert http.get(f"{DESIGNS}/{bearing['id']}/revisions/1/worksheet").json() == answer


def test_unknown_kind(http, bearing):
    refusal = problem(http.get(f"{place(bearing)}.ods"), 404, "not-found")
    assert "xlsx" in refusal["detail"]


def test_names_of_sheets(http):
    double = {"template": "double", "version": 1, "inputs": {"length": {"value": [1, 2], "unit": "mm"}}}
    names = ["a" * 40, "a" * 41, "Values", "values2"]
    design = created(http, {"name": "sheets", "steps": dict.fromkeys(names, double)})
    content = http.get(f"{DESIGNS}/{design['id']}/worksheet.xlsx").content
    sheets = openpyxl.load_workbook(io.BytesIO(content)).sheetnames
    assert len(sheets) == 5
    assert len({name.lower() for name in sheets}) == 5


def test_a_step_that_waits_has_its_inputs(http):
    loops = {"id": "moody", "version": 1, "parameters": {"size": "11.125 mm", "mood": "loops"}}
    double = {"template": "double", "version": 1, "inputs": {"length": "= model.mass * 1 mm/kg"}}
    answer = http.post(
        DESIGNS, json={"name": "waits", "steps": {"d": double}, "model": loops}, headers={"Prefer": "wait=0"}
    )
    lines = list(csv.DictReader(io.StringIO(http.get(f"{place(answer.json())}.csv").text)))
    assert [line["value"] for line in lines if line["name"] == "length"] == ["'= model.mass * 1 mm/kg"]
    assert http.delete(answer.headers["location"]).is_success
