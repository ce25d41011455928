"""Parameters of a `crankshaft` with two throws, undivided pins and all optional features."""

from typing import Any

from cad.models.crankshaft_v1 import Crankshaft

TWO_THROWS: dict[str, Any] = {
    **Crankshaft.example,
    "pin_angles": {"value": [0, 180], "unit": "deg"},
    "pin_split": "0 deg",
    "pin_length": "32 mm",
    "counterweight_radius": {"value": [70, 0, 0, 70], "unit": "mm"},
    "thrust_main": 2,
}
