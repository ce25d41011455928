"""The table of variants over HTTP as CSV and XLSX: read, saved, refused with addresses of cells."""

import io

import pytest
from openpyxl import Workbook, load_workbook
from serving import API, created, faults, paper, problem

DESIGNS = f"{API}/designs"
CSV = "text/csv"
XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
TABLE = (
    "variant,scale,film.radial_load,film.bearing_width =\nunit,1,kN,\nmain_1,1.1,,\nmain_2,,24,20 mm - 1 mm\n"
)
VARIANTS = {
    "main_1": {"scale": "1.1"},
    "main_2": {"film.bearing_width": "= 20 mm - 1 mm", "film.radial_load": "24 kN"},
}


def without_model(**more):
    document = paper(**more)
    del document["model"]
    return document


@pytest.fixture
def design(http):
    return created(http, without_model())


def put(http, design, content, media=CSV, tag='"1"', **headers):
    body = content.encode() if isinstance(content, str) else content
    sent = {"Content-Type": media, "If-Match": tag, "Prefer": "wait=30", **headers}
    return http.put(f"{DESIGNS}/{design['id']}/variants", content=body, headers=sent)


def sheet(http, design, media):
    answer = http.get(f"{DESIGNS}/{design['id']}/variants", headers={"Accept": media})
    assert answer.status_code == 200
    assert answer.headers["content-type"].partition(";")[0] == media
    return answer


def stored(http, design):
    whole = http.get(f"{DESIGNS}/{design['id']}").json()
    return whole["revision"], whole.get("variants", {})


def test_a_sheet_becomes_the_variants_of_a_design(http, design):
    answer = put(http, design, TABLE)
    assert answer.status_code == 200, answer.text
    assert answer.headers["etag"] == '"2"'
    assert answer.json()["variants"] == VARIANTS
    assert stored(http, design) == (2, VARIANTS)


@pytest.mark.parametrize("media", [CSV, XLSX])
def test_what_is_read_can_be_saved_again_without_a_revision(http, media):
    written = {
        "exact": {
            "scale": {"value": 1.1, "unit": "1"},
            "film.speed": {"value": 4000, "unit": "rpm", "plus": 5},
        },
        "related": {"film.bearing_width": "= scale * 18 mm", "film.radial_load": "= -(-2) * 12 kN"},
        "nothing": {},
        "small": {"film.diametral_clearance": " 0.05 mm", "film.radial_load": "2.4e4 N"},
    }
    design = created(http, without_model(variants=written))
    answer = sheet(http, design, media)
    again = put(http, design, answer.content, media, answer.headers["etag"])
    assert again.status_code == 200, again.text
    assert stored(http, design) == (1, dict(sorted(written.items())))


def test_results_stand_behind_the_inputs(http, design):
    put(http, design, TABLE)
    answer = http.get(f"{DESIGNS}/{design['id']}/variants.csv")
    assert 'filename="' in answer.headers["content-disposition"]
    head = answer.text.splitlines()[0].split(",")
    assert head[:4] == ["variant", "scale", "film.radial_load", "film.bearing_width ="]
    assert all(name.startswith("results: ") for name in head[4:])
    book = load_workbook(io.BytesIO(http.get(f"{DESIGNS}/{design['id']}/variants.xlsx").content))
    rows = list(book["variants"].iter_rows(values_only=True))
    assert rows[0][:4] == ("variant", "scale", "film.radial_load", "film.bearing_width =")
    assert rows[2][:3] == ("main_1", 1.1, None)
    assert rows[3][:4] == ("main_2", None, 24, "20 mm - 1 mm")


def test_json_stays_what_is_answered_where_no_sheet_is_asked_for(http, design):
    path = f"{DESIGNS}/{design['id']}/variants"
    for accept in ("*/*", "application/json", "text/html", "application/json, text/csv;q=0.5", ""):
        answer = http.get(path, headers={"Accept": accept})
        assert answer.headers["content-type"] == "application/json", accept
    assert http.get(path, headers={"Accept": "application/json;q=0.5, text/csv"}).text.startswith("variant")


