"""The mesh of a supplied film: cells that rotate at the mean speed of journal and sleeve, in axial rows.

Axially, the mesh covers half the width: rows of nodes from the middle to the edge of the shortest pocket, one
row at the edge of every other pocket, then rows that become finer towards the end of a wide bearing. The end,
at ambient pressure, has no row.
"""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from templates.core.arrays import Array, Integers

_FADES = 0.35
"""Distance from the end over D/2 within which the pressure of a wide bearing falls to ambient [-]."""
_FADES_THIN = 2.0
"""The same distance over the width of the smallest gap, sqrt(2 (1 − eps)) [-]."""
_DENSITY = 0.6
"""Row density along a pocket, relative to equal spacing [-]."""


class Mesh(NamedTuple):
    """A mesh of n circumferential × m axial nodes on half the width, with data for the compiled kernel."""

    ratio: float
    """Width over diameter B/D [-]."""
    zeta: Array
    """(m + 1,) axial positions of the nodes, 0 (middle) … 1 (end)."""
    width: Array
    """(m,) axial widths of the cells."""
    quadrature: Array
    """(m,) weights that average the nodes' pressures over the width; exact for a parabola."""
    normal: Array
    """(2, n) cosine and sine of the nodes' angles."""
    middle: Array
    """(2, n) cosine and sine of the angles midway to the next node."""
    order: Integers
    """(n,) index of each node in the sequence 0, 1, 3, …, 4, 2, in which neighbours are at most two apart."""


def supplied_mesh(
    ratio: float,
    around: int,
    across: int,
    edges: tuple[float, ...] = (),
    grooved: bool = False,
    gap: float = 1.0,
    finest: float = 1.0,
) -> Mesh:
    """Return a mesh with nodes on pocket edges, with one extra row for each edge after the first.

    Parameters
    ----------
    ratio
        Width over diameter B/D [-].
    around
        Number of circumferential nodes.
    across
        Number of rows over half the width, without the end.
    edges
        Ascending half lengths of the pockets over B/2 [-].
    grooved
        Whether the pressure also falls towards the pockets; the mesh on the land is then finer at both of its
        sides.
    gap
        Expected least gap [-]. If it is small, the film is short circumferentially, and its pressure falls
        closer to the edges.
    finest
        Largest spacing of the rows at the edges, relative to that of equally spaced rows [-].
    """
    inner = _inner_cells(edges[0], across) if edges else 0
    edge, rows = (edges[-1], across - inner + 1) if edges else (0.0, across + 1)
    fades = min(_FADES, _FADES_THIN * np.sqrt(2 * gap))
    fine, t = min(finest, fades / (ratio * (1 - edge))), np.linspace(0, 1, rows)
    t = t - (1 - fine) * np.sin(2 * np.pi * t) / (2 * np.pi) if grooved else _towards_end(t, fine)
    zeta = np.concatenate(
        [np.arange(inner) / max(inner, 1) * min(edges, default=0.0), edges[:-1], edge + (1 - edge) * t]
    )
    phi = np.arange(around) * 2 * np.pi / around
    half = phi + np.pi / around
    node = np.arange(around)
    order = np.where(2 * node <= around, 2 * node - 1, 2 * (around - node))
    order[0] = 0
    return Mesh(
        ratio=float(ratio),
        zeta=zeta,
        width=np.diff(np.concatenate([[0.0], (zeta[1:] + zeta[:-1]) / 2])),
        quadrature=_quadrature(zeta, inner, len(edges)),
        normal=np.stack([np.cos(phi), np.sin(phi)]),
        middle=np.stack([np.cos(half), np.sin(half)]),
        order=order.astype(np.int64),
    )


def _towards_end(t: Array, fine: float) -> Array:
    """Return places 0 … 1 whose spacing decreases to `fine` times the spacing of equally spaced ones."""
    return np.asarray(1 - (1 - t) * (fine + (1 - fine) * (1 - t)))


def _inner_cells(edge: float, across: int) -> int:
    """Return the number of cells from the middle to the first edge; the land keeps at least three rows."""
    return min(max(1, round(_DENSITY * edge * across)), max(1, across - 3))


def _quadrature(zeta: Array, inner: int, edges: int) -> Array:
    """Return axial weights that integrate an even parabola exactly; the pressure has a kink at each edge."""
    weights = np.zeros(zeta.size)
    first = inner if edges else zeta.size - 1
    if first == 1:
        weights[:2] = zeta[1] * np.array([2 / 3, 1 / 3])
    else:
        even = zeta[: first + 1]
        spline = CubicSpline(even, np.eye(even.size), bc_type=((1, np.zeros(even.size)), "not-a-knot"))
        weights[: first + 1] = spline.integrate(0.0, even[-1])
    for row in range(first, first + edges - 1):
        weights[row : row + 2] += (zeta[row + 1] - zeta[row]) / 2
    if edges:
        land = zeta[first + edges - 1 :]
        spline = CubicSpline(land, np.eye(land.size), bc_type="not-a-knot")
        weights[-land.size :] += spline.integrate(land[0], 1.0)
    return weights[:-1]


def carried(mesh: Mesh, finer: Mesh, values: Array, end: Array) -> Array:
    """Interpolate values (n, m) of one mesh to the nodes of another.

    `end` contains the values at the bearing's end, (n,).
    """
    phi, finer_phi = (np.arange(one.order.size) * 2 * np.pi / one.order.size for one in (mesh, finer))
    around = [np.interp(finer_phi, phi, v, period=2 * np.pi) for v in (*values.T, end)]
    return np.stack([np.interp(finer.zeta[:-1], mesh.zeta, row) for row in np.stack(around, axis=1)])
