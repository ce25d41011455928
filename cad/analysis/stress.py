"""The greatest stress of a loaded shaft and its convergence; without convergence there is no result.

The mesh is refined where the stress is high. Elements of second order find the place on each mesh, at a
quarter of the cost of the third. From the third mesh on, once a refinement changes the stress little, third
order confirms it on the same mesh. The stress has converged if the confirmed value is nearly that of second
order, or nearly that confirmed on a mesh before. A single small change may be a coincidence, so both the
refinement and one of these changes must be small. The compared stress is recovered: polynomials of
neighbouring elements are averaged where they meet (Zienkiewicz and Zhu 1992). At a sharp inner corner it is
unbounded and each refinement raises it by a quarter, so the analysis gives no value, and names the corner as
the reason. The search omits the regions near the ends, where the idealised clamp or load disturbs the field
(de Saint-Venant's principle). If a fillet or a web begins closer to an end, the search begins there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import ngsolve as ng
import numpy as np

from cad.analysis.elastic import Response, System, respond, stress
from cad.analysis.kinds import Boundary, Kind
from cad.analysis.mesh import Fineness, Grid, Near, make_grid, sharp_edges
from cad.analysis.solid import FREE, HELD, LOADED, Solid
from cad.errors import AnalysisError
from cad.shaft import Material
from templates.core.arrays import Array

Components = list[Any]  # xx, yy, zz, xy, yz, xz of a stress, each a function on the mesh
Measure = Callable[[Components], Any]

START = Fineness(size=0.7, curvature=0.8, turn=np.pi / 4)
ORDERS = (2, 3)  # of the elements that find the greatest stress, and of those that confirm it
LEAST, MOST = 3, 6  # number of meshes
SMALL, CONVERGED = 0.1, 0.01  # largest relative change by the last refinement, and of the confirmed value
FLOOR = 0.008  # relative error that the last change does not show (docs/finite_elements.md)

_END_ZONE = 0.3  # stresses within this share of the loaded end's radius are ignored
_PLAIN = 0.9  # nor within this share of the distance from an end to the next faces, if that is less
_TOUCHES = 1e-3  # [mm]: a face that begins within this distance of an end touches it
_HIGH = (0.85, 0.85, 0.9)  # share of the highest stress on each mesh above which elements are halved


@dataclass(frozen=True)
class Peak:
    """The greatest stress on one mesh."""

    value: float  # [MPa] under 1 N·mm
    point: tuple[float, float, float]  # [mm]
    elements: int
    degrees_of_freedom: int
    order: int


@dataclass(frozen=True)
class Peaks:
    """The greatest stress on each mesh, and by each order of the elements if the mesh has two."""

    steps: tuple[Peak, ...]

    @property
    def error(self) -> float:
        """Return the estimated relative error of the last value: its `change` plus `FLOOR`."""
        return self.change + FLOOR

    @property
    def change_by_mesh(self) -> float:
        """Return the relative change by the last refinement, in elements of the lower order."""
        return _last_change(self._values(ORDERS[0]))

    @property
    def change(self) -> float:
        """Return the smaller relative change of the last confirmed value: by its order or by refinement."""
        if not self.steps or self.steps[-1].order != ORDERS[1]:
            return 1.0
        return min(_last_change([peak.value for peak in self.steps]), _last_change(self._values(ORDERS[1])))

    @property
    def is_steady(self) -> bool:
        """Return whether the last of enough refinements changed the value little."""
        return len(self._values(ORDERS[0])) >= LEAST and self.change_by_mesh <= SMALL

    @property
    def converged(self) -> bool:
        """Return whether the last refinement changed the value little, and the confirmed value less."""
        return self.is_steady and self.change <= CONVERGED

    def _values(self, order: int) -> list[float]:
        return [peak.value for peak in self.steps if peak.order == order]


def _last_change(values: list[float]) -> float:
    return abs(values[-1] - values[-2]) / values[-1] if len(values) > 1 else 1.0


def von_mises(components: Components) -> Any:
    """Return the equivalent stress by von Mises (1913)."""
    xx, yy, zz, xy, yz, xz = components
    apart = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return ng.sqrt(apart / 2 + 3 * (xy**2 + yz**2 + xz**2))


def greatest_stress(
    solid: Solid,
    material: Material,
    load: Kind,
    boundary: Boundary,
    report: Callable[[int], None],
    measure: Measure = von_mises,
) -> Peaks:
    """Refine the mesh where the stress is high until its greatest value converges."""
    peaks = Peaks(())
    near: tuple[Near, ...] = ()
    edges = sharp_edges(solid, START)

    def places_on(grid: Grid, order: int) -> Places:
        """Return the places by one order; its system is released on return, so that only one is in memory."""
        system = System(grid, order, material, load, few_forces=True)
        return _places_on(respond(system, boundary), measure)

    for step in range(MOST):
        report(step)
        grid = make_grid(solid, START, near, edges)
        for order in ORDERS:
            places = places_on(grid, order)
            peaks = Peaks((*peaks.steps, places.peak))
            if not peaks.is_steady:
                break
        if peaks.converged:
            break
        near += places.high(_HIGH[min(step, len(_HIGH) - 1)])
    return peaks


@dataclass(frozen=True)
class Places:
    """The greatest stress on a mesh, and the surface elements with nearly as much stress."""

    peak: Peak
    corners: Array  # (elements, 3, 3) [mm]
    values: Array  # (elements,) the highest stress in each element [MPa] under 1 N·mm

    def high(self, share: float) -> tuple[Near, ...]:
        """Return the elements to refine: those whose stress exceeds a share of the greatest stress."""
        return tuple(_halved(one) for one in self.corners[self.values > share * self.peak.value])


def _places_on(response: Response, measure: Measure) -> Places:
    """Return the greatest recovered stress away from the ends, with its places.

    Raises
    ------
    AnalysisError
        `no_free_length` if the whole solid is close to its ends.
    """
    system = response.system
    mesh, solid = system.grid.mesh, system.grid.solid
    points, values = _on_surface(system, measure(recover(response)))
    low, high = searched(solid)
    inside = (points[..., 2] > low) & (points[..., 2] < high)
    if not inside.any():
        detail = "the shaft is so short that all of it is close to its ends; lengthen its ends"
        raise AnalysisError("no_free_length", detail)
    values = np.where(inside, values, -np.inf)
    element, place = np.unravel_index(int(np.argmax(values)), values.shape)
    x, y, z = (float(c) for c in points[element, place])
    peak = Peak(float(values[element, place]), (x, y, z), mesh.ne, system.space.ndof, system.order)
    return Places(peak, _corners(mesh), values.max(axis=1))


def searched(solid: Solid) -> tuple[float, float]:
    """Return the range of z [mm] in which the greatest stress is searched."""
    ends = [face.center.z for face in solid.shape.faces if face.name in (HELD, LOADED)]
    low, high = min(ends), max(ends)
    extents = [_extent(face) for face in solid.shape.faces if face.name == FREE]
    begins = [first for first, _ in extents if first > low + _TOUCHES]
    stops = [last for _, last in extents if last < high - _TOUCHES]
    zone = _END_ZONE * solid.radius
    return (
        low + min(zone, _PLAIN * (min(begins, default=high) - low)),
        high - min(zone, _PLAIN * (high - max(stops, default=low))),
    )


def _extent(face: Any) -> tuple[float, float]:
    """Return the range of z [mm] of a face from its edges; the kernel's boxes of curved faces are larger."""
    levels = []
    for edge in face.edges:
        if edge.mass > 0:
            start, end = edge.parameter_interval
            levels += [edge.Value(t).z for t in np.linspace(start, end, 5)]
    return min(levels), max(levels)