def test_every_faulty_cell_is_named_and_nothing_is_saved(http, design):
    head = "variant,film.radial_load,film.bearng_width,film.speed\nunit,kN,mm,rpm\n"
    text = f"{head}a,24 umm,18,=1\nb,2 mm,18,5000\n"
    answer = put(http, design, text)
    problem(answer, 422, "invalid-inputs")
    assert faults(answer) == {
        "B3": "unknown_unit",
        "B4": "wrong_unit",
        "C1": "unknown_name",
        "D3": "formula",
    }
    details = {fault["name"]: fault["detail"] for fault in answer.json()["errors"]}
    assert "umm" in details["B3"]
    assert "film.bearing_width" in details["C1"]
    assert stored(http, design) == (1, {})


def test_cells_that_cannot_be_read_hide_none_that_the_calculation_refuses(http, design):
    head = "variant,film.radial_load,film.bearing_width =,film.speed\nunit,kN,,mm\n"
    text = f"{head}a,abc,,1\nb,-24,film.nothing,5\nb,24,,\nc,24,20 kN,\nd,25,19 mm,\n"
    answer = put(http, design, text)
    problem(answer, 422, "invalid-inputs")
    assert set(faults(answer)) == {"D2", "B3", "B4", "C4", "A5", "C6"}
    details = {fault["name"]: fault["detail"] for fault in answer.json()["errors"]}
    assert "'abc'" in details["B3"]
    assert "-24 kN; it must be" in details["B4"]
    assert stored(http, design) == (1, {})


def test_what_the_calculation_refuses_is_named_by_its_cell(http, design):
    head = "variant,film.radial_load,film.bearing_width =\nunit,kN,\n"
    refused = faults(put(http, design, f"{head}a,-24,\nb,24,20 mm\nc,-1,\n"))
    assert set(refused) == {"B3", "B5"}
    assert set(faults(put(http, design, f"{head}a,24,film.nothing\nb,24,20 kN\n"))) == {"C3", "C4"}


def test_formula_cells_of_a_workbook_are_refused(http, design):
    book = Workbook()
    for row in (["variant", "film.radial_load"], ["unit", "kN"], ["a", "=20+4"]):
        book.active.append(row)
    stream = io.BytesIO()
    book.save(stream)
    assert faults(put(http, design, stream.getvalue(), XLSX)) == {"B3": "formula"}


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"PK\x03\x04", b"\x00" * 100, b'"'], ids=repr)
@pytest.mark.parametrize("media", [CSV, XLSX])
def test_what_is_no_table_is_refused(http, design, content, media):
    answer = put(http, design, content, media)
    problem(answer, 422, "invalid-inputs")
    assert faults(answer)


def test_a_change_needs_the_revision_that_was_read(http, design):
    put(http, design, TABLE)
    problem(put(http, design, TABLE.replace("1.1", "1.2"), tag='"1"'), 412, "stale-revision")
    headers = {"Content-Type": CSV}
    bare = http.put(f"{DESIGNS}/{design['id']}/variants", content=TABLE.encode(), headers=headers)
    problem(bare, 428, "precondition-required")
    assert put(http, design, TABLE.replace("1.1", "1.2"), tag="*").status_code == 200


def test_a_repeated_request_makes_one_revision(http, design):
    key = {"Idempotency-Key": f"sheet-{design['id']}"}
    assert put(http, design, TABLE, **key).headers["etag"] == '"2"'
    assert put(http, design, TABLE, **key).headers["etag"] == '"2"'
    assert stored(http, design)[0] == 2


def test_other_media_and_unknown_designs_are_refused(http, design):
    problem(put(http, design, TABLE, "text/plain"), 415, "unsupported-media-type")
    nobody = {"id": "nobody"}
    problem(put(http, nobody, TABLE), 404, "not-found")
    for path in ("variants.csv", "variants.xlsx", "variants/report.html"):
        problem(http.get(f"{DESIGNS}/nobody/{path}"), 404, "not-found")


def test_a_design_without_variants_has_no_report_of_them_and_an_empty_table(http, design):
    problem(http.get(f"{DESIGNS}/{design['id']}/variants/report.html"), 404, "not-found")
    assert sheet(http, design, CSV).text == "variant\r\nunit\r\n"
