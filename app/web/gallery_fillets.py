"""Stress tensors at the fillets of the gallery's crank throws under unit loads, by finite elements.

Made by `python -m benchmarks.engine_fillets`, which says how; not edited by hand. A row for each point: xx,
yy, zz, xy, yz, xz; force 1 along the throw, force 2 across it, moment 1 the torque.
"""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import JsonValue


@dataclass(frozen=True)
class Tensors:
    """Tables of one throw."""

    force_1: list[JsonValue]  # MPa/kN
    force_2: list[JsonValue]  # MPa/kN
    moment_1: list[JsonValue]  # MPa/(kN m)


FOUR = Tensors(
    force_1=[[2.4, 0.5, 7.3, 0.3, 0.5, 2.4], [0.8, 0.3, -5.2, 0, 0.3, 1]],
    force_2=[[0.3, 0.8, 1, 0.5, 2.9, 0.5], [0.3, 0.5, 0.8, 0.3, 2.4, 0.3]],
    moment_1=[[5, 13, 29, 10, 220, 23], [8, 10, 21, 13, 240, 18]],
)

V_EIGHT = Tensors(
    force_1=[[2.4, 0.5, 7.3, 0.3, 0.5, 2.4], [0.8, 0.3, -5.2, 0, 0.3, 1]],
    force_2=[[0.3, 0.8, 1, 0.5, 2.9, 0.5], [0.3, 0.5, 0.8, 0.3, 2.4, 0.3]],
    moment_1=[[5, 13, 29, 10, 220, 23], [8, 10, 21, 13, 240, 18]],
)
