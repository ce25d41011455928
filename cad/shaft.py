"""The data of a solid that an analysis needs besides its shape: material, supports and loads.

This module needs no kernel: finite elements bring their own kernel, and one process must not load both.
"""

from __future__ import annotations

from dataclasses import dataclass

STEEL_DENSITY = 7850.0  # kg/m³, carbon and low-alloy steel (EN 1991-1-1, table A.4: 77.0–78.5 kN/m³)


@dataclass(frozen=True)
class Material:
    """An isotropic, linearly elastic material."""

    young: float  # [Pa]
    poisson: float
    density: float  # [kg/m³]


STEEL_MATERIAL = Material(210e9, 0.3, STEEL_DENSITY)  # EN 1993-1-1, 3.2.6


@dataclass(frozen=True)
class Shaft:
    """Supports and load of one solid: its faces at two levels of z, about the z axis."""

    held: float  # [mm]
    loaded: float  # [mm]
    material: Material = STEEL_MATERIAL


@dataclass(frozen=True)
class PinPlace:
    """Place of the pin of a throw [mm], of split pins the front one: its axis at (throw, 0)."""

    throw: float
    radius: float
    length: float  # of the cylinder, between its fillets
    middle: float = 0.0  # its z; z = 0 is half way between the mains


@dataclass(frozen=True)
class ThrowSolid:
    """One throw of a shaft as a STEP file of its own, from mid-main to mid-main; z = 0 is half way."""

    step: bytes
    shaft: Shaft
    pin: PinPlace


@dataclass(frozen=True)
class PlacedThrow:
    """Which solid a throw of a shaft is, and how it stands there."""

    solid: int  # its number among the solids, from 0
    angle: float  # of its pin about z [rad]


@dataclass(frozen=True)
class ThrowsApart:
    """The throws of a shaft, one after the other; throws alike share a solid."""

    solids: tuple[ThrowSolid, ...]
    places: tuple[PlacedThrow, ...]


CAST_IRON_MATERIAL = Material(110e9, 0.26, 7200.0)  # EN-GJL-250: EN 1561:2011, annex: 103 to 118 GPa


@dataclass(frozen=True)
class BorePlace:
    """A split bore [mm] about z, its middle at z = 0, and by which face its solid is held.

    Held is the flat face at y = `held_at`, or, where `held_radius` is given, the cylinder along z about
    (0, `held_at`).
    """

    radius: float
    half_width: float
    held_at: float
    held_radius: float | None
    material: Material
