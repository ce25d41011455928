"""Variants of a design: the table, and results equal to those of separate designs."""

from copy import deepcopy

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from row_designs import BEARING, CATALOGUES, CURVES, engine_of, ref

from app.calculations.json_values import rendered
from app.designs.document import Document, merge
from app.designs.engine.calculate import calculate
from app.designs.engine.steps import memory
from app.designs.engine.verdicts import judged
from app.designs.graph import build_graph, starts
from app.designs.results import single_outputs
from app.designs.variants.checks import checked
from app.designs.variants.names import natural
from app.designs.variants.table import applied, faulty_cells, places
from app.designs.variants.together import Available, together
from app.designs.variants.verdict import merged

SAME = 1e-12
UNBUILT = Available(CATALOGUES, lambda shape: None, lambda shape, question, wanted: None)
CRITERIA = {
    "thick": {"require": "film.minimum_film_thickness >= 3 um"},
    "cool": {"require": "idle.power_loss <= 0.7 * film.power_loss"},
}


def document(raw, variants, **more):
    return Document.model_validate({**deepcopy(raw), "variants": variants, **more})


def alone(design):
    """A design of its own, calculated by itself."""
    graph, faults = build_graph(design, CATALOGUES)
    assert not faults
    return calculate(graph, UNBUILT.measured, UNBUILT.analysed, starts(design))


def assert_same(one, other, where=""):
    """Two values of JSON are equal, their numbers to 1e-12."""
    if isinstance(one, dict):
        assert one.keys() == other.keys(), where
        for name in one:
            assert_same(one[name], other[name], f"{where}.{name}")
    elif isinstance(one, list):
        assert len(one) == len(other), where
        for number, pair in enumerate(zip(one, other, strict=True)):
            assert_same(*pair, f"{where}[{number}]")
    elif isinstance(one, float) and one:
        assert other == pytest.approx(one, rel=SAME, abs=SAME * abs(one)), where
    else:
        assert one == other, where


def assert_as_alone(design):
    """Every variant is what a design of its own is: outputs, verdicts, model parameters."""
    outcomes = together(design, UNBUILT)
    assert [outcome.name for outcome in outcomes] == list(design.variants)
    for outcome in outcomes:
        assert not outcome.faults
        own = alone(applied(design, design.variants[outcome.name]))
        assert_same(single_outputs(own), outcome.outputs, outcome.name)
        close = rendered(judged(own))
        for criterion in (close, got := rendered(outcome.judgements)):
            for one in criterion.get("criteria", ()):
                margin = one.pop("margin", None)  # a difference of equals loses digits
                assert margin is None or np.isfinite(margin["value"])
        assert_same(close, got, outcome.name)


def spread(count, seed=1):
    """Clearances, widths, and every third a relation."""
    random = np.random.default_rng(seed)
    for number in range(count):
        values = {"clearance": f"{random.uniform(40, 80):.6g} um"}
        if number % 2:
            values["width"] = {"value": random.uniform(16, 22), "unit": "mm"}
        if number % 3 == 0:
            values["film.bearing_width"] = "= width - 2 mm"
        if number % 5 == 0:
            values["film.radial_load"] = "24 kN"
        yield f"v_{number}", values


