"""Tolerances in the text of a quantity are read or refused, and change nothing else."""

import csv
from collections import defaultdict
from pathlib import Path
from string import ascii_letters

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from templates import get
from templates.core.errors import FaultyText, InvalidInputs
from templates.core.units.fits import zones
from templates.core.units.quantity import read, read_any
from templates.core.units.tolerance import Tolerance, is_toleranced

REFERENCE = Path(__file__).parents[1] / "references" / "iso286_tolerances.csv"
UM = 1e-6


def limits(raw, declared):
    """Lower and upper deviation [SI] as read."""
    tolerance = read(raw, declared).tolerance
    return tolerance.lower, tolerance.upper


MEANT = [
    ("55 ± 5 um", "um", 55 * UM, -5 * UM, 5 * UM),
    ("55±5um", "mm", 55 * UM, -5 * UM, 5 * UM),
    ("55 +/- 5 um", "um", 55 * UM, -5 * UM, 5 * UM),
    ("55 +- 5 um", "um", 55 * UM, -5 * UM, 5 * UM),
    ("55 +10/-5 um", "um", 55 * UM, -5 * UM, 10 * UM),
    ("55 +10 / −5 um", "um", 55 * UM, -5 * UM, 10 * UM),
    ("55 -5/+10 um", "um", 55 * UM, -5 * UM, 10 * UM),
    ("55 0/-5 um", "um", 55 * UM, -5 * UM, 0),
    ("48 mm +50/+25 um", "mm", 0.048, 25 * UM, 50 * UM),
    ("48 mm ± 0.1", "mm", 0.048, -1e-4, 1e-4),
    ("48 mm H7", "mm", 0.048, 0, 25 * UM),
    ("48 mm f7", "um", 0.048, -50 * UM, -25 * UM),
    ("50 mm js6", "mm", 0.05, -8 * UM, 8 * UM),
    ("50000 um H7", "mm", 0.05, 0, 25 * UM),
    ("2 inch H7", "mm", 0.0508, 0, 30 * UM),
    ("20 ± 2 %", "1", 0.2, -0.02, 0.02),
    ("20 ± 2", "1", 20, -2, 2),
    ("3000 ± 30 rpm", "rpm", 100 * np.pi, -np.pi, np.pi),
    ("10 1/s ± 1", "1/s", 10, -1, 1),
    ("80 ± 5 degC", "degC", 353.15, -5, 5),
    ("80 degC ± 5 K", "degC", 353.15, -5, 5),
    ("80 degC ± 5 delta_degC", "degC", 353.15, -5, 5),
    ("212 ± 9 degF", "degC", 373.15, -5, 5),
    ("15 ± 2 K", "delta_degC", 15, -2, 2),
    ({"value": 55, "unit": "um", "plus": 10, "minus": "5 um"}, "um", 55 * UM, -5 * UM, 10 * UM),
    ({"value": 55, "unit": "um", "plus": 10}, "um", 55 * UM, 0, 10 * UM),
    ({"value": 55, "unit": "um", "upper": -2, "lower": -4}, "um", 55 * UM, -4 * UM, -2 * UM),
    ({"value": 48, "unit": "mm", "zone": "H7"}, "mm", 0.048, 0, 25 * UM),
    ({"value": 80, "unit": "degC", "plus": "2 delta_degC"}, "degC", 353.15, 0, 2),
]


@pytest.mark.parametrize(
    ("raw", "declared", "value", "lower", "upper"), MEANT, ids=[str(m[0]) for m in MEANT]
)
def test_what_a_tolerance_means(raw, declared, value, lower, upper):
    assert read(raw, declared).si == pytest.approx(value, rel=1e-12)
    assert limits(raw, declared) == pytest.approx((lower, upper), rel=1e-12, abs=1e-18)
    assert is_toleranced(raw)
    assert read_any(raw).si == read(raw, declared).si


@pytest.mark.parametrize("distribution", ["normal", "uniform", "triangular"])
def test_a_distribution_is_kept(distribution):
    typed = read({"value": 55, "unit": "um", "plus": 5, "minus": 5, "distribution": distribution}, "um")
    assert typed.tolerance == Tolerance(-5 * UM, 5 * UM, distribution)
    assert typed.extra == {"plus": 5, "minus": 5, "distribution": distribution}
    assert read("55 ± 5 um", "um").tolerance.distribution == "normal"


