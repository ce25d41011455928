"""Values that the wizard proposes for an engine: each a named relation with its source.

A proposal is an ordinary relation of a design, such as `= 0.65 * bore`; the user may change it before or
after the design is created. Ratios marked *customary* come from common practice: no standard gives them, and
they suit car engines with plain bearings best. They start a design and do not verify it.

References
----------
Service data of a Chrysler 2.4 L four-cylinder engine (main 60 mm, pin 50 mm for 87.5 mm bore: 0.69 and 0.57),
a Ford 3.8 L V6 (64 mm and 58.7 mm for 96.8 mm: 0.66 and 0.61) and a Subaru 2.5 L boxer engine (60 mm and 52
mm for 99.5 mm: 0.60 and 0.52).
Clevite's guide to engine bearings, in Mopar Muscle Magazine, June 2008: a clearance of 0.001 of the shaft's
diameter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from app.web.engine_bearings.layouts import Family, written_order

SHAFT, BEARINGS, SUPPLY, GAS = "Crankshaft", "Bearings", "Oil supply", "Gas"
CUSTOMARY = "customary"
SERVICE_DATA = "customary; service data of three engines: 0.60 to 0.69"
SERVICE_DATA_OF_PINS = "customary; service data of three engines: 0.52 to 0.61"
CLEARANCE = "Clevite's guide to engine bearings: 0.001 of the diameter"


@dataclass(frozen=True)
class Ratio:
    """A proposed value: a relation, or a quantity, and its source.

    Parameters
    ----------
    words
        What it is, as the page names it.
    unit
        The unit of the value.
    relation
        The value as a design's parameter states it.
    source
        Where the value comes from.
    group
        The heading under which the page shows it.
    """

    words: str
    unit: str
    relation: str
    source: str = CUSTOMARY
    group: str = SHAFT


_CRANKSHAFT = {
    "journal_diameter": Ratio("journal diameter", "mm", "= 0.65 * bore", SERVICE_DATA),
    "crankpin_diameter": Ratio("crankpin diameter", "mm", "= 0.57 * bore", SERVICE_DATA_OF_PINS),
    "web_width": Ratio("web width", "mm", "= 0.93 * bore"),
    "rod_centre": Ratio(
        "rod's centre of gravity, from the big end", "mm", "= 0.3 * rod_length", "customary: 0.25 to 0.35"
    ),
    "support_stiffness": Ratio("stiffness of the block at a main", "kN/mm", "= 5.8 kN/mm**2 * bore"),
}
_LENGTHS: Mapping[Family, Mapping[str, float]] = {
    "in_line": {"throw_pitch": 1.1, "crankpin_length": 0.37, "web_thickness": 0.2},
    "vee": {"throw_pitch": 1.35, "crankpin_length": 0.53, "web_thickness": 0.22},
    "boxer": {"throw_pitch": 0.66, "crankpin_length": 0.24, "web_thickness": 0.09},
}
"""Lengths along the shaft over the bore; in a boxer engine every rod has its own throw."""
_LENGTH_WORDS = {
    "throw_pitch": "distance from main to main",
    "crankpin_length": "crankpin length",
    "web_thickness": "web thickness",
}
_BEARINGS = {
    "main_width": Ratio(
        "width of a main bearing", "mm", "= 0.75 * (throw_pitch - crankpin_length - 2 * web_thickness)",
        CUSTOMARY, BEARINGS,
    ),
    "main_clearance": Ratio(
        "diametral clearance of the mains", "mm", "= 0.001 * journal_diameter", CLEARANCE, BEARINGS
    ),
    "big_end_clearance": Ratio(
        "diametral clearance of the big ends", "mm", "= 0.001 * crankpin_diameter", CLEARANCE, BEARINGS
    ),
    "groove_width": Ratio(
        "width of the oil groove over half the bearing", "mm", "= 0.035 * bore", CUSTOMARY, BEARINGS
    ),
}  # fmt: skip
_BIG_END_WIDTH = {1: "= 0.75 * crankpin_length", 2: "= 0.46 * crankpin_length"}
"""Width of a big-end bearing, by the number of rods on a throw."""
_VALVES = {"inlet_closes": "222 deg", "exhaust_opens": "492 deg", "crankcase_pressure": "1 bar"}
CYCLES: Mapping[str, Mapping[str, str]] = {
    "petrol": {
        "suction_pressure": "0.9 bar",
        "exhaust_pressure": "1.1 bar",
        "compression_ratio": "10",
        "compression_exponent": "1.32",
        "expansion_exponent": "1.28",
        "combustion_pressure": "60 bar",
        "cutoff": "1.15",
        **_VALVES,
    },
    "diesel": {
        "suction_pressure": "1.8 bar",
        "exhaust_pressure": "2 bar",
        "compression_ratio": "17",
        "compression_exponent": "1.35",
        "expansion_exponent": "1.28",
        "combustion_pressure": "150 bar",
        "cutoff": "1.5",
        **_VALVES,
    },
}
"""The values of an ideal four-stroke cycle: a petrol engine without and a diesel engine with a charger."""


def of_order(order: Sequence[int]) -> Ratio:
    """Return the usual firing order of a layout."""
    return Ratio("firing order", "1", written_order(order), "customary for this layout", SHAFT)


def of_crankshaft(family: Family) -> dict[str, Ratio]:
    """Return the proposed dimensions of a crankshaft and its rods."""
    lengths = {
        name: Ratio(_LENGTH_WORDS[name], "mm", f"= {ratio:g} * bore")
        for name, ratio in _LENGTHS[family].items()
    }
    return {**_CRANKSHAFT, **lengths}


def of_bearings(rods_per_throw: int) -> dict[str, Ratio]:
    """Return the proposed dimensions of the bearings."""
    width = Ratio("width of a big-end bearing", "mm", _BIG_END_WIDTH[rods_per_throw], CUSTOMARY, BEARINGS)
    return {**_BEARINGS, "big_end_width": width}


def of_supply(*, has_temperature: bool) -> dict[str, Ratio]:
    """Return the proposed oil supply; only the viscosity of a grade depends on the temperature."""
    warm = Ratio("supply temperature", "degC", "100 degC", "customary for a warm engine", SUPPLY)
    return {
        "supply_pressure": Ratio("supply pressure", "bar", "4 bar", "customary: 3 to 5 bar", SUPPLY),
        **({"supply_temperature": warm} if has_temperature else {}),
    }


def of_gas(kind: str) -> dict[str, Ratio]:
    """Return the proposed values of an ideal cycle; empty for an indicator diagram."""
    source = f"customary for a {kind} engine"
    return {
        name: Ratio(name.replace("_", " "), text.partition(" ")[2] or "1", text, source, GAS)
        for name, text in CYCLES.get(kind, {}).items()
    }


def of_crankcase(*, is_gauge: bool) -> dict[str, Ratio]:
    """Return the proposed crankcase pressure beside an indicator diagram."""
    text = "0 bar" if is_gauge else "1 bar"
    return {"crankcase_pressure": Ratio("crankcase pressure", "bar", text, "that of the atmosphere", GAS)}
