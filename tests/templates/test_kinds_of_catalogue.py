"""Temperatures and speeds of every template and model: the units that each accepts."""

import itertools

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from cad.catalogue import models
from templates.core.errors import FaultyText
from templates.core.units.quantity import read, read_beside
from templates.core.units.units import registry, require_same_kind, unit
from templates.door import built_in

CLASSES = [*built_in(), *models()]
MEANINGS = {
    (cls.id, cls.version, one.name): one.meaning
    for cls in CLASSES
    for one in {**cls.inputs, **cls.formulas}.values()
}
KELVIN = {place: one for place, one in MEANINGS.items() if one.scale.base == registry.kelvin}
DIFFERENCES = {place: one for place, one in KELVIN.items() if one.scale.difference}
TEMPERATURES = {place: one for place, one in KELVIN.items() if place not in DIFFERENCES}
SPEEDS = {place: one for place, one in MEANINGS.items() if one.scale.base == unit("rad/s").base}
ABSOLUTE = {
    "degC": (1.0, 273.15),
    "degF": (5 / 9, 459.67 * 5 / 9),
    "°C": (1.0, 273.15),
    "celsius": (1.0, 273.15),
}
RELATIVE = {"K": 1.0, "delta_degC": 1.0, "delta_degF": 5 / 9, "mK": 1e-3, "degR": 5 / 9}


def test_the_catalogue_has_both_kinds_and_no_other():
    assert len(DIFFERENCES) >= 10
    assert len(TEMPERATURES) >= 30
    assert {one.accepted for one in KELVIN.values()} == {"degC", "delta_degC"}


@settings(max_examples=examples(150), deadline=None)
@given(st.sampled_from(sorted(DIFFERENCES)), st.floats(-1e4, 1e4), st.sampled_from(sorted(ABSOLUTE)))
def test_property_a_difference_refuses_a_scale_with_a_zero_of_its_own(place, number, name):
    declared = DIFFERENCES[place].accepted
    for raw in (f"{number!r} {name}", {"value": number, "unit": name}, [f"{number!r} {name}"]):
        with pytest.raises(FaultyText, match=r"delta_deg[CF]"):
            read(raw, declared)
        size = ABSOLUTE[name][0]  # a limit or a target takes the kind of the difference
        assert read_beside(raw, declared).si == pytest.approx(number * size, rel=1e-12)


@settings(max_examples=examples(150), deadline=None)
@given(st.sampled_from(sorted(DIFFERENCES)), st.floats(-1e4, 1e4), st.sampled_from(sorted(RELATIVE)))
def test_property_a_difference_takes_every_unit_of_differences(place, number, name):
    declared = DIFFERENCES[place].accepted
    assert read(f"{number!r} {name}", declared).si == pytest.approx(number * RELATIVE[name], rel=1e-12)


@settings(max_examples=examples(150), deadline=None)
@given(st.sampled_from(sorted(TEMPERATURES)), st.floats(-1e4, 1e4), st.sampled_from(sorted(ABSOLUTE)))
def test_property_a_temperature_takes_scales_and_refuses_differences(place, number, name):
    declared = TEMPERATURES[place].accepted
    size, zero = ABSOLUTE[name]
    for reader in (read, read_beside):
        assert reader(f"{number!r} {name}", declared).si == pytest.approx(number * size + zero, abs=1e-8)
    for other in ("delta_degC", "delta_degF"):
        with pytest.raises(FaultyText, match="a temperature, not a difference"):
            read(f"{number!r} {other}", declared)


@pytest.mark.parametrize("place", sorted(SPEEDS), ids=str)
def test_property_speeds_refuse_what_counts_cycles(place):
    declared = SPEEDS[place].unit
    for name in ("Hz", "kHz"):
        with pytest.raises(FaultyText, match="turns or radians"):
            require_same_kind(name, declared)
    if unit(declared).turns:
        with pytest.raises(FaultyText, match="write rpm or rad/s"):
            require_same_kind("1/s", declared)
    for one, other in itertools.pairwise(["rpm", "rps", "rev/s", "turn/min", "deg/s", "rad/s"]):
        ratio = read(f"1 {one}", declared).si / read(f"1 {other}", declared).si
        assert ratio == pytest.approx(unit(one).factor / unit(other).factor, rel=1e-14)
