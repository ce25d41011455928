"""Files derived from a finished STEP file, on request only: meshes, pictures, drawings."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cad.drafting.paper import as_pdf
from cad.drafting.sheet import write_dxf
from cad.drafting.svg import write_drawing
from cad.drawing import write_svg
from cad.gltf import write_glb
from cad.header import Header, read_header
from cad.mesh import Mesh, mesh
from cad.picture import write_png
from cad.step import Body, read_step
from cad.stl import write_stl

MEDIA_TYPES = {
    "step": "model/step",
    "glb": "model/gltf-binary",
    "stl": "model/stl",
    "drawing.svg": "image/svg+xml",
    "svg": "image/svg+xml",
    "png": "image/png",
    "dxf": "image/vnd.dxf",
    "drawing.pdf": "application/pdf",
}
"""Every kind of file in which a build can be had; the last kind of a media type is its usual one."""

DRAWINGS = ("drawing.svg", "dxf", "drawing.pdf")
"""Kinds that show dimensions; they take longer than a picture."""


def derive(step: bytes, kind: str) -> bytes:
    """The file of that kind for a STEP file; equal STEP bytes give equal bytes.

    Raises
    ------
    UnreadableStep
        If the bytes are not a STEP file or hold no shape.
    KeyError
        If no such kind can be derived.
    """
    return _WRITERS[kind](read_step(step), read_header(step))


Writer = Callable[[Sequence[Body], Header | None], bytes]


def _of_meshes(write: Callable[[Sequence[Mesh]], bytes]) -> Writer:
    return lambda bodies, _header: write([mesh(body) for body in bodies])


_WRITERS: dict[str, Writer] = {
    "glb": _of_meshes(write_glb),
    "stl": _of_meshes(write_stl),
    "drawing.svg": write_drawing,
    "svg": lambda bodies, _header: write_svg(bodies),
    "png": _of_meshes(write_png),
    "dxf": write_dxf,
    "drawing.pdf": lambda bodies, header: as_pdf(write_drawing(bodies, header)),
}

DERIVED = tuple(_WRITERS)
"""The kinds that are derived from the STEP file."""
