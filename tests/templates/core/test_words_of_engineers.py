"""The language reads words of engineers: r/min, mils, decimal commas, grades of oil, radial clearances."""

import re

import numpy as np
import pytest

from templates.core.errors import FaultyText, InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.units.quantity import read, read_any
from templates.core.units.units import unit
from templates.oil_film.journal_friction_v1 import JournalFriction
from templates.oil_film.oil_film_v1 import OilFilm as PaperFilm
from templates.oil_film.oil_film_v2 import OilFilm
from templates.oil_film.thermal_film_v1 import ThermalFilm


@pytest.mark.parametrize("text", ["2 mil", "2 mils", "2 mil/s", "2 N/mil"])
def test_mil_is_refused_and_thou_is_named(text):
    with pytest.raises(FaultyText, match="write thou") as refusal:
        read_any(text)
    assert refusal.value.code == "ambiguous_unit"
    assert read("2 thou", "mm").si == pytest.approx(50.8e-6, rel=1e-12)
    assert read("2 mrad", "rad").si == pytest.approx(0.002, rel=1e-12)


@pytest.mark.parametrize("text", ["10 Grad", "10 grad", "10 N*m/Grad", "1 Mrad", "1 Gdeg"])
def test_degrees_in_german_are_refused_and_deg_is_named(text):
    """Pint would take `Grad` for 1e9 rad."""
    with pytest.raises(FaultyText, match=r"write .*deg") as refusal:
        read_any(text)
    assert refusal.value.code == "ambiguous_unit"
    assert read("100 gon", "deg").si == pytest.approx(np.pi / 2, rel=1e-12)


@pytest.mark.parametrize(("text", "same"), [("r/min", "rpm"), ("r/s", "rev/s"), ("kN*mm/(r/min)", None)])
def test_revolutions_as_iso_80000_writes_them(text, same):
    if same is None:
        with pytest.raises(FaultyText):
            unit(text)
        return
    assert unit(text).factor == pytest.approx(unit(same).factor, rel=1e-15)
    assert unit(text).base == unit(same).base
    assert unit(text).turns
    assert read(f"3000 {text}", "rpm").si == read(f"3000 {same}", "rpm").si


@pytest.mark.parametrize(
    ("text", "declared", "written", "si"),
    [
        ("0,58 kg", "kg", "0.58 kg", 0.58), (",58 kg", "kg", "0.58 kg", 0.58),
        ("-0,5 mm", "mm", "-0.5 mm", -5e-4),
        ("1.234,5 kg", "kg", "1234.5 kg", 1234.5), ("1,234.5 kg", "kg", "1234.5 kg", 1234.5),
        ("1,5e3 kg", "kg", "1.5e3 kg", 1500), ("48,5 mm +0,02/-0,01", "mm", "48.5 mm +0.02/-0.01", 0.0485),
        ("55,5 ± 0,5 um", "um", "55.5 ± 0.5 um", 55.5e-6), ("0,5", "1", "0.5", 0.5),
    ],
)  # fmt: skip
def test_a_decimal_comma_is_called_one_and_the_remedy_is_right(text, declared, written, si):
    for reading in (lambda: read(text, declared), lambda: read_any(text)):
        with pytest.raises(FaultyText, match=re.escape(f"write {written}")) as refusal:
            reading()
        assert refusal.value.code == "decimal_comma"
    assert read(written, declared).si == pytest.approx(si, rel=1e-12)


def test_three_digits_after_a_comma_have_two_meanings():
    with pytest.raises(FaultyText, match=r"write 1\.234 mm, or 1234 mm if thousands are meant"):
        read("1,234 mm", "mm")


@pytest.mark.parametrize("text", ["1,2,3 kg", "x,y", ",", "1,", "1,2,", "," * 150, "1," * 90 + "1"])
def test_other_commas_are_refused_as_before(text):
    with pytest.raises(FaultyText) as refusal:
        read(text, "kg")
    assert refusal.value.code != "decimal_comma"


@pytest.mark.parametrize(
    ("written", "option"),
    [("ISO VG 46", "iso_vg_46"), ("iso vg46", "iso_vg_46"), ("VG 46", "iso_vg_46"), ("SAE 20", "sae_20"),
     ("SAE 10W-40", "sae_10w_40"), ("sae_30", "sae_30")],
)  # fmt: skip
def test_a_grade_of_oil_as_it_is_printed(written, option):
    def film(grade):
        given = {**OilFilm.example, "oil_grade": grade}
        return evaluate(OilFilm, given, outputs=["minimum_film_thickness"])

    one, other = film(written), film(option)
    assert one.outputs["minimum_film_thickness"].value == other.outputs["minimum_film_thickness"].value


def test_a_grade_in_place_of_a_quantity_names_the_input():
    with pytest.raises(FaultyText, match="oil_grade"):
        read("ISO VG 46", "mPa*s")
    with pytest.raises(InvalidInputs, match="SAE 21"):
        evaluate(OilFilm, {**OilFilm.example, "oil_grade": "SAE 21"})


FILMS = pytest.mark.parametrize("cls", [OilFilm, PaperFilm, ThermalFilm])


def smallest(cls, **changes):
    given = {**cls.example, **changes}
    kept = {name: value for name, value in given.items() if value is not None}
    return evaluate(cls, kept, outputs=["minimum_film_thickness"]).outputs["minimum_film_thickness"].value


@FILMS
@pytest.mark.parametrize("radial", ["30 um", "30 ± 1 um", {"value": 30, "unit": "um"}, "0.03 mm", ["30 um"]])
def test_half_the_diametral_clearance_is_accepted(cls, radial):
    expected = smallest(cls, diametral_clearance="60 um")
    assert smallest(cls, diametral_clearance=None, radial_clearance=radial) == pytest.approx(
        expected, rel=1e-9
    )
    if not isinstance(radial, list):
        assert smallest(cls, diametral_clearance="60 um", radial_clearance=radial) == pytest.approx(expected)


@FILMS
def test_clearances_that_differ_are_refused(cls):
    with pytest.raises(InvalidInputs) as refusal:
        smallest(cls, diametral_clearance="60 um", radial_clearance="60 um")
    ((name, code),) = [(fault.name, fault.code) for fault in refusal.value.faults]
    assert (name, code) == ("radial_clearance", "conflict")


def test_the_other_way_round():
    given = dict(JournalFriction.example)
    expected = evaluate(JournalFriction, given).outputs["power_loss"].value
    radial = read(given.pop("radial_clearance"), "mm").si
    given["diametral_clearance"] = f"{2e3 * radial!r} mm"
    assert evaluate(JournalFriction, given).outputs["power_loss"].value == pytest.approx(expected, rel=1e-9)


def test_a_radial_tolerance_is_doubled():
    given = {**OilFilm.example, "radial_clearance": "30 ± 1 um"}
    del given["diametral_clearance"]
    template = OilFilm.from_quantities(given)
    tolerance = template.ledger.typed["diametral_clearance"].tolerance
    assert (tolerance.lower, tolerance.upper) == (pytest.approx(-2e-6), pytest.approx(2e-6))
