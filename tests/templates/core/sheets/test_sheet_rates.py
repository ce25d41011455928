"""Turns, radians and hertz have one meaning in worksheets; ambiguities are reported, and remedies work."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from templates.core.language.evaluate import evaluate
from templates.core.sheets import SheetRefused, read

GIVEN = """# Rates
given D [mm] = 48 mm "diameter"
given N [rpm] = 5000 rpm "speed"
given w [rad/s] = 100 rad/s "angular speed"
given f [Hz] = 50 Hz "frequency"
given t [s] = 0.1 s "time"
given v [m/s] = 10 m/s "velocity"
given r [m] = 2 m "radius"
given T [N*m] = 1.909859317 N*m "torque"
given mu [mPa*s] = 10 mPa*s "viscosity"
given P [MPa] = 3.2 MPa "pressure"
given k [N/m] = 1e6 N/m "stiffness"
given m [kg] = 0.01 kg "mass"
given c_t [N*m/rad] = 1e6 N*m/rad "torsional stiffness"
given b_t [N*m*s/rad] = 1000 N*m*s/rad "torsional damping"
given J [kg*m**2] = 2 kg*m**2 "inertia"
"""
N = 5000 * 2 * math.pi / 60


def sheet(line, given=GIVEN):
    return read(given + line).template("rates", 1)


def result(line, given=GIVEN):
    """The value of the line in its declared unit, and the report on its readings."""
    cls = sheet(line, given)
    evaluation = evaluate(cls, cls.example)
    (answer,) = evaluation.outputs.values()
    return answer.value, [warning.detail for warning in evaluation.warnings if warning.code == "turns"]


def refused(line):
    with pytest.raises(SheetRefused) as refusal:
        read(GIVEN + line)
    (fault,) = refusal.value.faults
    return fault


def formula(unit, text):
    return f'x [{unit}] = {text} "x"'


REPORTED = [  # unit, formula, its value, the formula that counts turns, and its value
    ("m/s", "pi*D*N", 0.048 * math.pi * N, "pi*D*(N/(2*pi))", 0.048 * N / 2),
    ("W", "2*pi*T*N", 2 * math.pi * 1.909859317 * N, "2*pi*T*(N/(2*pi))", 1000),
    (
        "1",
        "(20/0.02)**2*mu*N/P",
        1e6 * 0.01 * N / 3.2e6,
        "(20/0.02)**2*mu*(N/(2*pi))/P",
        1e4 * 83.3333 / 3.2e6,
    ),
    ("s", "1/N", 1 / N, "1/(N/(2*pi))", 0.012),
    ("1", "N*t", 0.1 * N, "(N/(2*pi))*t", 8.33333),
    ("1/s", "N*D/(1 mm)", 48 * N, "(N/(2*pi))*D/(1 mm)", 4000),
    ("m/s", "pi * 48 mm * 5000 rpm", 0.048 * math.pi * N, "pi * 48 mm * (5000 rpm / (2*pi))", 0.048 * N / 2),
    ("kW", "T*sqrt(N**2)", 1.909859317e-3 * N, None, None),
]


class TestReports:
    @pytest.mark.parametrize(("unit", "text", "value", "turns", "counted"), REPORTED)
    def test_both_readings_are_named_and_each_remedy_is_right(self, unit, text, value, turns, counted):
        number, (report,) = result(formula(unit, text))
        assert number == pytest.approx(value, rel=1e-6)
        assert "in turns" in report
        assert "in rad/s" in report
        if turns is not None:
            assert turns in report
            assert result(formula(unit, turns)) == (pytest.approx(counted, rel=1e-5), [])

    @pytest.mark.parametrize(("unit", "text", "value", "turns", "counted"), REPORTED)
    def test_what_is_declared_in_radians_is_not_reported(self, unit, text, value, turns, counted):
        given = GIVEN.replace("N [rpm] = 5000 rpm", f"N [rad/s] = {N} rad/s")
        if "5000 rpm" in text:
            text = text.replace("5000 rpm", f"{N} rad/s")
        assert result(formula(unit, text), given) == (pytest.approx(value, rel=1e-6), [])

    @pytest.mark.parametrize(("unit", "text", "value", "turns", "counted"), REPORTED[:-2])
    def test_a_division_by_one_radian_silences_it_too(self, unit, text, value, turns, counted):
        written = re.sub(r"\bN\b", "(N/(1 rad))", text)
        assert result(formula(unit, written)) == (pytest.approx(value, rel=1e-6), [])

    @pytest.mark.parametrize(
        ("text", "short", "value"),
        [("pi*D*N", "which is D*N/2", 12.56637), ("2*pi*T*N", "which is T*N", 1000)],
    )
    def test_the_short_form_of_the_other_reading(self, text, short, value):
        unit = "W" if "T" in text else "m/s"
        _, (report,) = result(formula(unit, text))
        assert short in report
        assert result(formula(unit, short.removeprefix("which is ")))[0] == pytest.approx(value, rel=1e-6)

    @pytest.mark.parametrize(
        ("unit", "text"),
        [
            ("rad/s", "2*pi*N"),
            ("rpm", "2*pi*N"),
            ("rad/s", "pi*N/30"),
            ("rpm", "30/pi*w"),
            ("rps", "w*30/pi"),
            ("rad/s", "N/60"),
            ("rps", "N / 60"),
        ],
    )
    def test_factors_of_turns_between_speeds_are_reported(self, unit, text):
        _, (report,) = result(formula(unit, text))
        assert "omit" in report
        assert result(formula(unit, "N" if "N" in text else "w"))[1] == []

    @pytest.mark.parametrize(
        ("unit", "text", "value"),
        [
            ("rpm", "N", 5000),
            ("rad/s", "N", N),
            ("rpm", "w", 954.9297),
            ("rpm", "(N + w)/2", 2977.465),
            ("1", "N/w", N / 100),
            ("N*m", "2*pi*r**3*mu*D*w/P*P/(48 mm)", 16 * math.pi),
            ("W", "T*w", 190.9859),
            ("rad", "N*t", 0.1 * N),
            ("rad/s**2", "N/t", 10 * N),
            ("rad/s**2", "w**2 * sin(w*t)", 1e4 * math.sin(10)),
            ("rad/s**2", "w**2 * 2 rad", 2e4),
            ("rpm", "N*20/60", 5000 / 3),
            ("m/s", "r*w", 200),
            ("1", "sin(w*t)", math.sin(10)),
            ("l/min", "48 cm**3/rev * N", 240),
        ],
    )
    def test_one_reading_is_not_reported(self, unit, text, value):
        assert result(formula(unit, text)) == (pytest.approx(value, rel=1e-6), [])

    def test_a_function_reports_where_it_is_called(self):
        line = 'U(d [mm], n [rpm]) [m/s] = pi*d*n\nx [m/s] = U(D, N) "x"'
        assert len(result(line)[1]) == 1
        assert len(result(line.replace("U(D, N)", "U(D, w)"))[1]) == 1  # it is declared to take turns
        assert result(line.replace("n [rpm]", "n [rad/s]"))[1] == []

    def test_a_default_that_a_user_replaces_is_not_reported(self):
        cls = sheet('given x [m/s] = pi*D*N "x"')
        assert "turns" in {warning.code for warning in evaluate(cls, cls.example).warnings}
        assert evaluate(cls, {**cls.example, "x": "3 m/s"}).warnings == []

    @pytest.mark.parametrize(
        "line",
        [
            'check pi*D*N <= 60 m/s "x"',
            'require pi*D*N <= 99 m/s "x"',
            'x [1] = if pi*D*N > 3 m/s then 1 else 2 "x"',
            'solve x [mm] from 1 mm to 1 m so that pi*x*N == 3 m/s "x"',
        ],
    )
    def test_a_comparison_is_refused_and_its_remedies_are_accepted(self, line):
        fault = refused(line)
        assert "in turns" in fault.message
        assert "N/(2*pi)" in fault.remedy
        assert "N/(1 rad)" in fault.remedy
        for remedy in ("N/(2*pi)", "N/(1 rad)"):
            sheet(line.replace("N", f"({remedy})"))
        read(GIVEN.replace("N [rpm]", "N [rad/s]") + line)


class TestHertz:
    @pytest.mark.parametrize(
        ("unit", "text", "value"),
        [
            ("rad/s", "v/r", 5),
            ("rad/s", "sqrt(k/m)", 1e4),
            ("rad/s", "sqrt(c_t/J)", 707.1068),
            ("rpm", "(c_t/J)**0.5", 6752.372),
            ("Hz", "sqrt(c_t/J)/(2*pi)", 112.5395),
            ("Hz", "1/(2*pi)*sqrt(c_t/J)", 112.5395),
            ("rad/s", "b_t/J", 500),
            ("Hz", "b_t/J/(2*pi)", 79.57747),
            ("rad/s", "2*pi*f*1 rad", 314.1593),
            ("Hz", "v/r", 5),
            ("Hz", "sqrt(k/m)/(2*pi)", 1591.549),
            ("Hz", "w/(2*pi)", 15.91549),
            ("Hz", "w/2/pi", 15.91549),
            ("Hz", "1/(2*pi)*w", 15.91549),
            ("Hz", "N/(2*pi)", 83.33333),
            ("Hz", "w/(1 turn)", 15.91549),
            ("rad/s", "2*pi*f", 314.1593),
            ("rad/s", "f*2*pi", 314.1593),
            ("rad/s", "pi*f*2", 314.1593),
            ("rad/s", "4*pi*f", 628.3185),
            ("rpm", "2*pi*f", 3000),
            ("rpm", "f * 1 turn", 3000),
            ("1/s", "f", 50),
            ("1/s", "w", 100),
            ("1", "f*t", 5),
            ("rad/s", "sqrt(w**2 - (v/r)**2)", math.sqrt(1e4 - 25)),
            ("Hz", "f + 1/t", 60),
            ("rad/s", "w + 1/t", 110),
            ("1", "cos(2*pi*f*t)", 1),
            ("Hz", "max(f, 60 Hz)", 60),
            ("W", "T*2*pi*f", 600),
        ],
    )
    def test_accepted_without_a_remark(self, unit, text, value):
        assert result(formula(unit, text)) == (pytest.approx(value, rel=1e-5), [])

    @pytest.mark.parametrize(
        ("unit", "text", "remedies", "values"),
        [
            ("rpm", "1/t", ["1 turn / t", "1 rad / t"], [600, 95.49297]),
            ("rps", "v/r", ["(v/r) * 1 turn", "(v/r) * 1 rad"], [5, 0.7957747]),
            ("rev/s", "1/t", ["1 turn / t", "1 rad / t"], [10, 1.591549]),
            ("rpm", "w/(2*pi)", ["(w/(2*pi)) * 1 turn"], [954.9297]),
            ("deg/s", "1 / t", ["1 turn / t", "1 rad / t"], [3600, 572.9578]),
            ("rpm", "1 turn/t", ["1 turn / t"], [600]),
            ("rpm", "f", ["2*pi*f"], [3000]),
            ("rpm", "2*pi/t", ["(2*pi/t) * 1 rad"], [600]),
            ("Hz", "sqrt(c_t/J)", ["(sqrt(c_t/J))/(2*pi)"], [112.5395]),
            ("rad/s", "f*1 rad", ["2*pi*(f*1 rad)"], [314.1593]),
            ("rad/s", "f", ["2*pi*f"], [314.1593]),
            ("rad/s", "pi*f", ["2*pi*f"], [314.1593]),
            ("rad/s", "f + 1/t", ["2*pi*(f + 1/t)"], [376.9911]),
            ("Hz", "w", ["w/(2*pi)"], [15.91549]),
            ("Hz", "N", ["N/(2*pi)"], [83.33333]),
        ],
    )
    def test_refused_with_remedies_that_are_right(self, unit, text, remedies, values):
        fault = refused(formula(unit, text))
        assert fault.code == "unit_mismatch"
        for remedy, value in zip(remedies, values, strict=True):
            assert remedy in fault.remedy
            assert result(formula(unit, remedy)) == (pytest.approx(value, rel=1e-5), [])

    @pytest.mark.parametrize(
        "text", ["w + f", "f - N", "max(w, f)", "w < f", "[w, f]", "if t > 1 s then w else f"]
    )
    def test_hertz_and_radians_do_not_meet(self, text):
        unit = "1" if "<" in text else "rad/s"
        fault = refused(formula(unit, f"if {text} then 1 else 2" if "<" in text else text))
        assert fault.code == "unit_mismatch"
        assert "2*pi" in fault.remedy

    @pytest.mark.parametrize(
        ("of", "unit", "remedy", "value"),
        [("f", "rad/s", "2*pi*u", 314.1593), ("w", "Hz", "u/(2*pi)", 15.91549)],
    )
    def test_a_name_in_1_per_s_has_the_kind_of_its_formula(self, of, unit, remedy, value):
        """Whatever the order of the lines."""
        between = f'u [1/s] = {of} "rate"\n'
        for text in (between + formula(unit, "u"), formula(unit, "u") + "\n" + between):
            fault = refused(text)
            assert remedy in fault.remedy
            cls = sheet(text.replace(formula(unit, "u"), formula(unit, remedy)))
            assert evaluate(cls, cls.example).outputs["x"].value == pytest.approx(value, rel=1e-5)

    @pytest.mark.parametrize("sign", ["<", "<=", ">", ">=", "==", "!="])
    def test_a_number_in_1_per_s_beside_turns_names_both(self, sign):
        fault = refused(formula("1", f"if N {sign} 50 1/s then 1 else 2"))
        for remedy in ("50 turn/s", "50 rad/s"):
            assert remedy in fault.remedy
            sheet(formula("1", f"if N {sign} {remedy} then 1 else 2"))

    @pytest.mark.parametrize(
        ("unit", "text", "remedy", "value"),
        [
            ("rpm", "60*v/(pi*r)", "(v/(pi*r)) * 1 turn", 600 / (2 * math.pi)),
            ("rpm", "v/(pi*r) * 60", "(v/(pi*r)) * 1 turn", 600 / (2 * math.pi)),
            ("rpm", "60*f", "2*pi*f", 3000),
            ("Hz", "N/60", "N/(2*pi)", 83.33333),
        ],
    )
    def test_a_factor_of_minutes_is_left_out(self, unit, text, remedy, value):
        """Textbooks write n = 60 v/(π D) for numbers; units hold the minute already."""
        fault = refused(formula(unit, text))
        assert "omit 60" in fault.remedy
        assert remedy in fault.remedy
        assert result(formula(unit, remedy)) == (pytest.approx(value, rel=1e-5), [])

    @pytest.mark.parametrize(
        ("unit", "text", "remedy", "value"),
        [("m/s", "pi*D*N/60", "D*N/2", 12.56637), ("W", "2*pi*T*N/60", "T*N", 1000)],
    )
    def test_a_report_leaves_out_minutes_too(self, unit, text, remedy, value):
        _, (report,) = result(formula(unit, text))
        assert "omit 60" in report
        assert f"which is {remedy}" in report
        assert result(formula(unit, remedy))[0] == pytest.approx(value, rel=1e-6)

    def test_a_sum_of_turns_and_of_1_per_s_is_refused(self):
        assert "1 turn" in refused(formula("rpm", "N + 1/t")).remedy
        assert result(formula("rpm", "N + 1 turn / t"))[0] == pytest.approx(5600)


SPELLED = {
    "rpm": 2 * math.pi / 60,
    "rps": 2 * math.pi,
    "rev/s": 2 * math.pi,
    "turn/min": 2 * math.pi / 60,
    "rad/s": 1.0,
    "deg/s": math.pi / 180,
    "mrad/s": 1e-3,
}
FORMULAS = {
    "pi*D*N": "m/s",
    "2*pi*T*N": "W",
    "N": "rad/s",
    "N/(2*pi)": "Hz",
    "mu*N/P": "1",
    "T*N": "kW",
    "2*N": "rpm",
    "1/N": "s",
    "N*t": "rad",
    "if N > 10 rad/s then N*t else 1": "1",
    "sqrt(N**2)*r": "m/s",
}


class TestSpelling:
    @settings(max_examples=examples(150), deadline=None)
    @given(
        speed=st.floats(0.01, 1e5),
        declared=st.sampled_from(sorted(SPELLED)),
        typed=st.sampled_from(sorted(SPELLED)),
        text=st.sampled_from(sorted(FORMULAS)),
    )
    def test_property_a_value_does_not_depend_on_how_a_speed_is_written(self, speed, declared, typed, text):
        """Whatever unit N is declared in or typed in, the formula has it in rad/s."""
        given = GIVEN.replace("N [rpm] = 5000 rpm", f"N [{declared}] = 1 {declared}")
        cls = sheet(formula(FORMULAS[text], text), given)
        name = "speed"
        own, si = (
            evaluate(cls, {**cls.example, name: f"{speed / SPELLED[one]!r} {one}"}).outputs["x"].value
            for one in (typed, "rad/s")
        )
        assert own == pytest.approx(si, rel=1e-12)

    @settings(max_examples=examples(100), deadline=None)
    @given(speed=st.floats(0.01, 1e5), shown=st.sampled_from(sorted(SPELLED)))
    def test_property_turns_are_a_spelling_of_results(self, speed, shown):
        cls = sheet(formula("rad/s", "N"))
        raw = {**cls.example, "speed": f"{speed!r} rad/s"}
        answer = evaluate(cls, raw, units={"x": shown}).outputs["x"]
        assert np.asarray(answer.value) * SPELLED[shown] == pytest.approx(speed, rel=1e-12)


UNITS = [
    "rpm",
    "rps",
    "rad/s",
    "deg/s",
    "Hz",
    "1/s",
    "1/min",
    "rad",
    "turn",
    "1",
    "K",
    "degC",
    "delta_degC",
    "degF",
]


class TestEveryPair:
    @pytest.mark.parametrize("declared", UNITS)
    @pytest.mark.parametrize("typed", UNITS)
    def test_property_a_default_is_taken_or_refused_as_a_typed_value_is(self, declared, typed):
        """What the language accepts as a default, the service accepts as an input; nothing else happens."""
        line = f'given z [{declared}] = 2 {typed} "z"\ny [{declared}] = z "y"'.replace("2 1 ", "2 ")
        try:
            cls = sheet(line)
        except SheetRefused as refusal:
            faults = refusal.faults
        else:
            faults = ()
        if faults:
            assert all(fault.code == "unit_mismatch" and fault.remedy for fault in faults)
            return
        plain = evaluate(cls, cls.example).outputs["y"].value
        own = declared if typed == "1" else typed
        again = evaluate(cls, {**cls.example, "z": "2" if own == "1" else f"2 {own}"})
        assert again.outputs["y"].value == pytest.approx(plain, rel=1e-12)
