"""The table of variants survives round trips as CSV and XLSX, and faulty cells are named by address."""

import io
import zipfile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openpyxl import Workbook, load_workbook
from seeds import examples

from app.designs.schemas.variants import VariantColumn, VariantsOut
from app.designs.variant_sheets.csv_files import read_csv, write_csv
from app.designs.variant_sheets.grid import address, refuse
from app.designs.variant_sheets.reader import read_variants
from app.designs.variant_sheets.writer import rows_of, sheet_columns
from app.designs.variant_sheets.xlsx_files import MOST_UNPACKED, read_xlsx, write_xlsx
from templates.core.errors import InvalidInputs

UNITS = {
    "clearance": "um",
    "bearing": "1",
    "film.bearing_width": "mm",
    "film.radial_load": "kN",
    "film.oil_grade": None,
    "shell.wall": "mm",
}
QUANTITIES = {"clearance": "um", "bearing": "1", "film.bearing_width": "mm", "film.radial_load": "kN"}


def sheet_of(grid, before=None):
    """Return the variants of a sheet; raise InvalidInputs with every faulty cell."""
    sheet, faults = read_variants(grid, UNITS, before or {})
    refuse(faults)
    return sheet


def out_of(variants):
    places = sorted({place for overrides in variants.values() for place in overrides})
    columns = [VariantColumn(place=p, words=p, unit=UNITS[p]) for p in places]
    return VariantsOut(
        design="d", name="n", revision=1, state="current", variants=variants, columns=columns, rows=[]
    )


def through_csv(variants):
    return read_csv(write_csv(rows_of(sheet_columns(out_of(variants)))))


def through_xlsx(variants):
    columns = sheet_columns(out_of(variants))
    return read_xlsx(write_xlsx(rows_of(columns), [c.is_result for c in columns], "n"))


def faults_of(call, *arguments):
    with pytest.raises(InvalidInputs) as caught:
        call(*arguments)
    return {fault.name: fault for fault in caught.value.faults}


def attempt(call):
    """Return the result of a call and no fault, or None and its faults."""
    try:
        return call(), ()
    except InvalidInputs as error:
        return None, error.faults


def csv_faults(text, before=None):
    return faults_of(lambda: sheet_of(read_csv(text.encode()), before or {}))


def book_of(*rows, title="Sheet", hidden=False):
    book = Workbook()
    if hidden:
        book.active.append(["secret"])
        book.active.sheet_state = "hidden"
        sheet = book.create_sheet(title)
    else:
        sheet = book.active
        sheet.title = title
    for row in rows:
        sheet.append(row)
    return bytes_of(book)


def bytes_of(book):
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


numbers = st.floats(-1e9, 1e9, allow_nan=False).map(lambda x: float(f"{x:.12g}"))


def typed(place):
    unit = QUANTITIES[place]
    text = numbers.map(lambda x: f"{x!r} {unit}" if unit != "1" else repr(x))
    whole = numbers.map(lambda x: {"value": x, "unit": unit})
    exact = numbers.map(lambda x: {"value": x, "unit": unit, "plus": 1, "minus": 0.5})
    array = st.lists(numbers, min_size=1, max_size=3).map(lambda x: {"value": x, "unit": unit})
    mixed = numbers.map(lambda x: [f"{x!r} {unit}" if unit != "1" else repr(x), "= 2 * a"])
    relation = st.sampled_from(["= width - 2 mm", "=-b", "=  loads.main_load_x / 2 ", "= 5 mm"])
    return st.one_of(text, whole, exact, array, mixed, relation)


overrides = st.fixed_dictionaries(
    {},
    optional={
        **{place: typed(place) for place in QUANTITIES},
        "film.oil_grade": st.sampled_from(["iso_vg_32", "10", "-x", "'-x", "@y"]),
    },
)
tables = st.dictionaries(
    st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,8}", fullmatch=True), overrides, max_size=5
).map(lambda table: {name: row for name, row in table.items() if name != "base"})


@settings(max_examples=examples(150), deadline=None)
@given(tables)
def test_a_round_trip_through_csv_changes_no_value(variants):
    assert sheet_of(through_csv(variants), variants).variants == variants


@settings(max_examples=examples(25), deadline=None)
@given(tables)
def test_a_round_trip_through_xlsx_changes_no_value(variants):
    assert sheet_of(through_xlsx(variants), variants).variants == variants


@settings(max_examples=examples(100), deadline=None)
@given(st.text(max_size=200))
def test_any_text_is_read_or_refused(text):
    variants, faults = attempt(lambda: sheet_of(read_csv(text.encode(errors="replace"))).variants)
    assert all(fault.name and fault.detail for fault in faults)
    assert all(set(overrides) <= set(UNITS) for overrides in (variants or {}).values())


