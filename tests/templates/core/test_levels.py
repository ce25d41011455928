"""Levels of fidelity and other language features of `oil_film` 2, on small templates."""

import json

import numpy as np
import pytest

from templates import get
from templates.core.catalogue.golden import record
from templates.core.errors import InvalidInputs
from templates.core.language import levels
from templates.core.language.declare import limits
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import Accuracy
from templates.core.language.template import (
    Template,
    Truth,
    derived,
    formula,
    given,
    require,
    shared,
    table,
    text,
    units,
)
from templates.core.paper.schema import describe, inputs_schema

OFFSETS = {"rough": 0.1, "fine": 0.001}


@units(None, returns="1")
def counted(rows):
    return "many" if rows else ""


class Ladder(Template):
    """Two levels."""

    levels = ("rough", "fine")
    default_level = "fine"
    most_points = {"fine": 3}
    example = {"length": "2 m"}

    x = given("m", "length", ge=0)
    y = given("m", "height", optional=True)
    t = given("m", "depth", alternative=True)
    holes = table("m", "holes", "place", "width", ge=0)

    @require("length", warning="long", remedy="cut it")
    def short(self) -> Truth:
        """The length is below 100 m."""
        return self.x < 100

    @shared
    def offset(self):
        """The error of the level."""
        return OFFSETS[self.level]

    @derived("m", "breadth", shown=True)
    def b(self):
        return 2 * self.x

    @formula("m", "size", per_level={"rough": limits(1, 50, published=(2, None))}, remedy="take fine")
    def s(self):
        return self.x * (1 + self.offset)

    @formula("m", "lost depth", absent="no depth is given")
    def lost(self):
        return self.t - self.s * 0

    @formula("m**2", "side")
    def side(self):
        return self.x * self.y

    @text("word")
    def word(self):
        return counted(self.holes)


class Usual(Ladder):
    """The same, of which the rough level is the usual one."""

    default_level = "rough"


class Judged(Ladder):
    """The same with a criterion."""

    criteria = {"small": "size <= 40 m"}


class Quiet(Template):
    """An input with a default that is not an output."""

    example = {"length": "2 m"}

    x = given("m", "length")

    @derived("m", "breadth")
    def b(self):
        return 2 * self.x


@pytest.fixture
def measured(monkeypatch):
    grid = np.array([0.0, 10.0, 100.0])
    errors = {
        "rough": {"size": np.array([[0.1, 0.1], [0.3, np.nan]])},
        "fine": {"size": np.array([[0.001, 0.001], [0.002, 0.002]])},
    }
    accuracy = Accuracy(("x", "b"), (grid, 2 * grid), errors, {})
    monkeypatch.setitem(levels._cache, Ladder, accuracy)
    return accuracy


def evaluated(*names, level=None, tolerance=None, per_point=False, **raw):
    options = {"level": level, "tolerance": tolerance, "per_point": per_point}
    return evaluate(Ladder, {**Ladder.example, **raw}, outputs=names, **options)


def metres(*values):
    return {"value": list(values), "unit": "m"}


