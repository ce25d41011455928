"""Stress tensors over a cycle, superposed from those of unit loads, and the types that contain them.

A tensor has the components xx, yy, zz, xy, yz, xz [Pa], in the order of finite-element tables. By linear
elasticity, the stress of simultaneous loads is the sum of their tensors: sigma(theta) = sum over the loads of
load(theta) times its unit tensor. Equivalent stresses cannot be added.

References
----------
R. von Mises: Mechanik der festen Körper im plastisch-deformablen Zustand. Göttinger Nachrichten, 1913.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import prod

import numpy as np

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units

COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")
Rows = tuple[tuple[float, ...], ...]

_WEIGHTS = np.sqrt(np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0]))
"""Weights of the components in the length of a tensor: a shear component counts twice."""

PROPORTIONAL = 0.95
"""The share of one tensor in a history above which an equivalent stress may have a sign."""

MOST_TENSORS = 200_000
"""Most tensors for all points, angles and curves; Findley's method then takes about ten seconds."""

_PURE_SHEAR = (
    1e-6  # |p1 + p3| over the length of a tensor, below which neither tension nor compression dominates
)


def is_given(load: Array) -> bool:
    """Return whether a load is given."""
    return not bool(np.isnan(load).all())


@units(None, None, returns="1")
def go_together(loads: Sequence[Array], stresses: Sequence[Rows]) -> Truth:
    """Return whether every load has its stresses and every table of stresses has its load."""
    return all(is_given(load) == bool(rows) for load, rows in zip(loads, stresses, strict=True))


@units(None, returns="1")
def has_any(stresses: Sequence[Rows]) -> Truth:
    """Return whether any table of stresses is given."""
    return any(len(rows) > 0 for rows in stresses)


@units(None, returns="1")
def same_points(stresses: Sequence[Rows]) -> Truth:
    """Return whether all tables of stresses have the same number of points."""
    return len({len(rows) for rows in stresses if rows}) < 2


@units(None, returns="1")
def changes(loads: Sequence[Array]) -> Truth:
    """Return whether at least one load is a curve of two or more values."""
    return any(np.ndim(load) > 0 and np.shape(load)[-1] > 1 for load in loads)


@units(None, None, returns="1")
def is_manageable(loads: Sequence[Array], stresses: Sequence[Rows]) -> Truth:
    """Return whether the number of tensors (points, angles and curves) is within the limit."""
    curves = np.broadcast_shapes(*(np.shape(load)[:-1] for load in loads if np.ndim(load)))
    angles = max((np.shape(load)[-1] for load in loads if np.ndim(load)), default=1)
    rows = max((len(rows) for rows in stresses), default=0)
    return prod(curves) * angles * rows <= MOST_TENSORS


def superposed(loads: Sequence[Array], stresses: Sequence[Rows]) -> Array:
    """Return the stress tensors [..., point, angle, 6] [Pa] of loads [..., angle] times unit stresses.

    A load is in its SI unit, its stresses in Pa per unit of load. If the inputs do not match, which a rule
    refuses, the result is one point without stress.
    """
    fits = has_any(stresses) and same_points(stresses) and go_together(loads, stresses)
    if not (fits and is_manageable(loads, stresses)):
        return np.zeros((1, 1, len(COMPONENTS)))
    parts = [
        np.atleast_1d(load)[..., None, :, None] * np.asarray(rows)[:, None, :]
        for load, rows in zip(loads, stresses, strict=True)
        if rows
    ]
    return np.sum(np.broadcast_arrays(*parts), axis=0)


def as_matrices(tensors: Array) -> Array:
    """Return the tensors [..., 6] as symmetric matrices [..., 3, 3]."""
    xx, yy, zz, xy, yz, xz = np.moveaxis(tensors, -1, 0)
    return np.stack([np.stack(row, -1) for row in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))], -2)


def von_mises_1913(tensors: Array) -> Array:
    """Return the equivalent stress [Pa] of tensors [..., 6]."""
    xx, yy, zz, xy, yz, xz = np.moveaxis(tensors, -1, 0)
    apart = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(apart / 2 + 3 * (xy**2 + yz**2 + xz**2))


def leading_tensor(tensors: Array) -> tuple[Array, Array]:
    """Return the unit tensor [..., 6] that contributes most to a history, and its share [1].

    The share is that of the sum of squares of all tensors; 1 without stress. The sign of the tensor is such
    that its principal stress of larger magnitude is tension; for pure shear the sign is arbitrary.
    """
    weighted = tensors * _WEIGHTS
    gram = np.einsum("...ai,...aj->...ij", weighted, weighted)
    values, vectors = np.linalg.eigh(gram)
    total = np.sum(np.maximum(values, 0), axis=-1)
    share = np.where(total > 0, values[..., -1] / np.where(total > 0, total, 1.0), 1.0)
    tensor = vectors[..., -1] / _WEIGHTS
    lead = _leading_principal(tensor)
    return tensor * np.where(lead < 0, -1.0, 1.0)[..., None], share


def signed_von_mises(tensors: Array) -> Array:
    """Return the equivalent stress [..., angle] [Pa], negative where the leading tensor is reversed.

    This applies only to a history that one tensor dominates. Pure shear has no sign: its mean counts as
    tension.
    """
    tensor, _ = leading_tensor(tensors)
    along = np.einsum("...ai,...i->...a", tensors * _WEIGHTS**2, tensor)
    signed = np.where(along < 0, -1.0, 1.0) * von_mises_1913(tensors)
    middle = signed.max(axis=-1) + signed.min(axis=-1)
    turned = (np.abs(_leading_principal(tensor)) <= _PURE_SHEAR) & (middle < 0)
    return np.where(turned[..., None], -signed, signed)


def _leading_principal(tensor: Array) -> Array:
    """Return p1 + p3 [1] of tensors of unit length: positive if tension dominates, 0 in pure shear."""
    principal = np.linalg.eigvalsh(as_matrices(tensor))
    return np.asarray(principal[..., 0] + principal[..., 2])
