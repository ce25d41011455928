"""A field shown on a solid: its GLB file with a colour at each vertex, and a shaded picture.

`cad.gltf` writes the GLB file of a model that is one body at one position. This module keeps its triangles
and adds glTF's COLOR_0 and a white material. Colours range from violet (lowest value) through green to yellow
(highest); the part is grey where the field has no value.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cad.errors import GeometryError
from cad.gltf import framed
from cad.picture import Scene, shaded
from templates.core.arrays import Array, Integers

_VIRIDIS = (
    "440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b addc30"
    " d8e219 fde725"
)
_SCALE = np.array([[int(one[at : at + 2], 16) / 255 for at in (0, 2, 4)] for one in _VIRIDIS.split()])
_BARE = np.array([0.74, 0.76, 0.79])
_COLOUR_BUFFER = 34962  # of attributes of corners
_FLOAT = 5126
_MATT = {"baseColorFactor": [1.0, 1.0, 1.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7}


@dataclass(frozen=True)
class Field:
    """A field: a value at every vertex of a surface, NaN where there is none."""

    title: str
    unit: str
    values: Array
    low: float  # lower end of the colour scale
    high: float

    def colours(self) -> Array:
        """Return the colour of every vertex in sRGB, from 0 to 1."""
        span = self.high - self.low
        share = (self.values - self.low) / span if span > 0 else np.zeros_like(self.values)
        there = np.isfinite(share)
        at = np.clip(np.where(there, share, 0.0), 0.0, 1.0) * (len(_SCALE) - 1)
        places = np.arange(len(_SCALE))
        painted = np.column_stack([np.interp(at, places, channel) for channel in _SCALE.T])
        return np.where(there[:, None], painted, _BARE)


class Glb:
    """The GLB file of one body at one position, as arrays in millimetres."""

    def __init__(self, data: bytes) -> None:
        length = int.from_bytes(data[12:16], "little")
        self.about: dict[str, Any] = json.loads(data[20 : 20 + length])
        size = int.from_bytes(data[20 + length : 24 + length], "little")
        self.binary = data[28 + length : 28 + length + size]
        if len(self.about["meshes"]) != 1 or len(self.about["nodes"]) != 2:
            raise GeometryError("not_one_solid", "a field needs a model with one body at one position")
        self.primitives = self.about["meshes"][0]["primitives"]  # of the same vertices
        self.attributes = self.primitives[0]["attributes"]

    @cached_property
    def points(self) -> Array:
        """Return the vertices (n, 3) [mm] in the axes of the model."""
        matrix = np.array(self.about["nodes"][1]["matrix"]).reshape(4, 4).T
        own = self._read(self.attributes["POSITION"], np.float32, 3)
        return np.asarray(own @ matrix[:3, :3].T + matrix[:3, 3])

    @cached_property
    def normals(self) -> Array:
        """Return the outward normals of the vertices (n, 3)."""
        matrix = np.array(self.about["nodes"][1]["matrix"]).reshape(4, 4).T
        own = self._read(self.attributes["NORMAL"], np.float32, 3)
        return np.asarray(own @ matrix[:3, :3].T)

    @cached_property
    def triangles(self) -> Integers:
        """Return the vertex numbers of the triangles (m, 3)."""
        every = [self._read(drawn["indices"], np.uint32, 3) for drawn in self.primitives]
        return np.concatenate(every).astype(np.intp)

    @cached_property
    def faces(self) -> Integers:
        """Return the face number of every vertex (n,); faces of the solid share no vertices."""
        a, b, c = self.triangles.T
        one, other = np.concatenate([a, b]), np.concatenate([b, c])
        joined = coo_array((np.ones(len(one), dtype=np.int8), (one, other)), shape=(len(self.points),) * 2)
        return np.asarray(connected_components(joined, directed=False)[1])

    def _read(self, accessor: int, kind: Any, columns: int) -> Array:
        view = self.about["bufferViews"][self.about["accessors"][accessor]["bufferView"]]
        start = view["byteOffset"]
        values = np.frombuffer(self.binary[start : start + view["byteLength"]], kind)
        return np.asarray(values.reshape(-1, columns))

    def painted(self, field: Field) -> bytes:
        """Return the GLB file with the colours of a field; its root node states their meaning."""
        linear = (field.colours() ** 2.2).astype(np.float32)  # glTF needs linear colour values
        about = json.loads(json.dumps(self.about))
        data = linear.tobytes()
        start = len(self.binary)
        about["bufferViews"].append(
            {"buffer": 0, "byteOffset": start, "byteLength": len(data), "target": _COLOUR_BUFFER}
        )
        about["accessors"].append({
            "bufferView": len(about["bufferViews"]) - 1, "componentType": _FLOAT, "type": "VEC3",
            "count": len(linear),
        })  # fmt: skip
        about["buffers"][0]["byteLength"] = start + len(data)
        for drawn in about["meshes"][0]["primitives"]:
            drawn["attributes"]["COLOR_0"] = len(about["accessors"]) - 1
        about["materials"][0]["pbrMetallicRoughness"] = _MATT
        about["nodes"][0]["extras"] = {
            "field": field.title, "unit": field.unit, "low": field.low, "high": field.high,
        }  # fmt: skip
        text = json.dumps(about, separators=(",", ":")).encode()
        return framed(text, self.binary + data)

    def picture(self, field: Field) -> bytes:
        """Return a shaded PNG picture with the colours of a field."""
        corners = self.triangles
        faces = self.faces[corners[:, 0]]
        return shaded(Scene(self.points[corners], self.normals[corners], field.colours()[corners], faces))
