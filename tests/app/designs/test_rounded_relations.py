"""A rounded relation: the chosen value is used everywhere, and nothing differentiates through the steps."""

import json

import numpy as np
import pytest
from row_designs import CATALOGUES, assert_equal_to_designs, calculated, codes, engine_of, ref
from test_design_criteria import document, film, graph_of, verdicts

from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.verdicts import judged
from app.designs.explanation import explained
from app.designs.graph import build_graph
from app.designs.result_cells import rounded
from app.designs.service import resolved
from app.designs.solution import solved
from app.designs.tasks import DesignTask
from app.tolerances.analysis import Analysis
from app.tolerances.question import Question
from cad.regenerate import as_quantities, build_key

FRICTION = {
    "journal_diameter": "= diameter", "bearing_width": "= wide", "radial_clearance": "30 um",
    "speed": "3000 rpm", "dynamic_viscosity": "10 mPa*s",
}  # fmt: skip


def bearing(diameter="= 2 * radius", wide="= 0.47 * diameter rounded up to 0.5 mm", **more):
    return {
        "name": "rounded",
        "parameters": {"radius": "24.9 mm", "diameter": diameter, "wide": wide},
        "steps": {"idle": {"template": "journal_friction", "version": 1, "inputs": FRICTION}},
        **more,
    }


SHELL = {
    "id": "plain_bearing",
    "version": 1,
    "parameters": {"inner_diameter": "= diameter", "width": "= wide"},
}
PART = {"models": {"shell": SHELL}}


class TestTheChosenValue:
    def test_goes_into_solid_steps_and_other_relations(self):
        raw = bearing(**PART)
        raw["parameters"]["twice"] = "= 2 * wide"
        design = calculated(raw)
        assert not design.faults
        assert design.values["wide"].value == pytest.approx(23.5e-3, abs=0)  # calculated 23.406 mm
        assert design.values["twice"].value == 2 * design.values["wide"].value
        assert as_quantities(design.shapes["shell"])["width"] == {"value": 23.5, "unit": "mm"}
        typed = calculated(bearing(wide="23.5 mm", **PART))
        for output, value in typed.evaluations["idle"].outputs.items():
            assert design.evaluations["idle"].outputs[output].value == value.value
        assert build_key(design.shapes["shell"]) == build_key(typed.shapes["shell"])

    @pytest.mark.parametrize(
        ("limit", "verdict"), [("wide >= 23.45 mm", "met"), ("wide <= 23.45 mm", "not_met")]
    )
    def test_is_what_criteria_judge(self, limit, verdict):
        design = calculated(bearing(criteria={"wide": {"require": limit}}))
        (judgement,) = [one for one in judged(design) if one.name == "wide"]
        assert (judgement.verdict, judgement.error_known) == (verdict, True)

    def test_is_listed_with_the_calculated_one_and_the_rule(self):
        rows = {row["name"]: row for row in rounded(calculated(bearing(**PART)))}
        assert rows.keys() == {"wide", "idle.bearing_width", "shell.width"}  # two only name the first
        assert rows["wide"] == {
            "name": "wide",
            "rule": "rounded up to 0.5 mm",
            "calculated": {"value": 23.406, "unit": "mm"},
            "chosen": {"value": 23.5, "unit": "mm"},
        }
        assert rounded(calculated(bearing(wide="= 0.47 * diameter"))) == []

    def test_an_item_of_a_list_has_a_rule_of_its_own(self):
        raw = bearing()
        raw["parameters"]["sizes"] = [
            "= 0.9 mm rounded to 0.5 mm",
            "= wide / 7 rounded down to 0.2 mm",
            "= radius",
        ]
        design = calculated(raw)
        assert design.values["sizes"].value.tolist() == pytest.approx([1e-3, 3.2e-3, 24.9e-3], abs=1e-18)
        (row,) = [row for row in rounded(design) if row["name"] == "sizes"]
        assert row["calculated"]["value"] == pytest.approx([0.9, 23.5 / 7, 24.9], rel=1e-11)

    def test_is_of_every_row_its_own(self):
        raw, wanted = bearing(), [ref("wide"), ref("idle.power_loss")]
        engine = engine_of(raw, "radius")
        radii = np.linspace(20e-3, 30e-3, 9)
        table = engine({ref("radius"): radii}, wanted)
        assert_equal_to_designs(raw, engine, {ref("radius"): radii}, wanted, table)
        assert len({*table.columns[ref("wide")].tolist()}) == 9

    def test_a_value_that_is_no_number_there_is_refused_as_before(self):
        assert [fault.code for fault in calculated(bearing(wide="= 1 mm / 0 rounded to 1 mm")).faults][
            :1
        ] == ["not_finite"]


