"""Torsional vibration of published shafts and engines."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import cos, pi, radians
from typing import Any

import numpy as np

from templates import get
from templates.validate.case import Case, Numbers
from templates.validate.reference import Column, Row, reference

TONE: dict[str, Any] = {
    "excited_inertias": [1],
    "firing_angles": {"value": [0], "unit": "deg"},
    "crank_angle": {"value": [45.0 * n for n in range(8)], "unit": "deg"},
    "gas_torque": {"value": [float(np.cos(n * pi / 4)) for n in range(8)], "unit": "N*m"},
    "highest_order": 1,
    "speeds": {"value": [60], "unit": "rpm"},
}
"""An excitation that `forced_torsion` asks for, and on which natural frequencies do not depend."""
Link = tuple[int, int, float]
MARINE_DAMPING = [3.86e6, 0, 0, 0, 0, 108.77, 0, 0, 0, 42.738]
POUND_INCH, WITHOUT = 0.11298, 1e-6
"""N m in lb in, and the inertia of a gear that the source gives none."""


def chain(file: str) -> Callable[[Sequence[Row]], Numbers]:
    """Return a function that returns the natural frequencies of a file's chains, in the file's unit."""

    def ours(rows: Sequence[Row]) -> Numbers:
        columns = reference(file).columns
        scale = {"Hz": 1.0, "rpm": 60.0}[columns["frequency"].unit]
        return {"frequency": [scale * _chain(row, columns)[int(row["mode"]) - 1] for row in rows]}

    return ours


def _chain(row: Row, columns: Mapping[str, Column]) -> list[float]:
    lists: dict[str, Any] = {
        name: {"value": [float(x) for x in row[name].split()], "unit": columns[name].unit}
        for name in ("inertias", "stiffnesses")
    }
    found = get("torsional_vibration", 1)(**lists, ends=row.get("ends", "free_free"))
    return _above_zero(found.natural_frequencies.to("Hz").magnitude)


def geared(inertias: list[float], shafts: list[Link], gears: list[Link], **excitation: Any) -> Any:
    """Return `forced_torsion` of a geared train: inertias [kg m²], shafts [N m/rad], gears by ratio."""
    return get("forced_torsion", 1)(
        inertias={"value": inertias, "unit": "kg*m**2"},
        shaft_from=[i for i, _, _ in shafts],
        shaft_to=[j for _, j, _ in shafts],
        shaft_stiffness={"value": [k for _, _, k in shafts], "unit": "N*m/rad"},
        gear_from=[i for i, _, _ in gears],
        gear_to=[j for _, j, _ in gears],
        gear_ratios=[ratio for _, _, ratio in gears],
        **excitation,
    )


def marine_turbine(rows: Sequence[Row]) -> Numbers:
    """Return the natural frequencies of the geared marine train [1/min].

    1 propeller, 2 bull gear; 3 to 6 low-pressure pinion, gear, pinion, turbine; 7 to 10 the same for high
    pressure.
    """
    train = geared(*_marine_train(), **TONE)
    return {"frequency": _above_zero(train.natural_frequencies.to("1/min").magnitude)[: len(rows)]}


def _marine_train() -> tuple[list[float], list[Link], list[Link]]:
    """Return inertias, shafts and gears of the marine train."""
    inertias = [2.454e6, 0.826e6, WITHOUT, 1.283e4, WITHOUT, 1.509e4, WITHOUT, 2.723e4, WITHOUT, 2.612e2]
    shafts = [(1, 2, 826e6), (3, 4, 203.94e6), (5, 6, 30.51e6), (7, 8, 24.17e6), (9, 10, 14.26e6)]
    second = 9.4094
    gears = [(2, 3, -second), (4, 5, -40.0424 / second), (2, 7, -second), (8, 9, -78.2365 / second)]
    links = [(i, j, POUND_INCH * k) for i, j, k in shafts]
    return [POUND_INCH * J for J in inertias], links, gears


def propeller_response(rows: Sequence[Row]) -> Numbers:
    """Return the vibratory torque of the propeller shaft of the geared marine train [lb in]."""
    turn = [9.0 * n for n in range(40)]
    order_5 = [0.1 * 22.24e6 * POUND_INCH * cos(5 * radians(angle)) for angle in turn]
    train = geared(
        *_marine_train(), loss_factors=[2 * 0.00398] * 5, excited_inertias=[1],
        firing_angles={"value": [0], "unit": "deg"}, crank_angle={"value": turn, "unit": "deg"},
        gas_torque={"value": [0.0] * 40, "unit": "N*m"}, highest_order=5,
        inertia_torque={"value": order_5, "unit": "N*m"}, inertia_speed="85 rpm",
        absolute_damping={"value": [POUND_INCH * c for c in MARINE_DAMPING], "unit": "N*m*s/rad"},
        speeds={"value": [float(row["speed"]) for row in rows], "unit": "rpm"},
    )  # fmt: skip
    torque = train.vibratory_torque.to("N*m").magnitude[0]
    return {"torque": [float(T / POUND_INCH) for T in torque]}


def two_driven_rotors(rows: Sequence[Row]) -> Numbers:
    """Return the natural frequencies of one rotor that drives two others by gears [Hz]."""
    first, second = (68e9 * pi * d**4 / 32 / length for d, length in ((0.2, 2.5), (0.25, 3.5)))
    train = geared(
        [3200, 200, 200, 800, 800, 450, 450],
        [(1, 2, first), (4, 6, second), (5, 7, second)],
        [(2, 3, -1.0), (2, 4, -0.5 / 0.8), (3, 5, -0.5 / 0.8)],
        **TONE,
    )
    return {"frequency": _above_zero(train.natural_frequencies.to("Hz").magnitude)[: len(rows)]}


def motor_and_pump(rows: Sequence[Row]) -> Numbers:
    """Return the natural frequency of a motor that drives a pump through gears without inertia [Hz]."""
    first, second = (84e9 * pi * d**4 / 32 / length for d, length in ((0.045, 0.18), (0.09, 0.45)))
    train = geared([400, WITHOUT, WITHOUT, 1400], [(1, 2, first), (3, 4, second)], [(2, 3, -1 / 3)], **TONE)
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
        chain("two_rotors_opentorsion.csv"),
    ),
    Case(
        "friswell_9_7_1",
        "Friswell et al. 2010, example 9.7.1: engine, flywheel and driven machine",
        "friswell_2010_ex_9_7_1.csv",
        "torsional_vibration 1",
        "printed example",
        chain("friswell_2010_ex_9_7_1.csv"),
        abscissa="mode",
        ordinate="frequency",
    ),
    Case(
        "friswell_geared",
        "Friswell et al. 2010: motor and two geared rotors",
        "friswell_2010_geared.csv",
        "torsional_vibration 1",
        "printed example",
        chain("friswell_2010_geared.csv"),
    ),
    Case(
        "bevan_15_9",
        "Bevan, chapter 15, example 9: three rotors on a shaft",
        "bevan_1956_ch_15_ex_9.csv",
        "torsional_vibration 1",
        "printed example",
        chain("bevan_1956_ch_15_ex_9.csv"),
    ),
    Case(
        "honda_cbr600rr",
        "Biedenkopf 2020: crankshaft of a Honda CBR600RR",
        "honda_cbr600rr_crank.csv",
        "torsional_vibration 1",
        "other program",
        chain("honda_cbr600rr_crank.csv"),
    ),
    Case(
        "punewale_frequency",
        "Punewale et al. 2015: frequency of a crankshaft",
        "punewale_2015_frequency.csv",
        "torsional_vibration 1",
        "printed example",
        chain("punewale_2015_frequency.csv"),
    ),
    Case(
        "sarkar_11_12",
        "Sarkar, illustration 11.12: motor and geared pump",
        "sarkar_ch_11_ex_12.csv",
        "forced_torsion 1",
        "printed example",
        motor_and_pump,
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
    Case(
        "gunter_chen_response",
        "Gunter, Chen 2001, example 8.1: vibratory torque of the propeller shaft",
        "gunter_chen_2001_response.csv",
        "forced_torsion 1",
        "other program",
        propeller_response,
        abscissa="speed",
        ordinate="torque",
    ),
)
