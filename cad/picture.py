"""PNG pictures: a shaded view of the meshes, rendered with NumPy alone; OpenGL may be missing or crash.

Triangles are split into the rows of samples that they cover, and rows into samples; a depth buffer keeps the
nearest sample at each pixel. Normals are interpolated, so balls look round. Lines mark the borders between
faces.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from cad.mesh import Mesh, placed
from cad.view import view_of
from templates.core.arrays import Array, Integers, Mask

SIZE = (640, 480)  # [pixels]
_SAMPLES = 2  # along each side of a pixel
_MARGIN = 0.06  # of the picture, on each side
_PAPER = 1.0
_LINE = 0.45  # brightness of the lines between faces, relative to the surface

# Directions of the lights in the frame of the picture (right, up, towards the eye), and their strengths.
_KEY, _FILL = np.array([-0.45, 0.70, 0.55]), np.array([0.60, -0.10, 0.80])
_AMBIENT, _KEY_SHARE, _FILL_SHARE, _GLOSS = 0.36, 0.52, 0.42, 0.30
_SHININESS = 40


@dataclass(frozen=True)
class Scene:
    """Triangles in model axes [mm], and as projected in samples: y downwards, z towards the viewer."""

    corners: Array  # (t, 3, 3)
    normals: Array  # (t, 3, 3)
    colours: Array  # (t, 3), or of each corner (t, 3, 3)
    faces: Integers  # (t,), a different number for each face of each body


def write_png(meshes: Sequence[Mesh], size: tuple[int, int] = SIZE) -> bytes:
    """Return a picture of the meshes on a white background."""
    bodies = list(placed(meshes))
    corners = np.concatenate([points[one.triangles] for one, points, _ in bodies])
    normals = np.concatenate([normals[one.triangles] for one, _, normals in bodies])
    colours = np.concatenate([np.tile(one.colour, (len(one.triangles), 1)) for one, _, _ in bodies])
    firsts = np.cumsum([0, *(int(one.faces.max()) + 1 for one, _, _ in bodies)])
    faces = np.concatenate([one.faces + first for (one, _, _), first in zip(bodies, firsts, strict=False)])
    return shaded(Scene(corners, normals, colours, faces), size)


def shaded(triangles: Scene, size: tuple[int, int] = SIZE) -> bytes:
    """Return a picture of triangles [mm], given in the axes of their model, on a white background."""
    width, height = size[0] * _SAMPLES, size[1] * _SAMPLES
    scene = _scene(triangles, width, height)
    light, faces = _draw(scene, width, height)
    light[_borders(faces)] *= _LINE
    samples = Image.fromarray((np.clip(light, 0, 1) * 255).round().astype(np.uint8))
    stream = io.BytesIO()
    samples.resize(size, Image.Resampling.BOX).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def _scene(triangles: Scene, width: int, height: int) -> Scene:
    """Return the triangles that face the viewer, in the frame of the picture."""
    frame = view_of(np.ptp(triangles.corners, axis=(0, 1)))
    corners = _fitted(triangles.corners @ frame, width, height)
    # y points downwards in a picture: a triangle that faces the eye runs clockwise there.
    seen = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] < -1e-9
    return Scene(
        corners[seen], triangles.normals[seen] @ frame, triangles.colours[seen], triangles.faces[seen]
    )


def _fitted(corners: Array, width: int, height: int) -> Array:
    """Return the corners [mm; y upwards] scaled to fill the picture [samples; y downwards]."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    room = (1 - 2 * _MARGIN) * np.array([width, height])
    scale = (room / (high - low)[:2]).min()
    moved: Array = (corners - (low + high) / 2) * (scale * np.array([1, -1, 1]))
    moved += np.array([width / 2, height / 2, 0])
    return moved


