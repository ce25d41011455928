"""Torsional stiffness of a shaft by CalculiX, on Netgen's second-order tetrahedra; for benchmarks.torsion.

The same half of the solid, clamp, antisymmetry and traction as in `cad.analysis.elastic`, so both find the
same number when refined.
"""

import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
from netgen.meshing import MeshingParameters
from netgen.occ import OCCGeometry
from numpy.typing import NDArray

from cad.analysis.solid import HELD, LOADED, MIRROR, read_solid
from cad.shaft import Shaft

_TETRAHEDRON = (0, 1, 2, 3, 4, 7, 5, 6, 8, 9)  # C3D10 in the order of Netgen
_FLIPPED = (0, 2, 1, 3, 5, 7, 4, 6, 9, 8)  # the same with corners 2 and 3 changed

_EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))  # of Netgen's middle nodes
_GAUSS = np.full((4, 4), 0.1381966011250105) + np.eye(4) * (0.5854101966249685 - 0.1381966011250105)

# Dunavant 1985, six points of degree 4: the traction and the shape functions make four.
_A, _B = 0.445948490915965, 0.091576213509771
_POINTS = np.array(
    [(_A, _A), (1 - 2 * _A, _A), (_A, 1 - 2 * _A), (_B, _B), (1 - 2 * _B, _B), (_B, 1 - 2 * _B)]
)
_WEIGHTS = np.array([0.223381589678011] * 3 + [0.109951743655322] * 3) / 2


def stiffness(
    step: bytes, shaft: Shaft, size: float, curvature: float, folder: Path
) -> tuple[float, int, int]:
    """Stiffness [N·m/rad], elements and nodes of a mesh of this size [radii] and elements by radius."""
    solid = read_solid(step, shaft)
    if solid.mirror != "y":
        raise ValueError("this input file is written for the half y > 0 of a solid")
    parameters = MeshingParameters(maxh=size * solid.radius, grading=0.5, curvaturesafety=curvature)
    mesh = OCCGeometry(solid.shape).GenerateMesh(parameters)
    mesh.SecondOrder()
    points = _unfolded(mesh, np.array([tuple(point) for point in mesh.Points()]))
    force = _traction(points, _faces(mesh, LOADED)) / solid.parts
    Path(folder, "throw.inp").write_text(_deck(mesh, points, force, shaft))
    subprocess.run(["ccx", "throw"], cwd=folder, check=True, capture_output=True)
    moved = _displacements(Path(folder, "throw.dat").read_text(), len(points))
    work = float(np.sum(force * moved)) * solid.parts
    return 1e-3 / work, len(mesh.Elements3D()), len(points)


def _tetrahedra(mesh: Any) -> NDArray[np.int64]:
    """The ten nodes, from 0, of each tetrahedron, in the order of Netgen."""
    return np.array([[point.nr - 1 for point in one.points] for one in mesh.Elements3D()])


def _unfolded(mesh: Any, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """The nodes with the edges of folded elements made straight: CalculiX refuses a fold."""
    nodes, points = _tetrahedra(mesh), points.copy()
    gradients = np.array([_gradients(corner) for corner in (*np.eye(4), np.full(4, 0.25), *_GAUSS)])
    jacobians = np.linalg.det(np.einsum("gik,fij->fgkj", gradients, points[nodes]))
    folded = nodes[np.any(np.sign(jacobians) != np.sign(jacobians.sum(axis=1, keepdims=True)), axis=1)]
    for k, (a, b) in enumerate(_EDGES, 4):
        points[folded[:, k]] = (points[folded[:, a]] + points[folded[:, b]]) / 2
    return points


def _gradients(place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives (10, 3) of the shape functions of a tetrahedron at barycentric coordinates."""
    inner = np.vstack([-np.ones(3), np.eye(3)])
    corners = (4 * place - 1)[:, None] * inner
    return np.vstack([corners, *(4 * (place[a] * inner[b] + place[b] * inner[a])[None] for a, b in _EDGES)])


def _faces(mesh: Any, name: str) -> NDArray[np.int64]:
    """The six nodes, from 0, of each triangle on the faces of a name."""
    named = {i + 1 for i in range(mesh.GetNFaceDescriptors()) if mesh.GetBCName(i) == name}
    faces = [[v.nr - 1 for v in one.points] for one in mesh.Elements2D() if one.index in named]
    return np.array(faces)


def _traction(points: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """Nodal forces [N] of t = (-y, x, 0)/J, of torque 1 N·mm; J is that of these faces alone."""
    force = np.zeros_like(points)
    moment = 0.0
    for (r, s), weight in zip(_POINTS, _WEIGHTS, strict=True):
        t = 1 - r - s  # corners t, r, s; Netgen's middle nodes lie opposite to the corners
        shape = np.array([t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * r * s, 4 * t * s, 4 * t * r])
        by_r = np.array([1 - 4 * t, 4 * r - 1, 0, 4 * s, -4 * s, 4 * (t - r)])
        by_s = np.array([1 - 4 * t, 0, 4 * s - 1, 4 * r, 4 * (t - s), -4 * r])
        nodes = points[faces]
        place = np.einsum("i,fij->fj", shape, nodes)
        along = np.cross(np.einsum("i,fij->fj", by_r, nodes), np.einsum("i,fij->fj", by_s, nodes))
        area = weight * np.linalg.norm(along, axis=1)
        pull = np.column_stack([-place[:, 1], place[:, 0], 0 * place[:, 2]])
        moment += float(np.sum(area * np.sum(pull**2, axis=1)))
        np.add.at(force, faces, np.einsum("i,f,fj->fij", shape, area, pull))
    return force / moment


def _deck(mesh: Any, points: NDArray[np.float64], force: NDArray[np.float64], shaft: Shaft) -> str:
    """The input file of CalculiX, in N and mm."""
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(points, 1)]
    lines += ["*ELEMENT, TYPE=C3D10, ELSET=SOLID"]
    for i, nodes in enumerate(_tetrahedra(mesh), 1):
        a, b, c, d = points[nodes[:4]]
        order = _TETRAHEDRON if np.dot(np.cross(b - a, c - a), d - a) > 0 else _FLIPPED
        lines += [", ".join(str(n) for n in (i, *(nodes[k] + 1 for k in order)))]
    steel = shaft.material
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{steel.young * 1e-6:g}, {steel.poisson:g}"]
    lines += ["*SOLID SECTION, ELSET=SOLID, MATERIAL=STEEL", "*BOUNDARY"]
    held = set(_faces(mesh, HELD).ravel() + 1)
    lines += [f"{n}, 1, 3" for n in sorted(held)]
    mirrored = sorted(set(_faces(mesh, MIRROR).ravel() + 1) - held)
    lines += [f"{n}, {axis}, {axis}" for n in mirrored for axis in (1, 3)]
    lines += ["*STEP", "*STATIC", "*CLOAD"]
    rows, axes = np.nonzero(force)
    lines += [f"{i + 1}, {axis + 1}, {force[i, axis]:.12e}" for i, axis in zip(rows, axes, strict=True)]
    return "\n".join([*lines, "*NODE PRINT, NSET=ALL", "U", "*END STEP", ""])


def _displacements(text: str, count: int) -> NDArray[np.float64]:
    """Displacements [mm] of all nodes from CalculiX's .dat file."""
    displacements = np.zeros((count, 3))
    for line in text.splitlines():
        if re.match(r"\s*\d+\s+\S+\s+\S+\s+\S+\s*$", line):
            node, *moved = line.split()
            displacements[int(node) - 1] = [float(part) for part in moved]
    return displacements
