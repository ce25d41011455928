"""Each statement of a worksheet has its meaning, at one point and at many."""

import numpy as np
import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.sheets import SheetRefused, read, run_tests
from templates.examples.index import examples

BEARING = """# Journal bearing, first cut
> Steady load, **aligned** journal.
> Two lines of prose.
// a remark
given F [kN] "radial load" (>= 0; example 25 kN; also "load")
given D [mm] "bearing diameter" (> 0; <= 2 m; example 48 mm)
given B [mm] = D / 2 "bearing width" (> 0)
given n [1] = 3 "number of bearings" (whole; >= 1)
given p_gas [bar] over cycle "gas pressure" (example [1, 2, 30] * 1 bar)
given T [degC] = 80 degC "oil temperature"
choice law = walther "viscosity law" (walther | vogel)
curve mu(T [degC]) [mPa*s] "viscosity by temperature" (source "data sheet"):
  40 -> 80
  100 -> 9
curve nu(T [degC]) [mm**2/s] "held viscosity" (held):
  40 -> 80
  100 -> 9 mm**2/s
sigma(M [N*m], W [mm**3]) [MPa] = M / W
p [MPa] = F / (D * B) "projected pressure" (published 1 to 40; source "DIN 31652")
eta [mPa*s] = if law is walther then mu(T) else 0.9 * mu(T) "viscosity"
twice [mPa*s] = 2 * eta "twice the viscosity"
mild [mPa*s] = if T < 100 degC then mu(T) else 9 mPa*s "viscosity, held by hand"
held [mm**2/s] = nu(T) "kinematic viscosity"
bend [MPa] = sigma(F * D, D**2 * B) "bending stress"
swing [bar] over cycle = p_gas - mean(p_gas) "pressure swing"
most [bar] = max(p_gas) "largest pressure"
solve x [mm] from 1 mm to 2 m so that F / (x * B) == 10 MPa "diameter for 10 MPa"
require B <= 2 * D "The bush is at most twice as long as wide" (remedy "use two")
require p_gas > 0 bar "The gas presses"
check p <= 30 MPa "white metal carries it" (source "catalogue")
check most <= 29 bar "the gas pressure is moderate"
check T <= 120 degC "the oil stays cool"
test "by hand" with F = 12.5 kN, B = 24 mm gives p = 10.85 MPa within 0.1 %
test "by hand, absolute" with law = vogel gives eta = 29.4 mPa*s, twice = 58.8 mPa*s within 1e-9 mPa*s
test "wrong" gives p = 30 MPa within 1 %
"""


@pytest.fixture(scope="module")
def bearing():
    return read(BEARING).template("journal_bearing", 2)


def outputs(cls, **changed):
    answers = evaluate(cls, {**cls.example, **changed}).outputs
    return {name: answer.value for name, answer in answers.items()}


class TestOnePoint:
    def test_formulas_functions_curves_and_equations(self, bearing):
        results = outputs(bearing)
        assert results["projected_pressure"] == pytest.approx(25e3 / (48 * 24), rel=1e-12)
        assert results["viscosity"] == pytest.approx(80 - 71 * 40 / 60, rel=1e-12)
        assert results["bending_stress"] == pytest.approx(25e3 / (48 * 24), rel=1e-12)
        assert results["pressure_swing"] == pytest.approx([-10, -9, 19], rel=1e-12)
        assert results["diameter_for_10_mpa"] == pytest.approx(25e3 / (24 * 10), rel=1e-12)

    def test_a_choice_chooses(self, bearing):
        mine, other = outputs(bearing), outputs(bearing, viscosity_law="vogel")
        assert other["viscosity"] == pytest.approx(0.9 * mine["viscosity"], rel=1e-12)

    def test_a_default_may_follow_from_others(self, bearing):
        assert outputs(bearing, bearing_width="12 mm")["projected_pressure"] == pytest.approx(
            25e3 / (48 * 12)
        )

    def test_there_is_no_value_outside_a_curve_and_the_answer_says_why(self, bearing):
        answers = evaluate(bearing, {**bearing.example, "oil_temperature": "120 degC"}).outputs
        for name in ("viscosity", "twice_the_viscosity"):
            assert answers[name].value is None
            assert answers[name].reason == "mu is known from 40 degC to 100 degC only"
        assert answers["viscosity_held_by_hand"].value == pytest.approx(9)
        assert answers["kinematic_viscosity"].value == pytest.approx(9)

    def test_there_is_no_value_without_a_root_and_the_answer_says_why(self, bearing):
        answer = evaluate(bearing, {**bearing.example, "radial_load": "0 N"}).outputs["diameter_for_10_mpa"]
        assert answer.value is None
        assert (
            answer.reason
            == "there is no diameter for 10 MPa between 1 mm and 2 m for which the equation holds"
        )

    def test_a_rule_refuses_and_names_the_inputs(self, bearing):
        with pytest.raises(InvalidInputs) as refused:
            evaluate(bearing, {**bearing.example, "bearing_width": "100 mm"})
        (fault,) = refused.value.faults
        assert (fault.code, set(fault.names)) == ("inconsistent", {"bearing_width", "bearing_diameter"})
        assert "use two" in fault.detail

    def test_a_rule_of_a_list_holds_at_all_its_places(self, bearing):
        with pytest.raises(InvalidInputs, match="The gas presses"):
            evaluate(bearing, {**bearing.example, "gas_pressure": {"value": [1, -1, 2], "unit": "bar"}})

    def test_bounds_refuse(self, bearing):
        with pytest.raises(InvalidInputs, match="a whole number ≥ 1"):
            evaluate(bearing, {**bearing.example, "number_of_bearings": 1.5})

    def test_a_published_range_warns(self, bearing):
        warned = evaluate(bearing, {**bearing.example, "radial_load": "100 kN"}).warnings
        assert ("outside_published_range", "projected_pressure") in [(w.code, w.name) for w in warned]

    def test_a_check_is_a_criterion_and_warns(self, bearing):
        evaluation = evaluate(bearing, bearing.example)
        verdicts = {judged.name: judged.verdict for judged in evaluation.criteria}
        assert verdicts == {
            "white_metal_carries_it": "met",
            "the_gas_pressure_is_moderate": "not_met",
            "the_oil_stays_cool": "met",
        }
        assert ["check_not_met"] == [warning.code for warning in evaluation.warnings]
        carried = next(c for c in bearing.declared_criteria if c.name == "white_metal_carries_it")
        assert (carried.require, carried.source) == ("projected_pressure <= 30 MPa", "catalogue")


