"""Binary STL: the triangles of all bodies in one list, in millimetres, without colours."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cad.mesh import Mesh, placed

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(meshes: Sequence[Mesh]) -> bytes:
    """Return a binary STL file: an 80-byte header, the number of triangles, 50 bytes per triangle."""
    corners = np.concatenate([points[one.triangles] for one, points, _ in placed(meshes)])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    rows = np.zeros(len(corners), _TRIANGLE)
    rows["normal"] = normals / np.where(lengths == 0, 1, lengths)
    rows["corners"] = corners
    return b"Crankwright, mm".ljust(80) + np.uint32(len(rows)).tobytes() + rows.tobytes()
