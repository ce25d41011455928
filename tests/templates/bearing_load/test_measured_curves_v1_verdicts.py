"""measured_curves: verdicts on the difference, none without a limit."""

import numpy as np
import pytest

from templates.bearing_load.measured_curves_v1 import MeasuredCurves
from templates.core.language.evaluate import evaluate

QUANTITIES = {"film": "um", "speed": "rpm", "strain": "1"}
ANGLES = {"value": np.arange(0.0, 720, 10).tolist(), "unit": "deg"}
OFFSET, WAVE = 0.3, 0.2 * np.sqrt(2)  # of a difference: its mean, and the height of a wave about it


def verdicts(quantity, limits=None):
    """Of a curve that differs by an offset and a whole wave: rms² = offset² + height² / 2."""
    wave = OFFSET + WAVE * np.sin(np.radians(ANGLES["value"]))
    unit = QUANTITIES[quantity]
    base = 0.0 if quantity == "strain" else 4.0
    raw = {
        "crank_angle": ANGLES,
        "measured_angle": ANGLES,
        f"calculated_{quantity}": {"value": [base] * 72, "unit": unit},
        f"measured_{quantity}": {"value": (base + wave).tolist(), "unit": unit},
    }
    return {one.name: one for one in evaluate(MeasuredCurves, raw, limits=limits).criteria}


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_analytic_the_root_mean_square_decides(quantity):
    rms, name = np.hypot(OFFSET, WAVE / np.sqrt(2)), f"permissible_rms_{quantity}_difference"
    for share, verdict in ((1.001, "met"), (0.999, "not_met")):
        given = verdicts(quantity, {name: f"{share * rms:.9f} {QUANTITIES[quantity]}"})
        assert given[f"rms_{quantity}"].verdict == verdict
        assert given[f"largest_{quantity}"].verdict == "not_checked"


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_analytic_the_largest_difference_decides(quantity):
    """At 90 deg, one of the angles: the rms is smaller, and would pass."""
    largest, name = OFFSET + WAVE, f"permissible_largest_{quantity}_difference"
    for share, verdict in ((1.001, "met"), (0.999, "not_met")):
        given = verdicts(quantity, {name: f"{share * largest:.9f} {QUANTITIES[quantity]}"})
        assert given[f"largest_{quantity}"].verdict == verdict


def test_property_without_a_limit_nothing_is_judged():
    judged = evaluate(MeasuredCurves, MeasuredCurves.example).criteria
    assert {one.name for one in judged} == {f"{by}_{q}" for by in ("rms", "largest") for q in QUANTITIES}
    assert {one.verdict for one in judged} == {"not_checked"}


def test_property_a_limit_on_what_was_not_measured_is_never_met():
    raw = {name: value for name, value in MeasuredCurves.example.items() if "strain" not in name}
    limits = {f"permissible_{by}_strain_difference": "1" for by in ("rms", "largest")}
    judged = {one.name: one.verdict for one in evaluate(MeasuredCurves, raw, limits=limits).criteria}
    assert judged["rms_strain"] not in ("met", "not_met")
    assert judged["largest_strain"] not in ("met", "not_met")


def test_property_several_designs_are_judged_each():
    """One design of two differs too much: the rule does not hold for all."""
    raw = dict(MeasuredCurves.example)
    film = np.array(raw["calculated_film"]["value"])
    raw["calculated_film"] = {"value": [film.tolist(), (film + 5).tolist()], "unit": "um"}
    limits = {"permissible_rms_film_difference": "1 um"}
    judged = {one.name: one for one in evaluate(MeasuredCurves, raw, limits=limits).criteria}
    assert judged["rms_film"].verdict == "not_met"