class TestTable:
    @given(st.permutations(["main_1", "main_2", "main_10", "main_10a", "big_end", "Big_end2", "x"]))
    def test_property_the_order_is_natural_whatever_was_sent(self, names):
        design = document(BEARING, {name: {} for name in names})
        expected = ["big_end", "Big_end2", "main_1", "main_2", "main_10", "main_10a", "x"]
        assert list(design.variants) == expected
        assert sorted(names, key=natural) == expected

    def test_no_variants_are_not_mentioned(self):
        plain = Document.model_validate(BEARING).model_dump(mode="json")
        assert "variants" not in plain
        assert document(BEARING, {}).model_dump(mode="json") == plain

    def test_a_patch_goes_inside_and_null_drops(self):
        old = document(BEARING, {"a": {"clearance": "50 um", "width": "17 mm"}, "b": {}}).model_dump()
        patch = {"variants": {"a": {"width": None, "load": {"value": 2, "unit": "kN"}}, "b": None, "c": {}}}
        expected = {"a": {"clearance": "50 um", "load": {"value": 2, "unit": "kN"}}, "c": {}}
        assert merge(old, patch)["variants"] == expected
        assert "variants" not in Document.model_validate(merge(old, {"variants": None})).model_dump()

    def test_a_variant_changes_nothing_of_the_design(self):
        design = document(BEARING, {"a": {"clearance": "50 um", "film.speed": "4000 rpm"}})
        before = design.model_dump()
        own = applied(design, design.variants["a"])
        assert (own.parameters["clearance"], own.steps["film"].inputs["speed"]) == ("50 um", "4000 rpm")
        assert design.model_dump() == before
        assert own.variants == {}

    @pytest.mark.parametrize(
        ("place", "value", "code"),
        [
            ("clearence", "1 um", "unknown_name"),
            ("film.clearance", "1 um", "unknown_name"),
            ("film", "1 um", "unknown_name"),
            ("clearance", "1 kN", "wrong_unit"),
            ("clearance", "1", "missing_unit"),
            ("clearance", None, "not_a_quantity"),
        ],
    )
    def test_a_faulty_cell_is_named(self, place, value, code):
        design = document(BEARING, {"main_2": {place: value}})
        graph, _ = build_graph(design, CATALOGUES)
        ((cell, fault),) = faulty_cells(design, graph).items()
        assert (cell, fault.name, fault.code) == (("main_2", place), f"variants.main_2.{place}", code)

    @pytest.mark.parametrize(
        ("place", "value", "name", "code"),
        [
            ("diameter", "= diameter", "diameter", "loop"),
            ("diameter", [[]], "diameter", "empty"),
            ("film.radial_load", "= film.power_loss / 1 m * 1 s", "film.radial_load", "loop"),
            ("film.oil_grade", "none", "film.oil_grade", "not_an_option"),
            ("film.speed", {"value": float("nan"), "unit": "rpm"}, "film.speed", "not_finite"),
            ("width", "= 1 / 0 * 1 mm", "width", "not_finite"),
            ("width", "= x[0]", "width", "syntax"),
        ],
    )
    def test_what_a_design_refuses_a_variant_refuses(self, place, value, name, code):
        design = document(BEARING, {"m": {place: value}})
        _, faults = checked(design, alone(applied(design, {})), UNBUILT)
        assert (f"variants.m.{name}", code) in {(fault.name, fault.code) for fault in faults}

    def test_every_place_may_be_overridden(self):
        graph, _ = build_graph(Document.model_validate(BEARING), CATALOGUES)
        there = list(places(graph))
        assert {"clearance", "film.bearing_width", "idle.speed"} <= set(there)
        assert faulty_cells(document(BEARING, {"a": dict.fromkeys(there, "= clearance")}), graph) == {}


class TestCalculation:
    def test_variants_are_what_designs_of_their_own_are(self):
        assert_as_alone(document(BEARING, dict(spread(24)), criteria=CRITERIA))

    def test_curves_of_variants_share_a_call(self):
        variants = {
            f"v{n}": {"speed": f"{2000 + 100 * n} rpm", "clearance": f"{50 + n} um"} for n in range(20)
        }
        own = {"value": np.linspace(0.8, 1.2, 24).tolist(), "unit": "1"}
        variants["flat"] = {"factor": own}
        assert_as_alone(document(CURVES, variants))

    def test_choices_levels_and_optional_inputs_part_them(self):
        fast = {f"f{n}": {"film.speed": f"{4000 + n} rpm"} for n in range(5)}
        given_oil = {f"g{n}": {"film.dynamic_viscosity": f"{8 + n} mPa*s"} for n in range(5)}
        assert_as_alone(document(BEARING, {**fast, **given_oil}))

    def test_a_step_with_a_tolerance_has_one_level(self):
        raw = deepcopy(BEARING)
        raw["steps"]["film"]["tolerance"] = 1e-3
        outcomes = together(document(raw, dict(spread(6))), UNBUILT)
        assert len({outcome.calculation.evaluations["film"].level for outcome in outcomes}) == 1

    def test_a_relation_is_shown_in_the_unit_of_its_parameter(self):
        (outcome,) = together(document(BEARING, {"a": {"width": "= diameter / 3"}}), UNBUILT)
        assert outcome.values["width"] == {"value": pytest.approx(16, rel=SAME), "unit": "mm"}

    def test_a_refused_variant_speaks_for_itself(self):
        variants = {"a": {"clearance": "50 um"}, "b": {"clearance": "-1 um"}, "c": {"clearance": "60 um"}}
        a, b, c = together(document(BEARING, variants), UNBUILT)
        assert (a.faults, c.faults) == ((), ())
        assert {fault.name for fault in b.faults} >= {"variants.b.film.diametral_clearance"}
        assert a.outputs.keys() == c.outputs.keys() != {}

    def test_each_step_is_called_once_for_all(self, monkeypatch):
        calls = []
        asked = memory.evaluation

        def counted(block, raw, wanted):
            calls.append(block.name)
            return asked(block, raw, wanted)

        monkeypatch.setattr(memory, "evaluation", counted)
        together(document(BEARING, {f"v{n}": {"clearance": f"{41.5 + n} um"} for n in range(30)}), UNBUILT)
        assert sorted(calls) == ["film", "idle"]

    def test_rows_of_the_design_are_refused(self):
        variants = {"a": {"film.speed": {"value": [4000, 5000], "unit": "rpm"}}}
        (outcome,) = together(document(BEARING, variants), UNBUILT)
        assert {(fault.name, fault.code) for fault in outcome.faults} >= {("variants.a.film", "shape")}


