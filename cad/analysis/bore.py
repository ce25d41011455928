"""Compliance of a split bore under the pressure of an oil film, as a matrix between pressure modes.

A mode is a distribution of pressure, or of radial displacement, over the whole bore: 1, cos nθ or sin nθ up
to n = 9, each uniform along the bore or multiplied by the second Legendre polynomial of z. Each mode is
scaled to a mean square of 1. C_ij is the displacement in mode i under a unit pressure of mode j, that is, the
work of the pressure of mode i on this displacement over the area of the bore. So C is symmetric (Betti), and
positive definite because every pressure does positive work.

θ is measured from +y, the block of a housing or the shank of a rod, towards -x.

The two parts of the solid are joined, because bolts keep the joint closed. Rows c1 and s1 are the
displacement of the whole bore, which an oil film sees as eccentricity. A pressure in mode c1 or s1 also
deforms the bore, which the other rows describe.

The solid must be symmetric about z = 0; only one half is meshed. Lengths are in mm, forces in N, stresses in
MPa.

References
----------
Oh, Goenka 1985: The elastohydrodynamic solution of journal bearings under dynamic loading (J. Tribology 107).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import pi
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import ngsolve as ng
import numpy as np
from netgen.meshing import MeshingParameters
from netgen.occ import HalfSpace, OCCGeometry, Pnt, Vec

from cad.analysis.elastic import stress
from cad.analysis.kinds import HARMONICS, mode_names
from cad.analysis.mesh import ONE_THREAD, curve, meshed
from cad.analysis.solid import FREE, HELD, MIRROR
from cad.errors import AnalysisError
from cad.shaft import BorePlace
from templates.core.arrays import Array

BORE = "bore"

RIGID = np.array([name in ("c1", "s1") for name in mode_names()])
"""The modes that move the bore as a whole."""

_NEAR = 1e-5  # [mm], distance within which a point lies on a surface
_ALIKE = 1e-6  # relative difference of volumes, centres and moments of mirrored halves
_GRADING = 0.5  # growth rate of the elements
_SAMPLES = 5  # number of points on an edge


@dataclass(frozen=True)
class BoreFineness:
    """Sizes of elements relative to the bore radius."""

    bore: float  # at the bore
    body: float  # elsewhere


@dataclass(frozen=True)
class BoredSolid:
    """The half of a solid at z > 0, with named faces."""

    shape: Any
    place: BorePlace


def read_bored(step: bytes, place: BorePlace) -> BoredSolid:
    """Read the solids about the bore of a STEP file, join them, and keep one half.

    Raises
    ------
    AnalysisError
        `no_bore` if they are not symmetric about z = 0, or a face is missing at its position.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder, "model.step")
        path.write_bytes(step)
        solids = list(OCCGeometry(str(path)).shape.solids)[: place.solids or None]
    whole = solids[0]
    for other in solids[1:]:
        whole = whole + other
    half = _upper_half(list(whole.solids))
    if half is None:
        raise AnalysisError(
            "no_bore", "the solids of the bore must form one body that is symmetric about z = 0"
        )
    for face in half.faces:
        face.name = _name(face, place)
    for name, words in ((BORE, "bore"), (HELD, "face to hold it by")):
        if not any(face.name == name for face in half.faces):
            raise AnalysisError("no_bore", f"the solid has no {words} where the model specifies one")
    return BoredSolid(half, place)


def _upper_half(joined: list[Any]) -> Any:
    """Return the part of a solid at z > 0.

    Return None if there are several such parts, or if the halves differ in volume, centre or inertia.
    """
    if len(joined) != 1:
        return None
    sides = [list((joined[0] * HalfSpace(Pnt(0, 0, 0), Vec(0, 0, side))).solids) for side in (1, -1)]
    if any(len(solids) != 1 for solids in sides):
        return None
    looks = [_look(solids[0], flip) for solids, flip in zip(sides, (1, -1), strict=True)]
    if any(np.abs(one - other).max() > _ALIKE * np.abs(one).max() for one, other in zip(*looks, strict=True)):
        return None
    return max((solids[0] for solids in sides), key=lambda solid: solid.center[2])


def _look(half: Any, flip: int) -> tuple[Array, Array, Array]:
    """Return the volume, centre and moments of a solid, or of its mirror image about z = 0."""
    signs = np.array([1.0, 1.0, flip])
    moments = np.array([[half.inertia[i, j] for j in range(3)] for i in range(3)])
    return np.array([half.mass]), signs * np.array([*half.center]), moments * np.outer(signs, signs)


