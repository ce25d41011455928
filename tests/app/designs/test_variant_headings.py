"""Tables of variants written by people: headings in words, names with spaces."""

import pytest

from app.designs.variant_sheets.grid import grid_of, refuse
from app.designs.variant_sheets.reader import read_variants
from templates.core.errors import InvalidInputs

UNITS = {"width": "mm", "film.radial_load": "N", "film.speed": "rad/s", "pad.speed": "m/s", "film.width": "m"}


def read(*rows):
    sheet, faults = read_variants(grid_of(rows), UNITS, {})
    refuse(faults)
    return sheet.variants


@pytest.mark.parametrize("heading", ["film.radial_load", "radial load", "Radial  Load", "RADIAL_LOAD"])
def test_an_input_is_named_by_its_words_where_they_mean_one(heading):
    assert read(["variant", heading], ["unit", "kN"], ["main 1", "21"], ["main_2", "22"]) == {
        "main_1": {"film.radial_load": "21 kN"},
        "main_2": {"film.radial_load": "22 kN"},
    }


def test_words_with_a_unit_in_brackets_and_for_a_relation():
    read_back = read(["variant", "radial load [kN]", "film.width ="], ["front main", "3", "2 * width"])
    assert read_back == {"front_main": {"film.radial_load": "3 kN", "film.width": "= 2 * width"}}


def test_a_whole_name_prevails_over_the_words_of_an_input():
    assert read(["variant", "width"], ["unit", "mm"], ["a", "5"]) == {"a": {"width": "5 mm"}}


@pytest.mark.parametrize(
    ("rows", "where", "code"),
    [
        ((["variant", "speed"], ["a", "5"]), "B1", "unknown_name"),  # of two steps
        ((["variant", "radial load", "film.radial_load"], ["a", "1 N", "2 N"]), "C1", "named_twice"),
        ((["variant", "width"], ["main 1", "5 mm"], ["main_1", "6 mm"]), "A3", "named_twice"),
        ((["variant", "width"], ["1st main", "5 mm"]), "A2", "ill_named"),
    ],
)
def test_what_is_not_clear_is_refused_in_its_cell(rows, where, code):
    with pytest.raises(InvalidInputs) as caught:
        read(*rows)
    assert [(fault.name, fault.code) for fault in caught.value.faults] == [(where, code)]


@pytest.mark.parametrize(
    ("typed", "name"),
    [
        ("main 1", "main_1"),
        ("pin +10 %", "pin_plus_10_percent"),
        ("throw +1.5 mm", "throw_plus_1_point_5_mm"),
        ("throw −1,5 mm", "throw_minus_1_point_5_mm"),
        ("width -2 mm", "width_minus_2_mm"),
        ("crank-pin", "crank_pin"),
        ("face 1.4°", "face_1_point_4_deg"),
    ],
)
def test_a_row_is_named_as_people_write_it(typed, name):
    assert read(["variant", "width"], ["unit", "mm"], [typed, "5"]) == {name: {"width": "5 mm"}}
