"""Compute the surface of an analysed solid as data for a picture: points, displacements, stresses.

The data come from the response of one mesh, of one order, to a load of 1 N·m. Every curved surface element is
divided into plane triangles, so that a shaft looks round; triangles share their points, so the surface is
closed. If the solid was halved by symmetry, the other half is added with the signs that the load requires
(see `cad.analysis.elastic`); faces in the mirror plane are omitted. The data serve pictures only:
`cad.analysis.analyse` computes outputs with their errors, `cad.analysis.stress` the greatest stresses.

Twist is the local rotation about z, (∂u_y/∂x − ∂u_x/∂y)/2: it needs no axis, so it is as accurate on the
axis of the shaft as on a pin far from it, and for a circular shaft it is Coulomb's angle of the section.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

import ngsolve as ng
import numpy as np

from cad.analysis.elastic import Response, is_antisymmetric
from cad.analysis.solid import FREE, HELD, LOADED
from cad.analysis.stress import recover, von_mises
from templates.core.arrays import Array, Integers

MOST_TRIANGLES = 16_000
"""Largest number of triangles that dividing elements may give; undivided elements may exceed it."""

LOADS = {"torsion": "a torque of 1 N*m about z", "bending": "a moment of 1 N*m about y"}

_FINEST = 3  # largest number of divisions of an element's side
_NEAR = 1e-6  # [mm], distance within which a point lies on the mirror plane
_DIGITS = 6
_NOISE = 1e-9  # relative to the largest value: smaller values count as zero


@dataclass(frozen=True)
class Surface:
    """Triangles between points, counterclockwise as seen from outside.

    Each field has a value at each point.
    """

    points: Array  # (n, 3) [mm]
    triangles: Integers  # (m, 3)
    displacement: Array  # (n, 3) [mm/(N·m)]
    twist: Array | None  # (n,) [deg/(N·m)]; torsion only
    stress: Array  # (n,) [MPa/(N·m)], von Mises, recovered
    load: str

    def as_json(self) -> dict[str, Any]:
        """Return the surface for JSON with six significant digits and a unit for every field."""
        fields = {"points": (self.points, "mm"), "displacement": (self.displacement, "mm")}
        if self.twist is not None:
            fields["twist"] = (self.twist, "deg")
        fields["stress"] = (self.stress, "MPa")
        quantities = {name: {"value": _written(v), "unit": unit} for name, (v, unit) in fields.items()}
        return {"load": self.load, "triangles": self.triangles.tolist(), **quantities}


def surface(response: Response) -> Surface:
    """Return the surface of the whole solid, including the held and the loaded end."""
    system = response.system
    mesh, mirror = system.grid.mesh, system.grid.solid.mirror
    region = mesh.Boundaries(f"{FREE}|{HELD}|{LOADED}")
    corners = np.array([[vertex.nr for vertex in element.vertices] for element in region.Elements()])
    division = _division(len(corners) * system.grid.solid.parts)
    lattice = _lattice(division)
    where = mesh.MapToAllElements(_rule(lattice, division), region)
    fields = _fields(response, where)
    number, first = _shared(corners, lattice)
    triangles = number.reshape(len(corners), -1)[:, _pieces(lattice)].reshape(-1, 3)
    half = Surface(
        fields["points"][first],
        triangles,
        fields["displacement"][first],
        fields["twist"][first] if system.load == "torsion" else None,
        fields["stress"][first],
        LOADS[system.load],
    )
    return _whole(half, "xyz".index(mirror), is_antisymmetric(mirror, system.load)) if mirror else half


def _fields(response: Response, where: Any) -> dict[str, Array]:
    """Return all fields at mapped points (n) under 1 N·m."""
    u = response.displacement
    gradient = ng.Grad(u)
    turned = ng.GridFunction(ng.H1(response.system.grid.mesh, order=response.system.order - 1))
    turned.Set((gradient[1, 0] - gradient[0, 1]) / 2)
    stress = von_mises(recover(response))
    return {
        "points": _at(where, ng.x, ng.y, ng.z),
        "displacement": 1e3 * _at(where, *(u[i] for i in range(3))),
        "twist": np.degrees(1e3 * _at(where, turned)[:, 0]),
        "stress": 1e3 * _at(where, stress)[:, 0],
    }


def _at(where: Any, *functions: Any) -> Array:
    return np.column_stack([np.ravel(function(where)) for function in functions])


def _division(elements: int) -> int:
    """Return the number of parts into which each side of an element is divided."""
    return max(n for n in range(1, _FINEST + 1) if n == 1 or elements * n**2 <= MOST_TRIANGLES)


def _lattice(division: int) -> Integers:
    """Return the points of a divided triangle as integer weights of its three corners."""
    steps = range(division + 1)
    return np.array([(i, j, division - i - j) for i, j in product(steps, steps) if i + j <= division])


def _rule(lattice: Integers, division: int) -> Any:
    """Return the points of a lattice in the form that NGSolve uses: the weights of the first two corners."""
    points = [(i / division, j / division) for i, j, _ in lattice.tolist()]
    return ng.IntegrationRule(points, [0.0] * len(points))


def _pieces(lattice: Integers) -> Integers:
    """Return the triangles (m, 3) between the points of a lattice, oriented outwards like the element."""
    place = {(i, j): n for n, (i, j, _) in enumerate(lattice.tolist())}
    up = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in place]
    down = [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in place]
    return np.array([[place[at] for at in piece] for piece in up + down if place.keys() >= {*piece}])


def _shared(corners: Integers, lattice: Integers) -> tuple[Integers, Integers]:
    """Return the numbers of each element's points among the distinct points, and the first index of each."""
    numbers: dict[tuple[tuple[int, int], ...], int] = {}
    number: list[int] = []
    first: list[int] = []
    for vertices in corners.tolist():
        for weights in lattice.tolist():
            pairs = zip(vertices, weights, strict=True)
            key = tuple(sorted((vertex, weight) for vertex, weight in pairs if weight))
            # Points within an element have all its vertices; elements with equal vertices do not exist.
            if numbers.setdefault(key, len(numbers)) == len(first):
                first.append(len(number))
            number.append(numbers[key])
    return np.array(number), np.array(first)


def _whole(half: Surface, normal: int, antisymmetric: bool) -> Surface:
    """Return both halves: the given one and its mirror image, which share the points of the mirror plane."""
    image = np.where(np.arange(3) == normal, -1.0, 1.0)
    moved = -image if antisymmetric else image
    apart = np.abs(half.points[:, normal]) > _NEAR
    count = len(half.points)
    number = np.arange(count)
    number[apart] = count + np.arange(apart.sum())
    return Surface(
        np.concatenate([half.points, half.points[apart] * image]),
        np.concatenate([half.triangles, number[half.triangles][:, ::-1]]),
        np.concatenate([half.displacement, half.displacement[apart] * moved]),
        None if half.twist is None else np.concatenate([half.twist, half.twist[apart]]),
        np.concatenate([half.stress, half.stress[apart]]),
        half.load,
    )


def _written(values: Array) -> Any:
    noise = _NOISE * np.abs(values).max(initial=0.0)
    return [_row(row, noise) for row in values.tolist()]


def _row(value: Any, noise: float) -> Any:
    if isinstance(value, list):
        return [_row(part, noise) for part in value]
    return float(f"{value:.{_DIGITS}g}") if abs(value) > noise else 0.0
