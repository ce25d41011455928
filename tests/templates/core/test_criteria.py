"""Criteria of small templates are refused with the class, or judged with the evaluation."""

import json

import numpy as np
import pytest

from templates.core.criteria import limits as limits_of
from templates.core.criteria.limits import Library, RowValue
from templates.core.errors import InvalidInputs
from templates.core.language import levels
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template, choice, curve, formula, given, profile, text


class Beam(Template):
    """A beam without levels and without a table of errors."""

    criteria = {
        "stress": {
            "require": "stress <= permissible_stress",
            "words": "the stress is one that the steel bears",
            "source": "a handbook",
            "limits": {
                "permissible_stress": {"unit": "MPa", "words": "stress that is borne", "from": "steel"}
            },
            "warning": "overloaded",
        },
        "sag": "sag <= largest_sag",
        "slender": {"require": "2 * height >= length / 10", "unverified": "from memory"},
    }

    F = given("kN", "force", ge=0)
    A = given("mm**2", "area", default="100 mm**2", gt=0)
    length = given("m", "length", default="1 m")
    h = given("mm", "height", default="60 mm")
    f_max = given("mm", "largest sag", optional=True)
    stiff = given("N/mm", "stiffness", optional=True)
    kind: str = choice("short", "long", words="kind", default="short")

    @formula("MPa", "stress")
    def sigma(self):
        return self.F / self.A

    @formula("mm", "sag")
    def f(self):
        return self.F / self.stiff

    @text("remark")
    def remark(self):
        return "none"


class Wave(Template):
    """A curve over angles, with two levels and a table."""

    levels = ("rough", "fine")
    default_level = "rough"
    criteria = {
        "height": {
            "require": "height >= least_height",
            "limits": {"least_height": {"unit": "mm", "words": "least height"}},
        },
        "top": "top <= 12 mm",
    }

    angle = curve("deg", "angle")
    size = given("mm", "size", gt=0)

    @formula("mm", "top")
    def top(self):
        return self.size * (1.1 if self.level == "rough" else 1.0)

    @profile("mm", "height", along="angle")
    def height(self):
        return np.multiply.outer(np.asarray(self.top), 2 + np.cos(self.angle))


ANGLES = {"value": [0, 90, 180, 270], "unit": "deg"}


@pytest.fixture
def wave(monkeypatch):
    """The class with a table: at level rough the top is off by 10 %, the height nowhere known at fine."""
    content = {
        "axes": [{"attribute": "size", "values": [0, 1]}, {"attribute": "size", "values": [0, 1]}],
        "levels": {
            "rough": {
                "errors": {"top": [[0.1]], "height": [[0.05]]},
                "truth": {"top": "the sea", "height": "the lake"},
            },
            "fine": {"errors": {"top": [[0.0]]}},
        },
    }
    errors = {
        level: {name: np.array(table) for name, table in part["errors"].items()}
        for level, part in content["levels"].items()
    }
    table = levels.Accuracy(("size", "size"), (np.array([0, 1]), np.array([0, 1])), errors, content)
    monkeypatch.setitem(levels._cache, Wave, table)
    return Wave


def by_name(evaluation):
    return {judgement.name: judgement for judgement in evaluation.criteria}


def test_analytic_criteria_of_an_evaluation():
    result = evaluate(Beam, {"force": "30 kN"}, limits={"permissible_stress": "200 MPa"})
    stress, sag, slender = (by_name(result)[name] for name in ("stress", "sag", "slender"))
    assert (stress.verdict, stress.value, stress.limit) == ("not_met", pytest.approx(300), pytest.approx(200))
    assert (stress.utilisation, stress.margin) == (pytest.approx(1.5), pytest.approx(-100))
    assert not stress.error_known  # nobody measured the error of the beam
    assert (sag.verdict, sag.give) == ("not_checked", ("stiffness", "largest_sag"))
    assert (slender.verdict, slender.error_known, slender.is_certain) == ("met", True, False)  # inputs alone
    assert slender.margin == pytest.approx(20)
    assert [judgement.name for judgement in result.criteria] == ["stress", "sag", "slender"]