class TestManyPoints:
    TEMPERATURES = (50.0, 120.0, 90.0, 30.0)

    def test_equal_single_points(self, bearing):
        loads = [25.0, 0.0, 100.0, 12.0]
        many = evaluate(bearing, {
            **bearing.example,
            "radial_load": {"value": loads, "unit": "kN"},
            "oil_temperature": {"value": list(self.TEMPERATURES), "unit": "degC"},
        }).outputs  # fmt: skip
        for place, (load, temperature) in enumerate(zip(loads, self.TEMPERATURES, strict=True)):
            one = evaluate(bearing, {
                **bearing.example, "radial_load": f"{load} kN", "oil_temperature": f"{temperature} degC",
            }).outputs  # fmt: skip
            for name, answer in one.items():
                here = many[name].value
                if np.ndim(here) == 0 or name == "pressure_swing":
                    continue
                if answer.value is None:
                    assert np.isnan(here[place])
                    assert many[name].reasons[place] == answer.reason
                else:
                    assert here[place] == pytest.approx(answer.value, rel=1e-12), name

    def test_curves_at_many_points_are_each_their_own(self, bearing):
        pressures = [[1.0, 2.0, 30.0], [3.0, 3.0, 3.0]]
        results = outputs(bearing, gas_pressure={"value": pressures, "unit": "bar"})
        assert results["pressure_swing"] == pytest.approx(
            np.array([[-10, -9, 19], [0, 0, 0]]), rel=1e-12, abs=1e-12
        )
        assert results["largest_pressure"] == pytest.approx([30, 3])

    def test_a_curve_of_a_list_says_at_which_points_it_has_no_value(self):
        text = """given g [bar] over cycle "gas" (example [1, 2] * 1 bar)
given k [1] = 1 "factor"
curve c(x [bar]) [1] "curve": 0 -> 0 10 -> 5
most [1] = k * max(c(g)) "most"
each [1] over cycle = k * c(g) "each"
third [bar] = g[k] "chosen"
"""
        cls = read(text).template("curve_of_list", 1)
        inputs = {"gas": {"value": [[1, 2], [3, 20], [4, 6]], "unit": "bar"}, "factor": [1, 2, 3]}
        answers = evaluate(cls, inputs).outputs
        reason = "c is known from 0 bar to 10 bar only"
        assert answers["most"].reasons.tolist() == answers["each"].reasons.tolist() == [None, reason, None]
        assert answers["most"].value[[0, 2]] == pytest.approx([1, 9])
        assert answers["chosen"].reasons.tolist() == [None, None, "the list has no item of this index"]


