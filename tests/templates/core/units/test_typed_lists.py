"""Lists are read as people type them, and everything else as before."""

import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from templates.core.errors import FaultyText
from templates.core.units.quantity import read, read_any, read_beside
from templates.core.units.typed_lists import LONGEST_LIST, listed

NUMBERS = st.lists(
    st.integers(0, 99).map(float) | st.floats(0.001, 99.9).map(lambda x: round(x, 3)), min_size=2
)
UNITS = st.sampled_from(["mm", "deg", "kN", "m/s", "1/s", "µm"])


@given(st.lists(st.integers(0, 64), min_size=2, max_size=40))
def test_a_firing_order_is_the_list_of_its_numbers(order):
    assert read("-".join(map(str, order)), "1").si.tolist() == order


@given(
    NUMBERS, UNITS.filter(lambda unit: unit[0] != "1"), st.sampled_from([" ", "  ", "; ", ";", ", ", " ; "])
)
def test_separators_of_a_list_change_nothing(numbers, unit, separator):
    text = separator.join(f"{number:g}" for number in numbers)
    expected = read({"value": numbers, "unit": unit}, unit)
    for written in (f"{text} {unit}", f"[{text}] {unit}"):
        typed = read(written, unit)
        np.testing.assert_array_equal(typed.si, expected.si)
        assert (typed.unit, typed.tolerance) == (unit, None)
        np.testing.assert_array_equal(read_any(written).si, expected.si)


@given(st.lists(st.integers(-90, 90), min_size=1), UNITS)
def test_brackets_and_semicolons_allow_signs(numbers, unit):
    text = f"[{' '.join(map(str, numbers))}] {unit}"
    if unit[0] == "1":
        assert listed(text) is None
    else:
        assert listed(text) == (numbers, unit)
        if len(numbers) > 1:
            assert listed("; ".join(map(str, numbers)) + f" {unit}") == (numbers, unit)


@given(st.text("0123456789.,;- +[]/eE±mkN°%", max_size=40))
def test_a_text_that_is_no_list_is_read_or_refused_as_before(text):
    try:
        items = listed(text)
    except FaultyText:
        return
    if items is None:
        return
    assert len(items.numbers) >= 1
    assert all(np.isfinite(items.numbers)) or "e" in text.lower()
    try:
        typed = read(text, items.unit or "1")
    except FaultyText:
        return
    assert np.shape(typed.si) == (len(items.numbers),)


@pytest.mark.parametrize(
    ("text", "value", "has_tolerance"),
    [("25 kN", 25e3, False), ("10 1/s", 10.0, False), ("25 +1/-2 kN", 25e3, True), ("25 ± 1 kN", 25e3, True)],
)
def test_a_single_quantity_is_no_list(text, value, has_tolerance):
    assert listed(text) is None
    typed = read_any(text)
    assert (typed.si, typed.tolerance is not None) == (value, has_tolerance)


@pytest.mark.parametrize("text", ["25 500 N", "1 000 N", "1 234 567 Pa", "90 180 270 deg"])
def test_thousands_with_spaces_are_not_taken_for_a_list(text):
    with pytest.raises(FaultyText, match="one number or a list"):
        read_any(text)


def test_a_list_without_its_unit_is_refused_and_a_limit_may_be_a_list():
    with pytest.raises(FaultyText, match="the unit is missing; write it at the end"):
        read("0 90 180", "deg")
    assert read_beside("10 20 K", "delta_degC").si.tolist() == [10, 20]
    with pytest.raises(FaultyText, match=r"decimal comma: write 0\.5 0\.6 mm"):
        read("0,5 0,6 mm", "mm")


@pytest.mark.parametrize("part", ["1 ", "1-", "; ", "1,", "  ", "[1 ", "1e", "+1 ", "1\n"])
def test_a_long_text_is_read_in_linear_time(part):
    text = part * (LONGEST_LIST // len(part) - 1)
    began = time.process_time()
    try:
        read(text, "1")
    except FaultyText:
        pass
    assert time.process_time() - began < 1, "a quadratic reader takes minutes"


def test_a_pure_number_with_its_unit_is_no_list():
    assert read("0.3 1", "1").si == 0.3
    assert read_any("0.3 1").si == 0.3
    assert listed("0.3; 1") is not None
