"""Units of design parameters that a relation sets, as the interface writes them."""

from serving import API

from app.presentation.numbers import unit as printed
from templates.core.units.units import unit

TORQUE = {"name": "torque", "parameters": {"force": "2 N", "arm": "3 m", "torque": "= force * arm"}}


def test_a_preview_writes_a_unit_that_can_be_read_and_printed(http):
    design = http.post(f"{API}/designs", json=TORQUE).json()["id"]
    path = f"{API}/designs/{design}/preview"
    answer = http.post(path, params={"worksheet": True}, json={"parameters": {"force": "4 N"}}).json()
    value = answer["parameters"]["torque"]
    assert value == {"value": 12.0, "unit": "N*m"}
    assert printed(value["unit"]) == "N·m"
    assert unit(value["unit"]).factor == 1.0
