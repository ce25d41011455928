"""Linear elasticity of a shaft that is held at one end and loaded at the other.

Lengths are in mm, forces in N, stresses in MPa and masses in t, so that the equations need no conversion
factors.

The rotation is defined by energy: under the traction t = (-y, x, 0)/J, which has the torque 1, the loaded end
turns by θ = ∫ t·u ds, the mean of its rotation with weight r². So K = 1/θ = 1/(2 U). The finite-element space
is a subspace of all displacements, so θ is too small and K too large; K decreases towards the true value with
refinement.

Symmetry. Torsion of a solid that is symmetric about y = 0 is antisymmetric: u(x, -y, z) has the opposite u_x
and u_z, the same u_y. On the plane the tangential displacements are zero and the normal one is free; half the
solid carries half the torque. Bending in the plane y = 0 is symmetric: there u_y is zero.

Boundaries. `free_end`: only the load acts at the loaded end. `guided_end`: the mean displacement of that end
across z is zero, as at the middle of a bearing; the bearing forces are calculated from the compliances of the
unit forces and the load, without a further system of equations.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import ngsolve as ng
import numpy as np
from ngsolve.krylovspace import CGSolver

from cad.analysis.kinds import Boundary, Kind
from cad.analysis.mesh import Grid, curve
from cad.analysis.solid import HELD, LOADED, MIRROR
from cad.errors import AnalysisError
from cad.shaft import Material
from templates.core.arrays import Array, Integers

_RESIDUAL = 1e-5  # relative, in the preconditioner's norm: stresses change by about 1e-5, stiffnesses by 1e-9
_MOST_STEPS = 1000


def stress(u: Any, material: Material) -> Any:
    """Return the stress [MPa] of a displacement [mm] by Hooke's law."""
    E, nu = material.young * 1e-6, material.poisson
    strain = ng.Sym(ng.Grad(u))
    return E / (1 + nu) * (strain + nu / (1 - 2 * nu) * ng.Trace(strain) * ng.Id(3))


class System:
    """Stiffness of a held solid with elements of one order, prepared to be solved for one kind of load.

    The curvature of the elements has the order of the displacements, and the mesh keeps it until the next
    system is built on it. The matrix is factorised. If there are few forces and the order is above 2, each is
    solved by conjugate gradients instead; the preconditioner solves the second order exactly and the other
    unknowns of each edge and face separately (`_by_order`).
    """

    def __init__(
        self, grid: Grid, order: int, material: Material, load: Kind, *, few_forces: bool = False
    ) -> None:
        self.grid, self.order, self.material, self.load = grid, order, material, load
        self.deformation = curve(grid.mesh, order)
        locked = _locked(grid.solid.mirror, load)
        where = {axis: f"{HELD}|{MIRROR}" if axis in locked else HELD for axis in "xyz"}
        self.space = ng.VectorH1(
            grid.mesh, order=order, dirichletx=where["x"], dirichlety=where["y"], dirichletz=where["z"]
        )
        u, v = self.space.TnT()
        self.form = ng.BilinearForm(self.space, symmetric=True, symmetric_storage=True, condense=True)
        self.form += ng.InnerProduct(stress(u, material), ng.Grad(v)) * ng.dx  # a stress is symmetric
        self.form.Assemble()
        self.inverse = self._inverse_of_form(few_forces)

    def _inverse_of_form(self, few_forces: bool) -> Any:
        """Return a solver of the assembled form for a force; it acts on the unknowns outside elements."""
        if few_forces and self.order > 2:
            by_order = _by_order(self.form, self.space)
            return CGSolver(self.form.mat, by_order, tol=_RESIDUAL, maxiter=_MOST_STEPS)
        return self.form.mat.Inverse(self.space.FreeDofs(True), inverse="sparsecholesky")

    def solve(self, force: Any) -> Any:
        """Return the displacement under a force, both as vectors; unknowns inside elements are condensed.

        Raises
        ------
        AnalysisError
            `solver` if conjugate gradients do not converge.
        """
        form = self.form
        outer, u = force.CreateVector(), force.CreateVector()
        outer.data = force + form.harmonic_extension_trans * force
        u.data = self.inverse * outer
        if getattr(self.inverse, "iterations", 0) >= _MOST_STEPS:
            raise AnalysisError(
                "solver", f"the solver did not converge in {_MOST_STEPS} steps; try another level"
            )
        u.data += form.harmonic_extension * u
        u.data += form.inner_solve * force
        return u

    def traction(self, field: Any) -> Any:
        """Return the force of a traction on the loaded end, as a vector."""
        v = self.space.TestFunction()
        force = ng.LinearForm(self.space)
        force += field * v.Trace() * ng.ds(LOADED)
        force.Assemble()
        return force.vec

    def loads(self) -> tuple[Any, list[Any]]:
        """Return the unit load, and the unit forces of a guide that symmetry does not balance already."""
        mesh, parts = self.grid.mesh, self.grid.solid.parts
        shape = ng.CF((-ng.y, ng.x, 0)) if self.load == "torsion" else ng.CF((0, 0, -ng.x))
        unit = shape / (parts * ng.Integrate(shape * shape * ng.ds(LOADED), mesh))
        area = parts * ng.Integrate(ng.CF(1) * ng.ds(LOADED), mesh)
        locked = _locked(self.grid.solid.mirror, self.load)
        sideways = {"x": ng.CF((1, 0, 0)), "y": ng.CF((0, 1, 0))}
        guides = [self.traction(way / area) for axis, way in sideways.items() if axis not in locked]
        return self.traction(unit), guides


