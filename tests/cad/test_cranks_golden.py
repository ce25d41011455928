"""Cranks measure the same as at their release; frozen records do not cover their shared geometry.

A change in `cad/cranks` that moves one of these makes other solids of the same parameters: it belongs in a
new version of the models, beside the old geometry. `python tests/cad/test_cranks_golden.py` writes it again.
"""

import json
from pathlib import Path
from typing import Any

import pytest

from cad.catalogue import models
from cad.regenerate import regenerate

RECORD = Path(__file__).with_name("crank_geometry.json")
MEASURES = (
    "volume",
    "centre_x",
    "centre_z",
    "inertia_xx",
    "polar_inertia",
    "low_x",
    "high_x",
    "high_y",
    "high_z",
)
THROW = {
    "journal_diameter": "55 mm", "journal_length": "40 mm", "pin_diameter": "48 mm", "pin_length": "32 mm",
    "throw": "42 mm", "web_thickness": "18 mm", "web_width": "80 mm", "fillet": "3 mm",
}  # fmt: skip
CASES = {
    "reference throw": ("crank_throw", THROW),
    "of one parameter": ("crank_throw", {"journal_diameter": "55 mm"}),
    "rectangular webs": ("crank_throw", {**THROW, "web_shape": "rectangular", "fillet": "0 mm"}),
    "inclined faces": ("crank_throw", {**THROW, "face_inclination": "10 deg"}),
    "bored": ("crank_throw", {**THROW, "journal_bore": "20 mm", "pin_bore": "15 mm"}),
    "drilled": ("crank_throw", {**THROW, "oil_drilling_diameter": "6 mm"}),
    "counterweights": ("crank_throw", {**THROW, "counterweight_radius": "80 mm"}),
    "counterweights on rectangular webs": (
        "crank_throw",
        {
            **THROW,
            "web_shape": "rectangular",
            "counterweight_radius": "80 mm",
            "counterweight_angle": "75 deg",
        },
    ),
    "throw with everything": ("crank_throw", None),
    "shaft of one throw": (
        "crankshaft",
        {
            "pin_angles": "[0] deg",
            "journal_diameter": "40 mm",
            "nose_length": "32 mm",
            "nose_diameter": "32 mm",
            "flange_thickness": "32 mm",
            "flange_diameter": "36 mm",
        },
    ),
    "shaft of one throw with everything": (
        "crankshaft",
        {
            "pin_angles": "[0] deg",
            "journal_diameter": "40 mm",
            "journal_length": "32 mm",
            "journal_bore": "12 mm",
            "pin_diameter": "36 mm",
            "pin_length": "26 mm",
            "pin_bore": "10 mm",
            "web_thickness": "16 mm",
            "web_width": "60 mm",
            "web_shape": "rectangular",
            "throw": "40 mm",
            "fillet": "2.5 mm",
            "oil_drilling_diameter": "5 mm",
            "counterweight_radius": "64 mm",
            "counterweight_angle": "130 deg",
            "face_inclination": "10 deg",
            "nose_length": "45 mm",
            "nose_diameter": "30 mm",
            "flange_thickness": "12 mm",
            "flange_diameter": "70 mm",
        },
    ),
    "split pins with everything": ("crankshaft", None),
}


def measured(case: str) -> dict[str, float]:
    name, given = CASES[case]
    cls = models().get(name, 1)
    measures = regenerate(name, 1, cls.from_quantities(given or cls.example).inputs_si()).measures
    return {name: measures[name] for name in MEASURES}


@pytest.mark.parametrize("case", CASES)
def test_golden_geometry_is_unchanged(case: str) -> None:
    record: dict[str, Any] = json.loads(RECORD.read_text())
    assert measured(case) == pytest.approx(record[case], rel=1e-9, abs=1e-9)


def test_record_has_every_case() -> None:
    assert set(json.loads(RECORD.read_text())) == set(CASES)


if __name__ == "__main__":
    RECORD.write_text(json.dumps({case: measured(case) for case in CASES}, indent=1) + "\n")
