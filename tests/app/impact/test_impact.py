"""The impact of a version: joint results equal separate ones; changes are ranked."""

import numpy as np
import pytest
from impact_designs import at_points, batch_of, loaded, paper, weighed, with_variants
from row_designs import BEARING, CATALOGUES, CURVES

from app.designs.document import Document
from app.impact.comparison import change_size
from app.impact.forms import form_of
from app.impact.process import _columns, compared
from app.impact.severity import rank
from app.impact.single import outcome_alone
from app.impact.solids import Solids
from app.impact.task import upgraded
from app.impact.together import Together

LOADS = ("1 kN", "10 kN", "24 kN", "26 kN", "30 kN", "4e5 kN", "1e9 kN")


def bearing(**parameters):
    return {**BEARING, "parameters": {**BEARING["parameters"], **parameters}}


def chain(speed):
    return {**CURVES, "parameters": {**CURVES["parameters"], "speed": speed}}


def fed(pressure):
    """A bearing of version 2, which takes another level where oil is supplied under pressure."""
    document = bearing()
    film = document["steps"]["film"]
    inputs = {**film["inputs"], "supply_pressure": pressure}
    return {**document, "steps": {**document["steps"], "film": {**film, "inputs": inputs}}}


def loosely(clearance):
    """A bearing that chooses its level by a tolerance."""
    document = bearing(clearance=clearance)
    film = {**document["steps"]["film"], "tolerance": 0.02}
    return {**document, "steps": {**document["steps"], "film": film}}


def newer(document):
    return upgraded(Document.model_validate(document), "oil_film", 2).model_dump(mode="json")


def outcomes(documents):
    """Documents of one form together (None if they have to be calculated alone), and each alone."""
    read = [Document.model_validate(document) for document in documents]
    forms = [form_of(document, CATALOGUES) for document in read]
    assert len({form.text for form in forms}) == 1
    columns = _columns([form.quantities for form in forms])
    together = Together.of(read[0], CATALOGUES, columns.keys())
    alone = [outcome_alone(document, CATALOGUES, Solids(), {}) for document in read]
    return together and together.outcomes(columns, len(read)), alone


