"""Fatigue of published parts."""

from __future__ import annotations

from typing import Any

from templates import get
from templates.validate.by_template import by_template
from templates.validate.case import Case, by_row

NOT_USED: dict[str, Any] = {"fatigue_strength_coefficient": "900 MPa", "fatigue_strength_exponent": -0.09}
"""Basquin's line, which the safety factor for endless life does not use."""


def reversed_bending(row: dict[str, float]) -> dict[str, float]:
    """Return the life under a reversed stress, by the line through the two strengths."""
    strengths: dict[str, Any] = {name: f"{row[name]} MPa" for name in STRENGTHS}
    life = get("fatigue_life", 1)(
        force_1={"value": [1.0, 0.0, -1.0, 0.0], "unit": "kN"},
        stress_of_force_1={"value": [[row["stress"], 0, 0, 0, 0, 0]], "unit": "MPa/kN"},
        surface="polished",
        reliability=0.5,
        **strengths,
    )
    return {"cycles": float(life.cycles.magnitude)}


STRENGTHS = ("ultimate_strength", "endurance_limit", "strength_at_1000_cycles")

FATIGUE = (
    Case(
        "bhandari_5_17",
        "Bhandari, example 5.17: safety factors after Gerber and Goodman",
        "bhandari_ex_5_17.csv",
        "stress_life 1",
        "printed example",
        by_template("stress_life", 1, "bhandari_ex_5_17.csv", **NOT_USED),
    ),
    Case(
        "bhandari_5_8",
        "Bhandari, example 5.8: life of a shaft of 30 mm in bending",
        "bhandari_ex_5_8.csv",
        "fatigue_life 1",
        "printed example",
        by_row(reversed_bending),
    ),
)
