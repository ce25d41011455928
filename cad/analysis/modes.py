"""The first torsional natural frequency of a held shaft.

The number of a mode does not show whether the mode is torsional: the first mode of a throw is bending. A mode
φ of unit mass has the effective inertia (rᵀ M φ)², where r is the rigid rotation about z; the effective
inertias of all modes add up to the inertia of the solid.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import ngsolve as ng
import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from cad.analysis.elastic import Response
from cad.errors import AnalysisError
from templates.core.arrays import Array

_MODES = 6
_MOST_MODES = 48


@dataclass(frozen=True)
class Mode:
    """A natural mode with its frequency and effective inertia."""

    frequency: float  # [Hz]
    share: float  # effective inertia about z over the inertia of the solid


def torsional_mode(response: Response) -> Mode:
    """Return the mode with the largest effective inertia about z.

    Further modes are computed until the result is certain.

    Raises
    ------
    AnalysisError
        `not_converged` if none of the first 48 modes clearly has the largest inertia.
    """
    count = _MODES
    while count <= _MOST_MODES:
        modes = natural_modes(response, count)
        best = max(modes, key=lambda mode: mode.share)
        if best.share > 1 - sum(mode.share for mode in modes):
            return best
        count *= 2
    raise AnalysisError(
        "not_converged", f"none of the first {_MOST_MODES} modes is mainly a rotation about z"
    )


def natural_modes(response: Response, count: int) -> list[Mode]:
    """Return the lowest modes by Lanczos' method, which uses the factorised matrix of the static response."""
    system = response.system
    mass = _mass(response)
    free = np.flatnonzero(np.array(list(system.space.FreeDofs())))
    work, done = mass.CreateColVector(), mass.CreateColVector()

    def times_mass(part: Array) -> Array:
        work.FV().NumPy()[:] = 0
        work.FV().NumPy()[free] = part.ravel()
        done.data = mass * work
        return np.array(done.FV().NumPy()[free])

    def inverse(part: Array) -> Array:
        work.FV().NumPy()[:] = 0
        work.FV().NumPy()[free] = part.ravel()
        return np.array(_guided(response, system.solve(work)).FV().NumPy()[free])

    size = (len(free), len(free))
    rotation = ng.GridFunction(system.space)
    rotation.Set(ng.CF((-ng.y, ng.x, 0)))
    turned = mass.CreateColVector()
    turned.data = mass * rotation.vec
    start = np.array(response.displacement.vec.FV().NumPy()[free])
    squares, shapes = eigsh(
        LinearOperator(size, matvec=times_mass, dtype=float),  # the operator is used only for its size
        count,
        M=LinearOperator(size, matvec=times_mass, dtype=float),
        sigma=0.0,
        OPinv=LinearOperator(size, matvec=inverse, dtype=float),
        v0=start,
    )
    whole = ng.InnerProduct(turned, rotation.vec)
    moved = shapes.T @ np.array(turned.FV().NumPy()[free])
    return [
        Mode(sqrt(square) / (2 * pi), float(part**2 / whole))
        for square, part in zip(squares, moved, strict=True)
    ]


def _mass(response: Response) -> Any:
    system = response.system
    u, v = system.space.TnT()
    form = ng.BilinearForm(system.space, symmetric=False)
    form += system.material.density * 1e-12 * ng.InnerProduct(u, v) * ng.dx
    form.Assemble()
    return form.mat


def _guided(response: Response, u: Any) -> Any:
    """Return a displacement plus that of the guide forces that keep the end on the axis."""
    if response.guides:
        off = np.array([ng.InnerProduct(guide, u) for guide in response.guides])
        for reaction, w in zip(np.linalg.solve(response.gram, off), response.guided, strict=True):
            u.data -= float(reaction) * w
    return u
