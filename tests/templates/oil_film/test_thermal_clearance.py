"""Warm clearances against a manual calculation and its limits."""

import pytest

from templates import get
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate

CLEARANCE = get("thermal_clearance", 1)
EXAMPLE = CLEARANCE.template.example


def of(**inputs):
    return CLEARANCE(**{**EXAMPLE, **inputs})


def verdicts(**inputs):
    judged = evaluate(CLEARANCE.template, {**EXAMPLE, **inputs}).criteria
    return {judgement.name: judgement.verdict for judgement in judged}


def um(quantity):
    return quantity.to("um").magnitude


def test_analytic_an_aluminium_housing_on_a_steel_journal():
    """48 mm: 48e3 µm · 23e-6/K · 80 K = 88.32 µm and 48e3 µm · 11e-6/K · 90 K = 47.52 µm."""
    warm = of()
    assert um(warm.growth_of_the_bore) == pytest.approx(88.32, rel=1e-12)
    assert um(warm.growth_of_the_journal) == pytest.approx(47.52, rel=1e-12)
    assert um(warm.diametral_clearance) == pytest.approx(55 + 88.32 - 47.52, rel=1e-12)
    assert um(warm.radial_clearance) == pytest.approx(47.9, rel=1e-12)
    assert warm.relative_clearance.magnitude == pytest.approx(95.8e-6 / 48e-3, rel=1e-12)


def test_analytic_at_the_reference_temperature_it_is_the_cold_clearance():
    for temperature in ("20 degC", "68 degF", "293.15 K"):
        cold = of(housing_temperature=temperature, journal_temperature=temperature)
        assert um(cold.diametral_clearance) == pytest.approx(55, rel=1e-9)


def test_analytic_equal_parts_at_one_temperature_keep_their_clearance():
    same = of(housing_expansion_coefficient="1.1e-5 1/K", housing_temperature="110 degC")
    assert um(same.diametral_clearance) == pytest.approx(55, rel=1e-12)


def test_analytic_another_reference_temperature_shifts_both_parts():
    moved = of(reference_temperature="30 degC")
    assert um(moved.diametral_clearance) == pytest.approx(55 + 48e3 * (23e-6 * 70 - 11e-6 * 80), rel=1e-12)


def test_a_journal_that_seizes_is_not_met():
    hot = {"journal_temperature": "400 degC", "housing_temperature": "20 degC"}
    assert um(of(**hot).diametral_clearance) == pytest.approx(55 - 48e3 * 11e-6 * 380, rel=1e-12)
    assert verdicts(**hot) == {"runs": "not_met", "least_clearance": "not_checked"}
    assert verdicts()["runs"] == "met"


def test_a_coefficient_without_its_power_of_ten_is_refused():
    with pytest.raises(InvalidInputs) as refused:
        of(housing_expansion_coefficient="23 1/K")
    assert [fault.name for fault in refused.value.faults] == ["housing_expansion_coefficient"]