class TestLadder:
    def test_property_cheapest_that_will_do(self, measured):
        assert evaluated("size", tolerance=0.2).level == "rough"
        assert evaluated("size", tolerance=0.01).level == "fine"
        evaluation = evaluated("size", tolerance=0.2, length=metres(5, 20, 30), per_point=True)
        assert evaluation.level.tolist() == ["rough", "fine", "fine"]
        np.testing.assert_allclose(evaluation.error["size"], [0.1, 0.002, 0.002])

    def test_property_one_level_serves_all_points(self, measured):
        """A level that changes from point to point would make a step in the curve."""
        points = metres(5, 20, 30)
        assert evaluated("size", tolerance=0.2, length=points).level == "fine"
        assert evaluated("size", tolerance=0.2, length=metres(5, 6, 7)).level == "rough"
        values = evaluated("size", tolerance=0.2, length=points).outputs["size"].value
        assert values == pytest.approx(1.001 * np.array([5, 20, 30]))

    def test_property_a_level_that_refuses_does_not_do(self, measured):
        assert evaluated("size", tolerance=0.5, length="0.5 m").level == "fine"

    def test_property_outputs_without_a_level_are_exact(self, measured):
        assert evaluated("breadth", tolerance=0.0).level == "rough"
        assert evaluated("breadth").error["breadth"] == 0

    def test_property_dear_levels_take_few_points(self):
        with pytest.raises(InvalidInputs, match="level fine takes at most 3 points at once, not 4"):
            evaluated("size", length=metres(1, 2, 3, 4))

    def test_property_a_single_point_is_no_plural(self, monkeypatch, measured):
        monkeypatch.setitem(Ladder.most_points, "fine", 1)
        with pytest.raises(InvalidInputs, match="level fine takes at most 1 point at once, not 2"):
            evaluated("size", level="fine", length=metres(1, 2))

    @pytest.mark.parametrize("length", [metres(200, 5), metres(5, 200)])
    def test_property_a_point_beyond_both_ends_of_the_measured_grid_has_no_estimate(self, measured, length):
        """The breadth is twice the length, so both leave their grids together."""
        error = evaluated("size", level="rough", length=length).error["size"]
        assert np.isnan(error).tolist() == [value == 200 for value in length["value"]]

    def test_property_criteria_are_judged_over_the_points_of_all_levels(self, measured, monkeypatch):
        """Point 0 at the rough level, points 1 and 2 at the fine one, of which one is too large."""
        monkeypatch.setitem(levels._cache, Judged, measured)
        lengths = {"length": metres(5, 20, 60)}
        evaluation = evaluate(Judged, lengths, outputs=("size",), tolerance=0.2, per_point=True)
        assert evaluation.level.tolist() == ["rough", "fine", "fine"]
        (judgement,) = evaluation.criteria
        assert (judgement.verdict, [place.value for place in judgement.where]) == ("not_met", [3])
        assert judgement.value == pytest.approx(60.06)

    @pytest.mark.parametrize("cls", [Usual, Ladder])
    def test_property_without_measured_errors_the_usual_level_answers(self, cls):
        """Also where it is not the finest: nobody knows that a finer one would do."""
        evaluation = evaluate(cls, cls.example, outputs=("size",), tolerance=0.1)
        assert evaluation.level == cls.default_level

    @pytest.mark.parametrize(
        "rows",
        [[[1, 2, 3]], [[1], [2]], [[1, 2]] * 13, [[1, -2]]],
        ids=["three columns", "one column", "thirteen rows", "below its domain"],
    )
    def test_a_table_is_refused_with_its_columns_and_their_most_rows(self, rows):
        with pytest.raises(InvalidInputs, match="at most 12 rows of place, width, each ≥ 0 m") as refusal:
            evaluated("word", holes={"value": rows, "unit": "m"})
        assert [(fault.name, fault.code) for fault in refusal.value.faults] == [("holes", "not_a_table")]

    def test_a_table_takes_as_many_rows_as_it_says(self):
        assert evaluated("word", holes={"value": [[1, 2]] * 12, "unit": "m"}).outputs["word"].value == "many"

    def test_property_unmeasured_is_reported(self):
        assert [w.code for w in evaluated("size", tolerance=0.1).warnings] == ["tolerance_unmet"]


class TestLimits:
    def test_property_one_point_that_misses_the_tolerance_warns(self, measured):
        """Two points at the finest level, errors 0.001 and 0.002: the good one does not excuse the other."""
        at_both = metres(5, 50)
        assert evaluated("size", tolerance=0.0025, length=at_both).warnings == []
        for points in (at_both, metres(50, 5)):
            (warning,) = evaluated("size", tolerance=0.0015, length=points).warnings
            assert (warning.code, warning.name) == ("tolerance_unmet", "size")
            assert "0.002" in warning.detail

    def test_property_limits_of_a_level(self):
        assert evaluated("size", level="fine", length="0.5 m").outputs["size"].value
        with pytest.raises(InvalidInputs, match="it must be ≥ 1 m and ≤ 50 m; take fine"):
            evaluated("size", level="rough", length="0.5 m")
        assert [w.name for w in evaluated("size", level="rough", length="1.5 m").warnings] == ["size"]
        reasons = evaluated("size", level="rough", length=metres(0.5, 3)).outputs["size"].reasons
        assert reasons[1] is None
        assert "≥ 1 m" in reasons[0]

    def test_property_limits_of_a_level_are_on_the_page(self):
        texts = [limit["text"] for limit in describe(Ladder)["limits"]]
        assert any("at level rough" in text for text in texts)

    def test_property_remark_warns(self):
        assert [w.code for w in evaluated("breadth", length="200 m").warnings] == ["long"]
        assert evaluated("breadth").warnings == []


class TestOptional:
    def test_property_missing_input_is_named(self):
        assert evaluated("side").outputs["side"].reason == "needs height"
        assert evaluated("side", height="3 m").outputs["side"].value == 6

    def test_property_alternative_is_dealt_with_by_its_formulas(self):
        assert evaluated("lost_depth").outputs["lost_depth"].reason == "no depth is given"
        answer = evaluated("lost_depth", length=metres(1, 2)).outputs["lost_depth"]
        assert answer.reasons.tolist() == ["no depth is given"] * 2

    def test_property_shown_input_is_an_output_too(self):
        assert evaluated("breadth").outputs["breadth"].value == 4
        assert "breadth" not in evaluated("breadth").inputs
        given_one = evaluated("breadth", breadth="7 m")
        assert given_one.outputs["breadth"].value == 7
        assert given_one.inputs["breadth"].source == "given"

    def test_property_a_default_that_is_not_shown_is_an_input_alone(self):
        assert "breadth" not in Quiet.formulas
        assert evaluate(Quiet, Quiet.example).inputs["breadth"].source == "default"

    def test_property_tables(self):
        assert evaluated("word").outputs["word"].value is None
        assert evaluated("word", holes=metres(1, 2)).outputs["word"].value == "many"
        assert (
            evaluated("word", holes={"value": [[1, 2], [3, 4]], "unit": "m"}).outputs["word"].value == "many"
        )
        for wrong in (metres(1, 2, 3), metres(-1, 2)):
            with pytest.raises(InvalidInputs, match="holes are at most 12 rows of place, width"):
                evaluated("word", holes=wrong)
        assert "holes" in inputs_schema(Ladder)["properties"]

    def test_property_golden_record_is_json(self):
        cases = json.loads(json.dumps(record(Ladder), allow_nan=False))["cases"]
        assert cases[0]["outputs"]["side"] is None


