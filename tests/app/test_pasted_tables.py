"""Pasted tables are read with any separator, decimal commas and units; faults name row and column."""

import time

import pytest

from app.calculations.tables import MOST_CHARACTERS, MOST_ROWS, read_table
from app.schemas.tables import ChosenColumn, PastedTable, TableField
from app.web.lists.columns import paste
from templates.core.errors import InvalidInputs

FIELDS = [
    TableField(name="cycle.crank_angle", words="crank angle", symbol="\\theta", unit="deg"),
    TableField(name="cycle.load_x", words="load x", symbol="F_{x}", unit="N"),
    TableField(name="cycle.load_y", words="load y", symbol="F_{y}", unit="N"),
]
CYCLE = "crank angle;Fx;load y\ndeg;kN;kN\n0;1,5;0\n240;-2,5;1\n480;0,5;-1\n720;1,5;0\n"


def columns(text):
    return [(c.name, c.unit, c.values) for c in read_table(text)]


def faults(text):
    with pytest.raises(InvalidInputs) as error:
        read_table(text)
    return [f"{fault.name}: {fault.detail}" for fault in error.value.faults]


ANGLES = ("angle", "deg", (0.0, 15.5))
LOADS = ("load_x", "kN", (1.0, -2.5))


@pytest.mark.parametrize(
    "text",
    [
        "angle [deg],load_x [kN]\n0,1\n15.5,-2.5\n",
        "angle [deg];load_x [kN]\n0;1\n15,5;-2,5\n",
        "angle (deg)\tload_x (kN)\n0\t1\n15,5\t-2,5",
        "angle;load_x\ndeg;kN\n0;1\n15,5;-2.5\n",
        "angle,load_x\n[deg],[kN]\n0,1\n15.5,-2.5\n",
        "\ufeffangle [deg],load_x [kN]\r\n0,1\r\n15.5,-2.5\r\n",
        "\n\nangle [deg],load_x [kN]\n\n0,1\n \n15.5,-2.5\n\n",
        "angle [deg];load_x [kN];;\n0;1;;\n;;;\n15,5;-25e-1;;\n",
        'angle [deg],"load_x [kN]"\n"0","1"\n15.5, -2.5\n',
        "angle [deg],load_x\n-,kN\n0,1\n15.5,-2.5\n".replace("-,kN", "deg,kN"),
    ],
    ids=["comma", "semicolon", "tab", "units row", "bracketed", "bom and crlf", "blank lines", "spreadsheet",
         "quoted", "unit twice"],
)  # fmt: skip
def test_a_table_is_read_however_it_was_saved(text):
    assert columns(text) == [ANGLES, LOADS]


