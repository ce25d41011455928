"""Temperatures and temperature differences in worksheets: their kinds, and what each refuses."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from templates.core.language.evaluate import evaluate
from templates.core.sheets import SheetRefused, read, run_tests
from templates.core.units.units import unit

GIVEN = """# Temperatures
given T1 [degC] = 40 degC "inlet"
given T2 [degF] = 194 degF "outlet"
given rise [delta_degC] = 5 K "rise"
given free [K] = 300 K "kelvins"
given a [1/K] = 12e-6 1/K "expansion"
given q [W] = 100 W "heat"
given c [W/K] = 2 W/K "capacity"
given x [1] = 0.5 "share"
"""


def sheet(lines):
    return read(GIVEN + lines).template("temperatures", 1)


def outputs(lines):
    cls = sheet(lines)
    return {name: (answer.value, answer.unit) for name, answer in evaluate(cls, cls.example).outputs.items()}


def refused(lines):
    with pytest.raises(SheetRefused) as refusal:
        read(GIVEN + lines)
    (fault,) = refusal.value.faults
    assert fault.code in ("unit_mismatch", "check")
    return f"{fault.message}; {fault.remedy}"


def judged(lines):
    cls = sheet(lines)
    (judgement,) = evaluate(cls, cls.example).criteria
    return judgement


class TestChecks:
    @pytest.mark.parametrize("limit", ["30 degC", "54 degF", "30 K", "30 delta_degC", "54 delta_degF"])
    @pytest.mark.parametrize(
        "line",
        [
            'dT [K] = T2 - T1 "rise of both"\ncheck dT <= {} "cool"',
            'dT [delta_degF] = T2 - T1 "rise of both"\ncheck {} >= dT "cool"',
            'check T2 - T1 <= {} "cool"',
            'check dT <= {} "cool"\ndT [K] = d2 "d"\nd2 [K] = x*d3 * 2 "d2"\nd3 [K] = T2 - T1 "d3"',
        ],
    )
    def test_a_limit_beside_a_difference_is_one(self, line, limit):
        """40 °C to 90 °C are 50 K, 20 K more than 30 K."""
        one = judged(line.format(limit))
        assert one.verdict == "not_met"
        assert one.margin * unit(one.margin_unit).factor == pytest.approx(-20)
        assert "303" not in f"{one.require} {one.limit}"

    @pytest.mark.parametrize(
        ("line", "verdict"),
        [
            ('Tm [K] = (T1 + T2)/2 "mean"\ncheck Tm <= 60 degC "cool"', "not_met"),
            ('Tm [degC] = (T1 + T2)/2 "mean"\ncheck Tm <= 70 degC "cool"', "met"),
            ('check T1 + rise <= 44 degC "cool"', "not_met"),
            ('check T1 + rise <= 320 K "cool"', "met"),
            ('check rise <= 6 degC "cool"', "met"),
            ('check free <= 301 K "cool"', "met"),
        ],
    )
    def test_a_limit_beside_a_temperature_is_one(self, line, verdict):
        assert judged(line).verdict == verdict

    @pytest.mark.parametrize(
        "line",
        [
            'check free <= 30 degC "cool"',
            'dT [K] = q/c "d"\ncheck dT <= 30 degC "cool"',
            'y [1] = if free > 30 degC then 1 else 2 "y"',
            'require free >= 30 degC "cool"',
        ],
    )
    def test_beside_kelvins_both_meanings_are_named_and_accepted(self, line):
        words = refused(line)
        assert "303.15 K for a temperature" in words
        assert "30 delta_degC for a difference" in words
        sheet(
            line.replace("30 degC", "303.15 K") if "require" not in line else line.replace("30 degC", "290 K")
        )
        sheet(line.replace("30 degC", "30 delta_degC"))

    @pytest.mark.parametrize(
        "line",
        [
            'check T1 <= 30 delta_degC "x"',
            'check rise <= T1 "x"',
            'require T1 > rise "x"',
            'y [1] = if T1 > rise then 1 else 2 "y"',
            'y [K] = max(T1, rise) "y"',
            'y [K] = if x > 1 then T1 else rise "y"',
        ],
    )
    def test_kinds_do_not_meet(self, line):
        refused(line)

    @pytest.mark.parametrize(
        ("line", "meant"),
        [
            ("T2 - T1 <= rise + 10 degC", "10 delta_degC"),
            ("T2 - T1 <= 10 degC + rise", "10 delta_degC"),
            ("T2 - T1 - rise - 50 degF <= free - free + rise", "50 delta_degF"),
            ("T2 <= T1 - 50 degF", "50 delta_degF"),
            ("T2 <= T1 + 10 degC", "10 delta_degC"),
            ("T2 - T1 <= max(10 degC, 20 degC)", "10 delta_degC, 20 delta_degC"),
        ],
    )
    def test_the_remedy_names_the_number_that_is_meant_as_a_difference(self, line, meant):
        """What it names is accepted, and judged as a difference: no temperature of 283 K."""
        said = refused(f'check {line} "cool"')
        assert f"write {meant} for" in said
        assert "both in the same unit" not in said
        for text in meant.split(", "):
            line = line.replace(text.replace("delta_", ""), text)
        assert judged(f'check {line} "cool"').verdict in ("met", "not_met")

    def test_without_such_a_number_the_remedy_is_a_sum_or_a_difference(self):
        said = refused('check rise <= T1 "cool"')
        assert "subtract a temperature from the temperature, or add one to the difference" in said
        assert judged('check rise <= T1 - T2 "cool"').verdict == "not_met"
        assert judged('check rise + T2 <= T1 "cool"').verdict == "not_met"

    def test_conditions_and_rules_take_the_kind_of_the_other_side(self):
        lines = 'y [1] = if T2 - T1 > 30 degC then 1 else 2 "y"\nrequire rise <= 6 degC "small"'
        assert outputs(lines) == {"y": (1, "1")}


class TestDeclarations:
    @pytest.mark.parametrize(
        ("line", "words"),
        [
            ('given dT [K] = 50 degC "d"', ["323.15 K for a temperature", "50 delta_degC for a difference"]),
            (
                'given dT [K] "d" (example -4 degF)',
                ["253.15 K for a temperature", "-4 delta_degF for a difference"],
            ),
            (
                'given dT [K] = 50 K "d" (<= 90 degC)',
                ["363.15 K for a temperature", "90 delta_degC for a difference"],
            ),
            ('dT [K] = 50 degC "d"', ["323.15 K for a temperature", "50 delta_degC for a difference"]),
            ('given dT [delta_degC] = 50 degC "d"', ["50 delta_degC"]),
            ('given dT [delta_degF] = 90 degF "d"', ["90 delta_degF"]),
            ('given t [degC] = 50 delta_degC "d"', ["difference"]),
            ('t [degC] = T2 - T1 "d"', ["difference of temperatures"]),
            ('t [delta_degC] = T1 "d"', ["temperature, not a difference"]),
            (
                'L [mm] = 48 mm * (1 + a * 50 degC) "d"',
                ["323.15 K for a temperature", "50 delta_degC for a difference"],
            ),
            (
                'L [mm] = 48 mm * (1 + 122 degF * a) "d"',
                ["323.15 K for a temperature", "122 delta_degF for a difference"],
            ),
            ('t [degC] = T1 + 5 degC "d"', ["5 delta_degC for a difference"]),
            ('g(y [K]) [1] = y / 1 K\nz [1] = g(50 degC) "z"', ["323.15 K", "50 delta_degC"]),
            ('g(y [delta_degC]) [1] = y / 1 K\nz [1] = g(T1) "z"', ["temperature, not a difference"]),
        ],
    )
    def test_what_is_refused_names_what_would_be_right(self, line, words):
        said = refused(line)
        assert all(word in said for word in words), said

    @pytest.mark.parametrize(
        ("line", "value"),
        [
            ('given dT [K] = 323.15 K "d"\ny [K] = dT "y"', (323.15, "K")),
            ('given dT [K] = 50 delta_degC "d"\ny [K] = dT "y"', (50, "delta_degC")),
            ('given dT [delta_degC] = 90 delta_degF "d"\ny [K] = dT "y"', (50, "delta_degC")),
            ('y [mm] = 48 mm * (1 + a * 50 delta_degC) "y"', (48.0288, "mm")),
            ('y [mm] = 48 mm * (1 + a * (T1 + 5 delta_degC - 20 degC)) "y"', (48.0144, "mm")),
            ('y [degC] = T1 + 5 delta_degC "y"', (45, "degC")),
            ('y [degC] = T1 + rise "y"', (45, "degC")),
            ('y [K] = T1 "y"', (313.15, "K")),
            ('y [K] = T2 - T1 "y"', (50, "delta_degC")),
            ('y [degF] = T1 "y"', (104, "degF")),
            ('y [delta_degF] = T2 - T1 "y"', (90, "delta_degF")),
            ('y [degR] = T2 - T1 "y"', (90, "delta_degF")),
            ('y [degC] = (T1 + T2)/2 "y"', (65, "degC")),
            ('y [degC] = T1 + x*(T2 - T1) "y"', (65, "degC")),
            ('y [delta_degC] = q/c "y"', (50, "delta_degC")),
            ('y [degC] = T1 + q/c "y"', (90, "degC")),
            ('y [K] = q/c "y"', (50, "K")),
            ('y [K] = 90 degC - T1 "y"', (50, "delta_degC")),
            ('y [1] = T1/(1 K) "y"', (313.15, "1")),
            ('g(y [degC]) [1] = y / 1 K\ny [1] = g(50 degC) "y"', (323.15, "1")),
            ('g(y [K]) [1] = y / 1 K\ny [1] = g(T1) "y"', (313.15, "1")),
            ('y [K] = z "y"\nz [K] = T1 + rise "z" (> 20 K)', (318.15, "K")),
        ],
    )
    def test_what_is_accepted_is_right(self, line, value):
        assert outputs(line)["y"] == (pytest.approx(value[0], rel=1e-9), value[1])

    @pytest.mark.parametrize(
        ("declared", "limit", "accepted", "refused_"),
        [
            ("y [K] = T2 - T1", "60 degC", 59, 61),
            ("y [K] = T2 - T1", "108 degF", 59, 61),
            ("given y [delta_degC] = 5 K", "60 degC", 59, 61),
            ("y [K] = (T1 + T2)/2", "330 K", 329, 331),
            ("y [K] = (T1 + T2)/2", "56.85 degC", 329, 331),
            ("y [degC] = (T1 + T2)/2", "330 K", 329, 331),
        ],
    )
    def test_a_bound_takes_the_kind_of_what_it_bounds(self, declared, limit, accepted, refused_):
        meaning = sheet(f'{declared} "y" (<= {limit})').declarations["y"].meaning
        assert meaning.admits(float(accepted))
        assert not meaning.admits(float(refused_))

    @pytest.mark.parametrize("within", ["1 degC", "1.8 degF"])
    def test_the_tolerance_of_a_test_is_a_difference(self, within):
        line = 'y [degC] = (T1 + T2)/2 "y"\ntest "by hand" with T1 = 40 degC gives y = 65 degC within {}'
        said = refused(line.format(within))
        remedy = said.rpartition("write ")[2]
        assert remedy in ("1 delta_degC", "1.8 delta_degF")
        (outcome,) = run_tests(sheet(line.format(remedy)))
        assert outcome.passed
        (outcome,) = run_tests(sheet(line.replace("65", "67").format(remedy)))
        assert not outcome.passed

    def test_a_test_of_a_difference_expects_one(self):
        line = 'y [K] = T2 - T1 "y"\ntest "by hand" with T1 = 40 degC gives y = {} within {}'
        for expected, within in (
            ("50 K", "1e-9 K"),
            ("90 delta_degF", "0.1 %"),
            ("50 delta_degC", "1 delta_degF"),
        ):
            (outcome,) = run_tests(sheet(line.format(expected, within)))
            assert outcome.passed, outcome.message
        assert "50 delta_degC" in refused(line.format("50 degC", "1 K"))

    @pytest.mark.parametrize(
        ("raw", "accepted"),
        [
            ("30 delta_degC", True),
            ("54 delta_degF", True),
            ("30 K", True),
            ("30 degC", False),
            ("86 degF", False),
        ],
    )
    @pytest.mark.parametrize("declared", ["[K] = T2 - T1", "[delta_degC] = 5 K", "[delta_degF] = T2 - T1"])
    def test_an_input_that_is_a_difference(self, raw, accepted, declared):
        cls = sheet(f'given dT {declared} "step"\ny [K] = 2*dT "y"')
        if accepted:
            answer = evaluate(cls, {**cls.example, "step": raw}, outputs=["y"]).outputs["y"]
            assert answer.value * unit(answer.unit).factor == pytest.approx(60)
        else:
            with pytest.raises(Exception, match="delta_deg"):
                evaluate(cls, {**cls.example, "step": raw})

    @pytest.mark.parametrize(
        ("name", "asked", "value"),
        [
            ("y", "degC", (50, "delta_degC")),
            ("y", "degF", (90, "delta_degF")),
            ("y", "K", (50, "K")),
            ("z", "degC", (65, "degC")),
            ("z", "degF", (149, "degF")),
            ("z", "K", (338.15, "K")),
        ],
    )
    def test_the_unit_of_an_output_takes_its_kind(self, name, asked, value):
        cls = sheet('y [K] = T2 - T1 "y"\nz [K] = (T1 + T2)/2 "z"')
        answer = evaluate(cls, cls.example, units={name: asked}).outputs[name]
        assert (answer.value, answer.unit) == (pytest.approx(value[0]), value[1])

    @pytest.mark.parametrize(("name", "asked"), [("z", "delta_degC"), ("w", "degC")])
    def test_and_refuses_another(self, name, asked):
        cls = sheet('y [K] = T2 - T1 "y"\nz [K] = (T1 + T2)/2 "z"\nw [K] = q/c "w"')
        with pytest.raises(Exception, match="temperature"):
            evaluate(cls, cls.example, units={name: asked})


def trees(leaves):
    number = st.sampled_from(["2", "0.5", "3"])
    pairs = st.tuples(leaves, leaves)
    return st.one_of(
        pairs.map(lambda two: f"({two[0]} + {two[1]})"),
        pairs.map(lambda two: f"({two[0]} - {two[1]})"),
        pairs.map(lambda two: f"min({two[0]}, {two[1]})"),
        leaves.map(lambda one: f"(0 delta_degC - {one})" if one[0].isdigit() else f"(-{one})"),
        st.tuples(number, leaves).map(lambda two: f"({two[0]} * {two[1]})"),
        st.tuples(leaves, number).map(lambda two: f"({two[0]} / {two[1]})"),
        st.tuples(leaves, leaves).map(lambda two: f"(if x < 1 then {two[0]} else {two[1]})"),
    )


EXPRESSIONS = st.recursive(
    st.sampled_from(["T1", "T2", "rise", "20 degC", "7 delta_degF"]), trees, max_leaves=7
)


class TestOrigin:
    @settings(max_examples=examples(300), deadline=None)
    @given(EXPRESSIONS)
    def test_property_a_difference_does_not_know_where_zero_lies(self, text):
        """Shift every temperature by 10 K: a temperature moves with them, a difference stays.

        The kinds that the language finds are held against values, which know nothing of kinds.
        """
        try:
            cls = sheet(f'y [K] = {text} "y"')
        except SheetRefused:
            return
        declared = cls.formulas["y"].meaning
        shifted = sheet(f'y [K] = {text.replace("20 degC", "30 degC")} "y"')
        warmer = {**cls.example, "inlet": "50 degC", "outlet": "100 degC"}
        before, after = (
            float(np.asarray(one.outputs["y"].value))
            for one in (
                evaluate(cls, cls.example, units={"y": "K"}),
                evaluate(shifted, warmer, units={"y": "K"}),
            )
        )
        moved = {"delta_degC": 0.0, "degC": 10.0}.get(declared.accepted)
        if moved is not None:
            assert after - before == pytest.approx(moved, abs=1e-6)
        else:
            assert not any(after - before == pytest.approx(one, abs=1e-6) for one in (0.0, 10.0))

    def test_property_most_expressions_are_known(self):
        texts = ["T1", "T2", "rise"]
        kinds = [
            sheet(f'y [K] = {one} {sign} {two} "y"').formulas["y"].meaning.accepted
            for one, two in itertools.product(texts, texts)
            for sign in "+-"
        ]
        assert [kinds.count(name) for name in ("degC", "delta_degC", "K")] == [6, 6, 6]
