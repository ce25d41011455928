"""Kinds of files of a build, and their options: the deflection of a mesh, and a single part.

Pages, commands and routes offer the kinds that are listed here. A kind with options is named
`stl@0.05mm#upper_shell`, and its file is stored in addition to that of `stl`. The deflection is the largest
distance of a facet from the true surface. Deflections are rounded down to six values per decade, so a part
has at most 19 meshes of a kind, however many deflections are requested.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import floor, log10
from typing import TYPE_CHECKING

from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt, listed
from templates.core.units.quantity import read
from templates.core.units.units import unit

if TYPE_CHECKING:
    from cad.step import Body

STEP = "step"
"""The kind of the file from which all others are derived."""

VALIDATED = "validated.step"
"""The kind of a STEP file that states volume, area and centroid of each part."""

MEDIA_TYPES = {
    VALIDATED: "model/step",
    "step": "model/step",
    "glb": "model/gltf-binary",
    "stl": "model/stl",
    "3mf": "model/3mf",
    "brep": "application/x-brep",
    "drawing.svg": "image/svg+xml",
    "svg": "image/svg+xml",
    "png": "image/png",
    "dxf": "image/vnd.dxf",
    "drawing.pdf": "application/pdf",
}
"""Media types of all kinds of files of a build; the last kind with a media type is its default."""

DRAWINGS = ("drawing.svg", "dxf", "drawing.pdf")
"""Kinds of files that show dimensions; they take longer than a picture."""

SHOWN = ("step", "glb")
"""Kinds of files that a page shows; they are created with a build, all others on request."""
MESHES = ("glb", "stl", "3mf")
"""Kinds of files made of triangles; a user may choose their deflection."""
BY_PART = ("step", *MESHES, "brep", "drawing.svg", "dxf")
"""Kinds of files that can contain a single part, in its own coordinates."""

FINEST, COARSEST = 1e-4, 0.1
"""Smallest and largest deflection over the diagonal of the largest body's bounding box."""
LEAST, MOST = 1e-6, 1e5
"""Smallest and largest deflection for any solid [mm]: a nanometre, and 100 m."""

STEPS = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)
"""Steps of the deflection within a decade."""

_AT, _OF, _UNIT = "@", "#", "mm"
_SAME = 1e-9  # relative; so 0.1 mm and 100 um are the same step


def with_deflection(kind: str, raw: str) -> str:
    """Return the file kind for a deflection as the user typed it, such as `0.05 mm`.

    Raises
    ------
    InvalidInputs
        If it is not a length above 0, or the kind has no facets.
    """
    if kind not in MESHES:
        detail = f"only {listed(MESHES)} are made of facets; omit it for {kind}"
        raise InvalidInputs([Fault("deflection", "not_offered", detail)])
    try:
        typed = read(raw, _UNIT)
    except FaultyText as error:
        raise InvalidInputs([error.fault("deflection")]) from None
    if typed.tolerance is not None or not isinstance(typed.si, float) or typed.si <= 0:
        detail = "a deflection is a single length above 0, such as `0.05 mm`"
        raise InvalidInputs([Fault("deflection", "out_of_range", detail)])
    asked = float(unit(_UNIT).from_si(typed.si))
    if not LEAST <= asked <= MOST:
        detail = f"{asked:.6g} {_UNIT} suits no solid; give {LEAST:g} to {MOST:g} {_UNIT}"
        raise InvalidInputs([Fault("deflection", "out_of_range", detail)])
    return f"{kind}{_AT}{_step_not_above(asked):.6g}{_UNIT}"


def with_part(kind: str, part: str) -> str:
    """Return the file kind for a file that contains only one part.

    Raises
    ------
    InvalidInputs
        If a file of that kind always contains all parts.
    """
    if plain_kind(kind) not in BY_PART:
        detail = f"only {listed(BY_PART)} can hold one part alone; omit it for {plain_kind(kind)}"
        raise InvalidInputs([Fault("part", "not_offered", detail)])
    return f"{kind}{_OF}{part}"


def _steps(around: float) -> list[float]:
    """Return the allowed deflections from a decade below a length to a decade above it, ascending."""
    decade = floor(log10(around))
    return [float(f"{step:g}e{decade + more}") for more in (-1, 0, 1) for step in STEPS]


def _step_not_above(length: float) -> float:
    """Return the largest allowed deflection that does not exceed a length."""
    return max(step for step in _steps(length) if step <= length * (1 + _SAME))


def _step_not_below(length: float) -> float:
    """Return the smallest allowed deflection that is not below a length."""
    return min(step for step in _steps(length) if step >= length * (1 - _SAME))


def plain_kind(kind: str) -> str:
    """Return the file kind without its deflection."""
    return kind.partition(_OF)[0].partition(_AT)[0]


def bodies_of(kind: str, bodies: Sequence[Body]) -> Sequence[Body]:
    """Return the bodies in a file of that kind: all bodies, or one part once in its own coordinates.

    Raises
    ------
    InvalidInputs
        If no body has the name of the part.
    """
    _, has_part, part = kind.partition(_OF)
    if not has_part:
        return bodies
    found = [body for body in bodies if body.name == part]
    if not found:
        names = listed([body.name for body in bodies])
        offered = f"the only part is {names}" if len(bodies) == 1 else f"the parts are {names}"
        detail = f"there is no part {excerpt(part)}; {offered}"
        raise InvalidInputs([Fault("part", "unknown_part", detail)])
    from cadquery import Location  # it takes a second, and a command that lists kinds needs no geometry

    return [replace(body, places=(Location(),)) for body in found]


def deflection_of(kind: str, bodies: Sequence[Body]) -> float | None:
    """Return the deflection [mm] of a file kind.

    None stands for the default, a fraction of the size of each body.

    Raises
    ------
    InvalidInputs
        If it is too fine or too coarse for bodies of this size.
    """
    _, at, text = kind.partition(_OF)[0].partition(_AT)
    if not at:
        return None
    asked, size = float(text.removesuffix(_UNIT)), _size(bodies)
    if not FINEST * size <= asked <= COARSEST * size:
        between = f"give {_step_not_below(FINEST * size):g} to {COARSEST * size:.3g} {_UNIT}"
        across = f"a solid whose box measures {size:.4g} {_UNIT} across"
        detail = f"{asked:g} {_UNIT} does not suit {across}; {between}"
        raise InvalidInputs([Fault("deflection", "out_of_range", detail)])
    return asked


def _size(bodies: Sequence[Body]) -> float:
    """Return the largest diagonal of the bounding box of any body [mm], regardless of positions."""
    return max(float(body.shape.BoundingBox().DiagonalLength) for body in bodies)