def test_a_criterion_that_is_not_met_warns_with_its_code():
    result = evaluate(Beam, {"force": "30 kN"}, limits={"permissible_stress": "200 MPa"})
    (warning,) = [w for w in result.warnings if w.code == "overloaded"]
    assert warning.name == "stress"
    assert warning.detail == "stress 300 MPa is above permissible stress 200 MPa: not met; error unknown"
    assert not evaluate(Beam, {"force": "1 kN"}, limits={"permissible_stress": "200 MPa"}).warnings


def test_restricted_outputs_compute_nothing_more():
    result = evaluate(Beam, {"force": "30 kN"}, outputs=["stress"])
    assert set(by_name(result)) == {"stress", "slender"}
    assert "f" not in vars(result.template)
    assert set(by_name(evaluate(Beam, {"force": "1 kN"}, outputs=[]))) == {"slender"}


def test_a_missing_limit_says_what_to_give():
    stress = by_name(evaluate(Beam, {"force": "30 kN"}))["stress"]
    assert (stress.verdict, stress.give, stress.value) == (
        "not_checked",
        ("permissible_stress",),
        pytest.approx(300),
    )
    assert stress.reason == "give permissible_stress in MPa, or a row of steel"


@pytest.mark.parametrize(
    ("given_limits", "names"),
    [
        ({"permissible_stres": "1 MPa"}, ["limits.permissible_stres"]),
        ({"permissible_stress": "1 mm", "other": 1}, ["limits.other", "limits.permissible_stress"]),
        ({"steel": "C45"}, ["limits.steel"]),
    ],
)
def test_wrong_limits_are_refused_by_name(given_limits, names):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(Beam, {"force": "30 kN"}, limits=given_limits)
    assert sorted(fault.name for fault in refusal.value.faults) == names


def test_a_row_of_a_library_fills_limits_and_a_hand_wins(monkeypatch):
    rows = {"C45": {"permissible_stress": RowValue("350 MPa", "a table"), "other": RowValue("1 K", "x")}}
    monkeypatch.setitem(limits_of._libraries, "steel", Library(lambda: rows, rows.__getitem__))
    stress = by_name(evaluate(Beam, {"force": "30 kN"}, limits={"steel": "C45"}))["stress"]
    assert (stress.verdict, stress.limit, stress.source) == ("met", pytest.approx(350), "a handbook; a table")
    by_hand = {"steel": "C45", "permissible_stress": "100 MPa"}
    stress = by_name(evaluate(Beam, {"force": "30 kN"}, limits=by_hand))["stress"]
    assert (stress.verdict, stress.limit, stress.source) == ("not_met", pytest.approx(100), "a handbook")
    with pytest.raises(InvalidInputs, match="did you mean C45"):
        evaluate(Beam, {"force": "30 kN"}, limits={"steel": "C46"})


def test_rows_are_judged_one_by_one_against_limits_of_their_own():
    forces = {"value": [10, 30, 50], "unit": "kN"}
    stress = by_name(evaluate(Beam, {"force": forces}, limits={"permissible_stress": "300 MPa"}))["stress"]
    assert (stress.verdict, stress.counts) == ("not_met", {"not_met": 1, "met": 2})
    assert (stress.where[0].name, stress.where[0].value) == ("point", 3)
    own = {"permissible_stress": {"value": [50, 400, 600], "unit": "MPa"}}
    stress = by_name(evaluate(Beam, {"force": forces}, limits=own))["stress"]
    assert (stress.verdict, stress.where[0].value, stress.limit) == ("not_met", 1, pytest.approx(50))


@pytest.mark.parametrize("many", [[100, 200], [[100], [200], [300]], [1.0] * 1000])
def test_limits_never_make_more_points_than_the_calculation_has(many):
    raw = {"permissible_stress": {"value": many, "unit": "MPa"}}
    stress = by_name(evaluate(Beam, {"force": {"value": [10, 30, 50], "unit": "kN"}}, limits=raw))["stress"]
    assert stress.verdict == "not_checked"
    assert "do not fit" in stress.reason


def test_a_reported_unit_is_that_asked_for():
    stress = by_name(
        evaluate(Beam, {"force": "30 kN"}, units={"stress": "GPa"}, limits={"permissible_stress": "200 MPa"})
    )["stress"]
    assert (stress.unit, stress.value, stress.limit) == ("GPa", pytest.approx(0.3), pytest.approx(0.2))


