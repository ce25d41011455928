r"""The film of sector pads whose gap depends only on the angle, solved for many pads together.

With zeta along ln r, the Reynolds equation of a rotating collar has the same form as for a rectangle:

.. math::
    \partial_\xi(H^3\partial_\xi P) + (2\varphi/\Lambda)^2 H^3\,\partial_\zeta^2 P
    = (r/r_m)^2\,dH/d\xi, \quad H = a-(a-1)\xi, \quad P = \frac{p\,h_o^2}{6\,\eta\,\omega\,r_m^2\,\varphi}

xi = 0 (inlet) … 1 (outlet) of the angle phi, zeta = −1 (inner edge) … 1 over Lambda = ln(r_o/r_i), r_m the
mean radius; P = 0 at all four edges. Only the source term grows outwards. So the eigenvectors across separate
these balances as in `pad_equations`, and a narrow ring of large radius behaves like a row of rectangles.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.pads.pad_equations import cell_lengths, eliminated
from templates.physics.pads.pad_mesh import across, grading


def solved_sectors(a: Array, angle: Array, reach: Array, along: int, across_half: int) -> Array:
    """Return the solutions of converging sector pads on one mesh.

    Parameters
    ----------
    a
        (N,) film ratio h_i/h_o, above 1 [-].
    angle
        (N,) angle of a pad [rad].
    reach
        (N,) outer over inner radius, above 1 [-].
    along
        Number of intervals along the pad.
    across_half
        Number of intervals over half the width.

    Returns
    -------
    (N, 3) load W h_o²/(6 eta omega r_m³ phi² b), and inlet and side flow over omega r_m h_o b.
    """
    logarithm = np.log(reach)
    x = grading(a, logarithm / angle).place(np.linspace(0, 1, along + 1))
    middle, cells = (x[:, 1:] + x[:, :-1]) / 2, cell_lengths(x)
    a, width = a[:, None], (logarithm / angle)[:, None]
    H, H_mid = a - (a - 1) * x, a - (a - 1) * middle
    conductance, leak = H_mid**3 / np.diff(x), 4 * H**3 * cells / width**2
    half = across(a[:, 0], width[:, 0], across_half)
    zeta = np.concatenate([-half[:, :0:-1], half], axis=-1)
    eigenvalues, plain, weighted = _modes(zeta, logarithm, reach)
    p = eliminated(conductance, leak[:, 1:-1], eigenvalues, (a - 1) * np.diff(middle))
    to_width = (logarithm * (reach + 1) / (2 * (reach - 1)))[:, None]  # Lambda r_m over b
    load = to_width[:, 0] * np.einsum("inm,nm,ni->n", p, weighted**2, cells[:, 1:-1]) / 2
    ends = to_width * np.einsum("inm,nm->ni", p[[0, -1]], weighted * plain) / 2
    inlet = (H_mid[:, 0] - conductance[:, 0] * ends[:, 0]) / 2
    outlet = (H_mid[:, -1] + conductance[:, -1] * ends[:, 1]) / 2
    return np.stack([load, inlet, inlet - outlet], axis=-1)


def _modes(zeta: Array, logarithm: Array, reach: Array) -> tuple[Array, Array, Array]:
    """Return eigenvalues of the flow across (N, m), the modes' shares of a constant and of (r/r_m)²."""
    step, cells = 1 / np.diff(zeta), cell_lengths(zeta)[:, 1:-1]
    stiff = np.zeros((*cells.shape, cells.shape[-1]))
    i = np.arange(cells.shape[-1])
    stiff[:, i, i] = step[:, 1:] + step[:, :-1]
    stiff[:, i[1:], i[:-1]] = stiff[:, i[:-1], i[1:]] = -step[:, 1:-1]
    root = np.sqrt(cells)
    eigenvalues, vectors = np.linalg.eigh(stiff / (root[:, :, None] * root[:, None, :]))
    square = (4 * reach / (1 + reach) ** 2)[:, None] * np.exp(zeta[:, 1:-1] * logarithm[:, None])
    plain, weighted = (np.einsum("ni,nik->nk", root * weight, vectors) for weight in (1.0, square))
    return eigenvalues, plain, weighted