class Frugal(Ladder):
    """It starts at its rough level."""

    default_level = "rough"
    most_points = {}


class TestBudget:
    """Where no level is known to meet the tolerance, the finest within the budget answers."""

    @staticmethod
    def state(monkeypatch, cost, fine=np.nan):
        """State errors of level rough, and of level fine a cost and perhaps an error."""
        errors = {"rough": {"size": np.full((2, 2), 0.1)}, "fine": {"size": np.full((2, 2), fine)}}
        content = {"levels": {"rough": {"cost": {"single": 1e-3}}, "fine": {"cost": cost}}}
        grid = np.array([0.0, 10.0, 100.0])
        monkeypatch.setitem(levels._cache, Frugal, Accuracy(("x", "b"), (grid, 2 * grid), errors, content))

    @staticmethod
    def answer(tolerance=0.01, per_point=False, **raw):
        raw = {**Frugal.example, **raw}
        return evaluate(Frugal, raw, outputs=["size"], tolerance=tolerance, per_point=per_point)

    @pytest.mark.parametrize("per_point", [False, True])
    def test_a_finer_level_of_unknown_error_answers_within_the_budget(self, monkeypatch, per_point):
        self.state(monkeypatch, {"single": 9.0})
        answer = self.answer(per_point=per_point)
        assert set(np.atleast_1d(answer.level)) == {"fine"}
        assert [notice.code for notice in answer.warnings] == ["tolerance_unmet"]

    @pytest.mark.parametrize("per_point", [False, True])
    def test_beyond_the_budget_the_starting_level_answers(self, monkeypatch, per_point):
        self.state(monkeypatch, {"single": 11.0})
        assert set(np.atleast_1d(self.answer(per_point=per_point).level)) == {"rough"}

    def test_many_points_may_be_beyond_the_budget(self, monkeypatch):
        self.state(monkeypatch, {"single": 4.0, "vectorised": 4.0})
        assert self.answer(length=metres(1, 2)).level == "fine"
        assert self.answer(length=metres(1, 2, 3)).level == "rough"

    def test_the_cheapest_that_is_known_to_do_still_answers(self, monkeypatch):
        self.state(monkeypatch, {"single": 0.1}, fine=0.001)
        assert self.answer(tolerance=0.2).level == "rough"
        assert self.answer(tolerance=0.01).level == "fine"


def test_the_fit_of_the_standard_is_never_chosen_by_a_tolerance():
    """At tolerances between the error of fit and that of map, and above both, over loads of six decades."""
    film = get("oil_film", 2).template
    loads = {"value": (10.0 ** np.arange(0, 6, 0.25)).tolist(), "unit": "N"}
    for tolerance in (1.0, 0.1, 0.03, 0.01, 1e-3):
        answer = evaluate(
            film, {**film.example, "radial_load": loads}, tolerance=tolerance, per_point=True,
            outputs=["minimum_film_thickness"],
        )  # fmt: skip
        assert "fit" not in set(np.atleast_1d(answer.level))
    named = evaluate(film, film.example, level="fit", outputs=["minimum_film_thickness"])
    assert named.level == "fit"


def test_the_time_to_expect_follows_case_and_cell():
    """Of a half groove by its band of load and width, summed over points; of no cell, and no level, none."""
    Cycle = get("oil_film_cycle", 1).template
    measured = levels.accuracy(Cycle)
    stated = measured.content["expected_seconds"]["supplied"]
    grids, table = stated["grids"], stated["cases"]["half_groove, fixed"]
    one = Cycle.from_quantities(Cycle.example)
    band = int(np.searchsorted(grids[0], one.S_max) - 1)
    row = int(np.searchsorted(grids[1], float(one.W / one.D)) - 1)
    assert measured.seconds(one, "supplied") == table[band][row]
    assert measured.seconds(one, "mobility") is None
    three = Cycle.from_quantities({**Cycle.example, "bearing_width": {"value": [18, 18, 18], "unit": "mm"}})
    assert measured.seconds(three, "supplied") == pytest.approx(3 * table[band][row])
    narrow = Cycle.from_quantities({**Cycle.example, "bearing_width": "6 mm"})
    assert measured.seconds(narrow, "supplied") is None
