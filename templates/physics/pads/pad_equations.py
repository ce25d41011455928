"""Flow balances of converging pads of finite width, solved for many pads together.

The balances are those of `film_equations` on the mesh of `pad_mesh`. A converging film does not rupture, so
the equations are separable: each eigenvector across the pad leaves one tridiagonal system along it.

References
----------
R. E. Lynch, J. R. Rice, D. H. Thomas, Numer. Math. 6, 1964, p. 185.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.pads.pad_mesh import across, grading


def solved_pads(a: Array, width: Array, along: int, across_half: int) -> tuple[Array, Array]:
    """Return the solutions of converging pads on one mesh.

    Parameters
    ----------
    a
        (N,) film ratio h_i/h_o, 1 or more [-].
    width
        (N,) b/l [-].
    along
        Number of intervals n along the pad.
    across_half
        Number of intervals over half the width.

    Returns
    -------
    (N, 4) load, its moment about the inlet, inlet flow and side flow as in `slider_film.PadFilm`, and
    (N, n + 1) the pressure p h_o²/(6 eta U l) at mid-width.
    """
    x = grading(a, width).place(np.linspace(0, 1, along + 1))
    middle, cells = (x[:, 1:] + x[:, :-1]) / 2, cell_lengths(x)
    a, width = a[:, None], width[:, None]
    H, H_mid = a - (a - 1) * x, a - (a - 1) * middle
    conductance, leak = H_mid**3 / np.diff(x), 4 * H**3 * cells / width**2
    eigenvalues, shares, centre = _modes(across(a[:, 0], width[:, 0], across_half))
    source = (a - 1) * np.diff(middle)
    p = eliminated(conductance, leak[:, 1:-1], eigenvalues, source)
    line = np.einsum("inm,nm->ni", p, shares**2)
    load = cells[:, 1:-1] * line
    inlet = H_mid[:, 0] / 2 - conductance[:, 0] * line[:, 0] / 2
    edge = 1 - np.sum(
        shares**2, axis=-1
    )  # at the sides P = 0, so the half cells there pass on all their inflow
    side = np.einsum("inm,nm,ni->n", p, eigenvalues * shares**2, leak[:, 1:-1]) + edge * source.sum(-1)
    measures = np.stack([load.sum(-1), (load * x[:, 1:-1]).sum(-1), inlet, side / 2], axis=-1)
    return measures, np.pad(np.einsum("inm,nm->ni", p, shares * centre), ((0, 0), (1, 1)))


def cell_lengths(nodes: Array) -> Array:
    """Return the lengths of the cells around the nodes (..., n + 1), half cells at the ends."""
    half = np.diff(nodes) / 2
    return np.pad(half, ((0, 0), (0, 1))) + np.pad(half, ((0, 0), (1, 0)))


def _modes(zeta: Array) -> tuple[Array, Array, Array]:
    """Return eigenvalues of the flow across (N, m), each mode's share of a constant, and mid-width values."""
    step, cells = 1 / np.diff(zeta), cell_lengths(zeta)[:, :-1]
    stiff = np.zeros((*cells.shape, cells.shape[-1]))
    i = np.arange(cells.shape[-1])
    stiff[:, i, i] = step + np.pad(step[:, :-1], ((0, 0), (1, 0)))
    stiff[:, i[1:], i[:-1]] = stiff[:, i[:-1], i[1:]] = -step[:, :-1]
    root = np.sqrt(cells)
    eigenvalues, vectors = np.linalg.eigh(stiff / (root[:, :, None] * root[:, None, :]))
    return eigenvalues, np.einsum("ni,nik->nk", root, vectors), vectors[:, 0] / root[:, :1]


def eliminated(conductance: Array, leak: Array, eigenvalues: Array, source: Array) -> Array:
    """Return the balances solved along the pad for every mode by Gaussian elimination, (n − 1, N, m).

    Parameters
    ----------
    conductance
        (N, n) conductance between neighbours.
    leak
        (N, n − 1) conductance across, to be multiplied by the modes' eigenvalues.
    eigenvalues
        (N, m) eigenvalues of the modes.
    source
        (N, n − 1) source, the same for all modes except for the share of each.
    """
    g = conductance.T[:, :, None]
    pivot = leak.T[:, :, None] * eigenvalues + (g[:-1] + g[1:])
    p = np.repeat(source.T[:, :, None], eigenvalues.shape[-1], axis=2)
    for i in range(1, len(p)):
        ratio = g[i] / pivot[i - 1]
        pivot[i] -= ratio * g[i]
        p[i] += ratio * p[i - 1]
    p[-1] /= pivot[-1]
    for i in range(len(p) - 2, -1, -1):
        p[i] = (p[i] + g[i + 1] * p[i + 1]) / pivot[i]
    return p
