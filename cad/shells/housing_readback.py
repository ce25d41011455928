"""Read the holes, shoulders, bulkhead, bolts and dowels of a housing back from the surfaces of its parts.

Each feature is recognised by its position: bolt holes are along y beside the shaft, and of two coaxial
cylinders of a half the wider one is a counterbore.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from cad.surfaces import PartSurfaces, Size, Surface, X, Y, Z

_CLEAR = 1e-6  # [mm]


def bolt_holes(block: PartSurfaces, cap: PartSurfaces) -> dict[str, float]:
    """Return diameter, spacing and depth of the bolt holes; a diameter of 0 if there are none."""
    blind, through = _holes(block), _holes(cap)
    if not blind:
        return {"bolt_hole_diameter": 0.0}
    left, right = [b for b in blind if b.point.x < 0], [b for b in blind if b.point.x > 0]
    are_alike = abs(blind[0].diameter - through[0].diameter) < _CLEAR
    spacing = max(b.point.x for b in right) - min(b.point.x for b in left)
    return {
        "bolt_hole_diameter": Size.diameter([*blind, *through] if are_alike else through),
        "bolt_spacing": Size.distance(spacing, left, right),
        "bolt_hole_depth": block.apart(Y, 0.0, blind[0].reach[1]),
    }


def _holes(half: PartSurfaces) -> list[Surface]:
    """Return the bolt holes of a half: of coaxial cylinders along y beside the shaft, the narrowest."""
    beside = [hole.turned(Y) for hole in half.cylinders if hole.along(Y) and not hole.about(Y)]
    least = min((hole.diameter for hole in beside), default=0.0)
    return [hole for hole in beside if hole.diameter - least < _CLEAR]


def saddle_sizes(block: PartSurfaces, cap: PartSurfaces) -> dict[str, float]:
    """Return the sizes of shoulders and bulkhead; 0 for none."""
    sizes: dict[str, float] = {"shoulder_depth": 0.0, "bulkhead_thickness": 0.0}
    if len(across := cap.levels(X)) > 2:
        side, levels = cap.planes_at(X, across[-2])[0], cap.levels(Y)
        sizes["crown_width"] = cap.between(X, 1, -2)
        sizes["shoulder_depth"] = cap.apart(Y, levels[0], _end_of(side, levels))
    if len(block.levels(Z)) > 2:
        sizes["bulkhead_thickness"] = block.between(Z, 1, -2)
        step = next(level for level in block.levels(Y) if _is_step(block, level))
        sizes["saddle_height"] = block.apart(Y, 0.0, step)
    return sizes


def _end_of(side: Surface, levels: Sequence[float]) -> float:
    """Return the level at which a side of the crown ends; its middle is halfway there from the bottom."""
    assert side.middle is not None, "a plane has a middle"
    wanted = 2 * side.middle.y - levels[0]
    return min(levels, key=lambda level: abs(level - wanted))


def _is_step(block: PartSurfaces, level: float) -> bool:
    """Return whether planes at a level lie on both sides of the middle along z, as those of a saddle do."""
    middles = [p.middle.z for p in block.planes_at(Y, level) if p.middle is not None]
    return bool(middles) and min(middles) < -_CLEAR and max(middles) > _CLEAR


def fastener_sizes(seen: Mapping[str, PartSurfaces]) -> dict[str, float]:
    """Return the sizes of bolts and dowels in their own axes; diameters of 0 if there are none."""
    sizes: dict[str, float] = {"bolt_diameter": 0.0, "dowel_diameter": 0.0}
    if bolt := seen.get("bolt"):
        sizes |= {
            "bolt_diameter": bolt.diameters(Z)[0],
            "bolt_length": bolt.between(Z, 1, 2),
            "bolt_head_height": bolt.between(Z, 0, 1),
            "bolt_head_width": bolt.length(X),
        }
    if dowel := seen.get("dowel"):
        sizes |= {"dowel_diameter": dowel.diameters(Z)[-1], "dowel_length": dowel.length(Z)}
    return sizes
