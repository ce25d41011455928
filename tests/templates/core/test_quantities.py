"""The language reads quantities and units as users, and attackers, type them."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from templates.core.errors import FaultyText, excerpt, plain, unknown_name
from templates.core.units.quantity import read, read_any, require_same_kind
from templates.core.units.units import unit


def nested(depth):
    raw = []
    for _ in range(depth):
        raw = [raw]
    return raw


class TestReading:
    @pytest.mark.parametrize(
        ("raw", "declared", "si"),
        [
            ("25 kN", "N", 25e3),
            ("25kN", "N", 25e3),
            (" +2.5e1  kN ", "N", 25e3),
            (".5 mm", "mm", 5e-4),
            ("5. mm", "mm", 5e-3),
            ("-4 um", "mm", -4e-6),
            ("4 µm", "mm", 4e-6),  # micro sign
            ("4 μm", "mm", 4e-6),  # Greek mu
            ("1 lbf", "N", 4.4482216152605),
            ("1 inch", "mm", 25.4e-3),
            ("1 in", "mm", 25.4e-3),
            ("80 degC", "degC", 353.15),
            ("80 °C", "degC", 353.15),
            ("176 degF", "degC", 353.15),
            ("353.15 K", "degC", 353.15),
            ("18 delta_degF", "delta_degC", 10.0),
            ("10 K", "delta_degC", 10.0),
            ("3000 rpm", "rpm", 100 * math.pi),
            ("3000 rev/min", "rpm", 100 * math.pi),
            ("50 turn/s", "rpm", 100 * math.pi),
            ("2 rad/s", "rpm", 2.0),
            ("2 1/s", "rad/s", 2.0),
            ("2 1/s", "Hz", 2.0),
            ("2 kHz", "1/s", 2e3),
            ("14.5 mm²/s", "mm**2/s", 14.5e-6),
            ("14.5 mm**2/s", "mm**2/s", 14.5e-6),
            ("14.5 mm^2/s", "mm**2/s", 14.5e-6),
            ("14.5 cSt", "mm**2/s", 14.5e-6),
            ("2 W/(m²*K)", "W/(m**2*K)", 2.0),
            ("1 N·m", "N*m", 1.0),
            ("5", "1", 5.0),
            (5, "1", 5.0),
            ("5 %", "1", 0.05),
            (np.float32(0.5), "1", 0.5),
            (np.int64(5), "1", 5.0),
            ({"value": 5, "unit": "mm"}, "m", 5e-3),
            ({"value": 5}, "1", 5.0),
        ],
    )
    def test_literature_units(self, raw, declared, si):
        """Conversion factors: SI Brochure, 9th ed.; NIST SP 811, appendix B (lbf, inch, °F)."""
        assert read(raw, declared).si == pytest.approx(si, rel=1e-12)

    @pytest.mark.parametrize(
        ("raw", "declared", "si"),
        [
            ([1, 2.5], "1", [1, 2.5]),
            (np.array([1.0, 2.5]), "1", [1, 2.5]),
            ({"value": [1, 2], "unit": "mm"}, "m", [1e-3, 2e-3]),
            ({"value": np.array([1, 2]), "unit": "mm"}, "m", [1e-3, 2e-3]),
            ({"value": [[1, 2], [3, 4]], "unit": "mm"}, "m", [[1e-3, 2e-3], [3e-3, 4e-3]]),
            (["1 mm", "1 inch", {"value": 3, "unit": "m"}], "m", [1e-3, 25.4e-3, 3]),
            ({"value": [0, 100], "unit": "K"}, "degC", [0, 100]),
        ],
    )
    def test_property_arrays(self, raw, declared, si):
        np.testing.assert_allclose(read(raw, declared).si, si, rtol=1e-14)

    def test_property_keeps_what_was_typed(self):
        typed = read({"value": 48, "unit": "mm", "plus": "0.1 mm", "minus": 0.02}, "m")
        assert (typed.value, typed.unit, typed.extra) == (48, "mm", {"plus": "0.1 mm", "minus": 0.02})
        assert read({"value": 80, "unit": "degC", "plus": "2 delta_degC"}, "degC").extra == {
            "plus": "2 delta_degC"
        }

    @pytest.mark.parametrize("raw", ["5 N*m", {"value": 5, "unit": "N*m"}, ["5 N*m"], [["5 N*m"]][0]])
    def test_property_any_kind(self, raw):
        assert np.ravel(read_any(raw).si) == [5.0]
        assert read_any("-20 degC").si == pytest.approx(253.15)
        assert read_any(2.5).si == 2.5

    @given(
        st.floats(-1e200, 1e200), st.sampled_from(["mm", "inch", "degC", "degF", "rpm", "kN", "MPa", "deg"])
    )
    def test_property_to_si_and_back(self, value, name):
        scale = unit(name)
        assert scale.from_si(scale.to_si(value)) == pytest.approx(value, rel=1e-12, abs=1e-10)


ODD = [
    ("-", "mm", "not_a_quantity"),
    ("", "mm", "not_a_quantity"),
    ("mm", "mm", "not_a_quantity"),
    ("NaN", "1", "not_a_quantity"),
    ("NaN mm", "mm", "not_a_quantity"),
    ("inf mm", "mm", "not_a_quantity"),
    ("1,5 mm", "mm", "decimal_comma"),
    ("٣ mm", "mm", "not_a_quantity"),  # Arabic digits
    ("３ mm", "mm", "not_a_quantity"),  # full-width digits
    ("1_000 mm", "mm", "unknown_unit"),
    ("0x10 mm", "mm", "unknown_unit"),
    ("5 mm; 6 mm", "mm", "unknown_unit"),
    ("9" * 201, "1", "not_a_quantity"),
    ("1e999", "1", "not_finite"),
    ("1e999 mm", "mm", "not_finite"),
    ("1e9999 mm", "mm", "not_finite"),
    ("1e99999 mm", "mm", "not_finite"),
    ("1e308 km", "mm", "not_finite"),
    ("5", "mm", "missing_unit"),
    (5, "mm", "missing_unit"),
    (10**400, "mm", "not_finite"),
    (10**5000, "1", "not_finite"),
    (math.nan, "1", "not_finite"),
    (math.inf, "1", "not_finite"),
    (True, "1", "not_a_quantity"),
    (True, "mm", "not_a_quantity"),
    (np.True_, "1", "not_a_quantity"),
    (None, "1", "not_a_quantity"),
    (1j, "1", "not_a_quantity"),
    (object(), "1", "not_a_quantity"),
    ("40 MPa", "mm", "wrong_unit"),
    ("5 mm", "1", "wrong_unit"),
    ("50 1/s", "rpm", "ambiguous_unit"),
    ("50 Hz", "rpm", "ambiguous_unit"),
    ("50 1/min", "rpm", "ambiguous_unit"),
    ("50 U/min", "rpm", "ambiguous_unit"),
    ("50 rpm", "Hz", "ambiguous_unit"),
    ("80 C", "degC", "wrong_unit"),
    ("80 F", "degC", "wrong_unit"),
    ("80 delta_degC", "degC", "wrong_unit"),
    ("80 degC", "delta_degC", "wrong_unit"),
    ("80 degC", "K", "wrong_unit"),
    ({"value": [0, 100], "unit": "degF"}, "K", "wrong_unit"),
    ("50 Hz", "rad/s", "ambiguous_unit"),
    ("50 1/s", "rev/s", "ambiguous_unit"),
    ("50 rad/s", "Hz", "ambiguous_unit"),
    ("5 dB", "1", "unknown_unit"),
    ("5 furlongs per fortnight", "m/s", "unknown_unit"),
    ("5 m**9**9**9", "mm", "unknown_unit"),
    ("5 m**999", "mm", "unknown_unit"),
    ("5 " + "m*" * 40 + "m", "mm", "unknown_unit"),
    ("5 (m", "mm", "unknown_unit"),
    ("5 \ud800", "mm", "unknown_unit"),
    ("\ud800", "mm", "not_a_quantity"),
    ("5 mm\x00", "mm", "unknown_unit"),
    ("5 __import__", "mm", "unknown_unit"),
    ([], "1", "empty"),
    ([], "mm", "empty"),
    ([1, 2], "mm", "missing_unit"),
    ([1, True], "1", "not_a_number"),
    ([1, "2"], "1", "not_a_number"),
    ([1, None], "1", "not_a_number"),
    ([1, math.nan], "1", "not_finite"),
    ([1, 10**400], "1", "not_finite"),
    ([[1, 2], [3]], "1", "uneven"),
    ([[1, 2], [3, 4, 5], [6]], "1", "uneven"),
    ([[1], 2], "1", "uneven"),
    (["1 mm", {"value": [1, 2], "unit": "mm"}], "mm", "uneven"),
    (["1 mm", "1 MPa"], "mm", "wrong_unit"),
    (nested(400), "1", "not_a_number"),
    ([nested(400), 1], "1", "uneven"),
    ({}, "mm", "not_a_quantity"),
    ({"unit": "mm"}, "mm", "not_a_quantity"),
    ({"value": 5}, "mm", "missing_unit"),
    ({"value": 5, "unit": None}, "mm", "not_a_quantity"),
    ({"value": 5, "unit": 5}, "mm", "not_a_quantity"),
    ({"value": 5, "unit": ""}, "mm", "unknown_unit"),
    ({"value": "5", "unit": "mm"}, "mm", "not_a_number"),
    ({"value": "٣", "unit": "mm"}, "mm", "not_a_number"),
    ({"value": True, "unit": "mm"}, "mm", "not_a_number"),
    ({"value": None, "unit": "mm"}, "mm", "not_a_number"),
    ({"value": {"value": 5}, "unit": "mm"}, "mm", "not_a_number"),
    ({"value": nested(400), "unit": "mm"}, "mm", "not_a_number"),
    ({"value": 5, "unit": "mm", "plus": "1 MPa"}, "mm", "wrong_unit"),
    ({"value": 5, "unit": "mm", "plus": True}, "mm", "not_a_number"),
    ({"value": 5, "unit": "degC", "plus": "2 degC"}, "degC", "wrong_unit"),
    ({"value": 5, "unit": "mm", "colour": "red"}, "mm", "not_a_quantity"),
]


class TestRefusals:
    @pytest.mark.parametrize(("raw", "declared", "code"), ODD, ids=range(len(ODD)))
    def test_property_odd_inputs_are_refused_with_a_remedy(self, raw, declared, code):
        with pytest.raises(FaultyText) as refusal:
            read(raw, declared)
        assert refusal.value.code == code
        assert 10 < len(str(refusal.value)) < 300
        json.dumps(str(refusal.value), ensure_ascii=False).encode("utf-8")

    @pytest.mark.parametrize(
        ("raw", "declared", "words"),
        [
            ("40 MPa", "mm", ["MPa", "a pressure", "a length", "mm"]),
            ("10 deg", "mm", ["an angle", "a length", "mm"]),
            ("3 rad/s", "deg", ["an angular speed", "an angle", "deg"]),
            ("3 mm", "1", ["a length", "a pure number"]),
            ("50 Hz", "rpm", ["Hz", "rpm or rad/s"]),
            ("1e6 cycle", "1", ["cycle", "counts angle", "without a unit"]),
            ("4 turn", "1", ["turn", "counts angle", "without a unit"]),
            ("50 U/min", "rpm", ["U/min", "rpm or rev/min"]),
            ("80 C", "degC", ["not a temperature: write degC"]),
            ("80 delta_degC", "degC", ["not a difference", "degC"]),
            ("80 degC", "delta_degC", ["difference of temperatures", "delta_degC"]),
            ("80 °F", "delta_degC", ["difference of temperatures", "delta_degF"]),
            ("80 degC", "K", ["a temperature in K", "a difference in delta_degC"]),
            ("5", "mm", ['"5 mm"']),
            ([1, 2], "mm", ['"unit": "mm"']),
            ("5 Kn", "N", ["Kn"]),
            (True, "mm", ["True", '"1.5 mm"']),
            ({"value": "5", "unit": "mm"}, "mm", ["'5'", "without quotes"]),
            ("5 W/foo", "W/K", ["W/foo", "case-sensitive"]),
        ],
    )
    def test_property_messages_say_what_would_be_right(self, raw, declared, words):
        with pytest.raises(FaultyText) as refusal:
            read(raw, declared)
        assert all(word in str(refusal.value) for word in words), str(refusal.value)

    @pytest.mark.parametrize(
        "raw", [{"unit": "\ud800"}, {"value": 1, "unit": "\ud800"}, nested(900), "5 \ud800"]
    )
    def test_property_any_kind_refuses_too(self, raw):
        with pytest.raises(FaultyText) as refusal:
            read_any(raw)
        str(refusal.value).encode("utf-8")


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=40),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(["value", "unit", "plus", "minus", "x"]), inner, max_size=4)
    ),
    max_leaves=12,
)
surrogates = st.text(st.characters(), max_size=60)
unit_like = st.text("mNkgsPaKdegCrpU1/*^()-_²³µ%·. 0123456789", max_size=60)
UNITS = st.sampled_from(["1", "mm", "rpm", "degC", "delta_degC", "mPa*s"])


class TestFuzz:
    @settings(max_examples=examples(400))
    @given(json_values | surrogates | st.builds("1 {}".format, unit_like), UNITS)
    def test_property_read_gives_a_finite_quantity_or_a_reason(self, raw, declared):
        try:
            si = read(raw, declared).si
        except FaultyText as refusal:
            code = refusal.code
            str(refusal).encode("utf-8")
        else:
            code = "read"
            assert np.all(np.isfinite(si))
        assert code

    @settings(max_examples=examples(400))
    @given(unit_like | surrogates)
    def test_property_unit_is_known_or_refused(self, text):
        try:
            scale = unit(text)
        except FaultyText as refusal:
            is_usable, code = False, refusal.code
        else:
            is_usable, code = 0 < scale.factor < math.inf and require_same_kind(text, text) == scale, None
        assert is_usable or code == "unknown_unit"

    @given(json_values | surrogates)
    def test_property_excerpts_are_short_ascii(self, raw):
        assert excerpt(raw).isascii()
        assert len(excerpt(raw)) <= 700

    @given(surrogates)
    def test_property_names_are_fit_for_json(self, name):
        fault = unknown_name(name, ["speed", "width"], "input")
        assert (fault.name + fault.detail).encode("utf-8")
        assert len(plain(name)) <= 480
