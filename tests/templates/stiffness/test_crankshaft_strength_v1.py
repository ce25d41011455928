"""`crankshaft_strength` 1 agrees with the printed rule in its own units, and feeds the life template."""

from math import sqrt

import pytest

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.stiffness.crankshaft_strength_v1 import CrankshaftStrength
from templates.stiffness.fatigue_life_v1 import FatigueLife

EXAMPLE = CrankshaftStrength.example


def strengths(**given):
    answer = evaluate(CrankshaftStrength, {**EXAMPLE, **given}, units={}).outputs
    return {
        name.removeprefix("strength_of_"): one.value for name, one in answer.items() if "strength_of" in name
    }


def test_literature_rule_in_its_own_units():
    """375.3 N/mm² and 0.264 + 0.371872 - 0.003061 + 0.086621, by hand for the pin of the example."""
    assert 1.073 * 200**-0.2 == pytest.approx(0.371872, abs=1e-6)
    assert strengths()["crankpin_fillet"] == pytest.approx(375.3 * 0.719432, rel=2e-6)
    journal = 375.3 * (0.264 + 1.073 / 220**0.2 - 15 / 4900 + 0.245 * sqrt(1 / 9))
    assert strengths()["journal_fillet"] == pytest.approx(journal, rel=1e-12)


@pytest.mark.parametrize(("manufacture", "K"), [("continuous_grain_flow", 1.05), ("cast_rolled", 0.93)])
def test_literature_factor_of_manufacture_above_1_counts_at_fillets_alone(manufacture, K):
    plain, made = strengths(), strengths(manufacture=manufacture)
    assert made["crankpin_fillet"] == pytest.approx(K * plain["crankpin_fillet"])
    assert made["oil_bore"] == pytest.approx(min(K, 1) * plain["oil_bore"])


def test_property_larger_shafts_and_fillets_bear_less():
    sizes = {"value": [50, 100, 200, 400], "unit": "mm"}
    radii = {"value": [2, 4, 8, 16], "unit": "mm"}
    for given in ({"crankpin_diameter": sizes}, {"crankpin_fillet": radii}):
        values = strengths(**given)["crankpin_fillet"].tolist()
        assert values == sorted(values, reverse=True)


def test_without_journal_and_bore_they_are_those_of_the_pin_and_none():
    left_out = ("journal_diameter", "journal_fillet", "oil_bore")
    given = {name: value for name, value in EXAMPLE.items() if name not in left_out}
    answer = evaluate(CrankshaftStrength, given).outputs
    assert answer["strength_of_journal_fillet"].value == answer["strength_of_crankpin_fillet"].value
    assert answer["strength_of_oil_bore"].value is None
    assert "oil_bore" in answer["strength_of_oil_bore"].reason


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("crankpin_fillet", "1.9 mm"),
        ("ultimate_strength", "80 kg"),
        ("crankpin_diameter", "0 mm"),
        ("oil_bore", "nan mm"),
    ],
)
def test_what_is_wrong_is_refused_by_name(name, value):
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(CrankshaftStrength, {**EXAMPLE, name: value})
    assert [fault.name for fault in refusal.value.faults] == [name]


def test_life_takes_it_as_endurance_limit():
    """The safety factor is in proportion to the limit; with a mean stress of zero exactly so."""
    limit = float(strengths(crankpin_diameter="48 mm", crankpin_fillet="2.5 mm")["crankpin_fillet"])
    raw = {
        "force_1": {"value": [5, -5], "unit": "kN"},
        "stress_of_force_1": {"value": [[10, 0, 0, 0, 0, 0]], "unit": "MPa/kN"},
        "ultimate_strength": "800 MPa",
        "endurance_limit": {"value": limit, "unit": "MPa"},
        "multiaxial_criterion": "signed_von_mises",
    }
    assert evaluate(FatigueLife, raw).outputs["safety_factor"].value == pytest.approx(limit / 50, rel=1e-6)
