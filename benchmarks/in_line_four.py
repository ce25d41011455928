"""Inputs of `engine` for an in-line four of 86 mm stroke, which tests and benchmarks use."""

from typing import Any

from templates.groups import petrol_engine

IN_LINE_FOUR: dict[str, Any] = {
    **petrol_engine.IN_LINE_FOUR,
    **petrol_engine.OVERLAP,
    "crank_angle_step": "60 deg",
    "cylinder_offset": "1 mm",
    "orders": [1, 2, 4],
}
