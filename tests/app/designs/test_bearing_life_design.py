"""A ball bearing in a design passes its own load ratings to its life calculation."""

import pytest
from serving import API, created

from cad.catalogue import models

pytestmark = pytest.mark.slow  # rings, balls and cage are drawn

PARAMETERS = {"designation": "6210", "ball_diameter": "12.7 mm", "balls": 10}
DESIGN = {
    "name": "ball bearing at the end of a shaft",
    "parameters": {"load": "4 kN"},
    "models": {"ball": {"id": "deep_groove_bearing", "version": 1, "parameters": PARAMETERS}},
    "steps": {
        "life": {
            "template": "rolling_bearing_life",
            "version": 1,
            "inputs": {
                "radial_load": "= load",
                "speed": "3000 rpm",
                "dynamic_capacity": "= ball.dynamic_capacity",
                "static_capacity": "= ball.static_capacity",
                "calculation_factor": "= ball.calculation_factor",
            },
        }
    },
}


def test_capacities_of_the_drawn_bearing_are_those_of_its_life(http):
    design = created(http, DESIGN)
    step = http.get(f"{API}/designs/{design['id']}/revisions/1").json()["steps"]["life"]
    drawn = models().get("deep_groove_bearing", 1).from_quantities(PARAMETERS)
    millions = (float(drawn.C) / 4000) ** 3
    assert step["outputs"]["basic_rating_life"]["value"] == pytest.approx(1e6 * millions, rel=1e-9)
    assert step["outputs"]["static_safety"]["value"] == pytest.approx(float(drawn.C_0) / 4000, rel=1e-9)