def test_what_a_new_sheet_says_becomes_values_with_the_unit_of_their_column():
    text = (
        "variant,clearance,film.radial_load =,film.oil_grade\nunit,um,,\n"
        "main_1,55,,iso_vg_32\nmain_2,0.06 mm,2 * load,"
    )
    assert sheet_of(read_csv(text.encode())).variants == {
        "main_1": {"clearance": "55 um", "film.oil_grade": "iso_vg_32"},
        "main_2": {"clearance": "0.06 mm", "film.radial_load": "= 2 * load"},
    }


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"], ids=["plain", "with a byte-order mark"])
def test_semicolons_and_decimal_commas_are_read(mark):
    text = "variant;clearance;film.bearing_width\nunit;mm;mm\nmain_1;0,055;18,5\nmain_2;0,06 mm;\n"
    assert sheet_of(read_csv(mark + text.encode())).variants == {
        "main_1": {"clearance": "0.055 mm", "film.bearing_width": "18.5 mm"},
        "main_2": {"clearance": "0.06 mm"},
    }


def test_a_unit_may_stand_in_brackets_without_a_row_of_units():
    text = "variant;clearance [um]\nmain_1;55\n"
    assert sheet_of(read_csv(text.encode())).variants == {"main_1": {"clearance": "55 um"}}


def test_result_columns_and_blank_rows_are_ignored():
    text = "variant,clearance,results: verdict\n,um,\nmain_1,55,=rubbish\n,,3 met\n"
    assert sheet_of(read_csv(text.encode())).variants == {"main_1": {"clearance": "55 um"}}


def test_every_faulty_cell_is_named_at_once():
    faults = csv_faults(
        "variant,clearence,clearance,film.bearing_width,film.radial_load =,shell.wall\n"
        "unit,um,kN,mm,,mmm\n"
        "main_1,1,60,60 umm,= 2 * load,2\n"
        "2nd,1,60,abc,load +,2\n"
        "main_1,1,60,18,load,2\n"
        "base,,,,,\n"
    )
    assert {name: fault.code for name, fault in faults.items()} == {
        "B1": "unknown_name",
        "C2": "wrong_unit",
        "F2": "unknown_unit",
        "D3": "unknown_unit",
        "E3": "formula",
        "A4": "ill_named",
        "D4": "not_a_quantity",
        "E4": "syntax",
        "A5": "named_twice",
        "A6": "reserved",
    }
    assert "clearance" in faults["B1"].detail
    assert "umm" in faults["D3"].detail


@pytest.mark.parametrize("heading", ["zone", "bearing", ""])
def test_the_first_column_is_that_of_the_names(heading):
    faults = csv_faults(f"{heading},clearance\nunit,um\nmain_1,55\n")
    assert faults["A1"].code == "missing_name"
    assert "'variant'" in faults["A1"].detail


def test_a_number_without_a_unit_and_a_place_set_twice_are_refused():
    faults = csv_faults("variant,clearance,film.radial_load,film.radial_load =\n,,kN,\na,55,3,load\n")
    assert {name: fault.code for name, fault in faults.items()} == {"B3": "missing_unit", "D3": "set_twice"}


def test_faults_of_a_save_are_named_by_their_cells():
    from templates.core.errors import Fault

    text = "variant,clearance\nunit,um\n\nmain_1,55\n"
    sheet = sheet_of(read_csv(text.encode()))
    names = ("variants.main_1.clearance", "variants.main_1", "variants.main_1.film.speed", "film.speed")
    error = sheet.named(InvalidInputs(Fault(name, "c", "d") for name in names))
    assert [fault.name for fault in error.faults] == ["B4", "A4", "A4", "film.speed"]


def test_addresses_count_as_spreadsheets_do():
    assert [address(0, 0), address(3, 25), address(3, 26), address(9, 701), address(9, 702)] == [
        "A1",
        "Z4",
        "AA4",
        "ZZ10",
        "AAA10",
    ]


@pytest.mark.parametrize(
    ("content", "name", "code"),
    [
        (b"", "A1", "empty"),
        (b"variant,clearance\n,um\nm\xe4in,55", "A3", "not_utf_8"),
        (b"x" * 2_000_001, "A1", "too_long"),
        (b"variant\n" + b"a\n" * 1200, "A1201", "too_many_rows"),
        (b"variant," + b"x," * 500, "SG1", "too_many_columns"),
    ],
    ids=["empty", "latin-1", "long", "rows", "columns"],
)
def test_csv_files_that_are_no_tables_are_refused(content, name, code):
    assert {n: f.code for n, f in faults_of(read_csv, content).items()}.get(name) == code


def test_more_than_two_hundred_variants_are_refused():
    text = "variant,scale\nunit,1\n" + "".join(f"v{n},\n" for n in range(201))
    assert csv_faults(text)["A1"].code == "too_many_rows"
    row = ",".join("1" * 60)
    text = f"variant,{row}\n" + "".join(f"v{n},{row}\n" for n in range(180))
    assert csv_faults(text)["A1"].code == "too_many_values"