class TestTests:
    def test_say_what_came_out(self, bearing):
        by_hand, absolute, wrong = run_tests(bearing)
        assert by_hand.passed
        assert absolute.passed
        assert not wrong.passed
        assert wrong.message.startswith("projected pressure is 21.70138")
        assert wrong.message.endswith("MPa, not 30 MPa within 1 %: 8.299 MPa (27.7 %) too low")

    def test_a_refused_input_fails(self):
        text = 'given F [N] "load" (> 0; example 1 N)\np [N] = F "p"\n'
        text += 'test "t" with F = -1 N gives p = 1 N within 1 %'
        (result,) = run_tests(read(text).template("refused", 1))
        assert not result.passed
        assert "refused" in result.message


class TestText:
    def test_it_is_of_version_1_of_the_language(self):
        """As are all released texts, which are read by it for ever."""
        assert read(BEARING).language == 1

    def test_layout_and_prose_do_not_change_the_digest(self):
        changed = (
            BEARING.replace("Steady load", "Any load")
            .replace("F / (D * B)", "F/(D*B)")
            .replace("  40", "    40")
        )
        assert changed != BEARING
        assert read(changed).digest() == read(BEARING).digest()
        assert read(BEARING.replace("\n", "\r\n")).digest() == read(BEARING).digest()

    @pytest.mark.parametrize(
        ("old", "new"),
        [("10 MPa", "11 MPa"), ('"load"', '"force"'), ("25 kN;", "26 kN;"), ("vogel)", "barus)")],
    )
    def test_what_calculates_changes_the_digest(self, old, new):
        text = BEARING.replace("law = vogel", "law = barus") if new == "barus)" else BEARING
        assert read(text.replace(old, new, 1)).digest() != read(BEARING).digest()

    def test_statements_follow_the_lines(self):
        sheet = read(BEARING)
        assert sheet.title == "Journal bearing, first cut"
        kinds = [(s.kind, s.name, s.line, s.last_line) for s in sheet.statements[:5]]
        assert kinds == [
            ("prose", "", 1, 1),
            ("prose", "", 2, 3),
            ("remark", "", 4, 4),
            ("given", "F", 5, 5),
            ("given", "D", 6, 6),
        ]
        assert sheet.statements[1].words == "Steady load, **aligned** journal.\nTwo lines of prose."
        curve = next(s for s in sheet.statements if s.kind == "curve")
        assert (curve.last_line - curve.line, curve.words) == (2, "viscosity by temperature")
        pressure = next(s for s in sheet.statements if s.name == "p")
        assert pressure.latex == r"p=\frac{F}{D\,B}"

    def test_names_complete(self):
        names = {name.name: (name.unit, name.kind) for name in read(BEARING).names}
        assert names["F"] == ("kN", "given")
        assert names["sigma"] == ("MPa", "function")
        assert names["mu"] == ("mPa*s", "curve")
        assert names["law"] == ("1", "choice")

    @pytest.mark.parametrize("example", examples(), ids=lambda example: example.id)
    def test_an_example_is_sound(self, example):
        cls = read(example.text).template(example.id, 1)
        assert example.title
        assert all(test.passed for test in run_tests(cls))
        assert evaluate(cls, cls.example).outputs

    def test_the_paper_comes_first(self):
        assert examples()[0].id == "paper_bearing"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('curve c(x [1]) [1] "c": 1 -> 2', "curve"),
        ('curve c(x [1]) [1] "c": 1 -> 2 1 -> 3', "curve"),
        ('curve c(x [1]) [1] "c": 2 -> 2 1 -> 3', "curve"),
        ('choice c = z "c" (x | y)', "choice"),
        ('choice c "c" (x | x)', "choice"),
        ('solve x [1] from 0 to 1 so that 2 == 3 "x"', "equation"),
        ('solve x [1] from 0 to 1 so that x < 3 "x"', "equation"),
        ('solve x [1] from 0 mm to 1 so that x == 3 "x"', "unit_mismatch"),
        ('given a [1] "a"\ncheck a < 3 "c"', "check"),
        ('given a [1] "a"\ncheck a <= 3 and a >= 1 "c"', "check"),
        ('given a [1] "a" (held)', "clause"),
        ('given a [1] "a" (published 40 to 1)', "limit"),
        ('given a [1] "a"\nrequire a > 1 "r" (> 3)', "clause"),
        ('given a [1] "a"\ntest "t" with b = 1 gives a = 1 within 1 %', "unknown_name"),
        ('given a [1] = 1 "a"\nb [mm] = 1 mm "b"\ntest "t" gives b = 1 N within 1 %', "unit_mismatch"),
        ('given a [1] = 1 "a"\nb [mm] = 1 mm "b"\ntest "t" gives b = 1 mm within 1', "limit"),
        ('given a [1] over cycle = 2 "a"', "axis_mismatch"),
    ],
)
def test_a_faulty_statement_is_refused(text, code):
    with pytest.raises(SheetRefused) as refused:
        read(text)
    assert code in [fault.code for fault in refused.value.faults], refused.value
