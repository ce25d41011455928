"""A stepped shaft by elements in its half plane (r, z), as a second method to `cad.analysis`.

A body of revolution under a bending moment moves in the first harmonic: u_r = U cos θ, u_θ = V sin θ,
u_z = W cos θ, with U, V and W in the half plane (Wilson 1965). In torsion u_θ = r ψ is all there is
(Timoshenko and Goodier 1970). The unknowns are U, v = (U + V)/r and w = W/r: so no strain divides by r, and
the axis needs no conditions. Elements are of sixth order on a graded mesh of the half plane. Nothing but the
library's elements is shared with `cad.analysis`: not the mesh, the symmetry, the curving, the solver, nor the
recovery of stress.

References
----------
E. L. Wilson, Structural analysis of axisymmetric solids, AIAA Journal 3, 1965, p. 2269.
S. P. Timoshenko and J. N. Goodier, Theory of Elasticity, 3rd edition, 1970, § 119.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import ngsolve as ng
import numpy as np
from netgen.geom2d import SplineGeometry

from cad.analysis.kinds import Boundary, Kind
from cad.shaft import STEEL_MATERIAL, Material
from tests.references.shoulder_fillet import END, FILLET, LOADS, NARROW, SHOULDER, WIDE, peaks

ORDER = 6
_LARGEST, _AT_FILLET = 8.0, 0.7  # [mm], of elements
_INSIDE, _PLACES = 1e-6, 400  # [mm]; points at which the stress of the fillet is read


@dataclass(frozen=True)
class HalfPlane:
    """A shaft with one step, z from 0 (held) to `end` (loaded) [mm]; no fillet and no step is a cylinder."""

    wide: float = WIDE / 2
    narrow: float = NARROW / 2
    shoulder: float = SHOULDER
    fillet: float = FILLET
    end: float = END

    def mesh(self) -> Any:
        """Triangles in (r, z), small at the fillet, curved as it is."""
        geometry = SplineGeometry()
        outline = [(0.0, 0.0), (self.wide, 0.0)]
        if self.wide > self.narrow:
            outline += [(self.wide, self.shoulder), (self.narrow + self.fillet, self.shoulder)]
            outline += [(self.narrow, self.shoulder), (self.narrow, self.shoulder + self.fillet)]
        outline += [(self.narrow, self.end), (0.0, self.end)]
        number = [geometry.AppendPoint(*point) for point in outline]
        last = len(outline) - 1
        names = {0: "held", last - 1: "loaded", last: "axis"}
        at, after = 0, 0
        while at <= last:
            is_fillet = last > 3 and at == 3
            after = at + (2 if is_fillet else 1)
            run = [number[k % (last + 1)] for k in range(at, after + 1)]
            kind, name = ("spline3", "fillet") if is_fillet else ("line", names.get(at, "free"))
            options = {"maxh": _AT_FILLET} if is_fillet else {}
            geometry.Append([kind, *run], bc=name, leftdomain=1, rightdomain=0, **options)
            at = after
        mesh = ng.Mesh(geometry.GenerateMesh(maxh=_LARGEST, grading=0.3))
        mesh.Curve(ORDER)
        return mesh


@dataclass(frozen=True)
class Solved:
    """A unit load of 1 N·mm: its rotation, and the stress at the fillet."""

    stiffness: float  # [N·m/rad]
    stress: float  # greatest first principal (bending), greatest von Mises (torsion) [MPa]


def bending(half: HalfPlane, boundary: Boundary, material: Material = STEEL_MATERIAL) -> Solved:
    """A moment of 1 N·mm about y, by the traction −x/I in z on the loaded end."""
    mesh = half.mesh()
    part = ng.H1(mesh, order=ORDER, dirichlet="held")
    space = part * part * part
    r, trial, test = ng.x, space.TrialFunction(), space.TestFunction()
    form = ng.BilinearForm(space, symmetric=True)
    form += pi * ng.InnerProduct(_stress(_strain(trial), material), _weighted(_strain(test))) * r * ng.dx
    form.Assemble()
    inverse = form.mat.Inverse(space.FreeDofs(), inverse="sparsecholesky")
    second_moment = pi * half.narrow**4 / 4
    area = pi * half.narrow**2
    (U, v, w) = test
    load = _vector(space, -pi * r**3 / second_moment * w)  # −x/I cos θ · W cos θ, over the circle
    guide = _vector(space, pi / area * (2 * U - r * v) * r)  # the mean of u_x
    moved, held = load.CreateVector(), load.CreateVector()
    moved.data, held.data = inverse * load, inverse * guide
    if boundary == "guided_end":
        moved.data -= float(ng.InnerProduct(guide, moved) / ng.InnerProduct(guide, held)) * held
    field = ng.GridFunction(space)
    field.vec.data = moved
    rr, tt, zz, rz, *_ = _stress(_strain(field.components), material)
    principal = (rr + zz) / 2 + ng.sqrt((rr - zz) ** 2 / 4 + rz**2)
    opposite = -(rr + zz) / 2 + ng.sqrt((rr - zz) ** 2 / 4 + rz**2)  # at θ = π
    stress = max(_greatest(half, mesh, one) for one in (principal, opposite, tt, -tt))
    return Solved(1e-3 / float(ng.InnerProduct(load, moved)), stress)


def torsion(half: HalfPlane, material: Material = STEEL_MATERIAL) -> Solved:
    """A torque of 1 N·mm, by the traction r/J around on the loaded end; u_θ = r ψ."""
    mesh = half.mesh()
    space = ng.H1(mesh, order=ORDER, dirichlet="held")
    psi, other = space.TnT()
    shear = material.young * 1e-6 / (2 * (1 + material.poisson))
    form = ng.BilinearForm(space, symmetric=True)
    form += 2 * pi * shear * ng.x**3 * ng.grad(psi) * ng.grad(other) * ng.dx
    form.Assemble()
    polar = pi * half.narrow**4 / 2
    load = ng.LinearForm(space)
    load += 2 * pi * ng.x**3 / polar * other * ng.ds("loaded")
    load.Assemble()
    field = ng.GridFunction(space)
    field.vec.data = form.mat.Inverse(space.FreeDofs(), inverse="sparsecholesky") * load.vec
    von_mises = sqrt(3) * shear * ng.x * ng.sqrt(ng.grad(field) * ng.grad(field))
    return Solved(1e-3 / float(ng.InnerProduct(load.vec, field.vec)), _greatest(half, mesh, von_mises))


def _strain(unknowns: Any) -> list[Any]:
    """Amplitudes of rr, θθ, zz, rz (cos θ) and rθ, θz (sin θ), from U, v = (U + V)/r, w = W/r."""
    U, v, w = unknowns
    dU, dv, dw = ng.grad(U), ng.grad(v), ng.grad(w)
    r = ng.x
    return [
        dU[0],
        v,
        r * dw[1],
        (dU[1] + w + r * dw[0]) / 2,
        (r * dv[0] - dU[0]) / 2,
        (r * dv[1] - dU[1] - w) / 2,
    ]


def _stress(strain: list[Any], material: Material) -> Any:
    """Hooke's law for these amplitudes [MPa]."""
    E, nu = material.young * 1e-6, material.poisson
    trace = strain[0] + strain[1] + strain[2]
    normal = [E / (1 + nu) * (one + nu / (1 - 2 * nu) * trace) for one in strain[:3]]
    return ng.CF((*normal, *(E / (1 + nu) * one for one in strain[3:])))


