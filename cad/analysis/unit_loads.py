"""Compute stress tensors at points of a throw under unit loads, which can be superposed for any load history.

There are five loads, each of 1 N or 1 N·mm, in axes that turn with the throw. The throw is held at one end
face.

`force_1`, `force_2`     act on the pin, along the throw (x) and across it (y), with the two mains as
                         supports: the loaded end carries its share by the lever rule, so only the torque
                         of force 2 reaches the held end
`moment_1`               is a torque about z from the loaded end to the held one
`moment_2`, `moment_3`   are bending moments about x and y, from end to end

A force on the pin is spread over its whole plain cylinder, along z as cos². The real contact pressure of the
rod differs and is not modelled: only its resultant matters at the fillets (de Saint-Venant). By linear
elasticity, the stress under any loads is the sum of these tensors, each times its load.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi
from typing import Any

import ngsolve as ng
import numpy as np

from cad.analysis.elastic import Response, System
from cad.analysis.mesh import Fineness, make_grid
from cad.analysis.solid import FREE, LOADED, read_solid
from cad.analysis.stress import recover
from cad.errors import AnalysisError
from cad.fillets import Crank, Ring
from cad.shaft import Shaft
from templates.core.arrays import Array, Integers

__all__ = ["LOADS", "Crank", "LoadedThrow", "Ring", "UnitStresses", "fillet_stresses"]

LOADS = ("force_1", "force_2", "moment_1", "moment_2", "moment_3")
FINENESS = Fineness(size=0.7, curvature=0.8, turn=pi / 4)
ORDER = 3

_ON_PIN = 1e-3  # relative to the radius: distance within which a point lies on the pin's cylinder


@dataclass(frozen=True)
class UnitStresses:
    """Stress tensors at points of the fillets under unit loads."""

    points: Array  # [point, 3] [mm]
    tensors: dict[str, Array]  # for each load: [point, 6], xx, yy, zz, xy, yz, xz [MPa] under 1 N or 1 N·mm
    elements: int


class LoadedThrow:
    """A throw with its mesh, prepared for any of the loads."""

    def __init__(
        self, step: bytes, shaft: Shaft, crank: Crank, fineness: Fineness = FINENESS, order: int = ORDER
    ) -> None:
        solid = read_solid(step, shaft, mirrors=())
        self.crank, self.shaft = crank, shaft
        grid = make_grid(solid, fineness)
        self.system = System(grid, order, shaft.material, "torsion")

    def _lever(self) -> float:
        """Return the share of a force at mid-pin that the support at the loaded end carries."""
        return -self.shaft.held / (self.shaft.loaded - self.shaft.held)

    def _on_pin(self) -> ng.CF:
        """Return the distribution of a force over the plain cylinder of the pin, largest in the middle."""
        crank = self.crank
        away = (ng.x - crank.throw) ** 2 + ng.y**2
        low, high = ((crank.pin_radius * (1 + side * _ON_PIN)) ** 2 for side in (-1, 1))
        beside = ng.IfPos(away - low, 1, 0) * ng.IfPos(high - away, 1, 0)
        along = ng.IfPos(crank.plain / 2 - ng.sqrt(ng.z**2), ng.cos(pi * ng.z / crank.plain) ** 2, 0)
        return beside * along

    def _pin_force(self, direction: int) -> Any:
        """Return the force vector of 1 N on the pin along x (0) or y (1).

        Raises
        ------
        AnalysisError
            `no_pin` if the pin has no plain cylinder at its stated position.
        """
        unit = ng.CF(tuple(float(axis == direction) for axis in range(3)))
        v = self.system.space.TestFunction()
        form = ng.LinearForm(self.system.space)
        form += self._on_pin() * unit * v.Trace() * ng.ds(FREE, bonus_intorder=4)
        form.Assemble()
        moved = ng.GridFunction(self.system.space)
        moved.Set(unit)
        total = float(ng.InnerProduct(form.vec, moved.vec))
        if total <= 0:
            raise AnalysisError("no_pin", "the pin has no plain cylinder between its fillets")
        form.vec.data /= total
        return form.vec

    def force(self, loads: Mapping[str, float]) -> Any:
        """Return the force vector of loads [N, N·mm] that act together."""
        mesh = self.system.grid.mesh
        area = ng.Integrate(ng.CF(1) * ng.ds(LOADED), mesh)
        across, up = (ng.Integrate(axis**2 * ng.ds(LOADED), mesh) for axis in (ng.x, ng.y))
        f_1, f_2, m_1, m_2, m_3 = (loads.get(name, 0.0) for name in LOADS)
        back, twist = -self._lever() / area, m_1 / (across + up)
        end = ng.CF((
            back * f_1 - twist * ng.y, back * f_2 + twist * ng.x, m_2 * ng.y / up - m_3 * ng.x / across
        ))  # fmt: skip
        total = self.system.traction(end)
        for direction, force in enumerate((f_1, f_2)):
            if force:
                total.data += force * self._pin_force(direction)
        return total

    def response(self, loads: Mapping[str, float]) -> Response:
        """Return the displacement under loads [N, N·mm] that act together."""
        displacement = ng.GridFunction(self.system.space)
        displacement.vec.data = self.system.solve(self.force(loads))
        return Response(self.system, 0.0, displacement, (), (), np.zeros((0, 0)))

    def on_surface(self, response: Response) -> tuple[Array, Array]:
        """Return points [n, 3] [mm] of the free surface, and recovered stress tensors [n, 6] [MPa] there."""
        mesh = self.system.grid.mesh
        where = mesh.MapToAllElements(
            ng.IntegrationRule(ng.TRIG, 2 * self.system.order), mesh.Boundaries(FREE)
        )
        points = np.column_stack([np.ravel(axis(where)) for axis in (ng.x, ng.y, ng.z)])
        return points, np.column_stack([np.ravel(part(where)) for part in recover(response)])


def fillet_stresses(throw: LoadedThrow, before: Callable[[str], None] | None = None) -> UnitStresses:
    """Return the tensors of all unit loads at the point of highest stress in each sector of the fillets.

    The point of highest stress has the largest ratio of von Mises stress under any load to the maximum of
    that load. The function `before` receives the name of each load before it is solved.

    Raises
    ------
    AnalysisError
        `no_fillet` if the throw has none.
    """
    if throw.crank.fillet <= 0:
        raise _no_fillet()
    everywhere = {}
    for load in LOADS:
        if before:
            before(load)
        points, everywhere[load] = throw.on_surface(throw.response({load: 1.0}))
    chosen = _chosen(points, everywhere, throw.crank.rings())
    if not len(chosen):
        raise _no_fillet()
    tensors = {load: values[chosen] for load, values in everywhere.items()}
    return UnitStresses(points[chosen], tensors, throw.system.grid.mesh.ne)


def _no_fillet() -> AnalysisError:
    return AnalysisError("no_fillet", "stress has no limit at a sharp inner corner; give the throw a fillet")


def _chosen(points: Array, tensors: dict[str, Array], rings: tuple[Ring, ...]) -> Integers:
    inside = [np.flatnonzero(ring.holds(points)) for ring in rings]
    used = np.concatenate(inside)
    if not len(used):
        return used
    use = np.zeros(len(points))
    for values in tensors.values():
        stress = _von_mises(values)
        use = np.maximum(use, stress / stress[used].max())
    chosen = []
    for ring, places in zip(rings, inside, strict=True):
        sectors = ring.sectors(points[places])
        for sector in np.unique(sectors):
            here = places[sectors == sector]
            chosen.append(here[np.argmax(use[here])])
    return np.array(chosen, dtype=np.intp)


def _von_mises(tensors: Array) -> Array:
    xx, yy, zz, xy, yz, xz = tensors.T
    apart = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.asarray(np.sqrt(apart / 2 + 3 * (xy**2 + yz**2 + xz**2)))
