"""Items of arrays in relations: `= loads.main_load_x[2]`, counted from 1."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from templates.core.criteria.criterion import read_comparison
from templates.core.errors import FaultyText
from templates.core.units.items import item_of
from templates.core.units.relation import Kind, parse
from templates.core.units.units import unit

FORCE = Kind(unit("N").base)
TABLES = arrays.arrays(
    float, arrays.array_shapes(min_dims=1, max_dims=3, max_side=6), elements=st.floats(-9, 9)
)


def refusal(text, values=None):
    with pytest.raises(FaultyText) as error:
        parse(text).value(values or {})
    return error.value


class TestReading:
    def test_property_an_item_names_its_array_and_its_index(self):
        relation = parse("= 2 * loads.x[ bearing ] + loads.x[3]")
        assert relation.names == {"loads.x", "bearing"}
        assert [item.text for item in relation.items] == ["loads.x[bearing]", "loads.x[3]"]
        assert relation.only_name is None

    @pytest.mark.parametrize("index", ["0", "-1", "1.5", "", "1 mm", "a + 1", "1][1", "pi", "9" * 12, "0.0"])
    def test_property_no_other_index_is_read(self, index):
        assert refusal(f"= x[{index}]").code == "syntax"

    @pytest.mark.parametrize("text", ["= pi[1]", "= (x)[1]", "= 2[1]", "= 2 mm[1]", "= sin(x)[1]", "= x [1"])
    def test_property_names_alone_have_items(self, text):
        with pytest.raises(FaultyText):
            parse(text)

    def test_property_zero_is_refused_with_the_right_range(self):
        assert "from 1" in str(refusal("= x[0]"))

    def test_property_a_criterion_takes_no_index(self):
        with pytest.raises(FaultyText, match="parameter or an input"):
            read_comparison("loads.x[2] <= 3 kN")


class TestKinds:
    def test_property_an_item_measures_what_its_array_does(self):
        assert parse("= x[2]").kind({"x": FORCE}) == FORCE
        assert parse("= x[n]").kind({"x": FORCE, "n": Kind()}) == FORCE

    @pytest.mark.parametrize("index", ["mm", "rad", "N"])
    def test_property_an_index_is_a_pure_number(self, index):
        with pytest.raises(FaultyText, match="pure number"):
            parse("= x[n]").kind({"x": FORCE, "n": Kind(unit(index).base)})

    def test_property_an_output_is_no_index(self):
        with pytest.raises(FaultyText, match="a parameter of the design"):
            parse("= x[film.n]").kind({"x": FORCE, "film.n": Kind()})


class TestValues:
    @given(TABLES, st.data())
    def test_property_counted_from_one_along_the_first_axis(self, table, data):
        place = data.draw(st.integers(1, len(table)))
        for text, values in ((f"= x[{place}]", {"x": table}), ("= x[n]", {"x": table, "n": float(place)})):
            np.testing.assert_array_equal(parse(text).value(values), table[place - 1])

    @given(TABLES, st.one_of(st.integers(-3, 0), st.integers(7, 50), st.floats(1.1, 1.9)))
    def test_property_beyond_the_range_the_length_is_named(self, table, place):
        error = refusal("= x[n]", {"x": table, "n": float(place)})
        assert error.code == "index"
        assert f"from 1 to {len(table)}" in str(error)

    @given(st.data())
    def test_property_rows_are_those_of_each_row_alone(self, data):
        """With rows in front, every row has what it would have alone."""
        rows, length, places = (data.draw(st.integers(1, 5)) for _ in range(3))
        table = np.arange(rows * length * places, dtype=float).reshape(rows, length, places)
        chosen = st.lists(st.integers(1, length), min_size=rows, max_size=rows)
        index = np.array(data.draw(chosen), dtype=float)
        (item,) = parse("= x[n]").items
        both = item_of(item, {"x": table, "n": index}, {"x", "n"})
        shared = item_of(item, {"x": table[0], "n": index}, {"n"})
        single = item_of(item, {"x": table, "n": 1.0}, {"x"})
        for row in range(rows):
            place = int(index[row])
            np.testing.assert_array_equal(both[row], table[row][place - 1])
            np.testing.assert_array_equal(shared[row], table[0][place - 1])
            np.testing.assert_array_equal(single[row], table[row][0])

    def test_property_a_single_value_has_no_items(self):
        assert "no items" in str(refusal("= x[1]", {"x": 3.0}))
        (item,) = parse("= x[1]").items
        with pytest.raises(FaultyText, match="no items"):
            item_of(item, {"x": np.ones(4)}, {"x"})

    def test_property_an_array_is_no_index(self):
        error = refusal("= x[n]", {"x": np.ones(4), "n": np.array([1.0, 2.0])})
        assert error.code == "index"
        assert "a single number" in str(error)
