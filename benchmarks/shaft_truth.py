"""Compute stiffnesses and torsional frequency of a shaft accurately enough to judge `cad.analysis`.

Against the levels three things differ. The mesh is another one. Along sharp inner edges it is not refined
evenly but in layers, each 0.15 times as thick as the one before (`RefineHP`): they resolve the singular field
exponentially, while small tetrahedra gain little, whichever their order. And the values of orders 2, 3 and 4
are extrapolated to infinite order, as a geometric series (Aitken); with sharp edges those of orders 2 and 3,
with the ratio that order 4 shows on one of them.

From fourth order on nothing but second order is factorised: forces are solved for by conjugate gradients. The
mode is a Ritz vector in the Krylov space of the static displacement.

    python -m benchmarks.shaft_truth NUMBER …

shows by how much an order more and a layer less change the truth of shafts that `benchmarks.torsion_levels`
keeps.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Collection
from math import pi, sqrt
from pathlib import Path
from typing import Any

import ngsolve as ng
import numpy as np
from netgen.meshing import MeshingParameters
from netgen.occ import OCCGeometry
from ngsolve.krylovspace import CGSolver
from scipy.linalg import eigh

from cad.analysis.corners import Edges, along
from cad.analysis.elastic import Response, System, respond
from cad.analysis.kinds import LOADS, Boundary, Kind
from cad.analysis.mesh import ONE_THREAD, Fineness, Grid, sharp_edges
from cad.analysis.solid import Solid, read_solid
from cad.shaft import Shaft
from templates.core.arrays import Integers

Found = dict[str, float]

RESULTS = Path("benchmarks/results/shaft_truth.json")
MESH = Fineness(size=0.6, curvature=0.55, turn=pi / 3)
SHARP_MESH = Fineness(size=0.8, curvature=0.4, turn=pi / 3, sharp=0.35)  # before layers are removed
LAYERS, THINNER = 2, 0.15
ORDERS, SHARP_ORDERS = (2, 3, 4), (2, 3)
RATIO = 0.15  # change from order 3 to 4 over change from 2 to 3 with sharp edges: 0.175 and 0.126 in RESULTS
KEY = (
    f"{MESH} in orders {ORDERS}, or {SHARP_MESH} with {LAYERS} layers by {THINNER} in orders {SHARP_ORDERS}; "
    f"ngsolve {ng.__version__}"
)

ASKED: dict[str, tuple[Kind, Boundary]] = {
    "stiffness": ("torsion", "free_end"),
    "guided stiffness": ("torsion", "guided_end"),
    "bending stiffness": ("bending", "free_end"),
    "guided bending stiffness": ("bending", "guided_end"),
}
FREQUENCY = "torsional frequency"
OUTPUTS = (*ASKED, FREQUENCY)

_RESIDUAL = 1e-4
_STEPS = 1000
_SOLUTIONS = 4  # solutions for the mode, beyond the static one
_SAMPLES = 200  # number of points on an edge


def truth(step: bytes, shaft: Shaft, outputs: Collection[str] = OUTPUTS) -> Found:
    """Return extrapolated outputs of a shaft: stiffnesses [N·m/rad], frequency [Hz]."""
    return extrapolated(by_orders(step, shaft, outputs))


def by_orders(step: bytes, shaft: Shaft, outputs: Collection[str] = OUTPUTS) -> list[Found]:
    """Return the values that `truth` extrapolates: outputs by ascending order."""
    grid = layered_grid(read_solid(step, shaft), LAYERS)
    orders = SHARP_ORDERS if grid.is_sharp else ORDERS
    return [outputs_by(grid, order, shaft, outputs) for order in orders]


def extrapolated(found: list[Found]) -> Found:
    """Return the limits of values by ascending order."""
    limits: Found = {}
    for name, last in found[-1].items():
        change = found[-2][name] - last
        before = found[-3][name] - found[-2][name] if len(found) > 2 else 0.0
        ratio = min(change / before, 0.5) if before > change > 0 else RATIO
        limits[name] = last - change * ratio / (1 - ratio)
    return limits


def layered_grid(solid: Solid, layers: int) -> Grid:
    """Return an accurate mesh, with layers of prisms around any sharp inner edges."""
    edges = sharp_edges(solid, MESH)
    is_sharp = len(edges.ends) > 0
    fineness = SHARP_MESH if is_sharp else MESH
    for edge in _edges_at(solid, edges):
        edge.hpref = 1
    parameters = MeshingParameters(
        maxh=fineness.size * solid.scale, grading=0.5, curvaturesafety=fineness.curvature, **ONE_THREAD
    )
    for point, size in along(edges, fineness.sharp):
        parameters.RestrictH(*point, size)
    mesh = ng.Mesh(OCCGeometry(solid.shape).GenerateMesh(parameters))
    if is_sharp and layers:
        mesh.RefineHP(layers, THINNER)
    return Grid(mesh, solid, is_sharp)


def _edges_at(solid: Solid, edges: Edges) -> list[Any]:
    """Return the kernel's edges to which segments belong."""
    proper = [edge for edge in solid.shape.edges if edge.mass > 0]
    lines = []
    for edge in proper:
        low, high = edge.parameter_interval
        lines.append(np.array([[*edge.Value(t)] for t in np.linspace(low, high, _SAMPLES)]))
    nearest = {
        int(np.argmin([np.linalg.norm(line - middle, axis=1).min() for line in lines]))
        for middle in edges.ends.mean(axis=1)
    }
    return [proper[number] for number in sorted(nearest)]


