"""Prepare the solid of a STEP file for analysis: name its end faces, and halve it if it is symmetric.

Faces are recognised by geometry, never by number. A mirror plane is used only if both halves are proven to be
mirror images: their volume, centre and inertia agree, and each face has a counterpart.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from netgen.occ import HalfSpace, OCCGeometry, Pnt, Vec
from numpy.typing import NDArray

from cad.errors import AnalysisError
from cad.shaft import Shaft

HELD, LOADED, MIRROR, FREE = "held", "loaded", "mirror", "free"

_AXES = "xyz"
_COLUMNS = ((slice(0, 1), 1), (slice(1, 4), 3), (slice(4, 10), 6))  # area, centre, moments
_NEAR = 1e-6  # [mm]
_ALIKE = 1e-7  # relative difference to which the kernel's integrals over mirrored faces agree
_FLAT = 1e-5  # relative to a moment of area; the kernel's moments are accurate to 1e-6


@dataclass(frozen=True)
class Solid:
    """A shape with named faces; half of the solid if `mirror` names the normal of a symmetry plane."""

    shape: Any
    mirror: str  # "x", "y" or ""
    radius: float  # [mm], of the loaded face about z

    @cached_property
    def scale(self) -> float:
        """Return a length for element sizes [mm]: the radius of the loaded end, unless that is too small."""
        low, high = self.shape.bounding_box
        return max(self.radius, 0.5 * sqrt(self.shape.mass * self.parts / pi / (high[2] - low[2])))

    @property
    def parts(self) -> int:
        """Return the number of copies of this solid that make up the whole: 1, or 2 if it was halved."""
        return 2 if self.mirror else 1


def read_solid(step: bytes, shaft: Shaft, mirrors: Iterable[str] = ("y", "x")) -> Solid:
    """Read the single solid of a STEP file, halved by the first plane of symmetry.

    Raises
    ------
    AnalysisError
        `no_shaft` if it is not one solid, `no_end` if there is no face at the held or loaded end.
    """
    whole = _only_solid(step)
    mirror, shape = next(_halves(whole, mirrors), ("", whole))
    ends = {HELD: shaft.held, LOADED: shaft.loaded}
    for face in shape.faces:
        face.name = _name(face, mirror, ends)
    for name, level in ends.items():
        if not any(face.name == name for face in shape.faces):
            raise AnalysisError(
                "no_end", f"the shaft needs a flat face at z = {level:g} mm, where it is {name}"
            )
    return Solid(shape, mirror, _radius(shape))


def planar(face: Any) -> bool:
    """Return whether a face is flat, so that its largest principal moment of area is the sum of the rest."""
    low, middle, high = np.linalg.eigvalsh(_inertia(face))
    return bool(abs(high - low - middle) < _FLAT * high)


def _only_solid(step: bytes) -> Any:
    with TemporaryDirectory() as folder:
        path = Path(folder, "model.step")
        path.write_bytes(step)
        solids = list(OCCGeometry(str(path)).shape.solids)
    if len(solids) != 1:
        raise AnalysisError("no_shaft", f"a shaft must be one solid; the file has {len(solids)}")
    return solids[0]


def _halves(whole: Any, mirrors: Iterable[str]) -> Any:
    """Yield the mirror planes of a solid, each with its half on the positive side."""
    for axis in mirrors:
        unit = [float(other == axis) for other in _AXES]
        sides = [whole * HalfSpace(Pnt(0, 0, 0), Vec(*(sign * u for u in unit))) for sign in (-1, 1)]
        solids = [list(side.solids) for side in sides]
        if all(len(group) == 1 for group in solids):
            one, other = solids[0][0], solids[1][0]
            if _images(one, other, axis, whole.mass):
                yield axis, max((one, other), key=lambda half: _middle(half)[_AXES.index(axis)])


def _middle(shape: Any) -> NDArray[np.float64]:
    """Return the middle of the bounding box of a shape [mm]."""
    return np.asarray(sum(np.array([*corner]) for corner in shape.bounding_box) / 2)


def _images(one: Any, other: Any, axis: str, volume: float) -> bool:
    """Return whether two halves are mirror images that together make up the whole."""
    inside = _look([one, other])
    if abs(inside[:, 0].sum() - volume) > _ALIKE * volume:
        return False
    seen, wanted = (
        np.vstack([_look(half.faces), row]) for half, row in zip((one, other), inside, strict=True)
    )
    if seen.shape != wanted.shape:
        return False
    scale = np.concatenate([[np.abs(seen[:, kind]).max()] * count for kind, count in _COLUMNS])
    apart = (np.abs(seen[:, None] - wanted[None] * _mirrored(axis)) / scale).max(axis=2)
    partner = apart.argmin(axis=1)
    return bool(len(set(partner)) == len(seen) and apart.min(axis=1).max() < 10 * _ALIKE)


def _look(shapes: Iterable[Any]) -> NDArray[np.float64]:
    """Return a row with the area or volume, the centre and the moments of each shape."""
    rows = []
    for shape in shapes:
        size, centre = shape.Properties()
        rows.append([size, *centre, *_inertia(shape)[np.triu_indices(3)]])
    return np.array(rows)


def _mirrored(axis: str) -> NDArray[np.float64]:
    """Return the factors that mirror the columns of `_look` across an axis."""
    flip = np.array([-1.0 if other == axis else 1.0 for other in _AXES])
    return np.concatenate([[1.0], flip, np.outer(flip, flip)[np.triu_indices(3)]])


def _inertia(shape: Any) -> NDArray[np.float64]:
    inertia = shape.inertia
    return np.array([[inertia[i, j] for j in range(3)] for i in range(3)])


def _name(face: Any, mirror: str, ends: dict[str, float]) -> str:
    low, high = (np.array([*corner]) for corner in face.bounding_box)
    if mirror and max(abs(low[_AXES.index(mirror)]), abs(high[_AXES.index(mirror)])) < _NEAR:
        return MIRROR
    for name, level in ends.items():
        if max(abs(low[2] - level), abs(high[2] - level)) < _NEAR:
            return name
    return FREE


def _radius(shape: Any) -> float:
    corners = [corner for face in shape.faces if face.name == LOADED for corner in face.bounding_box]
    return max(float(abs(corner[i])) for corner in corners for i in (0, 1))