def test_an_answer_states_a_tolerance_so_that_it_can_be_sent_again():
    for raw in ("55 ± 5 um", "55 +10/-5 um", "48 mm H7", "48 mm f7", "80 ± 5 degC"):
        typed = read(raw, read_any(raw).unit)
        again = {"value": typed.value, "unit": typed.unit, **typed.extra}
        one, other = limits(again, typed.unit), (typed.tolerance.lower, typed.tolerance.upper)
        assert one == pytest.approx(other, rel=1e-11)


def test_items_of_a_list_have_their_own_tolerances():
    typed = read(["48 mm H7", "50 mm", {"value": 1, "unit": "mm", "minus": 0.5}], "mm")
    assert typed.tolerance.lower == pytest.approx([0, 0, -5e-4])
    assert typed.tolerance.upper == pytest.approx([25e-6, 0, 0])
    assert typed.extra == {}
    assert read(["48 mm", "50 mm"], "mm").tolerance is None


REFUSED = [
    ("48 mm H4", "mm", "unknown_zone"),
    ("48 mm Q7", "mm", "unknown_zone"),
    ("0 mm H7", "mm", "out_of_range"),
    ("500.1 mm H7", "mm", "out_of_range"),
    ("5 mm K10", "mm", "out_of_range"),
    ("25 kN H7", "kN", "wrong_unit"),
    ("48 H7", "mm", "missing_unit"),
    ("48 mm H7/g6", "mm", "not_a_tolerance"),
    ("20 ± 5", "mm", "missing_unit"),
    ("48 mm +0.1", "mm", "not_a_tolerance"),
    ("48 mm ± five", "mm", "not_a_tolerance"),
    ("10 +10/5 um", "um", "not_a_tolerance"),
    ("12 mm ± 1 kN", "mm", "wrong_unit"),
    ("12 ± 1 kN", "mm", "wrong_unit"),
    ("1 ± 1e400 mm", "mm", "not_finite"),
    ({"value": 5, "unit": "mm", "minus": -1}, "mm", "out_of_range"),
    ({"value": 5, "unit": "mm", "upper": 1}, "mm", "not_a_tolerance"),
    ({"value": 5, "unit": "mm", "upper": 1, "lower": 2}, "mm", "not_a_tolerance"),
    ({"value": 5, "unit": "mm", "upper": 1, "lower": 0, "plus": 1}, "mm", "not_a_tolerance"),
    ({"value": 5, "unit": "mm", "distribution": "uniform"}, "mm", "not_a_tolerance"),
    ({"value": 5, "unit": "mm", "plus": 1, "distribution": "cauchy"}, "mm", "not_an_option"),
    ({"value": 5, "unit": "mm", "plus": 1, "distribution": []}, "mm", "not_an_option"),
    ({"value": 48, "unit": "mm", "zone": "H7", "plus": 1}, "mm", "not_a_tolerance"),
    ({"value": 48, "unit": "mm", "zone": 7}, "mm", "unknown_zone"),
    ({"value": [48, 50], "unit": "mm", "zone": "H7"}, "mm", "not_single"),
    (["1 ± 1 mm", {"value": 1, "unit": "mm", "plus": 1, "distribution": "uniform"}], "mm", "not_a_tolerance"),
]


@pytest.mark.parametrize(("raw", "declared", "code"), REFUSED, ids=[str(r[0]) for r in REFUSED])
def test_what_is_refused(raw, declared, code):
    with pytest.raises(FaultyText) as refused:
        read(raw, declared)
    assert refused.value.code == code


def test_a_size_outside_the_steps_of_a_zone_is_answered_with_those_it_has():
    with pytest.raises(
        FaultyText, match="K10 is shipped for nominal sizes above 0 mm and up to 3 mm, not 5 mm"
    ):
        read("5 mm K10", "mm")
    with pytest.raises(FaultyText, match="H has the grades 5 to 11"):
        read("48 mm H4", "mm")


@pytest.mark.parametrize("raw", ["60 ± 70 um", {"value": 60, "unit": "um", "minus": 70}, "60 +5/-60 um"])
def test_a_tolerance_that_leaves_the_bounds_of_an_input_is_refused(raw):
    film = get("oil_film", 2)
    with pytest.raises(InvalidInputs) as refused:
        film.template.from_quantities({**film.template.example, "diametral_clearance": raw})
    [fault] = refused.value.faults
    assert (fault.name, fault.code) == ("diametral_clearance", "out_of_range")
    assert "by its tolerance" in fault.detail