class TestRefusals:
    @pytest.mark.parametrize(
        ("change", "name", "said"),
        [
            (
                {"wide": "= 0.47 * diameter rounded to 0.5 N"},
                "wide",
                "wide is in mm, but it is rounded to 0.5 N",
            ),
            ({"wide": "= 0.47 * diameter rounded to 1"}, "wide", "give the step in mm, such as 0.5 mm"),
        ],
    )
    def test_a_step_of_another_dimension(self, change, name, said):
        _, faults = build_graph(Document.model_validate(bearing(**change)), CATALOGUES)
        (fault,) = faults
        assert (fault.name, fault.code) == (name, "unit_mismatch")
        assert said in fault.detail

    def test_of_an_input_in_its_declared_unit(self):
        raw = bearing()
        raw["steps"]["idle"]["inputs"] = {**FRICTION, "bearing_width": "= wide rounded to 2 MPa"}
        _, faults = build_graph(Document.model_validate(raw), CATALOGUES)
        assert [fault.detail for fault in faults] == [
            "idle.bearing_width is in mm, but it is rounded to 2 MPa; give the step in mm, such as 0.5 mm"
        ]

    def test_a_side_of_a_criterion(self):
        raw = bearing(criteria={"wide": {"require": "wide >= 2 mm rounded to 1 mm"}})
        _, faults = build_graph(Document.model_validate(raw), CATALOGUES)
        assert "a side of a criterion cannot be rounded" in faults[0].detail

    def test_a_place_whose_relation_is_rounded_cannot_vary(self):
        refused = codes(bearing(), "wide")
        assert "follows_from" in str(refused)


class TestErrors:
    def test_a_chosen_size_has_no_error_of_what_it_was_calculated_from(self):
        """The second bearing is as wide as the first film asks; its own error alone remains."""
        width = "= film.minimum_film_thickness * 6000 rounded up to 0.5 mm"
        raw = document(
            {"next": {"require": "next.minimum_film_thickness >= 1 um"}},
            steps={"film": film("fit"), "next": film("fit", bearing_width=width)},
        )
        judgement = verdicts(raw)["next"]
        graph, _ = graph_of(raw)
        chosen = calculate(graph, lambda _: None, lambda *_: None).values["next.bearing_width"].value
        raw["steps"]["next"] = film("fit", bearing_width=f"{chosen * 1e3:.12g} mm")
        typed = verdicts(raw)["next"]
        assert judgement.value == pytest.approx(typed.value, rel=1e-12)
        assert judgement.band == pytest.approx(typed.band, rel=1e-12)


class TestSlopes:
    def test_a_quantity_behind_a_rounding_has_a_reason_and_the_others_a_slope(self):
        raw = bearing(criteria={"loss": {"require": "idle.power_loss <= 60 W"}})
        answer = explained(Document.model_validate(raw), calculated(raw), CATALOGUES, "criteria.loss")
        found = {item.name: item for item in answer.sensitivities}
        assert found["radius"].slope is None
        assert found["radius"].reason == (
            "it acts through wide (rounded up to 0.5 mm), so the value changes in steps and has no slope"
        )
        assert found["idle.speed"].elasticity == pytest.approx(2)


def asked(raw, low, high, name, value):
    plain = resolved(Document.model_validate(raw), CATALOGUES).model_dump(mode="json", by_alias=True)
    body = {"unknown": "radius", "between": [low, high], "target": {name: value}}
    return solved(DesignTask.of(plain, CATALOGUES), 1, json.dumps(body))


class TestSolve:
    def test_finds_the_calculated_value_and_says_what_the_chosen_one_gives(self):
        solution = asked(bearing(), "20 mm", "30 mm", "idle.power_loss", "40 W")
        (root,) = solution.roots
        bare = asked(bearing(wide="= 0.47 * diameter"), "20 mm", "30 mm", "idle.power_loss", "40 W")
        assert root.value == bare.roots[0].value
        raw = bearing()
        raw["parameters"]["radius"] = f"{root.value!r} mm"
        there = calculated(raw).evaluations["idle"].outputs["power_loss"].value
        assert root.rounded.value == pytest.approx(there, rel=1e-12)
        assert there > 40.1  # the wider bearing loses more
        (warning,) = [one for one in solution.warnings if one.code == "rounded"]
        assert "calculated values of wide (rounded up to 0.5 mm)" in warning.detail

    def test_a_rounded_target_is_reached_before_its_rounding(self):
        (root,) = asked(bearing(), "20 mm", "30 mm", "wide", "23.4 mm").roots
        assert root.value == pytest.approx(23.4 / 0.47 / 2, rel=1e-9)
        assert root.rounded.value == pytest.approx(23.5)

    def test_without_rounding_on_the_way_nothing_is_said(self):
        solution = asked(bearing(), "20 mm", "30 mm", "diameter", "55 mm")
        assert "rounded" not in solution.roots[0].model_fields_set
        assert not solution.warnings


class TestTolerances:
    def test_all_products_have_the_chosen_size(self):
        """The loss of Petroff's bearing is proportional to d³ b; b is chosen once, so only d³ is left."""
        raw = bearing()
        raw["parameters"]["radius"] = "24.9 ± 0.6 mm"
        analysis = Analysis.of(
            Document.model_validate(raw), CATALOGUES, Question(("idle.power_loss",), (), 1024)
        )
        results = analysis.carried_out()
        nominal = results.nominal.columns[ref("idle.power_loss")][0]
        assert nominal == calculated(bearing()).evaluations["idle"].outputs["power_loss"].value
        low, high = (end.value / nominal for end in results.worst.ends[0])
        assert (low, high) == pytest.approx(((24.3 / 24.9) ** 3, (25.5 / 24.9) ** 3), rel=1e-9)
        (warning,) = [one for one in analysis.warnings if one.code == "held"]
        assert warning.name == "wide"
