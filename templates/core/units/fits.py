"""Tolerance zones of ISO 286: the limit deviations of `48 mm H7`, by tolerance class and nominal size.

The table is `iso286.csv`; its header names its sources and describes its checks.
"""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files

from templates.core.errors import FaultyText, excerpt

_DIGITS = 9  # of a nominal size in mm: two conversions turn 50 mm into 50.00000000000001


@dataclass(frozen=True)
class Step:
    """The limit deviations [um] of nominal sizes above `above` and up to `up_to` [mm]."""

    above: float
    up_to: float
    upper: float
    lower: float


def deviations(zone: str, size: float) -> tuple[float, float]:
    """Return the lower and upper limit deviation [m] of a zone such as `H7` or `js6` at a nominal size [m].

    Raises
    ------
    FaultyText
        If the zone is not in the tables, or not for this size.

    References
    ----------
    ISO 286-1:2010, ISO 286-2:2010.
    """
    steps = zones().get(zone)
    if steps is None:
        raise FaultyText("unknown_zone", _unknown(zone))
    nominal = round(size * 1e3, _DIGITS)
    for step in steps:
        if step.above < nominal <= step.up_to:
            return step.lower * 1e-6, step.upper * 1e-6
    sizes = f"nominal sizes above {steps[0].above:g} mm and up to {steps[-1].up_to:g} mm"
    detail = f"{zone} is shipped for {sizes}, not {nominal:.9g} mm; give plus and minus instead"
    raise FaultyText("out_of_range", detail)


@lru_cache(maxsize=1)
def zones() -> Mapping[str, Sequence[Step]]:
    """Return the steps of every zone in the table, by increasing size."""
    text = files(__package__).joinpath("iso286.csv").read_text(encoding="utf-8")
    steps = defaultdict[str, list[Step]](list)
    for row in csv.DictReader(line for line in text.splitlines() if not line.startswith("#")):
        limits = (float(row[name]) for name in ("above", "up_to", "upper", "lower"))
        steps[row["class"]].append(Step(*limits))
    return dict(steps)


def _unknown(zone: str) -> str:
    """Return a sentence that lists the available grades of a zone's letter, or the available letters."""
    letters = zone.rstrip("0123456789")
    alike = [name for name in zones() if name.rstrip("0123456789") == letters]
    if alike:
        grades = sorted(int(name.removeprefix(letters)) for name in alike)
        return f"{excerpt(zone)} is not shipped; {letters} has the grades {grades[0]} to {grades[-1]}"
    shipped = " ".join(dict.fromkeys(name.rstrip("0123456789") for name in zones()))
    return f"{excerpt(zone)} is not an available zone, such as `H7` or `g6`; the letters are {shipped}"
