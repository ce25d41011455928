"""GLB (glTF 2.0, binary): every body once, as a mesh with its colour, and a node for each of its positions.

glTF uses metres with y up; the root node rotates and scales the model, which is in millimetres with z up.
Faces that carry the same parameters are one primitive of the mesh; its `extras` name the parameters:
`{"parameters": ["pin_diameter"]}`. Faces that carry none come last, without `extras`.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad.face_marks import FaceMarks
from cad.mesh import Mesh
from cad.step import rigid

_FLOAT, _UINT = 5126, 5125  # component types
_ARRAY_BUFFER, _ELEMENT_BUFFER = 34962, 34963
_Z_UP_MM = [1e-3, 0, 0, 0, 0, 0, -1e-3, 0, 0, 1e-3, 0, 0, 0, 0, 0, 1]  # matrix in column order


def write_glb(meshes: Sequence[Mesh], title: str, marks: FaceMarks) -> bytes:
    """Return meshes as one GLB file; its root node has the title, every other node the name of its body.

    `marks` are the parameters that the faces carry.
    """
    buffers = _Buffers()
    nodes = [
        _node(i, place, name)
        for i, one in enumerate(meshes)
        for place, name in zip(one.places, one.names, strict=True)
    ]
    content = {
        "asset": {"version": "2.0", "generator": "Crankwright"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"name": title, "matrix": _Z_UP_MM, "children": list(range(1, len(nodes) + 1))},
            *nodes,
        ],
        "meshes": [_mesh(one, i, buffers, marks) for i, one in enumerate(meshes)],
        "materials": [_material(one) for one in meshes],
        **buffers.described(),
    }
    text = json.dumps(content, separators=(",", ":")).encode()
    return framed(text, b"".join(buffers.chunks))


class _Buffers:
    """The binary chunk under construction, with its views and accessors."""

    def __init__(self) -> None:
        self.chunks: list[bytes] = []
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, values: NDArray[Any], target: int, kind: str, **more: Any) -> int:
        """Append an array and return the number of its accessor."""
        data = values.tobytes()
        start = sum(map(len, self.chunks))
        self.views.append({"buffer": 0, "byteOffset": start, "byteLength": len(data), "target": target})
        component = _FLOAT if values.dtype == np.float32 else _UINT
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "type": kind, **more}
        self.accessors.append(accessor)
        self.chunks.append(data)
        return len(self.accessors) - 1

    def described(self) -> dict[str, Any]:
        """Return the buffers, views and accessors as glTF's JSON describes them."""
        length = sum(map(len, self.chunks))
        return {
            "buffers": [{"byteLength": length}],
            "bufferViews": self.views,
            "accessors": self.accessors,
        }


def _node(mesh: int, place: Any, name: str) -> dict[str, Any]:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rigid(place)
    return {"name": name, "mesh": mesh, "matrix": matrix.T.ravel().tolist()}


def _mesh(one: Mesh, material: int, buffers: _Buffers, marks: FaceMarks) -> dict[str, Any]:
    points = one.points.astype(np.float32)
    bounds = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
    position = buffers.add(points, _ARRAY_BUFFER, "VEC3", count=len(points), **bounds)
    normal = buffers.add(one.normals.astype(np.float32), _ARRAY_BUFFER, "VEC3", count=len(points))
    drawn = {"attributes": {"POSITION": position, "NORMAL": normal}, "material": material}
    return {"name": one.name, "primitives": [
        {**drawn, "indices": buffers.add(corners, _ELEMENT_BUFFER, "SCALAR", count=len(corners)),
         **({"extras": {"parameters": [*parameters]}} if parameters else {})}
        for parameters, corners in _by_marks(one, marks)
    ]}  # fmt: skip


def _by_marks(one: Mesh, marks: FaceMarks) -> Iterator[tuple[tuple[str, ...], NDArray[np.uint32]]]:
    """Yield the corners of all triangles with the same parameters; those without parameters come last."""
    of_face = [marks.get((one.name, number), ()) for number in range(int(one.faces.max()) + 1)]
    for parameters in sorted(set(of_face), key=lambda names: (not names, names)):
        faces = [number for number, names in enumerate(of_face) if names == parameters]
        corners = one.triangles[np.isin(one.faces, faces)].astype(np.uint32).ravel()
        if len(corners):
            yield parameters, corners


def _material(one: Mesh) -> dict[str, Any]:
    # glTF needs linear colour values; colours here are in sRGB, approximated by its usual exponent.
    linear = [round(channel**2.2, 6) for channel in one.colour]
    metal = {"baseColorFactor": [*linear, 1.0], "metallicFactor": 0.6, "roughnessFactor": 0.35}
    return {"name": one.name, "pbrMetallicRoughness": metal}


def framed(text: bytes, binary: bytes) -> bytes:
    """Return the GLB file: the 12-byte header and both chunks, padded to four bytes."""
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = [(text, b"JSON"), (binary, b"BIN\0")]
    body = b"".join(np.uint32(len(data)).tobytes() + kind + data for data, kind in chunks)
    return b"glTF" + np.array([2, 12 + len(body)], "<u4").tobytes() + body