class TestSize:
    def test_a_large_design_has_fewer_variants(self):
        parameters = {**BEARING["parameters"], **{f"p{n}": "1 mm" for n in range(400)}}
        design = document(BEARING, {f"v{n}": {} for n in range(150)}, parameters=parameters)
        ((fault,), outcomes) = reversed(checked(design, alone(applied(design, {})), UNBUILT))
        assert (fault.name, fault.code, outcomes) == ("variants", "too_many_values", [])
        assert "at most" in fault.detail

    def test_relations_of_all_variants_are_counted_together(self):
        long = {"value": list(range(50_000)), "unit": "mm"}
        terms = " + ".join(["long"] * 30)
        parameters = {**BEARING["parameters"], "long": long, "sum": f"= {terms}"}
        variants = {f"v{n}": {"clearance": f"{50 + n} um"} for n in range(12)}
        design = document({**BEARING, "steps": {}}, variants, parameters=parameters)
        outcomes = together(design, UNBUILT)
        assert {fault.code for outcome in outcomes for fault in outcome.faults} == {"too_many_values"}
        assert not together(document({**BEARING, "steps": {}}, {"a": {}}, parameters=parameters), UNBUILT)[
            0
        ].faults


LOADS = {"value": [20, 22, 24, 22, 20], "unit": "kN"}


class TestItems:
    def indexed(self, index, variants):
        raw = deepcopy(BEARING)
        raw["parameters"] |= {"loads": LOADS, "bearing": "1"}
        raw["parameters"]["load"] = f"= loads[{index}]"
        return document(raw, variants)

    def test_each_variant_takes_its_own_item(self):
        design = self.indexed("bearing", {f"main_{n}": {"bearing": f"{n}"} for n in range(1, 6)})
        outcomes = together(design, UNBUILT)
        loads = [outcome.calculation.values["film.radial_load"].value for outcome in outcomes]
        assert loads == pytest.approx([20e3, 22e3, 24e3, 22e3, 20e3], rel=SAME)
        assert_as_alone(design)

    @pytest.mark.parametrize("bearing", ["0", "6", "1.5", "-1"])
    def test_the_length_is_named_where_an_index_is_wrong(self, bearing):
        (outcome,) = together(self.indexed("bearing", {"m": {"bearing": bearing}}), UNBUILT)
        fault = next(fault for fault in outcome.faults if fault.code == "index")
        assert fault.name == "variants.m.load"
        assert "from 1 to 5" in fault.detail

    def test_an_index_in_mm_is_refused(self):
        _, faults = build_graph(self.indexed("width", {}), CATALOGUES)
        assert [(fault.name, fault.code) for fault in faults] == [("load", "index")]

    def test_rows_of_a_net_have_their_own_items(self):
        engine = engine_of(self.indexed("bearing", {}).model_dump(), "bearing")
        load = ref("film.radial_load")
        table = engine({ref("bearing"): np.array([1.0, 3.0, 7.0, 5.0])}, [load])
        np.testing.assert_allclose(table.columns[load], [20e3, 24e3, np.nan, 20e3], rtol=SAME)
        assert (table.refusals[2].place, table.refusals[2].code) == ("load", "index")
        assert "from 1 to 5" in table.refusals[2].detail
        assert table.refusals.keys() == {2}


class TestVerdict:
    def test_each_criterion_stands_at_its_worst_variant(self):
        variants = {"thin": {"load": "60 kN"}, "thick": {"load": "5 kN"}}
        design = document(BEARING, variants, criteria=CRITERIA)
        outcomes = together(design, UNBUILT)
        own = judged(alone(applied(design, {})))
        everywhere = {one.name: one for one in merged(own, {o.name: o.judgements for o in outcomes})}
        assert everywhere["thick"].where[0].value == "thin"
        assert (everywhere["thick"].verdict, everywhere["thick"].points) == ("not_met", 3)
        assert sum(everywhere["thick"].counts.values()) == 3
        assert {one.name for one in own} == everywhere.keys()

    def test_without_variants_nothing_changes(self):
        own = judged(alone(Document.model_validate({**BEARING, "criteria": CRITERIA})))
        assert merged(own, {}) == own
