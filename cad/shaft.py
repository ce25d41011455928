"""The data of a solid that an analysis needs besides its shape: material, supports and loads.

This module does not import the geometry kernel: the finite-element code loads its own kernel, and one process
must not load both.
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
    """Supports and load of one solid: its end faces at two levels of z; the axis is z."""

    held: float  # [mm]
    loaded: float  # [mm]
    material: Material = STEEL_MATERIAL


@dataclass(frozen=True)
class PinPlace:
    """Position of the pin of a throw [mm]: its axis is at (throw, 0). For split pins it is the front pin."""

    throw: float
    radius: float
    length: float  # of the cylinder, between its fillets
    middle: float = 0.0  # coordinate z of its middle; z = 0 is halfway between the main journals


@dataclass(frozen=True)
class ThrowSolid:
    """One throw of a shaft as its own STEP file, from mid-main to mid-main; z = 0 is half way."""

    step: bytes
    shaft: Shaft
    pin: PinPlace


@dataclass(frozen=True)
class PlacedThrow:
    """A throw of a shaft: the number of its solid, and its position."""

    solid: int  # number of its solid, from 0
    angle: float  # angle of its pin about z [rad]


@dataclass(frozen=True)
class ThrowsApart:
    """The throws of a shaft in order; equal throws share a solid."""

    solids: tuple[ThrowSolid, ...]
    places: tuple[PlacedThrow, ...]


CAST_IRON_MATERIAL = Material(110e9, 0.26, 7200.0)  # EN-GJL-250: EN 1561:2011, annex: 103 to 118 GPa


@dataclass(frozen=True)
class BorePlace:
    """A split bore [mm] about z with its middle at z = 0, and the face that holds its solid.

    The held face is the plane y = `held_at` or, if `held_radius` is given, the cylinder along z about (0,
    `held_at`). The first `solids` of the file surround the bore, all of them if it is 0; bolts come last.
    """

    radius: float
    half_width: float
    held_at: float
    held_radius: float | None
    material: Material
    solids: int = 0
