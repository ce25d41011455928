"""Levels of fidelity: the mesh and the order for a required accuracy, from a table beside this file.

The error of an answer is estimated on its own mesh, from the same answer at the next lower order. The change
times a factor covers what a higher order would correct; a floor covers what only a finer mesh would correct.
A coarse mesh about a drilling was 1.4 % too stiff in any order. Both are compared with the true errors of
random shafts in benchmarks/results/torsion_levels.json (`python -m benchmarks.torsion_levels`).

Solids with sharp inner edges have factors of their own. Where displacements grow as r^λ from an edge,
energies of order p err by c p^(-4 λ) (Babuška and Suri 1987), so the error is 1/((p/(p - 1))^(4 λ) - 1) of
the change. λ is 0.5445 at an inner edge of 90° and 0.5 at a crack, the worst: there the error is 0.8 of the
change in third order and 1.29 in fourth. With sharp edges two orders may agree by chance, as on crankshafts
with a slender end, so the floor for sharp edges is higher (tests/cad/analysis/test_torsion_levels.py).
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from cad.analysis.kinds import DEFAULT_LEVEL
from cad.analysis.mesh import Fineness


@dataclass(frozen=True)
class Level:
    """A rung of the ladder."""

    name: str
    fineness: Fineness
    order: int
    factor: float  # of the change from the order below: the error that is reported
    floor: float  # what no order of elements corrects, relative: it is added to that
    sharp_factor: float  # both where there are sharp inner edges
    sharp_floor: float
    typical: float  # the error that is usually reported, relative

    def error(self, low: float, high: float, *, is_sharp: bool = False) -> float:
        """Return the estimated relative error of a value, from the value of the next lower order."""
        change = abs(low - high) / high
        if is_sharp:
            return self.sharp_factor * change + self.sharp_floor
        return self.factor * change + self.floor


def _read() -> tuple[Level, ...]:
    rows = json.loads(Path(__file__).with_name("levels.json").read_text())
    return tuple(
        Level(
            row["name"],
            Fineness(row["size"], row["curvature"], row["turn"], row["sharp"]),
            row["order"],
            *(row[name] for name in ("factor", "floor", "sharp_factor", "sharp_floor", "typical")),
        )
        for row in rows
    )


LEVELS = _read()
NAMES = tuple(level.name for level in LEVELS)


def ladder(level: str | None, tolerance: float | None) -> tuple[Level, ...]:
    """Return the levels to try in turn: the one named, or those from the cheapest that is likely to do."""
    if tolerance is None:
        return tuple(rung for rung in LEVELS if rung.name == (level or DEFAULT_LEVEL))
    return tuple(rung for rung in LEVELS if rung.typical <= tolerance) or LEVELS[-1:]