def _name(face: Any, place: BorePlace) -> str:
    """Return the name of a face (mirror, bore, held or free), chosen by the points of its edges."""
    x, y, z = np.array([point for edge in face.edges for point in _points(edge)]).T
    if np.all(np.abs(z) < _NEAR):
        return MIRROR
    if np.all(np.abs(np.hypot(x, y) - place.radius) < _NEAR):
        return BORE
    away = y if place.held_radius is None else np.hypot(x, y - place.held_at)
    wanted = place.held_at if place.held_radius is None else place.held_radius
    return HELD if np.all(np.abs(away - wanted) < _NEAR) else FREE


def _points(edge: Any) -> Iterator[tuple[float, float, float]]:
    start, end = edge.parameter_interval
    for at in np.linspace(start, end, _SAMPLES):
        point = edge.Value(at)
        yield point.x, point.y, point.z


def bore_mesh(solid: BoredSolid, fineness: BoreFineness) -> Any:
    """Return a mesh of tetrahedra with straight edges.

    Raises
    ------
    AnalysisError
        `mesh` if Netgen fails, or the mesh is too large for a job.
    """
    radius = solid.place.radius
    for face in solid.shape.faces:
        if face.name == BORE:
            face.maxh = fineness.bore * radius
    largest = fineness.body * radius
    parameters = MeshingParameters(maxh=largest, grading=_GRADING, curvaturesafety=1.0, **ONE_THREAD)
    return meshed(solid.shape, parameters, largest)


def mode_functions(place: BorePlace) -> list[Any]:
    """Return the modes as functions in space, in the order of `mode_names`."""
    angle, zeta = ng.atan2(-ng.x, ng.y), ng.z / place.half_width
    around = [ng.CF(1.0)]
    for n in range(1, HARMONICS + 1):
        around += [2**0.5 * part(n * angle) for part in (ng.cos, ng.sin)]
    return [*around, *(5**0.5 * (3 * zeta**2 - 1) / 2 * part for part in around)]


def compliance_on(
    mesh: Any,
    order: int,
    place: BorePlace,
    *,
    spring: float = 0.0,
    report: Callable[[float], None] = lambda done: None,
    functions: Sequence[Any] = (),
) -> tuple[Array, int]:
    """Return the matrix C [mm/MPa] of a half solid with elements of an order, and the number of unknowns.

    A solid without supports is held at every point by a soft spring [N/mm⁴], which balances the load as the
    inertia of a free body does. Spatial functions other than the modes may be given, with the same scaling.
    """
    curve(mesh, order)
    space = ng.VectorH1(mesh, order=order, dirichletx=HELD, dirichlety=HELD, dirichletz=f"{HELD}|{MIRROR}")
    u, v = space.TnT()
    form = ng.BilinearForm(space, symmetric=True, symmetric_storage=True, condense=True)
    form += ng.InnerProduct(stress(u, place.material), ng.Sym(ng.Grad(v))) * ng.dx
    if spring:
        form += spring * ng.InnerProduct(u, v) * ng.dx
    form.Assemble()
    inverse = form.mat.Inverse(space.FreeDofs(True), inverse="sparsecholesky")
    outward = ng.CF((ng.x, ng.y, 0)) / place.radius
    loads, moved = [], []
    functions = functions or mode_functions(place)
    for number, function in enumerate(functions):
        force = ng.LinearForm(space)
        force += function * ng.InnerProduct(outward, v.Trace()) * ng.ds(BORE, bonus_intorder=6)
        force.Assemble()
        loads.append(force.vec)
        moved.append(_solved(form, inverse, force.vec))
        report(number / len(functions))
    work = np.array([[ng.InnerProduct(load, field) for field in moved] for load in loads])
    return work / (2 * pi * place.radius * place.half_width), int(space.ndof)


def _solved(form: Any, inverse: Any, force: Any) -> Any:
    """Return the displacement under a force; the unknowns inside elements are condensed."""
    outer, u = force.CreateVector(), force.CreateVector()
    outer.data = force + form.harmonic_extension_trans * force
    u.data = inverse * outer
    u.data += form.harmonic_extension * u
    u.data += form.inner_solve * force
    return u
