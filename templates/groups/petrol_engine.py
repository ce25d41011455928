"""Values of a petrol engine of 86 mm bore and stroke, from which examples and designs of engines start."""

from __future__ import annotations

from typing import Any

PETROL_CYCLE: dict[str, Any] = {
    "gas_cycle": "four_stroke",
    "suction_pressure": "0.9 bar",
    "exhaust_pressure": "1.1 bar",
    "compression_ratio": 10,
    "compression_exponent": 1.32,
    "expansion_exponent": 1.28,
    "combustion_pressure": "60 bar",
    "cutoff": 1.15,
    "inlet_closes": "222 deg",
    "exhaust_opens": "492 deg",
    "crankcase_pressure": "1 bar",
}
"""Gas cycle of the engine, with the valves of the gas exchange at dead centre."""

OVERLAP: dict[str, Any] = {"inlet_opens": "705 deg", "exhaust_closes": "14 deg"}
"""The other two valve angles, with overlap."""

SHAFT: dict[str, Any] = {
    "web_unbalance": "12 kg*mm",
    "counterweights": "16 kg*mm",
    "support_stiffness": "500 kN/mm",
    "journal_diameter": "55 mm",
    "crankpin_diameter": "48 mm",
    "crankpin_length": "32 mm",
    "web_thickness": "18 mm",
    "web_width": "80 mm",
}
"""Crankshaft of the engine, for any number of throws."""

IN_LINE_FOUR: dict[str, Any] = {
    "speed": "4500 rpm",
    "strokes": 4,
    "firing_order": [1, 3, 4, 2],
    "cylinder_positions": {"value": [47, 141, 235, 329], "unit": "mm"},
    "stroke": "86 mm",
    "rod_length": "145 mm",
    "bore": "86 mm",
    "rod_mass": "0.6 kg",
    "rod_centre": "42 mm",
    "rod_inertia": "2200 kg*mm**2",
    "piston_mass": "0.48 kg",
    **PETROL_CYCLE,
    "main_positions": {"value": [0, 94, 188, 282, 376], "unit": "mm"},
    "web_positions": {"value": [22, 72, 116, 166, 210, 260, 304, 354], "unit": "mm"},
    **SHAFT,
}
"""Inputs of `engine` with four cylinders in line."""
