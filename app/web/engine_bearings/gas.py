"""Check an indicator diagram before it loads an engine: span, count, pressure level, and dead centre.

The reader of indicator diagrams averages the cycles; this module makes one four-stroke cycle of the result,
with combustion at 360°, and lists every assumption. A diagram that does not fit is refused with the remedy.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.calculations.curves import curves_of
from templates.core.arrays import Array
from templates.core.errors import FaultyText, InvalidInputs
from templates.core.units.units import compatible, unit

CYCLE, TURN = 720.0, 360.0  # deg
FEWEST = 8  # points of a cycle
ATMOSPHERE = 1.013  # bar
GAUGE_BELOW = 0.3  # bar; a lower pressure cannot be absolute in a running engine
HIGHEST_INTAKE = 6.0  # bar; absolute, the pressure of gas exchange with two-stage charging
EARLIEST_PEAK, LATEST_PEAK = -2.0, 45.0  # deg after dead centre
MOST_FAULTS = 5


@dataclass(frozen=True)
class Diagram:
    """A four-stroke cycle with combustion at 360°, and the assumptions made while reading it.

    Parameters
    ----------
    angles
        Crank angles [deg], ascending.
    pressures
        Pressures [bar], absolute or gauge.
    is_gauge
        Whether the pressures count from the atmosphere.
    assumed
        What was assumed.
    """

    angles: list[float]
    pressures: list[float]
    is_gauge: bool
    assumed: list[str]

    @property
    def text(self) -> str:
        """Return the diagram as a table that can be read again."""
        kind = "g" if self.is_gauge else "a"
        rows = (f"{at:.10g},{p:.10g}" for at, p in zip(self.angles, self.pressures, strict=True))
        return "\n".join([f"crank angle [deg],pressure [bar({kind})]", *rows])


def diagram_of(body: bytes) -> Diagram:
    """Return the cycle in a file or a pasted table.

    Raises
    ------
    FaultyText
        If it is not a full four-stroke cycle of one cylinder; the error states the reason and the remedy.
    """
    try:
        read = curves_of(body)
    except InvalidInputs as error:
        lines = [f"{fault.name}: {fault.detail}" for fault in error.faults]
        more = [f"and {len(lines) - MOST_FAULTS} more"] if len(lines) > MOST_FAULTS else []
        raise FaultyText("unreadable", "; ".join([*lines[:MOST_FAULTS], *more])) from None
    angles = _only(read.curves, "deg", "crank angles, such as `crank angle [deg]`")
    pressures = _only(read.curves, "bar", "pressures, such as `pressure [bar]`")
    _require_cycle(angles)
    angles, pressures = _without_repetition(angles, pressures)
    is_gauge, level = _level(pressures, read.assumed)
    angles, shift = _with_combustion_at_360(angles, pressures)
    return Diagram(angles.tolist(), pressures.tolist(), is_gauge, [*read.assumed, *level, *shift])


def _only(curves: Mapping[str, Mapping[str, object]], wanted: str, example: str) -> Array:
    """Return the one column of a kind, in the unit wanted."""
    of_kind = {
        name: curve
        for name, curve in curves.items()
        if str(curve["unit"]) != "1" and compatible(unit(str(curve["unit"])), unit(wanted))
    }
    if len(of_kind) != 1:
        there = f" ({', '.join(of_kind)})" if of_kind else ""
        detail = (
            f"the table has {len(of_kind)} columns of {example.partition(',')[0]}{there}; "
            f"it needs one column of {example}, for one cylinder"
        )
        raise FaultyText("wrong_count", detail)
    (curve,) = of_kind.values()
    scale = unit(str(curve["unit"]))
    return np.asarray(curve["value"], dtype=float) * scale.factor / unit(wanted).factor


def _require_cycle(angles: Array) -> None:
    """Refuse angles that are not one cycle of 720° in ascending order."""
    if len(angles) < FEWEST:
        raise FaultyText(
            "wrong_count", f"the table has {len(angles)} points; a cycle needs at least {FEWEST}"
        )
    steps = np.diff(angles)
    if np.any(steps <= 0):
        at = int(np.argmax(steps <= 0)) + 1
        detail = (
            f"after the crank angle {angles[at - 1]:g}° follows {angles[at]:g}°; the angles must increase"
        )
        raise FaultyText("unordered", detail)
    span = float(angles[-1] - angles[0])
    if not -1e-6 <= CYCLE - span <= 1.001 * float(steps.max()):
        detail = (
            f"the crank angle goes from {angles[0]:g}° to {angles[-1]:g}°, a span of {span:g}°; one cycle of "
            f"four strokes has {CYCLE:g}°. Send the whole cycle, with gas exchange"
        )
        raise FaultyText("wrong_span", detail)


def _without_repetition(angles: Array, pressures: Array) -> tuple[Array, Array]:
    """Return the table without a last point that repeats the first one a cycle later."""
    repeats = angles[-1] - angles[0] > CYCLE - 1e-6
    return (angles[:-1], pressures[:-1]) if repeats else (angles, pressures)


def _level(pressures: Array, assumed: list[str]) -> tuple[bool, list[str]]:
    """Return whether pressures are gauge pressures, and the assumption if the file does not say so.

    Raises
    ------
    FaultyText
        If no gas exchange has such a pressure: the signal of the sensor is not pegged.
    """
    lowest, said = float(pressures.min()), " ".join(assumed)
    is_stated = "gauge pressure" in said or "absolute pressure" in said
    is_gauge = "gauge pressure" in said if is_stated else lowest < GAUGE_BELOW
    absolute = lowest + (ATMOSPHERE if is_gauge else 0.0)
    kind = "gauge" if is_gauge else "absolute"
    if not 0 < absolute < HIGHEST_INTAKE:
        detail = (
            f"the lowest pressure is {lowest:.3g} bar, taken as {kind}: gas exchange has between 0 and "
            f"{HIGHEST_INTAKE:g} bar absolute, so the signal is not pegged. Shift all pressures so that at "
            "bottom dead centre after intake the pressure is that of the intake manifold"
        )
        raise FaultyText("unpegged", detail)
    note = f"{kind} pressures, because the lowest is {lowest:.3g} bar"
    return is_gauge, [] if is_stated else [note]


def _with_combustion_at_360(angles: Array, pressures: Array) -> tuple[Array, list[str]]:
    """Return the angles with combustion at 360°, and the shift if there is one.

    Raises
    ------
    FaultyText
        If the largest pressure lies where no combustion is: dead centre is shifted.
    """
    peak = float(angles[int(np.argmax(pressures))])
    after = (peak + TURN / 2) % TURN - TURN / 2
    if not EARLIEST_PEAK <= after <= LATEST_PEAK:
        side = f"{after:.3g}° after" if after > 0 else f"{-after:.3g}° before"
        detail = (
            f"the largest pressure is at {peak:g}°, {side} dead centre; combustion has it up to "
            f"{LATEST_PEAK:g}° after dead centre, so dead centre is shifted. Count the angles from it"
        )
        raise FaultyText("shifted", detail)
    shift = (TURN - (peak - after)) % CYCLE
    moved = angles + shift
    while moved[0] > TURN:
        moved = moved - CYCLE
    where = f"largest pressure {after:.3g}° after dead centre"
    return moved, [where, *([f"combustion moved from {peak - after:g}° to 360°"] if shift else [])]