def test_curves_are_judged_with_the_error_of_their_level(wave):
    """The height is 3.3, 2.2, 1.1, 2.2 mm, off by 5 % of 3.3/0.95 = 0.174 mm."""
    result = evaluate(wave, {"angle": ANGLES, "size": "1 mm"}, limits={"least_height": "1 mm"})
    height, top = by_name(result)["height"], by_name(result)["top"]
    assert (height.verdict, height.level, height.truth) == ("undecided", "rough", "the lake")
    assert [(p.name, p.value) for p in height.where] == [("angle", pytest.approx(180))]
    assert height.band == pytest.approx((1.1 - 0.05 / 0.95 * 3.3, 1.1 + 0.05 / 0.95 * 3.3))
    assert (top.verdict, top.truth, top.relative_error) == ("met", "the sea", 0.1)
    along = {"least_height": {"value": [0, 0, 1, 2], "unit": "mm"}}
    height = by_name(evaluate(wave, {"angle": ANGLES, "size": "1 mm"}, limits=along))["height"]
    assert (height.verdict, height.where[0].value, height.limit) == ("undecided", pytest.approx(180), 1)


def test_an_error_that_was_not_measured_is_not_known(wave):
    raw = {"angle": ANGLES, "size": "1 mm"}
    height = by_name(evaluate(wave, raw, level="fine", limits={"least_height": "0.1 mm"}))["height"]
    assert (height.verdict, height.error_known, height.band) == ("met", False, None)
    assert height.reason == "error of height unknown"
    outside = by_name(evaluate(wave, {**raw, "size": "2 m"}))["top"]  # beyond the table
    assert (outside.verdict, outside.error_known) == ("not_met", False)


@pytest.mark.parametrize(
    ("others", "half"),
    [(["top"], 11 / 9), (5e-3, 5 / 9), (None, None)],  # e/(1 - e) of the largest of the outputs, or of a size
)
def test_an_error_is_relative_to_what_its_table_says(wave, others, half):
    levels._cache[Wave].content["relative_to"] = {"top": others}
    top = by_name(evaluate(wave, {"angle": ANGLES, "size": "10 mm"}, outputs=["top"]))["top"]
    if half is None:  # a size that is not an output
        assert (top.verdict, top.band, top.error_known) == ("met", None, False)
    else:
        assert top.band == pytest.approx((11 - half, 11 + half))
        assert top.verdict == ("undecided" if 11 + half > 12 else "met")


def test_each_level_is_judged_with_its_own_error(wave):
    sizes = {"value": [5, 11.5], "unit": "mm"}
    raw = {"angle": ANGLES, "size": sizes}
    top = by_name(evaluate(wave, raw, outputs=["top"], level="rough"))["top"]
    assert top.counts == {"undecided": 1, "met": 1}  # 11.5 · 1.1 = 12.65, ± 10 %
    top = by_name(evaluate(wave, raw, outputs=["top"], level="fine"))["top"]
    assert top.counts == {"met": 2}


BAD = {
    "an unknown name": "stres <= 3 MPa",
    "another kind": "stress <= 3 mm",
    "a word": "kind >= 1",
    "a text": "remark >= 1",
    "no comparison": "stress < 3 MPa",
    "another key": {"require": "stress <= 3 MPa", "remark": "x"},
    "a default that is a result": {
        "require": "stress <= most",
        "limits": {"most": {"unit": "MPa", "default": "max(stress)"}},
    },
}


@pytest.mark.parametrize("bad", BAD.values(), ids=BAD)
def test_a_bad_criterion_is_refused_with_its_class(bad):
    with pytest.raises(TypeError, match=r"Worse: criterion 'strong': "):
        type("Worse", (Beam,), {"criteria": {"strong": bad}, "__doc__": "Worse."})


def test_criteria_are_a_dict():
    with pytest.raises(TypeError, match="Worse: criteria must be a dict"):
        type("Worse", (Beam,), {"criteria": ["stress <= 3 MPa"], "__doc__": "Worse."})


def test_a_judgement_is_plain_data():
    """It crosses to the process that answers, and becomes JSON."""
    import pickle

    from app.calculations.json_values import rendered

    result = evaluate(Beam, {"force": {"value": [1, 30], "unit": "kN"}})
    copies = pickle.loads(pickle.dumps(result.criteria))
    assert [c.name for c in copies] == [c.name for c in result.criteria]
    assert json.loads(json.dumps(rendered(copies), allow_nan=False))["verdict"]["green"] is False