def _by_order(form: Any, space: Any) -> Any:
    """Return an approximate inverse of an assembled form, which is exact for second order.

    The basis is hierarchical: the unknowns of second order are those of the vertices and the first of each
    edge. Higher orders are inverted edge by edge and face by face.
    """
    scalar, mesh, order = space.components[0], space.mesh, space.components[0].globalorder
    edges = mesh.nv + np.arange(mesh.nedge * (order - 1)).reshape(mesh.nedge, order - 1)
    per_face = (order - 1) * (order - 2) // 2
    faces = mesh.nv + edges.size + np.arange(mesh.nface * per_face).reshape(mesh.nface, per_face)
    free = np.fromiter(space.FreeDofs(True), bool, space.ndof)
    blocks = []
    for numbers in (edges[:, 1:], faces):
        unknowns = _of_components(numbers, scalar.ndof)
        whole = free[unknowns].all(axis=1)
        blocks += unknowns[whole].tolist()
        blocks += [block for row in unknowns[~whole] if (block := row[free[row]].tolist())]
    low = np.zeros(space.ndof, bool)
    low[_of_components(np.concatenate([np.arange(mesh.nv), edges[:, 0]])[None], scalar.ndof)] = True
    second = form.mat.Inverse(ng.BitArray((low & free).tolist()), inverse="sparsecholesky")
    return second + form.mat.CreateBlockSmoother(blocks)


def _of_components(numbers: Integers, count: int) -> Integers:
    """Return the numbers of the unknowns of three components (n, 3 k) from those of one (n, k)."""
    return np.concatenate([numbers + component * count for component in range(3)], axis=1)


@dataclass(frozen=True)
class Response:
    """Response to a unit load: the displacement, and the work of the load on it."""

    system: System
    compliance: float  # [rad/(N·mm)]
    displacement: Any  # a GridFunction [mm]
    guides: tuple[Any, ...]  # forces on the guided end
    guided: tuple[Any, ...]  # displacements due to these forces
    gram: Array  # matrix of the work of each force on each displacement


def respond(system: System, boundary: Boundary) -> Response:
    """Return the response to a torque or a bending moment of 1 N·mm on the loaded end."""
    force, sideways = system.loads()
    guides = tuple(sideways) if boundary == "guided_end" else ()
    u = system.solve(force)
    guided = tuple(system.solve(guide) for guide in guides)
    gram = np.array([[ng.InnerProduct(f, w) for w in guided] for f in guides]).reshape(
        len(guides), len(guides)
    )
    held = np.array([ng.InnerProduct(guide, u) for guide in guides])
    reactions = np.linalg.solve(gram, held) if guides else held
    displacement = ng.GridFunction(system.space)
    displacement.vec.data = u
    for reaction, w in zip(reactions, guided, strict=True):
        displacement.vec.data -= float(reaction) * w
    work = ng.InnerProduct(force, displacement.vec) * system.grid.solid.parts
    return Response(system, float(work), displacement, guides, guided, gram)


def is_antisymmetric(mirror: str, load: Kind) -> bool:
    """Return whether mirrored points have mirrored displacements of opposite sign."""
    return load == "torsion" or mirror == "x"  # a moment about y is odd in x


def _locked(mirror: str, load: Kind) -> str:
    """Return the directions in which a mirror plane with this normal cannot move."""
    tangential = "".join(axis for axis in "xyz" if axis != mirror)
    return (tangential if is_antisymmetric(mirror, load) else mirror) if mirror else ""
