"""Loads, torque, balance and combustion of published engines."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from templates import get
from templates.validate.by_template import by_template
from templates.validate.case import Case, Numbers, by_row
from templates.validate.reference import FOLDER, Row


def generator_set(rows: Sequence[Row]) -> Numbers:
    """Return the results of `flywheel` 1 for a generator set of nine cylinders."""
    inputs = json.loads((FOLDER / "nine_cylinder_set.json").read_text(encoding="utf-8"))["inputs"]
    return by_template("flywheel", 1, "nine_cylinder_set.csv", **inputs)(rows)


def slider_crank(row: dict[str, float]) -> dict[str, float]:
    """Return the forces of a cylinder under a constant gas pressure, at one crank angle.

    The crank has no mass here and the rod, split into two points, a millionth of the piston's.
    """
    angles = {"value": [30.0 * n for n in range(12)], "unit": "deg"}
    mass = row["mass"]
    load = get("bearing_load", 1)(
        speed=f"{row['speed']} rpm", stroke=f"{row['stroke']} mm", rod_ratio=row["rod_ratio"],
        bore=f"{row['bore']} mm", crankpin_mass="0 kg", crank_mass="0 kg", crank_centre="0 mm",
        counterweight_mass="0 kg", counterweight_centre="0 mm", rod_mass=f"{1e-6 * mass} kg",
        rod_centre=f"{row['stroke'] / 4} mm", rod_inertia="0 kg*m**2", piston_mass=f"{mass} kg", strokes=2,
        gas_cycle="table", pressure_angle=angles, crankcase_pressure="0 bar", crank_angle_step="1 deg",
        pressure={"value": [row["pressure"]] * 12, "unit": "MPa"},
    )  # fmt: skip
    here = int(row["crank_angle"])
    along, across = (abs(getattr(load, f"wristpin_load_{axis}")[here].to("N").magnitude) for axis in "xy")
    return {"rod_force": float(np.hypot(along, across)), "wall_force": float(across),
            "torque": float(abs(load.torque[here].to("N*m").magnitude))}  # fmt: skip


def radial_of_three(row: dict[str, float]) -> dict[str, float]:
    """Return the balance weight at 3.5 in [lb] and the secondary force [lbf] of a radial engine."""
    engine = get("engine", 1)(
        speed="1500 rpm", strokes=2, crank_angle_step="30 deg", orders=[1, 2], gas_cycle="none",
        firing_order=[1, 2, 3], pin_angles={"value": [0, 0, 0], "unit": "deg"}, throws=[1, 1, 1],
        bank_angles={"value": [0, 120, 240], "unit": "deg"}, crank_radius="2.5 inch", rod_length="9 inch",
        cylinder_positions={"value": [0, 0, 0], "unit": "mm"}, bore="100 mm", piston_mass="4 lb",
        rod_mass="1e-6 kg", rod_centre="1 mm", crank_unbalance="0 kg*mm", harmonics="leading",
    )  # fmt: skip
    force = engine.order_force_forward.magnitude + engine.order_force_backward.magnitude
    speed = 1500 * np.pi / 30
    return {
        "balance": float(force[0] / (speed**2 * 3.5 * 0.0254) / 0.45359237),
        "secondary": float(force[1] / 4.4482216152605),
    }


def v16(rows: Sequence[Row]) -> Numbers:
    """Return couples and forces of the layouts of a V16 engine, largest along each axis.

    Vertical forces have a horizontal moment, which the tool calls H; the template gives a couple the
    direction of its forces.
    """
    found = [_balance_of_v16([float(angle) for angle in row["throws"].split()]) for row in rows]
    return {name: [one[name] for one in found] for name in found[0]}


def _balance_of_v16(throws: list[float]) -> dict[str, float]:
    engine = _v16(throws)
    couples, forces = _Axes(engine, "couple", "N*m"), _Axes(engine, "force", "N")
    return {
        "M_r": float(engine.rotating_couple.to("N*m").magnitude),
        "M_1H": couples.along(0, 0), "M_1V": couples.along(0, 90), "F_2H": forces.along(1, 90),
        "M_2H": couples.along(1, 0), "M_2V": couples.along(1, 90), "M_4H": couples.along(2, 0),
    }  # fmt: skip


def _v16(throws: list[float]) -> Any:
    """Return `engine` 1 of a V16 engine with these throws [°]; half of a throw belongs to each cylinder."""
    middles = [1120.0 - 320 * n for n in range(8)]
    pins, banks = [angle % 360 for angle in throws for _ in range(2)], [45.0, -45.0] * 8
    centres = [(bank - pin) % 360 for bank, pin in zip(banks, pins, strict=True)]
    return get("engine", 1)(
        speed="1500 rpm", strokes=2, crank_angle_step="30 deg", orders=[1, 2, 4], gas_cycle="none",
        firing_order=[n + 1 for n in sorted(range(16), key=centres.__getitem__)],
        pin_angles={"value": pins, "unit": "deg"}, bank_angles={"value": banks, "unit": "deg"},
        throws=[n // 2 + 1 for n in range(16)], crank_radius="60 mm", rod_length="411.5 mm", bore="200 mm",
        cylinder_positions={"value": [x + dx for x in middles for dx in (30, -30)], "unit": "mm"},
        rod_mass="21.19 kg", rod_centre=f"{411.5 * 9.86 / 21.19} mm", piston_mass="11.93 kg",
        crank_unbalance=f"{(8.66190878660935 * 60 + 2 * 14.45 * 17.3) / 2} kg*mm", web_unbalance="0 kg*mm",
        web_positions={"value": [x + dx for x in middles for dx in (-90, 90)], "unit": "mm"},
        counterweights=f"{17.15 * 136.4} kg*mm", harmonics="exact",
    )  # fmt: skip


class _Axes:
    """Forces or couples of the orders of an engine, which turn on ellipses."""

    def __init__(self, engine: Any, kind: str, unit: str) -> None:
        self.forward, self.backward = (
            getattr(engine, f"order_{kind}_{way}").to(unit).magnitude for way in ("forward", "backward")
        )
        self.direction = getattr(engine, f"order_{kind}_direction").to("rad").magnitude

    def along(self, order: int, axis: float) -> float:
        """Return the largest value along an axis [°] over the turn."""
        angle = np.radians(axis) - self.direction[order]
        longer = self.forward[order] + self.backward[order]
        shorter = self.forward[order] - self.backward[order]
        return float(np.hypot(longer * np.cos(angle), shorter * np.sin(angle)))


def otto_cycle(row: dict[str, float]) -> dict[str, float]:
    """Return the pressures [MPa] of a cycle whose heat comes at the top, in a tenth of a degree.

    The cylinder's size does not enter: the heat is that of the charge of any cylinder.
    """
    ratio, pressure = row["compression_ratio"], row["suction_pressure"]
    volume = np.pi / 4 * 0.1**3 * ratio / (ratio - 1)
    charge = pressure * volume / (row["gas_constant"] * row["temperature"])
    cycle = get("combustion_cycle", 1)(
        bore="100 mm", stroke="100 mm", rod_length="200 mm", compression_ratio=ratio, inlet_closes="180 deg",
        exhaust_opens="540 deg", suction_pressure=f"{pressure} kPa", exhaust_pressure=f"{pressure} kPa",
        heat_release=f"{row['heat'] * charge} kJ", combustion_start="-0.05 deg", wiebe_efficiency_constant=12,
        combustion_duration="0.1 deg", ratio_of_specific_heats=row["ratio_of_specific_heats"],
    )  # fmt: skip
    names = ("peak_pressure", "closed_mean_effective_pressure")
    return {name: float(getattr(cycle, name).to("MPa").magnitude) for name in names}


ENGINES = (
    *(
        Case(
            f"khurmi_{example.replace('.', '_')}",
            f"Khurmi, Gupta, example {example}: {words}",
            "khurmi_gupta_ch_15.csv",
            "bearing_load 1",
            "printed example",
            by_row(slider_crank),
            rows={"example": example},
        )
        for example, words in (
            ("15.7", "gas engine of 500 mm bore at 60°"),
            ("15.9", "petrol engine of 80 mm bore at 33°"),
            ("15.12", "double-acting steam engine of 250 mm bore at 45°"),
        )
    ),
    Case(
        "dyremi_nine_cylinders",
        "Rao, Singh 1993: balance of a generator set of nine cylinders",
        "nine_cylinder_set.csv",
        "flywheel 1",
        "printed example",
        generator_set,
    ),
    Case(
        "bevan_14_12",
        "Bevan, chapter 14, example 12: radial engine of three cylinders",
        "bevan_1956_ch_14_ex_12.csv",
        "engine 1",
        "printed example",
        by_row(radial_of_three),
    ),
    Case(
        "v16_balance",
        "Balancing tool of miriam-innio: six cranks of a V16 engine",
        "v16_balance_tool.csv",
        "engine 1",
        "other program",
        v16,
    ),
    Case(
        "nag_13_1",
        "Nag, example 13.1: Otto cycle at compression ratio 8",
        "nag_ex_13_1.csv",
        "combustion_cycle 1",
        "printed example",
        by_row(otto_cycle),
    ),
)