def _on_surface(system: System, field: Any) -> tuple[Array, Array]:
    """Return points (elements, places, 3) [mm] on the free surface, and the values of a field there."""
    mesh = system.grid.mesh
    where = mesh.MapToAllElements(ng.IntegrationRule(ng.TRIG, 2 * system.order), mesh.Boundaries(FREE))
    count = len(_corners(mesh))
    points = np.column_stack([np.ravel(axis(where)) for axis in (ng.x, ng.y, ng.z)])
    return points.reshape(count, -1, 3), np.ravel(field(where)).reshape(count, -1)


def _corners(mesh: Any) -> Array:
    """Return the corners (elements, 3, 3) [mm] of the elements on the free surface."""
    elements = mesh.Boundaries(FREE).Elements()
    return np.array([[mesh[v].point for v in element.vertices] for element in elements])


def _halved(corners: Array) -> Near:
    size = float(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).mean())
    x, y, z = (float(c) for c in corners.mean(axis=0))
    return Near((x, y, z), size / 2, size / 2)


def recover(response: Response) -> Components:
    """Return the stress components xx, yy, zz, xy, yz, xz [MPa], continuous across elements."""
    system = response.system
    raw = stress(response.displacement, system.material)
    places = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
    space = ng.H1(system.grid.mesh, order=system.order - 1)
    together = ng.GridFunction(ng.H1(system.grid.mesh, order=system.order - 1, dim=len(places)))
    together.Set(ng.CF(tuple(raw[place] for place in places)))  # one call takes a third of the time
    components = []
    for values in together.vec.FV().NumPy().reshape(-1, len(places)).T:
        component = ng.GridFunction(space)
        component.vec.FV().NumPy()[:] = values
        components.append(component)
    return components
