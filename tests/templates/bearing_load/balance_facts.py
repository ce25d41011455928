"""The exact balance of 28 layouts, tests/references/balance_facts.csv, and inputs of `engine` 1."""

import csv
from pathlib import Path

import numpy as np

_FILE = Path(__file__).parents[2] / "references/balance_facts.csv"
PITCH, RADIUS, ROD, PISTON, CRANK = 0.1, 0.05, 0.16, 0.8, 30.0  # m, m, m, kg, kg mm
SPEED = 3000 * np.pi / 30
UNITS = {
    "rotating": CRANK * 1e-3 * SPEED**2,
    "primary": PISTON * SPEED**2 * RADIUS,
    "secondary": PISTON * SPEED**2 * RADIUS**2 / ROD,
}


def numbers(text):
    return np.array([float(one) for one in text.split()])


def facts():
    lines = [line for line in _FILE.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def order_of(row):
    """The cylinders from 1 in the order in which they fire."""
    return [int(place) + 1 for place in np.argsort(numbers(row["firing_angles"]), kind="stable")]


def sizes(row):
    """What all rows share, without what says the layout."""
    return {
        "speed": "3000 rpm",
        "strokes": int(row["strokes"]),
        "crank_angle_step": "30 deg",
        "crank_radius": {"value": RADIUS, "unit": "m"},
        "rod_length": {"value": ROD, "unit": "m"},
        "bore": "80 mm",
        "rod_mass": "0 kg",
        "rod_centre": "50 mm",
        "piston_mass": {"value": PISTON, "unit": "kg"},
        "crank_unbalance": {"value": CRANK, "unit": "kg*mm"},
        "gas_cycle": "none",
        "bank_angles": {"value": numbers(row["bank_angles"]).tolist(), "unit": "deg"},
        "cylinder_positions": {"value": (PITCH * numbers(row["positions"])).tolist(), "unit": "m"},
        "reference_position": "0 m",
        "orders": [1, 2],
    }


def degrees(values):
    return {"value": np.asarray(values, dtype=float).tolist(), "unit": "deg"}
