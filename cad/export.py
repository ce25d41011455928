"""Files derived from a finished STEP file on request: meshes, pictures, drawings."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence

from cadquery import Compound

from cad.drafting.paper import as_pdf
from cad.drafting.sheet import write_dxf
from cad.drafting.svg import write_drawing
from cad.drawing import write_svg
from cad.face_marks import read_marks
from cad.file_kinds import BY_PART, STEP, VALIDATED, bodies_of, deflection_of, plain_kind
from cad.gltf import write_glb
from cad.header import Header, read_header
from cad.mesh import Mesh, closed_mesh, mesh
from cad.part_step import part_step
from cad.picture import write_png
from cad.step import Body, read_step
from cad.stl import write_stl
from cad.threemf import write_3mf
from cad.validation import with_validation


def derive(step: bytes, kind: str) -> bytes:
    """Return the file of a kind, derived from a STEP file; equal STEP bytes give equal bytes.

    Raises
    ------
    UnreadableStep
        If the bytes are not a STEP file or contain no shape, or validation properties match no part.
    KeyError
        If no such kind can be derived.
    InvalidInputs
        If the deflection of a mesh does not suit the size of the bodies, or no body has the part's name.
    GeometryError
        If a mesh has a gap.
    """
    if kind == VALIDATED:
        return with_validation(step)
    if kind != STEP and plain_kind(kind) == STEP:
        return part_step(step, kind)
    whole, header = read_step(step), read_header(step)
    bodies = bodies_of(kind, whole)
    if (write := _DRAWERS.get(plain_kind(kind))) is not None:
        return write(bodies, header, whole)
    deflection = deflection_of(kind, bodies)
    if plain_kind(kind) == GLB:
        title = header.model if header else "model"
        return write_glb(_meshes(bodies, deflection), title, read_marks(step, whole))
    if deflection is None:
        return _WRITERS[plain_kind(kind)](bodies, header)
    return _MESH_WRITERS[plain_kind(kind)](bodies, header, deflection)


GLB = "glb"

Writer = Callable[[Sequence[Body], Header | None], bytes]
Drawer = Callable[[Sequence[Body], Header | None, Sequence[Body]], bytes]
MeshWriter = Callable[[Sequence[Body], Header | None, float | None], bytes]


def _write_stl(bodies: Sequence[Body], _header: Header | None, deflection: float | None = None) -> bytes:
    return write_stl(_meshes(bodies, deflection))


def _write_3mf(bodies: Sequence[Body], header: Header | None, deflection: float | None = None) -> bytes:
    return write_3mf(_meshes(bodies, deflection), header.model if header else "model")


def _write_brep(bodies: Sequence[Body], _header: Header | None) -> bytes:
    """Return the shapes in OpenCASCADE's own text format; several shapes become one compound."""
    shapes = [body.shape.moved(place) for body in bodies for place in body.places]
    stream = io.BytesIO()
    (shapes[0] if len(shapes) == 1 else Compound.makeCompound(shapes)).exportBrep(stream)
    return stream.getvalue()


def _meshes(bodies: Sequence[Body], deflection: float | None = None) -> list[Mesh]:
    return [closed_mesh(body, deflection) for body in bodies]


_MESH_WRITERS: dict[str, MeshWriter] = {"stl": _write_stl, "3mf": _write_3mf}
_WRITERS: dict[str, Writer] = {
    "stl": _write_stl,
    "3mf": _write_3mf,
    "brep": _write_brep,
    "svg": lambda bodies, _header: write_svg(bodies),
    "png": lambda bodies, _header: write_png([mesh(body) for body in bodies]),
}
_DRAWERS: dict[str, Drawer] = {
    "drawing.svg": write_drawing,
    "dxf": write_dxf,
    "drawing.pdf": lambda bodies, header, whole: as_pdf(write_drawing(bodies, header, whole)),
}

DERIVED = (VALIDATED, GLB, *_WRITERS, *_DRAWERS)
"""Kinds of files that are derived from the STEP file."""


def is_derived(kind: str) -> bool:
    """Return whether a kind, perhaps with options, is derived from the STEP file."""
    return kind in DERIVED or (kind != STEP and plain_kind(kind) in BY_PART)