class Iterative(System):
    """A system on elements of any shape, which from fourth order on factorises its second order only."""

    def _inverse_of_form(self, few_forces: bool) -> Any:
        if self.order < 4:
            return super()._inverse_of_form(few_forces)
        return CGSolver(self.form.mat, self._by_order(), tol=_RESIDUAL, maxiter=_STEPS)

    def _by_order(self) -> Any:
        """As in `cad.analysis.elastic`, but for faces of three or four sides."""
        scalar, mesh = self.space.components[0], self.space.mesh
        free = np.fromiter(self.space.FreeDofs(True), bool, self.space.ndof)
        low = np.zeros(self.space.ndof, bool)
        low[_of_components(np.arange(mesh.nv), scalar.ndof)] = True
        blocks = []
        for kind, count, skipped in ((ng.EDGE, mesh.nedge, 1), (ng.FACE, mesh.nface, 0)):
            for number in range(count):
                unknowns = np.array(scalar.GetDofNrs(ng.NodeId(kind, number)), int)
                low[_of_components(unknowns[:skipped], scalar.ndof)] = True
                block = _of_components(unknowns[skipped:], scalar.ndof)
                blocks.append(block[free[block]].tolist())
        second = self.form.mat.Inverse(ng.BitArray((low & free).tolist()), inverse="sparsecholesky")
        return second + self.form.mat.CreateBlockSmoother([block for block in blocks if block])


def _of_components(numbers: Integers, count: int) -> Integers:
    return np.concatenate([numbers + component * count for component in range(3)])


def outputs_by(grid: Grid, order: int, shaft: Shaft, outputs: Collection[str] = OUTPUTS) -> Found:
    """Return outputs on one mesh in elements of one order: stiffnesses [N·m/rad], frequency [Hz]."""
    computed: Found = {}
    for load in LOADS:
        asked = {name: end for name, (kind, end) in ASKED.items() if kind == load and name in outputs}
        with_mode = load == "torsion" and FREQUENCY in outputs
        if not asked and not with_mode:
            continue
        system = Iterative(grid, order, shaft.material, load)
        free = respond(system, "free_end")
        for name, boundary in asked.items():
            guided = boundary == "guided_end"
            computed[name] = 1e-3 / (guided_compliance(free) if guided else free.compliance)
        if with_mode:
            computed[FREQUENCY] = torsional_frequency(free)
    return computed


def guided_compliance(free: Response) -> float:
    """Return the compliance [rad/(N·mm)] with the forces of a guide, from the unguided response."""
    system = free.system
    _, guides = system.loads()
    moved = [system.solve(guide) for guide in guides]
    gram = np.array([[ng.InnerProduct(f, w) for w in moved] for f in guides])
    held = np.array([ng.InnerProduct(guide, free.displacement.vec) for guide in guides])
    return free.compliance - system.grid.solid.parts * float(held @ np.linalg.solve(gram, held))


