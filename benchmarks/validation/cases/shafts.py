"""Torsional vibration of published shafts and engines."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np

from benchmarks.validation.case import Case, Numbers
from benchmarks.validation.reference import Row
from templates import get

TONE: dict[str, Any] = {
    "excited_inertias": [1],
    "firing_angles": {"value": [0], "unit": "deg"},
    "crank_angle": {"value": [45.0 * n for n in range(8)], "unit": "deg"},
    "gas_torque": {"value": [float(np.cos(n * pi / 4)) for n in range(8)], "unit": "N*m"},
    "highest_order": 1,
    "speeds": {"value": [60], "unit": "rpm"},
}
"""An excitation that `forced_torsion` asks for, and on which natural frequencies do not depend."""
POUND_INCH, WITHOUT = 0.11298, 1e-6
"""N m in lb in, and the inertia of a gear that the source gives none."""


def chain(rows: Sequence[Row]) -> Numbers:
    """Return the natural frequencies of chains of inertias above 0 Hz [Hz]."""
    return {"frequency": [_chain(row)[int(row["mode"]) - 1] for row in rows]}


def _chain(row: Row) -> list[float]:
    found = get("torsional_vibration", 1)(
        inertias={"value": [float(x) for x in row["inertias"].split()], "unit": "kg*m**2"},
        stiffnesses={"value": [float(x) for x in row["stiffnesses"].split()], "unit": "N*m/rad"},
        ends=row.get("ends", "free_free"),
    )
    return _above_zero(found.natural_frequencies.to("Hz").magnitude)


def geared(
    inertias: list[float], shafts: list[tuple[int, int, float]], gears: list[tuple[int, int, float]]
) -> Any:
    """Return `forced_torsion` of a geared train: inertias [kg m²], shafts [N m/rad], gears by ratio."""
    return get("forced_torsion", 1)(
        inertias={"value": inertias, "unit": "kg*m**2"},
        shaft_from=[i for i, _, _ in shafts],
        shaft_to=[j for _, j, _ in shafts],
        shaft_stiffness={"value": [k for _, _, k in shafts], "unit": "N*m/rad"},
        gear_from=[i for i, _, _ in gears],
        gear_to=[j for _, j, _ in gears],
        gear_ratios=[ratio for _, _, ratio in gears],
        **TONE,
    )


def marine_turbine(rows: Sequence[Row]) -> Numbers:
    """Return the natural frequencies of the geared marine train [1/min].

    1 propeller, 2 bull gear; 3 to 6 low-pressure pinion, gear, pinion, turbine; 7 to 10 the same for high
    pressure.
    """
    inertias = [2.454e6, 0.826e6, WITHOUT, 1.283e4, WITHOUT, 1.509e4, WITHOUT, 2.723e4, WITHOUT, 2.612e2]
    shafts = [(1, 2, 826e6), (3, 4, 203.94e6), (5, 6, 30.51e6), (7, 8, 24.17e6), (9, 10, 14.26e6)]
    second = 9.4094
    gears = [(2, 3, -second), (4, 5, -40.0424 / second), (2, 7, -second), (8, 9, -78.2365 / second)]
    train = geared([POUND_INCH * J for J in inertias], [(i, j, POUND_INCH * k) for i, j, k in shafts], gears)
    return {"frequency": _above_zero(train.natural_frequencies.to("1/min").magnitude)[: len(rows)]}


def two_driven_rotors(rows: Sequence[Row]) -> Numbers:
    """Return the natural frequencies of one rotor that drives two others by gears [Hz]."""
    first, second = (68e9 * pi * d**4 / 32 / length for d, length in ((0.2, 2.5), (0.25, 3.5)))
    train = geared(
        [3200, 200, 200, 800, 800, 450, 450],
        [(1, 2, first), (4, 6, second), (5, 7, second)],
        [(2, 3, -1.0), (2, 4, -0.5 / 0.8), (3, 5, -0.5 / 0.8)],
    )
    return {"frequency": _above_zero(train.natural_frequencies.to("Hz").magnitude)[: len(rows)]}


def _above_zero(frequencies: Any) -> list[float]:
    return sorted(float(f) for f in frequencies if f > 1e-6 * max(frequencies))


SHAFTS = (
    Case(
        "two_rotors",
        "openTorsion: shaft between two rotors",
        "two_rotors_opentorsion.csv",
        "torsional_vibration 1",
        "other program",
        chain,
    ),
    Case(
        "friswell_9_7_1",
        "Friswell et al. 2010, example 9.7.1: engine, flywheel and driven machine",
        "friswell_2010_ex_9_7_1.csv",
        "torsional_vibration 1",
        "printed example",
        chain,
        abscissa="mode",
        ordinate="frequency",
    ),
    Case(
        "friswell_geared",
        "Friswell et al. 2010: motor and two geared rotors",
        "friswell_2010_geared.csv",
        "torsional_vibration 1",
        "printed example",
        chain,
    ),
    Case(
        "friswell_9_6_3",
        "Friswell et al. 2010, example 9.6.3: one rotor drives two by gears",
        "friswell_2010_ex_9_6_3.csv",
        "forced_torsion 1",
        "printed example",
        two_driven_rotors,
        abscissa="mode",
        ordinate="frequency",
    ),
    Case(
        "gunter_chen_frequencies",
        "Gunter, Chen 2001, example 8.1: geared marine steam turbine",
        "gunter_chen_2001_frequencies.csv",
        "forced_torsion 1",
        "printed example",
        marine_turbine,
        abscissa="mode",
        ordinate="frequency",
    ),
)
