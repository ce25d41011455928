"""`journal_friction` 1 against the course MEC 315, and Petrov's error against full Reynolds solutions.

Worked case: d 50 mm, b 100 mm, 1500 rpm, 11.877 mPa s, c = r/100 → 2.9305 N, 0.073263 N m, 11.508 W; at the
course's own load of 3 kN So = 32 and eps = 0.965, where full-film friction is 5.3 times Petrov's.
"""

from math import pi

import numpy as np
import pytest
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.journal_friction_v1 import JournalFriction
from templates.physics.films.reynolds import extrapolated_film

CASE = {name: value for name, value in JournalFriction.example.items() if name != "radial_load"}


def outputs(raw):
    return {name: answer.value for name, answer in evaluate(JournalFriction, raw).outputs.items()}


class TestLiterature:
    def test_literature_worked_case(self):
        measured = outputs(CASE)
        assert measured["friction_force"] == pytest.approx(2.9305, abs=5e-5)
        assert measured["friction_torque"] == pytest.approx(0.073263, abs=5e-7)
        assert measured["power_loss"] == pytest.approx(11.508, abs=5e-4)

    def test_literature_form_of_the_course(self):
        """4 pi² r² eta N b/(60 c), N in rpm."""
        course = 4 * pi**2 * 0.025**2 * 11.877e-3 * 1500 * 0.1 / (60 * 0.00025)
        assert outputs(CASE)["friction_force"] == pytest.approx(course, rel=1e-14)

    def test_literature_load_of_the_course(self):
        answer = evaluate(JournalFriction, {**CASE, "radial_load": "3 kN"})
        measured = answer.outputs
        assert measured["sommerfeld_number"].value == pytest.approx(32, abs=0.5)
        assert measured["relative_eccentricity"].value == pytest.approx(0.965, abs=5e-4)
        assert measured["friction_ratio"].value == pytest.approx(5.3, abs=0.05)
        assert measured["friction_force"].value == pytest.approx(2.9305, abs=5e-5)
        (warning,) = answer.warnings
        assert (warning.name, warning.code) == ("friction_ratio", "outside_published_range")
        assert "5.34" in warning.detail
        true = 1 - 1 / measured["friction_ratio"].value
        assert true <= answer.error["friction_force"] < 1.15 * true


class TestAnalytic:
    @pytest.mark.parametrize(("load", "width"), [(30, 100), (300, 50), (3000, 25), (30, 12.5), (3000, 200)])
    def test_analytic_ratio_is_that_of_the_full_solution(self, load, width):
        measured = outputs({**CASE, "radial_load": f"{load} N", "bearing_width": f"{width} mm"})
        film = extrapolated_film(measured["relative_eccentricity"], width / 50)[0]
        assert measured["sommerfeld_number"] == pytest.approx(film.So, rel=1e-3)
        assert measured["friction_ratio"] == pytest.approx(film.friction / pi, rel=1e-3)

    def test_analytic_no_load_is_concentric(self):
        measured = outputs({**CASE, "radial_load": "0 N"})
        assert (measured["relative_eccentricity"], measured["friction_ratio"]) == (0, pytest.approx(1))

    def test_analytic_ratio_rises_with_the_load(self):
        loads = {"value": [0, *np.geomspace(1e-3, 1e6, 200).tolist()], "unit": "N"}
        measured = outputs({**CASE, "radial_load": loads})
        assert (np.diff(measured["relative_eccentricity"]) > 0).all()
        assert (np.diff(measured["friction_ratio"]) > -1e-9).all()
        assert np.unique(measured["friction_force"]).size == 1

    def test_analytic_proportions(self):
        """Twice the speed or viscosity or width, twice the force; half the clearance likewise."""
        force = outputs(CASE)["friction_force"]
        for change in (
            {"speed": "3000 rpm"},
            {"dynamic_viscosity": "23.754 mPa*s"},
            {"bearing_width": "0.2 m"},
            {"radial_clearance": "125 um"},
        ):
            assert outputs({**CASE, **change})["friction_force"] == pytest.approx(2 * force, rel=1e-14)


