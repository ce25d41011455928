"""The kinds of finite-element analyses: their outputs, boundaries and levels.

Only this module defines them. It does not import NGSolve, so the server and the relations of designs can use
it.
"""

from __future__ import annotations

from typing import Literal, get_args

Kind = Literal["torsion", "bending"]
Boundary = Literal["free_end", "guided_end"]
Level = Literal["coarse", "default", "fine"]

LOADS: tuple[Kind, ...] = get_args(Kind)
BOUNDARIES: tuple[Boundary, ...] = get_args(Boundary)
LEVELS: tuple[Level, ...] = get_args(Level)
DEFAULT_LEVEL: Level = "default"

UNIT_LOADS = "unit_loads"
"""The kind whose outputs are tables: stress tensors at the fillets of a throw under unit loads."""

CHAIN = "chain"
"""The kind that assembles a shaft from its throws: each throw by finite elements, the shaft by their
matrices."""

BORE_COMPLIANCE = "bore_compliance"
"""The kind whose output is a matrix: the compliance of a split bore to modes of an oil film's pressure."""

HARMONICS = 9
"""The highest circumferential harmonic of these modes."""


def mode_names() -> tuple[str, ...]:
    """Return the names of the modes: harmonics uniform along the bore, then times Legendre's polynomial.

    `m` is the mean, `c2` and `s2` are the cosine and sine of twice the angle from +y towards -x; `z` marks
    the second Legendre polynomial along the bore.
    """
    around = ("m", *(f"{part}{n}" for n in range(1, HARMONICS + 1) for part in "cs"))
    return (*around, *(f"{name}z" for name in around))


_TENSOR = ("xx", "yy", "zz", "xy", "yz", "xz")
_FORCE, _MOMENT = "MPa/kN", "MPa/(kN*m)"

KINDS: dict[str, dict[str, str]] = {
    "torsion": {"stiffness": "N*m/rad", "torsional_frequency": "Hz", "maximum_stress": "MPa"},
    "bending": {"stiffness": "N*m/rad", "maximum_stress": "MPa"},
    UNIT_LOADS: {
        **dict.fromkeys(("stress_of_force_1", "stress_of_force_2"), _FORCE),
        **dict.fromkeys(("stress_of_moment_1", "stress_of_moment_2", "stress_of_moment_3"), _MOMENT),
        "points": "mm",
    },
    BORE_COMPLIANCE: {"compliance": "um/GPa", "modulus": "GPa", "poisson_ratio": "1", "bore_width": "mm"},
    CHAIN: {"stiffness": "N*m/rad", "throw_stiffnesses": "N*m/rad", "torsional_frequency": "Hz"},
}
"""The outputs of each kind with their units; the stress is for a torque or moment of 1 N·m."""

TABLES: dict[str, tuple[str, ...]] = {
    **{output: ("x", "y", "z") if output == "points" else _TENSOR for output in KINDS[UNIT_LOADS]},
    "compliance": mode_names(),
}
"""The columns of the outputs that are tables; a table has a row for each point or mode."""

LISTS = frozenset({"throw_stiffnesses"})
"""The outputs that are lists; a list has a number for each throw."""

SURFACE = "surface"
"""An output of torsion and bending: the surface for a picture. No relation can use it, because it is not
a quantity."""

STRESSES = frozenset({"maximum_stress"})
"""Outputs proportional to the load; they are computed on their own meshes at every level."""
