"""From engine loads to the life of the crank: relations rotate the loads into the throw's axes."""

import numpy as np
import pytest
from serving import created, revision

from benchmarks.in_line_four import IN_LINE_FOUR
from templates.core.language.evaluate import evaluate
from templates.door import built_in

ANGLE = "(engine.crank_angle + engine.crankpin_angles[1])"
STRESSES = {
    "stress_of_force_1": {"value": [[0, 0, 3, 0, 0, 1], [0, 0, -2, 0, 0.5, 0]], "unit": "MPa/kN"},
    "stress_of_force_2": {"value": [[1, 0, 0, 0, 2, 0], [0, 1, 0, 0, 3, 0]], "unit": "MPa/kN"},
    "ultimate_strength": "900 MPa",
}
TURNED = {
    "force_1": f"= engine.crankpin_load_x[1] * cos({ANGLE}) + engine.crankpin_load_y[1] * sin({ANGLE})",
    "force_2": f"= engine.crankpin_load_y[1] * cos({ANGLE}) - engine.crankpin_load_x[1] * sin({ANGLE})",
}
USED = ("crankpin_load_x", "crankpin_load_y", "crank_angle", "crankpin_angles")


def test_loads_of_the_engine_become_life(http):
    engine = IN_LINE_FOUR
    steps = {
        "engine": {"template": "engine", "version": 1, "inputs": {**engine}, "outputs": [*USED]},
        "life": {"template": "fatigue_life", "version": 1, "inputs": {**STRESSES, **TURNED}},
    }
    done = revision(http, created(http, {"name": "crank", "steps": steps}))["steps"]
    x, y, angle, pins = (np.array(done["engine"]["outputs"][name]["value"]) for name in USED)
    turned = (x[0] + 1j * y[0]) * np.exp(-1j * np.radians(angle + pins[0]))
    forces = {
        "force_1": {"value": turned.real.tolist(), "unit": "N"},
        "force_2": {"value": turned.imag.tolist(), "unit": "N"},
    }
    alone = evaluate(built_in().get("fatigue_life", 1), {**STRESSES, **forces}).outputs
    outputs = done["life"]["outputs"]
    for name in ("greatest_von_mises", "safety_factor", "equivalent_amplitude"):
        assert outputs[name]["value"] == pytest.approx(alone[name].value, rel=1e-6), name