class TestLimits:
    def test_literature_error_is_unknown_without_a_load(self):
        answer = evaluate(JournalFriction, CASE)
        assert answer.warnings == []
        assert np.isnan(answer.error["friction_force"])
        for name in ("sommerfeld_number", "relative_eccentricity", "friction_ratio"):
            assert (answer.outputs[name].value, answer.outputs[name].reason) == (None, "needs radial_load")

    def test_literature_light_load_is_not_warned_of(self):
        assert evaluate(JournalFriction, {**CASE, "radial_load": "30 N"}).warnings == []

    def test_literature_warning_comes_with_the_force_alone(self):
        raw = {**CASE, "radial_load": "3 kN"}
        assert len(evaluate(JournalFriction, raw, outputs=["power_loss"]).warnings) == 1

    @pytest.mark.parametrize(
        ("raw", "words"),
        [
            ({"speed": "0 rpm", "radial_load": "3 N"}, "without speed"),
            ({"radial_load": "1e15 N"}, "no film bears"),
            ({"bearing_width": "6 m", "radial_load": "3 N"}, "no film bears"),
        ],
    )
    def test_property_what_the_film_cannot_tell_is_said(self, raw, words):
        answers = evaluate(JournalFriction, {**CASE, **raw}).outputs
        assert answers["friction_force"].value >= 0
        reasons = " ".join(answers[n].reason or "" for n in ("sommerfeld_number", "friction_ratio"))
        assert words in reasons

    @pytest.mark.parametrize(
        ("raw", "name", "code"),
        [
            ({"speed": "-1 rpm"}, "speed", "out_of_range"),
            ({"radial_clearance": "0 um"}, "radial_clearance", "out_of_range"),
            ({"radial_clearance": "25 mm"}, "radial_clearance", "inconsistent"),
            ({"dynamic_viscosity": "0 Pa*s"}, "dynamic_viscosity", "out_of_range"),
            ({"radial_load": "-3 N"}, "radial_load", "out_of_range"),
            ({"speed": "25 Hz"}, "speed", "ambiguous_unit"),
        ],
    )
    def test_literature_refuses_by_name(self, raw, name, code):
        with pytest.raises(InvalidInputs) as refusal:
            outputs({**CASE, **raw})
        assert (name, code) in {(one, fault.code) for fault in refusal.value.faults for one in fault.names}

    def test_property_whole_range_is_finite_or_refused(self):
        """physics.md, section 5: B/D 0.01 … 100, clearance ratio 1e-5 … 1e-1, So 1e-8 … 1e6 and beyond."""
        rng, n = np.random.default_rng(seeded(7)), 20_000
        d = 10 ** rng.uniform(-3, 0, n)
        raw = {
            "journal_diameter": (d, "m"),
            "bearing_width": (d * 10 ** rng.uniform(-2.1, 2.1, n), "m"),
            "radial_clearance": (d * 10 ** rng.uniform(-5, -1, n) / 2, "m"),
            "speed": (10 ** rng.uniform(-3, 6, n) * (rng.uniform(size=n) > 0.01), "rpm"),
            "dynamic_viscosity": (10 ** rng.uniform(-5, 2, n), "Pa*s"),
            "radial_load": (10 ** rng.uniform(-6, 9, n) * (rng.uniform(size=n) > 0.01), "N"),
        }
        typed = {name: {"value": value.tolist(), "unit": unit} for name, (value, unit) in raw.items()}
        answer = evaluate(JournalFriction, typed)
        for name, result in answer.outputs.items():
            missing = np.isnan(result.value)
            assert not np.isinf(result.value).any(), name
            assert result.reasons is not None or not missing.any(), name
            assert all(result.reasons[i] for i in np.flatnonzero(missing)), name
        for name in ("friction_force", "friction_torque", "power_loss"):
            assert np.isfinite(answer.outputs[name].value).all()
        ratio = answer.outputs["friction_ratio"].value
        present = np.isfinite(ratio)
        assert present.mean() > 0.8
        assert (ratio[present] > 1 - 1e-6).all()
        low = np.abs(1 / ratio - 1)
        assert (low[present] <= answer.error["friction_force"][present] + 1e-5).all()
