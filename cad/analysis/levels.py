"""Levels of fidelity: mesh size and order for a required accuracy, from a table in the same folder.

The error of a result is estimated on its own mesh, from the result at the next lower order. The change times
a factor covers the error that a higher order would remove; a constant covers the error that only a finer mesh
would remove: a coarse mesh around a drilling was 1.4 % too stiff at any order. Factor and constant were
compared with the true errors of random shafts in benchmarks/results/torsion_levels.json (`python -m
benchmarks.torsion_levels`).

Solids with sharp inner edges have separate factors. If displacements grow as r^λ from an edge, the energy at
order p has the error c p^(-4 λ) (Babuška and Suri 1987), so the error is 1/((p/(p - 1))^(4 λ) - 1) of the
change. λ is 0.5445 at an inner edge of 90° and 0.5 at a crack, the worst case, for which the error is 0.8 of
the change at third order and 1.29 at fourth. With sharp edges two orders may agree by chance, as for
crankshafts with a slender end, so the constant for sharp edges is larger
(tests/cad/analysis/test_torsion_levels.py).
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from cad.analysis.kinds import DEFAULT_LEVEL
from cad.analysis.mesh import Fineness


@dataclass(frozen=True)
class Level:
    """One level of fidelity: mesh size, order, and constants of the error estimate."""

    name: str
    fineness: Fineness
    order: int
    factor: float  # reported error over the change from the next lower order
    floor: float  # relative error that a higher order does not reduce; it is added
    sharp_factor: float  # factor and floor for solids with sharp inner edges
    sharp_floor: float
    typical: float  # typical reported error, relative
    unresolved: float  # relative error that small fillets add if elements are wider than they curve

    def error(self, low: float, high: float, *, is_sharp: bool = False, is_resolved: bool = True) -> float:
        """Return the estimated relative error of a value, from the value of the next lower order."""
        change = abs(low - high) / high
        added = 0.0 if is_resolved else self.unresolved
        if is_sharp:
            return self.sharp_factor * change + self.sharp_floor + added
        return self.factor * change + self.floor + added


_CONSTANTS = ("factor", "floor", "sharp_factor", "sharp_floor", "typical", "unresolved")


def _read() -> tuple[Level, ...]:
    rows = json.loads(Path(__file__).with_name("levels.json").read_text())
    return tuple(
        Level(
            row["name"],
            Fineness(row["size"], row["curvature"], row["turn"], row["sharp"], row["least"]),
            row["order"],
            *(row[name] for name in _CONSTANTS),
        )
        for row in rows
    )


LEVELS = _read()
NAMES = tuple(level.name for level in LEVELS)


def ladder(level: str | None, tolerance: float | None) -> tuple[Level, ...]:
    """Return the levels to try: the named one, or all from the cheapest that is likely to suffice."""
    if tolerance is None:
        return tuple(rung for rung in LEVELS if rung.name == (level or DEFAULT_LEVEL))
    return tuple(rung for rung in LEVELS if rung.typical <= tolerance) or LEVELS[-1:]