def test_formulas_dates_and_errors_in_cells_are_refused_by_address():
    import datetime

    content = book_of(
        ["variant", "clearance", "film.bearing_width", "shell.wall", "results: verdict"],
        ["unit", "um", "mm", "mm", None],
        ["main_1", "=1+1", datetime.datetime(2026, 1, 2), True, "=1+1"],
        ["main_2", 60, 18.5, 2, None],
    )
    faults = faults_of(lambda: sheet_of(read_xlsx(content)))
    assert {name: fault.code for name, fault in faults.items()} == {
        "B3": "formula",
        "C3": "date",
        "D3": "not_a_number",
    }


def test_hidden_sheets_are_passed_over_and_the_sheet_named_variants_is_read():
    rows = (["variant", "clearance"], ["unit", "um"], ["main_1", 55])
    assert read_xlsx(book_of(*rows, title="anything", hidden=True)).cell(2, 1) == "55"
    book = load_workbook(io.BytesIO(book_of(["notes"], title="notes")))
    sheet = book.create_sheet("Variants")
    for row in rows:
        sheet.append(row)
    assert read_xlsx(bytes_of(book)).cell(2, 0) == "main_1"


def test_an_exported_sheet_has_number_cells_frozen_headings_and_no_formula():
    variants = {
        "main_1": {"clearance": "55 um", "film.radial_load": "= -load"},
        "main_2": {"clearance": "0.06 mm"},
    }
    columns = sheet_columns(out_of(variants))
    content = write_xlsx(rows_of(columns), [False] * len(columns), "=1+1")
    sheet = load_workbook(io.BytesIO(content))["variants"]
    assert [cell.value for cell in sheet[1]] == ["variant", "clearance", "film.radial_load ="]
    assert [cell.value for cell in sheet[3]] == ["main_1", 55, "-load"]
    assert sheet["B4"].value == "0.06 mm"
    assert {cell.data_type for row in sheet.iter_rows() for cell in row} <= {"n", "s"}
    assert sheet["C3"].quotePrefix
    styles = [{(cell.font.bold, cell.font.italic) for cell in sheet[row]} for row in (1, 2, 3)]
    assert styles == [{(True, False)}, {(False, True)}, {(False, False)}]  # headings, units, values
    assert sheet.freeze_panes == "B3"
    assert sheet.column_dimensions["C"].width > len("film.radial_load =")
    assert b"'-load" in write_csv(rows_of(columns))


def archive_of(parts):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return stream.getvalue()


def repacked(content, change):
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    return archive_of(change(parts))


def test_a_file_that_unpacks_to_too_much_is_refused_before_it_is_unpacked():
    bomb = archive_of({"xl/worksheets/sheet1.xml": b" " * (MOST_UNPACKED + 1)})
    assert len(bomb) < 20_000
    assert faults_of(read_xlsx, bomb)["file"].code == "too_large"
    many = archive_of({f"part{n}": b"" for n in range(501)})
    assert faults_of(read_xlsx, many)["file"].code == "too_large"


def test_entities_of_xml_do_not_expand():
    levels = "".join(f'<!ENTITY a{n + 1} "{f"&a{n};" * 10}">' for n in range(9))
    doctype = f'<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a0 "aaaaaaaaaa">{levels}]>'.encode()
    body = b'<sheetData><row r="1"><c r="A1" t="inlineStr"><is><t>&a9;</t></is></c></row></sheetData>'

    def change(parts):
        xml = parts["xl/worksheets/sheet1.xml"]
        start = xml.index(b"<worksheet")
        before = xml[start : xml.index(b"<sheetData")]
        return {**parts, "xl/worksheets/sheet1.xml": doctype + before + body + b"</worksheet>"}

    content = repacked(book_of(["variant"]), change)
    assert faults_of(read_xlsx, content)["file"].code == "damaged"


@pytest.mark.parametrize(
    "content", [b"", b"PK\x03\x04rubbish", b"variant,clearance"], ids=["empty", "cut", "csv"]
)
def test_damaged_files_are_refused(content):
    assert faults_of(read_xlsx, content)["file"].code == "damaged"


SOUND = book_of(["variant", "clearance"], ["unit", "um"], ["main_1", 55])


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(0, len(SOUND) - 1), st.integers(1, 255))
def test_a_damaged_byte_is_refused_or_read_and_never_raises_anything_else(place, change):
    content = bytearray(SOUND)
    content[place] ^= change
    grid, faults = attempt(lambda: read_xlsx(bytes(content)))
    assert grid.rows if grid else faults


def test_a_cell_far_below_is_refused_not_dropped():
    book = load_workbook(io.BytesIO(book_of(["variant"], ["main_1"])))
    book.worksheets[0].cell(5000, 2).value = 1
    assert "too_many_rows" in {f.code for f in faults_of(read_xlsx, bytes_of(book)).values()}
