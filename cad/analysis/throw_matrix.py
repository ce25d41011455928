"""Compute the stiffness and mass matrices of one crank throw in a chain by finite elements.

The throw reaches from mid-main to mid-main: z = ±half, its pin at (throw, 0) and z = `middle`, which is 0
except for split pins, where the pin is the front one. Its degrees of freedom are the mean displacement [mm]
and rotation [rad] of each end section, six each, and the two displacements of the pin across the shaft. Each
mean is conjugate to a load: a displacement to a uniform traction, a rotation to a linear traction.

One end is held; there are eight unit loads, six on the other end and two on the pin. Their displacements are
the flexibility F [8, 8]. T [8, 14] maps the degrees of freedom to displacements relative to the rigid motion
of the first end. The stiffness is K = Tᵀ F⁻¹ T, so a rigid motion causes no force. The mass matrix uses the
same fields (rigid motions and responses to loads), so for rigid motions it gives the mass and inertia of the
solid.

Lengths are in mm, forces in N, masses in t.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import ngsolve as ng
import numpy as np

from cad.analysis.elastic import System
from cad.analysis.mesh import Grid
from cad.analysis.solid import FREE, LOADED
from cad.shaft import PinPlace, Shaft
from templates.core.arrays import Array

END, PIN = 6, 2
FREEDOMS = 2 * END + PIN

_AXES = (ng.CF((1, 0, 0)), ng.CF((0, 1, 0)), ng.CF((0, 0, 1)))
_INSIDE = 1e-4  # relative to the radius: distance by which a point on the pin's surface may lie outside it


@dataclass(frozen=True)
class ThrowMatrix:
    """Stiffness and mass [14, 14] of a throw; its degrees of freedom are those of both ends and the pin."""

    stiffness: Array
    mass: Array
    pitch: float  # [mm]
    throw: float  # [mm]
    degrees_of_freedom: int = 0  # of the elements from which the matrix was computed


def matrix_on(grid: Grid, order: int, shaft: Shaft, pin: PinPlace) -> ThrowMatrix:
    """Return the stiffness and mass matrices of a throw, computed on its mesh with elements of an order."""
    system = System(grid, order, shaft.material, "torsion")
    pitch = shaft.loaded - shaft.held
    loads = [*(system.traction(field) for field in section_loads(system, LOADED)), *_on_the_pin(system, pin)]
    moved = [system.solve(load) for load in loads]
    flexibility = np.array([[ng.InnerProduct(load, u) for u in moved] for load in loads])
    relative = relative_motion(pitch, pin.throw, pin.middle)
    forces = np.linalg.solve((flexibility + flexibility.T) / 2, relative)
    basis = np.vstack([np.eye(END, FREEDOMS), forces])
    return ThrowMatrix(
        stiffness=relative.T @ forces,
        mass=basis.T @ _mass(system, shaft.held, moved) @ basis,
        pitch=pitch,
        throw=pin.throw,
        degrees_of_freedom=system.space.ndof,
    )


def section_loads(system: System, name: str) -> list[Any]:
    """Return tractions of unit forces and moments on a flat section across z with its centre on the axis."""
    mesh = system.grid.mesh
    area, about_x, about_y = (
        ng.Integrate(weight * ng.ds(name), mesh) for weight in (ng.CF(1), ng.y * ng.y, ng.x * ng.x)
    )
    moments = (
        ng.CF((0, 0, ng.y)) / about_x,
        ng.CF((0, 0, -ng.x)) / about_y,
        ng.CF((-ng.y, ng.x, 0)) / (about_x + about_y),
    )
    return [*(axis / area for axis in _AXES), *moments]


def relative_motion(pitch: float, throw: float, middle: float = 0.0) -> Array:
    """Return displacements per degree of freedom, relative to the first end as a rigid body, (8, 14)."""
    lever = pitch / 2 + middle
    relative = np.zeros((END + PIN, FREEDOMS))
    relative[:, END:] = np.eye(END + PIN)
    relative[:END, :END] = -np.eye(END)
    relative[0, 4], relative[1, 3] = -pitch, pitch
    relative[6, 0], relative[6, 4] = -1, -lever
    relative[7, 1], relative[7, 3], relative[7, 5] = -1, lever, -throw
    return relative


def _on_the_pin(system: System, pin: PinPlace) -> list[Any]:
    """Return the vectors of unit forces along x and y, spread uniformly over the surface of the pin."""
    off = (ng.x - pin.throw) ** 2 + ng.y**2
    on_it = ng.IfPos((1 + _INSIDE) ** 2 * pin.radius**2 - off, 1.0, 0.0)
    outside = ng.IfPos(off - (1 - _INSIDE) ** 2 * pin.radius**2, 1.0, 0.0)
    along = ng.IfPos((pin.length / 2) ** 2 - (ng.z - pin.middle) ** 2, 1.0, 0.0)
    here = on_it * outside * along
    area = ng.Integrate(here * ng.ds(FREE), system.grid.mesh)
    vectors = []
    for axis in _AXES[:PIN]:
        v = system.space.TestFunction()
        force = ng.LinearForm(system.space)
        force += here / area * axis * v.Trace() * ng.ds(FREE)
        force.Assemble()
        vectors.append(force.vec)
    return vectors


def _mass(system: System, held: float, moved: list[Any]) -> Array:
    """Return mass products [14, 14] of the rigid motions of the held end and the responses to loads."""
    u, v = system.space.TnT()
    form = ng.BilinearForm(system.space, symmetric=False)
    form += system.material.density * 1e-12 * ng.InnerProduct(u, v) * ng.dx
    form.Assemble()
    z = ng.z - held
    rotations = (ng.CF((0, -z, ng.y)), ng.CF((z, 0, -ng.x)), ng.CF((-ng.y, ng.x, 0)))
    fields = []
    for motion in (*_AXES, *rotations):
        field = ng.GridFunction(system.space)
        field.Set(motion)
        fields.append(field.vec)
    fields += moved
    products = np.zeros((len(fields), len(fields)))
    done = form.mat.CreateColVector()
    for row, field in enumerate(fields):
        done.data = form.mat * field
        products[row] = [ng.InnerProduct(done, other) for other in fields]
    return (products + products.T) / 2
