"""Mesh a solid with curved tetrahedra: coarse where the shape is simple, finer at its curved edges.

Elements are isoparametric: with a lower order of curvature, a cylinder is 0.2 % too stiff; with a higher
order, the elements cannot represent a rotation. Because elements are curved, a mesh can be much coarser than
one for display. Three measures make that safe. Each curved edge has a minimum number of segments; otherwise
one chord could span the rim of a bore through its middle. Along sharp inner edges, where stress is unbounded
and a higher order gains little, elements are small (`cad.analysis.corners`). Harmonic functions extend the
curvature of the surface into the interior: Netgen curves only surface elements, which folds thin elements
under a fillet (46 of 2 000 elements in a throw; 6 with this measure). The remaining folded elements only add
stiffness, which the estimated error includes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import ceil, pi
from typing import Any

import ngsolve as ng
import numpy as np
from netgen.meshing import MeshingParameters
from netgen.occ import OCCGeometry

from cad.analysis.corners import NONE, Edges, along, sharp_inner_edges
from cad.analysis.element_count import element_sizes, estimated_elements
from cad.analysis.solid import FREE, Solid, planar
from cad.errors import AnalysisError

MOST_ELEMENTS = 60_000

ONE_THREAD = {"parallel_meshing": False}
"""On several threads Netgen makes the same mesh, but waits in busy loops: 3 to 7 times the processor time."""

_GRADING = 0.5  # growth rate from one element to the next
_SAMPLES = 16  # points on an edge, to measure its angle
_BELOW = 0.9  # share of a size below which another one counts as smaller


@dataclass(frozen=True)
class Fineness:
    """Parameters of the element sizes of a mesh."""

    size: float  # size of the largest elements, relative to the solid
    curvature: float  # elements per radius of curvature
    turn: float  # [rad], largest angle of one segment of an edge
    sharp: float = 0.15  # size of elements at sharp inner edges, relative to the edge's radius or the solid
    least: float = 0.0  # smallest elements at fillets and sharp edges, relative to the solid


@dataclass(frozen=True)
class Near:
    """A limit on the element size [mm] within a distance [mm] of a point [mm]."""

    point: tuple[float, float, float]
    reach: float
    size: float


@dataclass(frozen=True)
class Grid:
    """A mesh of a solid with straight elements."""

    mesh: Any
    solid: Solid
    is_sharp: bool = False  # whether the solid has sharp inner edges
    is_resolved: bool = True  # whether elements are as small as curvature and sharp edges require


def make_grid(
    solid: Solid, fineness: Fineness, near: Iterable[Near] = (), edges: Edges | None = None
) -> Grid:
    """Mesh a solid.

    If several meshes have the same fineness, pass the result of `sharp_edges` as `edges`. Elements at a
    fillet too small for `least` are wider than it curves: a stiffness permits this, a stress does not.

    Raises
    ------
    AnalysisError
        `mesh` if Netgen fails, or the mesh is too large for a job.
    """
    edges = sharp_edges(solid, fineness) if edges is None else edges
    parameters = sizes(solid, fineness, near, edges)
    mesh = meshed(solid.shape, parameters, fineness.size * solid.scale)
    return Grid(mesh, solid, len(edges.ends) > 0, edges.smallest == 0)


def sizes(solid: Solid, fineness: Fineness, near: Iterable[Near], edges: Edges) -> MeshingParameters:
    """Return the prescribed sizes of elements: at large, by curvature, near places and along sharp edges."""
    parameters = MeshingParameters(
        maxh=fineness.size * solid.scale,
        minh=edges.smallest,
        grading=_GRADING,
        curvaturesafety=fineness.curvature,
        **ONE_THREAD,
    )
    for place in near:
        for point in _ball(place):
            parameters.RestrictH(*point, place.size)
    for point, size in along(edges, fineness.sharp):
        parameters.RestrictH(*point, size)
    return parameters


def meshed(shape: Any, parameters: MeshingParameters, largest: float) -> Any:
    """Mesh a shape with straight elements, none larger than `largest` [mm], unless they would be too many.

    Raises
    ------
    AnalysisError
        `mesh` if Netgen fails, or the mesh would be too large for a job.
    """
    with _meshing():
        elements = estimated_elements(shape, parameters, largest, MOST_ELEMENTS)
        if elements <= MOST_ELEMENTS:
            return ng.Mesh(OCCGeometry(shape).GenerateMesh(parameters))
    detail = (
        f"the mesh would have more than {MOST_ELEMENTS} elements: ask for less accuracy, or draw what is "
        "smallest (a fillet, a drilling) larger or not at all"
    )
    raise AnalysisError("mesh", detail)


def sharp_edges(solid: Solid, fineness: Fineness) -> Edges:
    """Return the sharp inner edges of a solid, divided into pieces as long as the elements of a fineness.

    Raises
    ------
    AnalysisError
        `mesh` if Netgen fails.
    """
    bound_sizes(solid, fineness)
    with _meshing():
        return sharp_inner_edges(solid.shape, solid.scale, _smallest(solid, fineness))


def _smallest(solid: Solid, fineness: Fineness) -> float:
    """Return the size [mm] below which no elements are made; 0 if none would be.

    Segments of edges longer than that, such as the rim of a drilling, may be smaller than `least`.
    """
    least = fineness.least * solid.scale
    edges = [edge for edge in solid.shape.edges if edge.mass > 0]
    smallest = min([least, *(_limits(edge, fineness.turn)[1] for edge in edges if edge.mass > least)])
    if not smallest:
        return 0.0
    size_at = element_sizes(solid.shape, sizes(solid, fineness, (), NONE))
    middles = [edge.Value(sum(edge.parameter_interval) / 2) for edge in edges]
    return smallest if any(size_at((p.x, p.y, p.z)) < _BELOW * smallest for p in middles) else 0.0


@contextmanager
def _meshing() -> Iterator[None]:
    """Convert a failure of Netgen into an analysis error about the solid."""
    try:
        yield
    except Exception as error:  # Netgen raises no more specific exception
        raise AnalysisError("mesh", f"Netgen could not mesh the solid: {error}") from error


def curve(mesh: Any, order: int) -> Any:
    """Curve a mesh to fit its geometry, smoothly into the interior; return the deformation that does this."""
    mesh.UnsetDeformation()
    curved = _coordinates(mesh, order)
    mesh.Curve(1)
    scalar = ng.H1(mesh, order=order, dirichlet=".*")
    straight = _straight_coordinates(mesh, scalar)
    u, v = scalar.TnT()
    laplace = ng.BilinearForm(scalar, symmetric=True, symmetric_storage=True)
    laplace += ng.InnerProduct(ng.grad(u), ng.grad(v)) * ng.dx
    laplace.Assemble()
    inverse = laplace.mat.Inverse(scalar.FreeDofs(), inverse="sparsecholesky")
    deformation = ng.GridFunction(ng.VectorH1(mesh, order=order))
    for component, flat, round_ in zip(deformation.components, straight, curved, strict=True):
        shift = flat.CreateVector()
        shift.data = round_ - flat
        shift.data -= inverse * (laplace.mat * shift).Evaluate()
        component.vec.data = shift
    mesh.SetDeformation(deformation)
    return deformation


def _straight_coordinates(mesh: Any, space: Any) -> list[Any]:
    """Return the coordinates in straight elements, interpolated from their corners."""
    corners = np.array([vertex.point for vertex in mesh.vertices])
    vectors = []
    for values in corners.T:
        vector = ng.GridFunction(space).vec
        vector[:] = 0.0
        vector.FV().NumPy()[: len(values)] = values
        vectors.append(vector)
    return vectors


def _coordinates(mesh: Any, order: int) -> list[Any]:
    """Return the coordinates in curved elements as finite-element functions."""
    mesh.Curve(order)
    together = ng.GridFunction(ng.H1(mesh, order=order, dim=3))
    together.Set(ng.CF((ng.x, ng.y, ng.z)))  # one call takes a quarter of the time
    scalar = ng.H1(mesh, order=order)
    vectors = []
    for values in together.vec.FV().NumPy().reshape(-1, 3).T:
        vector = ng.GridFunction(scalar).vec
        vector.FV().NumPy()[:] = values
        vectors.append(vector)
    return vectors


def bound_sizes(solid: Solid, fineness: Fineness) -> None:
    """Limit the size of elements along curved edges, and on curved faces bounded by full circles."""
    limits: dict[Any, tuple[float, float]] = {}  # for each edge: angle that it turns, and its longest segment
    for face in solid.shape.faces:
        rims = []
        for edge in face.edges:
            if edge not in limits:
                limits[edge] = _limits(edge, fineness.turn)
            turn, longest = limits[edge]
            if turn > fineness.turn:
                edge.maxh = longest
                rims += [longest] if turn > 0.6 * pi else []
        if rims and face.name == FREE and not planar(face):
            face.maxh = min(face.maxh, 1.3 * min(rims))


def _limits(edge: Any, most: float) -> tuple[float, float]:
    """Return the total turning angle [rad] of an edge, and the longest segment [mm] allowed on it."""
    length = edge.mass
    turn = _turning(edge) if length > 0 else 0.0
    return turn, length / ceil(turn / most - 1e-6) if turn > most else length


def _turning(edge: Any) -> float:
    """Return the angle [rad] by which the direction of an edge turns from start to end."""
    start, end = edge.parameter_interval
    points = np.array([[*edge.Value(t)] for t in np.linspace(start, end, _SAMPLES + 1)])
    steps = np.diff(points, axis=0)
    steps /= np.linalg.norm(steps, axis=1)[:, None]
    angles = np.arccos(np.clip(np.sum(steps[1:] * steps[:-1], axis=1), -1, 1))
    return float(angles.sum()) * _SAMPLES / (_SAMPLES - 1)


def _ball(near: Near) -> Iterable[tuple[float, float, float]]:
    """Yield points that fill a ball densely enough for the size limit to apply between them."""
    count = max(1, ceil(near.reach / near.size))
    line = np.linspace(-near.reach, near.reach, 2 * count + 1)
    grid = np.stack(np.meshgrid(line, line, line), axis=-1).reshape(-1, 3)
    inside = grid[np.linalg.norm(grid, axis=1) <= near.reach]
    for x, y, z in inside + np.array(near.point):
        yield float(x), float(y), float(z)
