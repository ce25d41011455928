"""What is made from a finished STEP file, and only when somebody asks for it: GLB, STL, SVG, PNG."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cad.drawing import write_svg
from cad.gltf import write_glb
from cad.mesh import Mesh, mesh
from cad.picture import write_png
from cad.step import Body, read_step
from cad.stl import write_stl

MEDIA_TYPES = {
    "step": "model/step",
    "glb": "model/gltf-binary",
    "stl": "model/stl",
    "svg": "image/svg+xml",
    "png": "image/png",
}
"""Every kind of file in which a build can be had."""


def derive(step: bytes, kind: str) -> bytes:
    """The file of that kind for a STEP file; equal STEP bytes give equal bytes.

    Raises
    ------
    UnreadableStep
        If the bytes are no STEP file or hold no shape.
    KeyError
        If no such kind can be derived.
    """
    return _WRITERS[kind](read_step(step))


def _of_meshes(write: Callable[[Sequence[Mesh]], bytes]) -> Callable[[Sequence[Body]], bytes]:
    return lambda bodies: write([mesh(body) for body in bodies])


_WRITERS: dict[str, Callable[[Sequence[Body]], bytes]] = {
    "glb": _of_meshes(write_glb),
    "stl": _of_meshes(write_stl),
    "svg": write_svg,
    "png": _of_meshes(write_png),
}

DERIVED = tuple(_WRITERS)
"""The kinds that are derived from the STEP file."""
