"""What finite elements compute: the kinds of analyses, their outputs, boundaries and levels.

The one place that names them. It imports no NGSolve, so the server and the relations of designs can read it.
"""

from __future__ import annotations

from typing import Literal, get_args

Kind = Literal["torsion", "bending"]
Boundary = Literal["free_end", "guided_end"]
Level = Literal["coarse", "default", "fine"]

BOUNDARIES: tuple[Boundary, ...] = get_args(Boundary)
LEVELS: tuple[Level, ...] = get_args(Level)
DEFAULT_LEVEL: Level = "default"

KINDS: dict[str, dict[str, str]] = {
    "torsion": {"stiffness": "N*m/rad", "torsional_frequency": "Hz", "maximum_stress": "MPa"},
    "bending": {"stiffness": "N*m/rad", "maximum_stress": "MPa"},
}
"""The outputs of each kind with their units; stress is that under a torque or moment of 1 N·m."""

SURFACE = "surface"
"""An output of every kind, the surface for a picture. It is not a quantity, so no relation can use it."""

STRESSES = frozenset({"maximum_stress"})
"""Outputs proportional to the load, computed on meshes of their own, whatever the level."""
