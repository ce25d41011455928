"""measured_curves: a known curve sampled elsewhere, its shift, its offset; refusals."""

import numpy as np
import pytest

from templates.bearing_load.measured_curves_v1 import MeasuredCurves
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate

ANGLES = np.arange(0.0, 720, 10)
SAMPLED = np.arange(3.0, 720, 4)


def deg(values):
    return {"value": [float(value) for value in values], "unit": "deg"}


def um(values):
    return {"value": np.asarray(values, dtype=float).tolist(), "unit": "um"}


def film(angle):
    return 5 + 2 * np.cos(np.radians(angle)) + np.sin(np.radians(angle / 2))


def sawtooth(angle):
    """Linear between multiples of 45 deg, so that interpolation at those is exact."""
    corners = np.arange(0, 721, 45)
    return np.interp(np.asarray(angle) % 720, corners, [*np.resize([3, 7, 4, 9, 2, 6], 16).tolist(), 3])


def compared(calculated, measured, at=SAMPLED, **more):
    raw = {
        "crank_angle": deg(ANGLES), "measured_angle": deg(at), "calculated_film": um(calculated),
        "measured_film": um(measured), **more,
    }  # fmt: skip
    return {name: output.value for name, output in evaluate(MeasuredCurves, raw).outputs.items()}


def refused(**change):
    raw = {**MeasuredCurves.example, **change}
    with pytest.raises(InvalidInputs) as refusal:
        evaluate(MeasuredCurves, raw)
    return {name for fault in refusal.value.faults for name in fault.names}


def test_analytic_corners_of_a_measurement_are_read_exactly():
    at = np.arange(0, 720, 45)
    out = compared(sawtooth(ANGLES), sawtooth(at), at)
    assert out["film_difference"] == pytest.approx(np.zeros(72), abs=1e-12)
    assert out["largest_film_difference"] == pytest.approx(0, abs=1e-12)


def test_limit_a_fine_measurement_of_the_same_curve_differs_by_the_interpolation_alone():
    """At most h²/8 times the largest curvature, h = 4 deg: 2.25 um/rad²."""
    out = compared(film(ANGLES), film(SAMPLED))
    assert 0 < out["largest_film_difference"] <= np.radians(4) ** 2 / 8 * 2.25


def test_analytic_an_offset_is_the_mean_and_a_wave_the_rms():
    wave = 0.3 + 0.2 * np.sqrt(2) * np.sin(np.radians(ANGLES))
    out = compared(np.full(72, 4.0), 4 + wave, ANGLES)
    assert out["mean_film_difference"] == pytest.approx(0.3, rel=1e-12)
    assert out["rms_film_difference"] == pytest.approx(np.sqrt(0.3**2 + 0.2**2), rel=1e-12)
    assert out["largest_film_difference"] == pytest.approx(np.abs(wave).max(), rel=1e-12)


@pytest.mark.parametrize("shift", [0.0, 37.0, -200.0, 700.0])
def test_property_a_shift_moves_the_measurement(shift):
    """The encoder reads `shift` less than the crank angle."""
    at = np.arange(0, 720, 45)
    out = compared(sawtooth(ANGLES), sawtooth(at), at - shift, measured_shift=f"{shift} deg")
    assert out["film_difference"] == pytest.approx(np.zeros(72), abs=1e-9)


def test_property_a_repeated_last_point_counts_once():
    at = np.arange(0, 721, 45)
    out = compared(sawtooth(ANGLES), sawtooth(at), at)
    assert out["film_difference"] == pytest.approx(np.zeros(72), abs=1e-12)


def test_property_designs_as_an_array_are_each_alone():
    several = np.array([film(ANGLES), 1.1 * film(ANGLES)])
    together = compared(several, film(SAMPLED))["rms_film_difference"]
    for k, one in enumerate(several):
        assert together[k] == pytest.approx(compared(one, film(SAMPLED))["rms_film_difference"], rel=1e-12)


def test_property_what_is_not_measured_has_a_reason():
    outputs = evaluate(
        MeasuredCurves, {k: v for k, v in MeasuredCurves.example.items() if "strain" not in k}
    ).outputs
    assert outputs["strain_difference"].value is None
    assert "strain" in outputs["strain_difference"].reason
    assert outputs["rms_film_difference"].value > 0


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"measured_angle": deg([10, 100, 90, 280, 370, 460, 550, 640])}, "measured_angle"),
        ({"measured_angle": deg([10, 20, 30, 40, 50, 60, 70, 80])}, "measured_angle"),
        ({"measured_angle": deg([10, 200, 390, 500, 700, 800, 900, 1000])}, "measured_angle"),
        ({"crank_angle": deg([0, 90, 180, 270, 360, 450, 540, 540])}, "crank_angle"),
        ({"measured_film": um([1, 2, 3])}, "measured_film"),
        ({"measured_speed": um([1] * 8)}, "measured_speed"),
        ({"cycle": "0 deg"}, "cycle"),
    ],
)
def test_property_what_is_no_measurement_of_a_cycle_is_refused(change, name):
    assert name in refused(**change)