def _weighted(strain: list[Any]) -> Any:
    """Strains as they stand in the energy: shear counts twice."""
    return ng.CF((*strain[:3], *(2 * one for one in strain[3:])))


def _vector(space: Any, density: Any) -> Any:
    form = ng.LinearForm(space)
    form += density * ng.ds("loaded")
    form.Assemble()
    return form.vec


def _greatest(half: HalfPlane, mesh: Any, field: Any) -> float:
    """Along the fillet, just inside; of a cylinder, half way along its surface."""
    if half.wide == half.narrow:
        return float(field(mesh(half.narrow - _INSIDE, half.end / 2)))
    angle = np.linspace(1e-3, pi / 2 - 1e-3, _PLACES)
    radius = half.fillet + _INSIDE
    r = half.narrow + half.fillet - radius * np.cos(angle)
    z = half.shoulder + half.fillet - radius * np.sin(angle)
    return max(float(field(mesh(x, y))) for x, y in zip(r.tolist(), z.tolist(), strict=True))


def factor(load: Kind) -> dict[str, float]:
    """The stress concentration factor both ways, and how far the one on the solid says it has settled."""
    half = HalfPlane()
    plane = (torsion(half) if load == "torsion" else bending(half, "free_end")).stress / LOADS[load][1]
    found = peaks(load)
    solid = found.steps[-1].value / LOADS[load][1]
    return {
        "half plane": plane,
        "solid": solid,
        "difference": solid / plane - 1,
        "estimated error": found.error,
    }
