"""Relations with conditions, choices and lists, in single designs and in rows."""

import copy

import numpy as np
import pytest
from row_designs import BEARING, CATALOGUES, CURVES, FILM, assert_equal_to_designs, calculated, engine_of, ref
from row_designs import spread as nearby

from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.verdicts import Verdicts
from app.designs.explanation import explained
from app.designs.graph import build_graph

THIN = "= if film.minimum_film_thickness < 3 um then 22 mm else 20 mm"
SHELL = {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": "= diameter", "width": THIN}}


def bearing(parameters=None, film=None, **more):
    plain = copy.deepcopy(BEARING)
    plain["parameters"] |= parameters or {}
    plain["steps"]["film"]["inputs"] |= film or {}
    return {**plain, **more}


def faults_of(raw):
    _, faults = build_graph(Document.model_validate(raw), CATALOGUES)
    return {fault.name: (fault.code, fault.detail) for fault in faults}


class TestConditions:
    @pytest.mark.parametrize(("load", "width"), [("25 kN", 0.022), ("2 kN", 0.020)])
    def test_analytic_a_film_decides_a_width(self, load, width):
        one = calculated(bearing({"load": load}, models={"shell": SHELL}))
        film = one.value(ref("film.minimum_film_thickness"))
        assert (film < 3e-6) == (width == 0.022)
        assert one.value(ref("shell.width")) == width

    def test_analytic_rows_equal_designs(self):
        test = "1.4 um < film.minimum_film_thickness <= 2 um and width > 17.5 mm"
        parameters = {
            "chosen": f"= if {test} then width else 2 * width",
            "steps": "= floor(width / 1 mm) + count([width, diameter])",
            "largest": "= max([width, diameter / 3, 17 mm]) - min([width, 17 mm])",
            "picked": "= [width, diameter, 1 mm][place]",
            "place": "2",
        }
        raw = bearing(parameters)
        engine = engine_of(raw, "diameter", "width", "clearance")
        wanted = [FILM, *map(ref, ("chosen", "steps", "largest", "picked"))]
        rows = nearby(engine, 40)
        table = engine(rows, wanted)
        assert assert_equal_to_designs(raw, engine, rows, wanted, table) == 0
        assert len(set(np.round(table.columns[ref("chosen")] / rows[ref("width")]))) == 2

    def test_analytic_an_index_of_each_row_picks_from_a_list(self):
        raw = bearing({"picked": "= [width, 2 * width, 1 mm][place]", "place": "2"})
        engine = engine_of(raw, "width", "place")
        rows = {ref("width"): np.array([0.018] * 4), ref("place"): np.array([1.0, 2.0, 3.0, 4.0])}
        table = engine(rows, [ref("picked")])
        np.testing.assert_allclose(table.columns[ref("picked")], [0.018, 0.036, 0.001, np.nan])
        assert {row: refusal.code for row, refusal in table.refusals.items()} == {3: "not_finite"}

    def test_analytic_curves_are_summed_up_row_by_row(self):
        raw = copy.deepcopy(CURVES)
        raw["parameters"] |= {
            "mean": "= mean(loads.main_load_x)",
            "largest": "= max(abs(factor * loads.main_load_x)) + bore / 1 m * 1 N",
            "swing": "= sum(factor - mean(factor))",
        }
        engine = engine_of(raw, "bore", "factor")
        wanted = [ref("mean"), ref("largest"), ref("swing")]
        rows = nearby(engine, 24)
        assert assert_equal_to_designs(raw, engine, rows, wanted, engine(rows, wanted)) == 0

    def test_analytic_slopes_pass_through_the_branch_that_holds(self):
        """Width follows from the clearance in one branch: slope 400; the other is a constant."""
        relation = "= if film.minimum_film_thickness < {} then 400 * clearance else 20 mm"
        for limit, slope in (("3 um", 400.0), ("1 um", None)):
            width = relation.format(limit)
            shell = {**SHELL, "parameters": {"inner_diameter": "= diameter", "width": width}}
            raw = bearing(models={"shell": shell})
            document = Document.model_validate(raw)
            explanation = explained(document, calculated(raw), CATALOGUES, "shell.width")
            slopes = {one.name: one.slope for one in explanation.sensitivities}
            if slope is None:
                assert all(not one or one.value == 0 for one in slopes.values())
            else:
                assert slopes["clearance"].value == pytest.approx(slope)
            assert "cases" in explanation.latex
            assert {link.name for link in explanation.because} == {"clearance", "film.minimum_film_thickness"}

    @pytest.mark.parametrize(
        ("relation", "code", "words"),
        [
            ("= width < 20 mm", "no_truth", "if … then … else"),
            ("= if width then 1 mm else 2 mm", "no_truth", "a condition"),
            ("= if width < 3 then 1 mm else 2 mm", "unit_mismatch", "equal units"),
            ("= if width < 3 mm then 1 mm else 2", "unit_mismatch", "then and else"),
            ("= 1 mm + (width < 3 mm)", "no_truth", "takes quantities"),
            ("= if width < 3 mm then 1 N else 2 N", "unit_mismatch", "is in mm"),
            ("= if film.viscosity_law is vogl then 1 mm else 2 mm", "unknown_name", "vogel"),
            ("= if film.speed is vogel then 1 mm else 2 mm", "no_truth", "not a choice"),
            ("= if width is vogel then 1 mm else 2 mm", "no_truth", "not a choice"),
            ("= if flim.law is vogel then 1 mm else 2 mm", "unknown_name", "film"),
            ("= if film.viscosity_law == 1 then 1 mm else 2 mm", "unknown_name", "film.viscosity_law"),
            ("= 10 then", "syntax", "then"),
            ("= if width < 20 mm then 1 mm", "syntax", "ends too early"),
        ],
    )
    def test_property_no_condition_is_a_dimension(self, relation, code, words):
        shell = {**SHELL, "parameters": {"inner_diameter": "= diameter", "width": relation}}
        (fault,) = faults_of(bearing(models={"shell": shell})).items()
        assert fault[0] == "shell.width"
        assert fault[1][0] == code
        assert words in fault[1][1]

    def test_property_a_list_gives_no_single_input(self):
        shell = {**SHELL, "parameters": {"inner_diameter": "= diameter", "width": "= [1 mm, width]"}}
        one = faulty(bearing(models={"shell": shell}))
        assert "not_a_number" in {fault.code for fault in one.faults}

    def test_property_temperatures_stay_strict(self):
        raw = bearing({"warm": "= if width > 1 mm then 20 degC else 30 degC", "warmer": "= 2 * 20 degC"})
        assert faults_of(raw)["warmer"][0] == "unit_mismatch"
        raw["parameters"]["warmer"] = "= (if width > 1 mm then 20 degC else 30 degC) + 5 degC"
        assert faults_of(raw)["warmer"][0] == "unit_mismatch"
        raw["parameters"]["warmer"] = "= warm + 5 K"
        assert calculated(raw).value(ref("warmer")) == 298.15

    @pytest.mark.parametrize(
        ("require", "code"),
        [
            ("(if width < 3 mm then 1 mm else 2 mm) >= 1 mm", "no_truth"),
            ("width < 3 mm >= 1 mm", "no_truth"),
            ("1 mm <= width <= 3 mm", "syntax"),
            ("width == 3 mm", "syntax"),
            ("max([width, 3 mm]) >= 1 mm", "shape"),
            ("not width >= 1 mm", "no_truth"),
        ],
    )
    def test_property_a_criterion_compares_once(self, require, code):
        faults = faults_of(bearing(criteria={"own": {"require": require}}))
        assert {name: fault[0] for name, fault in faults.items()} == {"criteria.own": code}


def faulty(raw):
    """A document that is calculated with faults."""
    graph, faults = build_graph(Document.model_validate(raw), CATALOGUES)
    assert not faults
    return calculate(graph, lambda shape: None, lambda *question: None)


class TestErrors:
    @pytest.mark.parametrize(
        ("share", "verdict"), [(0.5, "not_met"), (0.9999, "undecided"), (1.0001, "undecided"), (1.5, "met")]
    )
    def test_analytic_a_decision_within_the_error_is_open(self, share, verdict):
        """The film has an error: where its band holds the threshold, both widths are possible."""
        film = calculated(bearing()).value(ref("film.minimum_film_thickness"))
        test = f"film.minimum_film_thickness < {share * film * 1e6:.9f} um"
        wanted = f"= if {test} then 18 mm else 22 mm"
        criteria = {"narrow": {"require": "wanted <= 20 mm"}}
        judging = Verdicts(calculated(bearing({"wanted": wanted}, criteria=criteria)))
        (judged,) = judging.some(["narrow"])
        assert judged.verdict == verdict


class TestChoices:
    GRADE = '= if film.viscosity_law is walther and not film.oil_grade is "sae_5w_30" then 18 mm else 19 mm'

    @pytest.mark.parametrize(
        ("film", "width"),
        [
            ({}, 0.018),
            ({"viscosity_law": "vogel"}, 0.019),
            ({"viscosity_law": {"value": "walther"}, "oil_grade": "sae_5w_30"}, 0.019),
        ],
    )
    def test_analytic_a_choice_of_a_step_decides_an_input_of_it(self, film, width):
        one = calculated(bearing({"width": "1 mm"}, {**film, "bearing_width": self.GRADE}))
        assert one.value(ref("film.bearing_width")) == pytest.approx(width)

    def test_analytic_rows_with_choices_and_lists_equal_designs(self):
        raw = bearing({"half": f"{self.GRADE} + clearance"})
        raw["parameters"]["both"] = "= [half, width][1]"
        engine = engine_of(raw, "clearance")
        wanted, rows = [ref("half"), ref("both")], nearby(engine, 5)
        assert assert_equal_to_designs(raw, engine, rows, wanted, engine(rows, wanted)) == 0

    def test_analytic_relations_in_lists_test_choices(self):
        pair = ["= if film.viscosity_law is vogel then 1 mm else 2 mm", "3 mm"]
        engine = engine_of(raw := bearing({"pair": pair}, {"viscosity_law": "vogel"}), "clearance")
        np.testing.assert_array_equal(calculated(raw).value(ref("pair")), [0.001, 0.003])
        np.testing.assert_array_equal(
            engine(nearby(engine, 2), [ref("pair")]).columns[ref("pair")][1], [0.001, 0.003]
        )

    def test_property_a_choice_that_is_tested_is_explained(self):
        shell = {**SHELL, "parameters": {"inner_diameter": "= diameter", "width": self.GRADE}}
        raw = bearing(film={"viscosity_law": "vogel"}, models={"shell": shell})
        explanation = explained(Document.model_validate(raw), calculated(raw), CATALOGUES, "shell.width")
        because = {link.name: link for link in explanation.because}
        assert because["film.viscosity_law"].typed == "vogel"
        assert because["film.oil_grade"].kind == "default"