def assert_equal(together, alone):
    assert [fault.name for fault in together.faults] == [fault.name for fault in alone.faults][:1]
    assert [fault.code for fault in together.faults] == [fault.code for fault in alone.faults][:1]
    assert together.values.keys() == alone.values.keys()
    for name, value in alone.values.items():
        scale = np.max(np.abs(np.nan_to_num(value)), initial=0.0)
        np.testing.assert_allclose(together.values[name], value, rtol=1e-11, atol=1e-11 * scale, err_msg=name)
    assert together.parameters == pytest.approx(dict(alone.parameters), rel=1e-12)
    assert {n: j.verdict for n, j in together.judged.items()} == {
        n: j.verdict for n, j in alone.judged.items()
    }
    for name, judged in alone.judged.items():
        other = together.judged[name]
        assert (other.margin is None) == (judged.margin is None)
        if judged.margin is not None:
            assert other.unit == judged.unit
            assert other.margin == pytest.approx(judged.margin, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("documents", [
    [loaded(load) for load in LOADS],
    [newer(loaded(load)) for load in LOADS],
    [bearing(clearance=clearance) for clearance in ("0.05 mm", "60 um", "0 mm", "0.07 mm")],
    [chain(speed) for speed in ("2000 rpm", "3000 rpm")],
    [at_points()] * 2,
], ids=["version 1", "version 2", "two steps", "curves", "equal designs at points"])  # fmt: skip
def test_designs_of_one_form_come_to_what_each_does_alone(documents):
    together, alone = outcomes(documents)
    for pair in zip(together, alone, strict=True):
        assert_equal(*pair)


def test_rows_that_start_at_different_levels_are_calculated_apart():
    together, alone = outcomes([fed(pressure) for pressure in ("0 bar", "2 bar", "0 bar", "3 bar")])
    for pair in zip(together, alone, strict=True):
        assert_equal(*pair)
    name = "film.minimum_film_thickness"
    assert together[0].values[name] == pytest.approx(together[2].values[name], rel=1e-12)


@pytest.mark.parametrize("documents", [
    [loosely(clearance) for clearance in ("0.05 mm", "0.06 mm")],
    [at_points(speed) for speed in ("4000 rpm", "3000 rpm")],
    [weighed()] * 2,
], ids=["tolerance", "points", "measured"])  # fmt: skip
def test_what_cannot_share_a_call_is_calculated_alone(documents):
    assert outcomes(documents)[0] is None


def test_the_impact_of_a_batch_is_that_of_each_design():
    documents = [loaded(load) for load in LOADS] + [
        with_variants(), at_points(), weighed(), bearing(), paper(oil_inlet_temperature=None)
    ]  # fmt: skip
    whole = compared(batch_of(documents, 2))
    singly = [
        compared(batch_of([document], 2, ids=[f"d{place:02}"])) for place, document in enumerate(documents)
    ]
    each = {impact.design: impact for comparison in singly for impact in comparison.designs}
    assert {impact.design for impact in whole.designs} == each.keys()
    for impact in whole.designs:
        one = each[impact.design]
        assert (impact.effect, impact.steps, impact.gone) == (one.effect, one.steps, one.gone)
        assert (impact.verdicts, impact.outputs_moved) == (one.verdicts, one.outputs_moved)
        assert [refusal.name for refusal in impact.refusals] == [one.name for one in one.refusals][:1]
        if one.margin:
            assert impact.margin.relative == pytest.approx(one.margin.relative, rel=1e-6)
            assert impact.margin.name == one.margin.name
        if one.output:
            assert impact.output.change == pytest.approx(one.output.change, rel=1e-6)
    assert whole.unchanged == sum(comparison.unchanged for comparison in singly) == 1  # it has version 2
    assert whole.variants == 3


def test_the_refusal_of_a_design_names_what_to_give_and_to_remove():
    document = bearing()
    film = {**document["steps"]["film"], "limits": {"permissible_film": "2 um"}}
    comparison = compared(batch_of([{**document, "steps": {"film": film}}], 1))
    [impact] = comparison.designs
    assert impact.effect == "refused"
    assert impact.remove == ["film.supply_temperature", "film.limits.permissible_film"]
    without = {n: raw for n, raw in film["inputs"].items() if n != "supply_temperature"}
    cut = {**film, "inputs": without, "limits": {}, "outputs": None}
    [again] = compared(batch_of([{**document, "steps": {"film": cut}}], 1)).designs
    assert again.give == ["film.oil_inlet_temperature", "film.oil_outlet_temperature"]
    assert again.remove == []


def test_the_worst_design_comes_first():
    met = {**paper(), "criteria": {"thick": {"require": "film.journal_diameter <= 47.95 mm"}}}
    fine = paper(radial_load="5 kN")
    refused = paper(oil_inlet_temperature=None)
    document = loaded("25 kN")
    document["criteria"] = {"gap": {"require": "film.relative_clearance >= 0.001147"}}
    document["steps"]["film"]["inputs"]["radial_load"] = "5 kN"
    comparison = compared(batch_of([fine, refused, met, document], 2))
    ordered = sorted(comparison.designs, key=rank)
    assert ordered[0].design == "d03"  # c/d became c/D
    assert (ordered[0].verdicts[0].name, ordered[0].verdicts[0].old) == ("gap", "met")
    assert ordered[0].verdicts[0].new == "not_met"
    assert [impact.effect for impact in ordered].index("refused") > 0


@pytest.mark.parametrize(("old", "new", "size"), [
    (2.0, 2.0, 0.0),
    (2.0, 3.0, 0.5),
    (-2.0, 2.0, 2.0),
    (0.0, 1.0, np.inf),
    (0.0, 0.0, 0.0),
    (np.nan, np.nan, 0.0),
    (1.0, np.nan, np.inf),
    (np.array([1.0, -4.0]), np.array([2.0, -4.0]), 0.25),
    (np.array([1.0, 2.0]), np.array([1.0, 2.0, 3.0]), np.inf),
    (2.0, np.array([2.0, 2.0]), 0.0),
])  # fmt: skip
def test_the_size_of_a_change(old, new, size):
    assert change_size(old, new) == size