def torsional_frequency(free: Response) -> float:
    """Return the frequency [Hz] of the Ritz vector with the largest effective inertia about z.

    The space: the static displacement, and what the inertia of each vector moves next. Vectors are orthogonal
    in the mass, and each keeps the force that moves it.
    """
    system = free.system
    times_mass = _mass(system)
    forces, vectors = [system.loads()[0]], [free.displacement.vec]
    for number in range(_SOLUTIONS + 1):
        force, vector = forces[number], vectors[number]
        for one, other in zip(forces[:number], vectors[:number], strict=True):
            share = float(ng.InnerProduct(times_mass(other), vector))
            force.data -= share * one
            vector.data -= share * other
        size = sqrt(ng.InnerProduct(times_mass(vector), vector))
        force *= 1 / size
        vector *= 1 / size
        if number < _SOLUTIONS:
            forces.append(times_mass(vector))
            vectors.append(system.solve(forces[-1]))
    stiffness = np.array([[ng.InnerProduct(f, u) for u in vectors] for f in forces])
    mass = np.array([[ng.InnerProduct(times_mass(u), w) for w in vectors] for u in vectors])
    squares, shapes = eigh((stiffness + stiffness.T) / 2, (mass + mass.T) / 2)
    rotation = ng.GridFunction(system.space)
    rotation.Set(ng.CF((-ng.y, ng.x, 0)))
    turned = times_mass(rotation.vec)
    moved = shapes.T @ np.array([ng.InnerProduct(turned, u) for u in vectors])
    return sqrt(squares[int(np.argmax(moved**2))]) / (2 * pi)


def _mass(system: System) -> Any:
    """Return the product with the mass matrix, which is equal for each component."""
    scalar = ng.H1(system.space.mesh, order=system.order)
    u, v = scalar.TnT()
    form = ng.BilinearForm(scalar, symmetric=True, symmetric_storage=True)
    form += system.material.density * 1e-12 * u * v * ng.dx
    form.Assemble()

    def times(vector: Any) -> Any:
        result = vector.CreateVector()
        for component in range(3):
            part = slice(component * scalar.ndof, (component + 1) * scalar.ndof)
            result[part].data = form.mat * vector[part]
        return result

    return times


def checked(step: bytes, shaft: Shaft) -> dict[str, Any]:
    """Return the results of one shaft up to one order more than `truth` uses.

    The results are the limits without this order, with it, and with one layer less.
    """
    grid = layered_grid(read_solid(step, shaft), LAYERS)
    usual = SHARP_ORDERS if grid.is_sharp else ORDERS
    found = [outputs_by(grid, order, shaft, CHECKED) for order in (*usual, usual[-1] + 1)]
    table = {
        "elements": grid.mesh.ne,
        "is sharp": grid.is_sharp,
        "ratio": RATIO,
        "by order": {str(order): values for order, values in enumerate(found, start=2)},
        "truth": extrapolated(found[:-1]),
        "with an order more": extrapolated(found[-3:]),
    }
    if grid.is_sharp:
        fewer = layered_grid(read_solid(step, shaft), LAYERS - 1)
        table["with a layer less"] = extrapolated(
            [outputs_by(fewer, order, shaft, CHECKED) for order in usual]
        )
    return table


CHECKED = ("stiffness", "bending stiffness")


def main(numbers: list[int]) -> None:
    """Check the reference values of some stored shafts, print and store the result."""
    from benchmarks.torsion_levels import RESULTS as SHAFTS
    from benchmarks.torsion_levels import drawn

    rows = json.loads(SHAFTS.read_text())["rows"]
    kept = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    for number in numbers:
        row = rows[number]
        kept[str(number)] = checked(*drawn(row["model"], row["parameters"]))
        RESULTS.write_text(json.dumps({key: kept[key] for key in sorted(kept, key=int)}, indent=1) + "\n")
        print(number, json.dumps(kept[str(number)]), flush=True)


if __name__ == "__main__":
    main([int(one) for one in sys.argv[1:]])