def test_a_tolerance_on_a_choice_is_refused():
    cls = next(c for c in [get("oil_film", 2).template] if c.example)
    choice = next(name for name, declared in cls.inputs.items() if hasattr(declared, "options"))
    with pytest.raises(InvalidInputs) as refused:
        cls.from_quantities({**cls.example, choice: {"value": "x", "plus": 1}})
    assert [fault.code for fault in refused.value.faults if fault.name == choice] == ["not_an_option"]


def test_the_value_alone_calculates():
    film = get("oil_film", 2)
    plain = film(**film.template.example)
    name = "bearing_width"
    given_width = film.template.example[name]
    number, unit = given_width.split(" ")
    toleranced = film(**{**film.template.example, name: f"{number} ± 0.1 {unit}"})
    assert toleranced.minimum_film_thickness == plain.minimum_film_thickness
    assert [w.name for w in toleranced.warnings if w.code == "tolerance_unused"] == [name]


def rows():
    with REFERENCE.open(encoding="utf-8") as file:
        yield from csv.DictReader(line for line in file if not line.startswith("#"))


def test_every_zone_of_the_published_tables_is_shipped_with_its_limits():
    count = 0
    for row in rows():
        above, up_to = float(row["above"]), float(row["up_to"])
        for size in (above + 1e-3, (above + up_to) / 2, up_to):
            wanted = (float(row["lower"]) * UM, float(row["upper"]) * UM)
            assert limits(f"{size!r} mm {row['class']}", "mm") == pytest.approx(wanted, rel=1e-12, abs=1e-15)
        count += 1
    assert count == 2400
    assert {row["class"] for row in rows()} == set(zones())


def test_the_published_tables_keep_the_rules_of_the_standard():
    """One width for each grade and size; H and h begin at zero; the holes D to H mirror the shafts d to h."""
    widths, by_class = defaultdict(set), defaultdict(dict)
    for name, steps in zones().items():
        letter, grade = name.rstrip("0123456789"), int(name.lstrip(ascii_letters))
        for size in (1, 4.5, 8, 14, 24, 40, 65, 100, 150, 215, 280, 357, 450):
            step = next((s for s in steps if s.above < size <= s.up_to), None)
            if step:
                widths[grade, size].add(step.upper - step.lower)
                by_class[letter][grade, size] = step
    assert all(len(each) == 1 for each in widths.values())
    assert all(step.lower == 0 for step in by_class["H"].values())
    assert all(step.upper == 0 for step in by_class["h"].values())
    for hole in "DEFGH":
        for key, step in by_class[hole].items():
            assert step.lower == -by_class[hole.lower()][key].upper


number = st.floats(0.001, 1e6).map(lambda x: f"{x:.6g}")
part = st.sampled_from(
    ["±", "+/-", "+-", "+", "-", "−", "/", " ", "mm", "um", "H7", "f6", "degC", "%", "1", ".", "e5", "kN"]
)


def reading(raw, declared):
    """The quantity as read, and the code of the refusal; one of them is None."""
    try:
        return read(raw, declared), None
    except FaultyText as refusal:
        str(refusal).encode("utf-8")
        return None, refusal.code


@given(st.lists(st.one_of(number, part, st.text(max_size=4)), max_size=12).map("".join))
@settings(max_examples=examples(400))
def test_any_text_is_read_or_refused(text):
    for declared in ("mm", "degC", "1"):
        typed, code = reading(text, declared)
        if typed is None:
            assert code
            continue
        assert np.isfinite(typed.si)
        assert is_toleranced(text) == (typed.tolerance is not None)
        if typed.tolerance:
            assert -np.inf < typed.tolerance.lower <= typed.tolerance.upper < np.inf


SCALARS = st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=8)
KEYS = st.sampled_from(["value", "unit", "plus", "minus", "upper", "lower", "zone", "distribution"])
JSON = st.recursive(
    SCALARS | st.sampled_from(["mm", "H7", "5 um"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=6),
    max_leaves=10,
)


@given(
    JSON | st.fixed_dictionaries({"value": st.just(48), "unit": st.just("mm"), "plus": JSON, "zone": JSON})
)
@settings(max_examples=examples(400))
def test_any_object_is_read_or_refused(raw):
    typed, code = reading(raw, "mm")
    assert code if typed is None else np.all(np.isfinite(typed.si))


LONG = ["5" + " " * 10**6, "5 ±" + "+/-" * 10**6, "5 " + "+1/" * 10**6, "5 mm " + "H7" * 10**6]


@pytest.mark.parametrize("text", LONG, ids=["blanks", "signs", "deviations", "zones"])
def test_long_texts_are_not_looked_at(text):
    assert reading(text + "x", "mm") == (None, "not_a_quantity")
    assert not is_toleranced(text)
