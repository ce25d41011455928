"""Rounding of relations: distances and sides for random values, exact multiples, noise, and refusals."""

from decimal import Decimal

import numpy as np
import pytest

from templates.core.errors import FaultyText
from templates.core.units.nodes import kind_of
from templates.core.units.quantity import read
from templates.core.units.relation import parse
from templates.core.units.rounding import NOISE, Rounding

RNG = np.random.default_rng(37)
STEPS = ("0.5 mm", "0.1 mm", "0.02 mm", "1 mm", "2.5 mm", "0.0625 inch", "1e-3 m")
COUNTS = RNG.integers(-2000, 2000, 500)


def chosen(text, value):
    return parse(f"= a rounded {text}").value({"a": value})


def mm(number):
    return read(f"{number} mm", "mm").si


def steps_of(text, si):
    """The value [SI] in steps, computed apart from the rule."""
    return si / read(text, "mm").si


class TestProperties:
    @pytest.mark.parametrize("step", STEPS)
    @pytest.mark.parametrize("direction", ["", "up ", "down "])
    def test_the_distance_is_bounded_and_the_side_is_right(self, step, direction):
        values = RNG.uniform(-0.3, 0.3, 20_000)
        moved = steps_of(step, chosen(f"{direction}to {step}", values) - values)
        most = {"": 0.5, "up ": 1.0, "down ": 0.0}[direction]
        least = {"": -0.5, "up ": 0.0, "down ": -1.0}[direction]
        assert moved.max() <= most + 1e-6
        assert moved.min() >= least - 1e-6
        assert np.ptp(moved) > 0.99  # the values reach both ends

    @pytest.mark.parametrize("step", STEPS)
    @pytest.mark.parametrize("direction", ["", "up ", "down "])
    def test_a_multiple_stays_even_if_its_float_is_off(self, step, direction):
        number, unit = step.split(" ")
        typed = [read(f"{Decimal(number) * int(count)} {unit}", "mm").si for count in COUNTS]
        added = read(step, "mm").si * COUNTS
        for off in (added, np.nextafter(added, np.inf), np.nextafter(added, -np.inf), added * (1 + 1e-12)):
            assert chosen(f"{direction}to {step}", off).tolist() == pytest.approx(typed, rel=1e-15, abs=0)

    @pytest.mark.parametrize("direction", ["", "up ", "down "])
    def test_the_chosen_value_is_the_typed_one_bit_by_bit(self, direction):
        assert chosen(f"{direction}to 0.1 mm", 3 * 0.1e-3) == read("0.3 mm", "mm").si
        assert chosen(f"{direction}to 0.5 mm", 0.0235 + 1e-16) == read("23.5 mm", "mm").si

    @pytest.mark.parametrize("direction", ["", "up ", "down "])
    def test_rounding_twice_is_rounding_once(self, direction):
        once = chosen(f"{direction}to 0.2 mm", RNG.uniform(-1, 1, 5000))
        assert chosen(f"{direction}to 0.2 mm", once).tolist() == once.tolist()


class TestNoise:
    def test_noise_above_a_multiple_does_not_cost_a_step(self):
        assert chosen("up to 0.5 mm", mm(6.000000001)) == mm(6)
        assert chosen("down to 0.5 mm", mm(5.999999999)) == mm(6)
        assert chosen("to 1 mm", mm(2.4999999999)) == mm(3)

    def test_more_than_noise_does(self):
        assert chosen("up to 0.5 mm", 6e-3 * (1 + 5 * NOISE)) == mm(6.5)
        assert chosen("down to 0.5 mm", 6e-3 * (1 - 5 * NOISE)) == mm(5.5)

    @pytest.mark.parametrize("size", [1e3, 1e6, 1e9, 1e12, 1e18, 1e300])
    @pytest.mark.parametrize("direction", ["", "up ", "down "])
    def test_a_value_of_very_many_steps_hardly_moves(self, size, direction):
        assert abs(chosen(f"{direction}to 0.5 mm", size) - size) <= max(0.5e-3, 1e-15 * size)


class TestCases:
    def test_a_half_goes_away_from_zero(self):
        assert chosen("to 1 mm", np.array([2.5e-3, -2.5e-3, 0.0])).tolist() == [3e-3, -3e-3, 0.0]

    def test_a_missing_value_stays_missing_and_a_condition_is_rounded(self):
        assert chosen("to 1 mm", np.array([np.nan, 0.0012])).tolist() == [
            pytest.approx(np.nan, nan_ok=True),
            1e-3,
        ]
        either = parse("= if a > 1 mm then a else 2.2 mm rounded down to 0.5 mm")
        assert either.value({"a": np.array([0.5e-3, 1.7e-3])}).tolist() == [2e-3, 1.5e-3]

    def test_temperatures_are_multiples_on_the_scale_of_the_step(self):
        assert chosen("up to 5 degC", 273.15 + 81) == pytest.approx(273.15 + 85, abs=1e-12)

    def test_the_rule_is_apart_from_the_relation(self):
        relation = parse("= 2 * rounded + up rounded up to 0.5 mm")  # both words are names before a value
        assert relation.names == {"rounded", "up"}
        assert relation.rounding.words == "rounded up to 0.5 mm"
        assert relation.calculated.text == "= 2 * rounded + up"
        assert parse("= 3 rounded to 2").value({}) == 4.0


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        ("= a rounded to 0 mm", "out_of_range", "above 0, not 0 mm"),
        ("= a rounded to 1e-400 mm", "out_of_range", "above 0"),
        ("= a rounded to -1 mm", "syntax", "`rounded up to 0.5 mm`"),
        ("= a rounded to b", "syntax", "`rounded to 0.5 mm`"),
        ("= a rounded sideways to 1 mm", "syntax", "`rounded down to 0.5 mm`"),
        ("= (a rounded to 1 mm) * 2", "syntax", "may end in a rule of rounding"),
        ("= a rounded to 1 mm rounded to 2 mm", "syntax", "may end in a rule of rounding"),
        ("= a rounded to 1 mmm", "unknown_unit", "mmm"),
    ],
)
def test_a_wrong_rule_is_refused_with_the_right_form(text, code, said):
    with pytest.raises(FaultyText) as error:
        parse(text)
    assert error.value.code == code
    assert said in str(error.value)


def test_a_step_of_another_kind_is_refused_with_the_unit_of_the_value():
    force = Rounding.read("0.5 N", "nearest")
    assert force.misfit(kind_of("mm"), "mm") == (
        ", but it is rounded to 0.5 N; give the step in mm, such as 0.5 mm"
    )
    assert Rounding.read("0.5", "up").misfit(kind_of("mm"), "mm")
    assert Rounding.read("0.5 mm", "up").misfit(kind_of("1"), "1").endswith("give the step without a unit")
    assert Rounding.read("5 delta_degC", "up").misfit(kind_of("degC"), "degC")
    assert Rounding.read("5 degC", "up").misfit(kind_of("delta_degC"), "delta_degC")
    assert Rounding.read("1 Hz", "up").misfit(kind_of("rpm"), "rpm")
    for step, unit in (
        ("0.1 inch", "mm"),
        ("50 rpm", "rpm"),
        ("5 degC", "degC"),
        ("5 K", "degC"),
        ("2", "1"),
    ):
        assert Rounding.read(step, "up").misfit(kind_of(unit), unit) == ""