def test_numbers_without_headings_and_pure_numbers_are_read():
    assert columns("1\n2\n3,\n") == [("column 1", "", (1.0, 2.0, 3.0))]
    assert columns("order\n1\n2\n") == [("order", "", (1.0, 2.0))]
    assert columns("order;angle\n1;deg\n1;5\n2;6\n") == [
        ("order", "1", (1.0, 2.0)),
        ("angle", "deg", (5.0, 6.0)),
    ]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("load_x [kN]\n1\n\nabc\n", "row 4, column load_x: 'abc' is not a number; write one such as 0.05"),
        ("a [deg];load_x [kN]\n1;\n", "row 2, column load_x: there is no number; write one such as 0.05"),
        ("a [deg],b [kN]\n1,2\n1,5,2\n", "row 3: it has 3 cells, the first row has 2; with decimal commas"),
        ("a [deg];b [kN]\n1;2\n3\n", "row 3: it has 1 cells, the first row has 2"),
        ("a [deg]\n1\n=A2+1\n", "row 3, column a: '=A2+1' is a formula; paste its value instead"),
        ("a [deg]\n=A2+1\n", "row 2, column a: '=A2+1' is a formula"),
        ("a [deg]\nNaN\n", "'NaN' is no"),
        ("a [deg]\n1e999\n", "row 2, column a: '1e999' is too large"),
        ("a [qqq]\n1\n", "row 1, column a: 'qqq' is not a known unit"),
        ("a;b\nkN;foo\n1;2\n", "row 2, column b: 'foo' is not a known unit"),
        ("a [N]\nkN\n1\n", "row 2, column a: the header says N, this row kN; keep one of them"),
        ("a [deg]\n1.000,5\n", "row 2: it has 2 cells"),
        ("a [deg]\n", "the table has no row of numbers"),
        (" \n;;\n", "the table is empty"),
        ('a;b\n"1;2\n', "row 2"),
        ("1;" * 33 + "1\n", "at most 32 columns"),
        ("1\n" * (MOST_ROWS + 3), "at most 10000 rows"),
        ("1" * (MOST_CHARACTERS + 1), "at most 1000000"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_by_row_and_column(text, wanted):
    assert any(wanted in fault for fault in faults(text)), faults(text)


def test_twenty_wrong_cells_are_named_and_the_others_counted():
    text = "a [deg]\n" + "1\nx\n" * 50
    assert len(faults(text)) == 21
    assert faults(text)[-1].startswith("table: 30 further faults of this table are not listed")
    assert faults(text)[1] == "row 5, column a: 'x' is not a number; write one such as 0.05"


def test_columns_go_to_fields_by_name_and_the_repeated_last_point_is_left_out():
    read = paste(PastedTable(text=CYCLE, fields=FIELDS))
    assert read.faults == []
    assert read.texts == {
        "cycle.crank_angle": "[0, 240, 480] deg",
        "cycle.load_x": "[1.5, -2.5, 0.5] kN",
        "cycle.load_y": "[0, 1, -1] kN",
    }
    assert read.rows == 3
    assert "720° apart" in read.notes[0]
    assert "left out" in read.notes[0]


def test_a_last_point_that_differs_is_kept_and_said():
    read = paste(PastedTable(text=CYCLE.replace("720;1,5", "720;2,5"), fields=FIELDS))
    assert read.texts["cycle.crank_angle"] == "[0, 240, 480, 720] deg"
    assert read.notes == ["The first and the last point lie 720° apart, but differ in Fx; both were kept."]


def test_an_offset_is_added_to_the_angles_in_their_own_unit():
    read = paste(PastedTable(text=CYCLE, fields=FIELDS, offset="0.2 rad"))
    assert read.texts["cycle.crank_angle"] == "[11.4591559026, 251.459155903, 491.459155903] deg"
    assert paste(PastedTable(text=CYCLE, fields=FIELDS, offset="-0.1 deg")).first[0][0] == -0.1
    for wrong, words in (("10", "angle offset"), ("3 mm", "angle offset"), ("abc", "angle offset")):
        read = paste(PastedTable(text=CYCLE, fields=FIELDS, offset=wrong))
        assert read.texts == {}
        assert words in read.faults[0]
    loads = PastedTable(text="load x [kN]\n1\n2\n", fields=FIELDS, offset="10 deg")
    assert "no column holds crank angles" in paste(loads).faults[0]


def test_a_column_needs_a_unit_that_fits_its_field():
    bare = PastedTable(text="load_x,load_y\n1,2\n3,4\n", fields=FIELDS)
    assert paste(bare).faults == [f"column load_{c} has no unit; give one, such as N" for c in "xy"]
    load, twice = ChosenColumn(field="cycle.load_x", unit="N"), ChosenColumn(field="cycle.load_x", unit="kN")
    assert "two columns" in paste(bare.model_copy(update={"columns": [load, twice]})).faults[0]
    other = ChosenColumn(field="", unit="")
    assert paste(bare.model_copy(update={"columns": [load, other]})).texts == {"cycle.load_x": "[1, 3] N"}
    wrong = ChosenColumn(field="cycle.load_x", unit="mm")
    assert "a force is wanted" in paste(bare.model_copy(update={"columns": [wrong, other]})).faults[0]
    assert "choose a field" in paste(bare.model_copy(update={"columns": [other, other]})).faults[0]


def test_reading_is_linear_in_the_length():
    def seconds(rows):
        text = "a [deg];b [kN]\n" + "1,5;x\n" * rows
        start = time.thread_time()
        assert len(faults(text)) == 21
        return time.thread_time() - start

    seconds(100)
    assert seconds(8000) < 60 * max(seconds(800), 1e-3)
