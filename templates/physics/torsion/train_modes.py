"""Free vibration of a train with branches and gears: natural frequencies and mode shapes.

The train is undamped. With K = Dᵀ k D, where D gives the twists from the free angles and M is diagonal, the
angular frequencies are the singular values of k^(1/2) D M^(-1/2): forming K would lose the small ones. Shafts
without stiffness, such as the shaft of a viscous damper's ring, give modes at 0.
"""

from __future__ import annotations

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper, units
from templates.physics.torsion.forced_train import Train

_ROUNDING = 1e-12  # relative to the highest frequency or the largest angle; smaller values count as 0
_TIE = 1 - 1e-9  # entries of a shape this near to the largest are as large


def _rows(train: Train) -> Array:
    """Return k^(1/2) D M^(-1/2), (…, rows, q), with zero rows added if there are fewer shafts than angles."""
    rows = np.sqrt(train.k)[..., :, None] * train.twists / np.sqrt(train.mass)[..., None, :]
    lack = max(0, rows.shape[-1] - rows.shape[-2])
    return np.concatenate([rows, np.zeros((*rows.shape[:-2], lack, rows.shape[-1]))], axis=-2)


@on_paper("solved numerically by singular values of the train's matrix of twists")
@units(None, returns="rad/s", latex=r"\sqrt{{\lambda_m\left(M^{{-1}}K\right)}}")
def natural_frequencies(train: Train) -> Array:
    """Return the natural angular frequencies [rad/s], ascending, (…, q); 0 for rigid-body rotation."""
    rows = _rows(train)
    is_finite = np.asarray(np.isfinite(rows).all(axis=(-2, -1), keepdims=True))
    values = np.linalg.svd(np.where(is_finite, rows, 0), compute_uv=False)[..., ::-1]
    values = np.where(values <= _ROUNDING * values[..., -1:], 0, values)
    return np.where(is_finite[..., 0], values, np.nan)


@on_paper("solved numerically by singular values of the train's matrix of twists")
@units(None, returns="1")
def mode_shapes(train: Train) -> Array:
    """Return the angles of all inertias in the modes, (…, q, n), each with 1 as its largest entry."""
    rows = _rows(train)
    is_finite = np.asarray(np.isfinite(rows).all(axis=(-2, -1), keepdims=True))
    free = np.linalg.svd(np.where(is_finite, rows, 0), full_matrices=False)[2][..., ::-1, :]
    values = natural_frequencies(train)
    for point in np.ndindex(free.shape[:-2]):
        still = values[point] == 0
        free[point][still] = _own_basis(free[point][still])
    shapes = (free / np.sqrt(train.mass)[..., None, :]) @ train.layout.reduction.T
    size = np.abs(shapes)
    largest = size.max(axis=-1, keepdims=True)
    shapes = np.where(size <= _ROUNDING * largest, 0, shapes)
    first = np.argmax(size >= _TIE * largest, axis=-1)[..., None]
    signed = shapes / (np.sign(np.take_along_axis(shapes, first, axis=-1)) * largest)
    return np.where(is_finite, signed, np.nan)


def _own_basis(vectors: Array) -> Array:
    """Return a basis of the same space (m, q) that does not depend on how the space was calculated.

    It is chosen so that the first angle determines the first vector.
    """
    projector, basis = vectors.T @ vectors, np.zeros((0, vectors.shape[-1]))
    for column in projector:
        rest = column - basis.T @ (basis @ column)
        size = np.linalg.norm(rest)
        if size > 1e-6 and len(basis) < len(vectors):
            basis = np.vstack([basis, rest / size])
    return basis
