"""The parts of a design that calculates every bearing of an engine: a film step, a shell, and a variant each.

The design's parameter `bearing` selects the bearing. The design itself calculates a main bearing; the
variants of big ends replace load, speed of the sleeve, sizes and groove.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pydantic import JsonValue

SHELL: dict[str, JsonValue] = {
    "id": "plain_bearing",
    "version": 1,
    "parameters": {"inner_diameter": "= film.bearing_diameter", "width": "= film.bearing_width"},
}
"""The model of a bearing's shell."""


LOAD_SENSE = "sleeve_on_journal"


@dataclass(frozen=True)
class Bearing:
    """Width and diametral clearance of a bearing, as quantities or relations."""

    width: str
    clearance: str


def film_step(main: Bearing, **inputs: JsonValue) -> dict[str, JsonValue]:
    """Return the step of the film in a main bearing; its groove is in the shell of the block.

    `inputs` are oil, permissible film, groove width and supply pressure.
    """
    return {
        "template": "oil_film_cycle",
        "version": 1,
        "level": "supplied",
        "inputs": {
            "crank_angle": "= engine.crank_angle",
            "load_x": "= engine.elastic_main_load_x[bearing]",
            "load_y": "= engine.elastic_main_load_y[bearing]",
            "load_sense": LOAD_SENSE,
            "speed": "= engine.speed",
            "sleeve_speed": "0 rpm",
            "bearing_diameter": "= engine.journal_diameter + film.diametral_clearance",
            "bearing_width": main.width,
            "diametral_clearance": main.clearance,
            "groove_start": "-90 deg",
            "groove_extent": "180 deg",
            **inputs,
        },
    }


def heat_step(grade: str, supply_temperature: str) -> dict[str, JsonValue]:
    """Return the step that gives each film the viscosity of an oil grade at its own temperature."""
    shared = (
        "crank_angle", "load_x", "load_y", "speed", "sleeve_speed", "bearing_diameter",
        "bearing_width", "diametral_clearance", "groove_width", "groove_start", "groove_extent",
        "supply_pressure",
    )  # fmt: skip
    return {
        "template": "cycle_heat_balance",
        "version": 1,
        "level": "mobility_grooved",
        "inputs": {
            **{name: f"= film.{name}" for name in shared},
            "load_sense": LOAD_SENSE,
            "oil_grade": grade,
            "supply_temperature": supply_temperature,
        },
    }


def bearings(mains: int, banks: Sequence[float], big_end: Bearing) -> dict[str, JsonValue]:
    """Return a variant for every main bearing and every big-end bearing.

    `banks` is the angle of each cylinder from the middle plane [deg]. The groove of a big end is in the shell
    of the cap, which lies opposite to the rod. The film measures it from the axis x of the engine at crank
    angle 0, and the rod is then inclined.
    """
    big_ends: dict[str, JsonValue] = {
        f"big_end_{n}": {
            "bearing": f"{n}",
            "film.load_x": "= engine.crankpin_load_x[bearing]",
            "film.load_y": "= engine.crankpin_load_y[bearing]",
            "film.sleeve_speed": "= engine.rod_angular_velocity[bearing]",
            "film.bearing_diameter": "= engine.crankpin_diameter + film.diametral_clearance",
            "film.bearing_width": big_end.width,
            "film.diametral_clearance": big_end.clearance,
            "film.groove_start": _groove_in_the_cap(bank),
        }
        for n, bank in enumerate(banks, 1)
    }
    return {**{f"main_{n}": {"bearing": f"{n}"} for n in range(1, mains + 1)}, **big_ends}


def _groove_in_the_cap(bank: float) -> str:
    """Return where the groove begins: 90° from the direction of the rod at crank angle 0."""
    pin = f"(engine.crankpin_angles[bearing] - {bank:g} deg)"
    return f"= {90 + bank:g} deg - asin(engine.stroke / 2 / engine.rod_length * sin{pin})"
