"""The rod's inertia follows from its pendulum period, in the calculation and in the report."""

import numpy as np
import pytest

from templates.bearing_load.flywheel_v1 import Flywheel
from templates.core.language.evaluate import evaluate
from templates.core.paper import report
from templates.physics.engine.crank_loads import GRAVITY


@pytest.fixture(scope="module")
def bar():
    """A uniform bar, hung at its end, swings with T = 2 π √(2 L/(3 g))."""
    period = 2 * np.pi * np.sqrt(2 * 0.3 / (3 * GRAVITY))
    rod = {"stroke": "200 mm", "rod_ratio": 3, "rod_mass": "2 kg", "rod_centre": "150 mm"}
    raw = {name: value for name, value in Flywheel.example.items() if name != "rod_inertia"}
    swung = {"rod_pendulum_period": {"value": float(period), "unit": "s"}}
    return evaluate(Flywheel, {**raw, **rod, **swung}, outputs=["rod_inertia"])


def test_analytic_a_uniform_bar_has_a_twelfth_of_its_mass_times_its_length_squared(bar):
    assert bar.outputs["rod_inertia"].value == pytest.approx(2 * 0.3**2 / 12)


def test_the_pendulum_stands_on_paper_as_a_formula(bar):
    line = next(row for row in report.rows(bar.template) if row.name == "rod_inertia")
    assert line.expression == r"m_{3}\,a_{g}\left(\frac{\tau^2 g}{4\pi^2}-a_{g}\right)"