def _draw(scene: Scene, width: int, height: int) -> tuple[Array, Integers]:
    """Return the light (height, width, 3) and the number of the visible face (height, width) at every sample.

    The face number is -1 where no face is visible.
    """
    triangle, column, row = _fragments(scene.corners)
    weights = _barycentric(scene.corners[triangle], column + 0.5, row + 0.5)
    depth = np.einsum("fc,fc->f", weights, scene.corners[triangle][:, :, 2])
    sample = row * width + column
    nearest = np.full(width * height, -np.inf)
    np.maximum.at(nearest, sample, depth)
    wins = depth == nearest[sample]
    triangle, weights, sample = triangle[wins], weights[wins], sample[wins]
    light = np.full((width * height, 3), _PAPER)
    normals = np.einsum("fc,fcx->fx", weights, scene.normals[triangle])
    colours = scene.colours[triangle]
    if colours.ndim == 3:
        colours = np.einsum("fc,fcx->fx", weights, colours)
    light[sample] = _lit(normals, colours)
    faces = np.full(width * height, -1)
    faces[sample] = scene.faces[triangle]
    return light.reshape(height, width, 3), faces.reshape(height, width)


def _fragments(corners: Array) -> tuple[Integers, Integers, Integers]:
    """Return the samples that triangles cover, as triangle, column and row.

    A triangle covers a sample if it contains the sample's centre.
    """
    x, y = corners[:, :, 0], corners[:, :, 1]
    triangle, row = _expand(y.min(axis=1), y.max(axis=1))
    middle = (row + 0.5)[:, None]
    x0, y0 = x[triangle], y[triangle]
    x1, y1 = np.roll(x0, -1, axis=1), np.roll(y0, -1, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (middle - y0) / (y1 - y0)
        crossing = x0 + along * (x1 - x0)
    crosses = (along >= 0) & (along <= 1)
    left = np.where(crosses, crossing, np.inf).min(axis=1)
    right = np.where(crosses, crossing, -np.inf).max(axis=1)
    span, column = _expand(left, right)
    return triangle[span], column, row[span]


def _expand(low: Array, high: Array) -> tuple[Integers, Integers]:
    """Return each interval number with every whole number n for which low ≤ n + 1/2 ≤ high."""
    first = np.ceil(np.where(np.isfinite(low), low, 0) - 0.5).astype(np.int64)
    last = np.floor(np.where(np.isfinite(high), high, -1) - 0.5).astype(np.int64)
    counts = np.maximum(last - first + 1, 0)
    which = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    return which, first[which] + within


def _barycentric(corners: Array, x: Any, y: Any) -> Array:
    """Return the weights (n, 3) of the corners of each triangle at its sample point."""
    a, b, c = (corners[:, i, :2] for i in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    px, py = x - a[:, 0], y - a[:, 1]
    area = ux * vy - uy * vx
    second, third = (px * vy - py * vx) / area, (ux * py - uy * px) / area
    return np.stack([1 - second - third, second, third], axis=1)


def _lit(normals: Array, colours: Array) -> Array:
    """Return the colours under two lights, with a highlight from the first (Blinn–Phong)."""
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    key, fill = (light / np.linalg.norm(light) for light in (_KEY, _FILL))
    between = key + np.array([0.0, 0.0, 1.0])
    gloss = np.clip(normals @ (between / np.linalg.norm(between)), 0, 1) ** _SHININESS
    diffuse = (
        _AMBIENT + _KEY_SHARE * np.clip(normals @ key, 0, 1) + _FILL_SHARE * np.clip(normals @ fill, 0, 1)
    )
    light: Array = colours * diffuse[:, None] + _GLOSS * gloss[:, None]
    return light


def _borders(faces: Integers) -> Mask:
    """Return the samples at which a different face begins."""
    differs = np.zeros(faces.shape, dtype=bool)
    differs[:, :-1] |= faces[:, :-1] != faces[:, 1:]
    differs[:-1, :] |= faces[:-1, :] != faces[1:, :]
    return differs
