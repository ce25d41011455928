r"""One step of a supplied film by Newton's method: the compiled kernel of level `supplied`.

In the frame of the mesh the shear flow vanishes. Multiplied by 12, the balance of a cell is

.. math:: 12\,\partial_\theta(\alpha H) = \partial_\varphi(H^3\partial_\varphi P)
    + (D/B)^2\,\partial_\zeta(H^3\partial_\zeta P) + \text{feed}, \quad P\ge0,\ 1-\alpha\ge0,\ P(1-\alpha)=0

A node in a pocket has the pocket's pressure. If the edge of a pocket is at a distance d from the next node,
oil flows from the edge with the conductance of the step times step/d: the edge moves continuously between
nodes, and its position is accurate to second order.

Circumferential conductances are the inverse of the mean of H^-3 between two nodes, by Simpson's rule. In each
cell the complementarity condition (active set: the smaller of pressure and void is 0; or the function of
Fischer and Burmeister) has two slopes, with respect to pressure and to void; the unknown with the
larger slope is eliminated. The remaining matrix is diagonally dominant by columns for every film. Let
r <= 1 be the ratio of the smaller slope to the larger. The diagonal of every column is 1 + r. The other
entries of the column of a full cell are conductances divided by their sum; those of any other column are r
times these. So the banded factorisation needs no pivoting.
"""

import numpy as np

from templates.core.arrays import Array
from templates.physics.numerics.machine_code import compiled
from templates.physics.supplied.supplied_mesh import Mesh

MOST = 25
"""Largest number of Newton iterations."""
SETTLED = 3e-5
"""Convergence: last change of the eccentricity over the gap, and imbalance of a cell over what it stores
when full [-]."""
LEAVES = 0.3
"""An iteration leaves at least this fraction of the gap."""
NEAREST = 1e4
"""Conductance that holds a node at the pressure of its pocket, over the conductance of the cell [-]."""


@compiled
def covered(mesh: Mesh, places: Array) -> Array:
    """Return, (3, n, m), a mask of nodes in a pocket, and the nearness of an edge ahead and of one behind.

    The nearness is step/d − 1, with d the distance to an edge that lies before the next node; it is 0 without
    an edge.

    places: (k, 3) centre in the mesh [rad], half angle [rad] and half length [-] of each pocket.
    """
    n, m = mesh.order.size, mesh.width.size
    step, seen = 2 * np.pi / n, np.zeros((3, n, m))
    for pocket in range(places.shape[0]):
        centre, half, length = places[pocket, 0], places[pocket, 1], places[pocket, 2]
        for i in range(n):
            off = (i * step - centre + np.pi) % (2 * np.pi) - np.pi
            inside = 1.0 if half >= np.pi or abs(off) <= half else 0.0
            ahead, behind = (-half - off) % (2 * np.pi), (off - half) % (2 * np.pi)
            for j in range(m):
                if mesh.zeta[j] <= length + 1e-9:
                    seen[0, i, j] = max(seen[0, i, j], inside)
                    if inside == 0:
                        seen[1, i, j] = max(seen[1, i, j], step / max(ahead, step / NEAREST) - 1)
                        seen[2, i, j] = max(seen[2, i, j], step / max(behind, step / NEAREST) - 1)
    return seen


@compiled
def coefficients(mesh: Mesh, e: Array) -> tuple[Array, Array, Array]:
    """Return circumferential and axial conductances and the gap [-].

    Each has its value and its derivatives by e_x and e_y: (3, n).
    """
    n = mesh.order.size
    step = 2 * np.pi / n
    around, across, gap = np.empty((3, n)), np.empty((3, n)), np.empty((3, n))
    for i in range(n):
        x, y = mesh.normal[0, i], mesh.normal[1, i]
        gap[0, i], gap[1, i], gap[2, i] = 1 - e[0] * x - e[1] * y, -x, -y
        across[0, i] = step / mesh.ratio**2 * gap[0, i] ** 3
        for d in range(2):
            across[1 + d, i] = -3 * across[0, i] * mesh.normal[d, i] / gap[0, i]
    for i in range(n):
        k = (i + 1) % n
        a, c = 1 / gap[0, i], 1 / gap[0, k]
        b = 1 / (1 - e[0] * mesh.middle[0, i] - e[1] * mesh.middle[1, i])
        mean = (a**3 + 4 * b**3 + c**3) / 6
        around[0, i] = 1 / (mean * step)
        for d in range(2):
            slope = (mesh.normal[d, i] * a**4 + 4 * mesh.middle[d, i] * b**4 + mesh.normal[d, k] * c**4) / 2
            around[1 + d, i] = -around[0, i] * slope / mean
    return around, across, gap


@compiled
def lost(mesh: Mesh, around: Array, across: Array, P: Array, loss: Array) -> None:
    """Store the outflow of the cells due to pressure, (n, m), in the output array."""
    n, m = P.shape
    loss[:] = 0.0
    for i in range(n):
        k = (i + 1) % n
        for j in range(m):
            flow = around[i] * mesh.width[j] * (P[i, j] - P[k, j])
            loss[i, j] += flow
            loss[k, j] -= flow
            after = P[i, j + 1] if j + 1 < m else 0.0
            axial = across[i] / (mesh.zeta[j + 1] - mesh.zeta[j]) * (P[i, j] - after)
            loss[i, j] += axial
            if j + 1 < m:
                loss[i, j + 1] -= axial


@compiled
def diagonal(mesh: Mesh, around: Array, across: Array) -> Array:
    """Return the sum of a cell's conductances, (n, m) [-]."""
    n, m = around.size, mesh.width.size
    total = np.empty((n, m))
    for i in range(n):
        ring = around[i] + around[i - 1]
        for j in range(m):
            total[i, j] = ring * mesh.width[j] + across[i] / (mesh.zeta[j + 1] - mesh.zeta[j])
            if j > 0:
                total[i, j] += across[i] / (mesh.zeta[j] - mesh.zeta[j - 1])
    return total


@compiled
def matrix(mesh: Mesh, around: Array, across: Array, alpha: Array, own: Array) -> Array:
    """Return rows of the banded matrix, (n m, 4 m + 1), diagonal in column 2 m, for k in P = alpha k."""
    n, m = alpha.shape
    band = 2 * m
    rows = np.zeros((n * m, 2 * band + 1))
    for i in range(n):
        k = (i + 1) % n
        for j in range(m):
            here, there = mesh.order[i] * m + j, mesh.order[k] * m + j
            flow = around[i] * mesh.width[j]
            rows[here, band] += own[i, j]
            rows[here, band + there - here] -= flow * alpha[k, j]
            rows[there, band + here - there] -= flow * alpha[i, j]
            if j + 1 < m:
                axial = across[i] / (mesh.zeta[j + 1] - mesh.zeta[j])
                rows[here, band + 1] -= axial * alpha[i, j + 1]
                rows[here + 1, band - 1] -= axial * alpha[i, j]
    return rows


@compiled
def eliminate(rows: Array, right: Array) -> None:
    """Solve a banded system with column-dominant matrix in place; right is (rows, 3)."""
    size, band = rows.shape[0], rows.shape[1] // 2
    for k in range(size):
        pivot = 1 / rows[k, band]
        for i in range(k + 1, min(k + band + 1, size)):
            shift = band + k - i
            factor = rows[i, shift] * pivot
            if factor == 0:
                continue
            for j in range(1, band + 1):
                rows[i, shift + j] -= factor * rows[k, band + j]
            for c in range(3):
                right[i, c] -= factor * right[k, c]
    for k in range(size - 1, -1, -1):
        for j in range(1, min(band, size - 1 - k) + 1):
            for c in range(3):
                right[k, c] -= rows[k, band + j] * right[k + j, c]
        for c in range(3):
            right[k, c] /= rows[k, band]


@compiled
def complement(P: Array, void: Array, A: Array, T: Array, smooth: bool) -> tuple[Array, Array, Array, Array]:
    """Return the linearised complementarity condition of every cell.

    The changes are dP = alpha k + P0 and dvoid = beta k + v0, with one unknown k for each cell. A and T
    convert pressure and void to flow. In a full cell the derivative with respect to the void is larger,
    elsewhere that with respect to the pressure.
    """
    alpha, beta, P0, v0 = np.empty(P.shape), np.empty(P.shape), np.zeros(P.shape), np.zeros(P.shape)
    for i in range(P.shape[0]):
        for j in range(P.shape[1]):
            p, v = A[i, j] * P[i, j], T[i, j] * void[i, j]
            ratio, shift = 0.0, -min(p, v)
            if smooth:
                size = np.hypot(p, v) + 1e-300
                larger = 1 - min(p, v) / size
                ratio, shift = (1 - max(p, v) / size) / larger, -(p + v - size) / larger
            if p >= v:
                alpha[i, j], beta[i, j], v0[i, j] = 1 / A[i, j], -ratio / T[i, j], shift / T[i, j]
            else:
                alpha[i, j], beta[i, j], P0[i, j] = -ratio / A[i, j], 1 / T[i, j], shift / A[i, j]
    return alpha, beta, P0, v0


@compiled
def borne(mesh: Mesh, alpha: Array, k: Array) -> tuple[float, float]:
    """Return the components of the force that a pressure alpha k exerts, in the axes of the mesh."""
    n, m = k.shape
    x, y = 0.0, 0.0
    for i in range(n):
        line = 0.0
        for j in range(m):
            line += alpha[i, j] * k[i, j] * mesh.quadrature[j]
        x += line * mesh.normal[0, i]
        y += line * mesh.normal[1, i]
    return x * np.pi / n, y * np.pi / n


@compiled
def displacement(a: float, b: float, c: float, d: float, x: float, y: float) -> tuple[float, float]:
    """Return the solution (x, y) of [[a, b], [c, d]]; by least squares if the determinant vanishes."""
    size, det = a * a + b * b + c * c + d * d, a * d - b * c
    if abs(det) > 1e-13 * size:
        return (d * x - b * y) / det, (a * y - c * x) / det
    return (a * x + c * y) / size, (b * x + d * y) / size


@compiled
def edges(around: Array, seen: Array, i: int, j: int) -> float:
    """Return conductances from a node to adjacent pocket edges, to be added to those between nodes."""
    return float(around[i] * seen[1, i, j] + around[i - 1] * seen[2, i, j])


@compiled
def balances(
    mesh: Mesh, e: Array, P: Array, void: Array, seen: Array, supply: float, store: float, rest: Array
) -> tuple[tuple[Array, Array], Array, Array, Array, Array]:
    """Return conductances, A, T, conductance of the feed, and the loss with derivatives by e, (3, n, m)."""
    n, m = P.shape
    around, across, gap = coefficients(mesh, e)
    A, T, feeding = diagonal(mesh, around[0], across[0]), np.empty((n, m)), np.empty((n, m))
    loss = np.empty((3, n, m))
    for d in range(3):
        lost(mesh, around[d], across[d], P, loss[d])
    for i in range(n):
        for j in range(m):
            feeding[i, j] = NEAREST * A[i, j]
            if seen[0, i, j] == 0:
                feeding[i, j] = edges(around[0], seen, i, j) * mesh.width[j]
            A[i, j] += feeding[i, j]
            T[i, j] = store * gap[0, i] * mesh.width[j]
            loss[0, i, j] += T[i, j] * (1 - void[i, j]) + rest[i, j] * mesh.width[j] * 24 * np.pi / n
            loss[0, i, j] -= feeding[i, j] * (supply - P[i, j])
            for d in range(1, 3):
                loss[d, i, j] += store * gap[d, i] * mesh.width[j] * (1 - void[i, j])
                if seen[0, i, j] == 0:
                    loss[d, i, j] -= edges(around[d], seen, i, j) * mesh.width[j] * (supply - P[i, j])
    return (around[0], across[0]), A, T, feeding, loss


@compiled
def responses(
    mesh: Mesh, flows: tuple[Array, Array], A: Array, T: Array, feeding: Array, loss: Array,
    law: tuple[Array, Array, Array, Array],
) -> Array:  # fmt: skip
    """Return the unknown k of every cell, without and per component of displacement, (3, n, m)."""
    alpha, beta, P0, v0 = law
    n, m = A.shape
    own, right, k = np.empty((n, m)), np.empty((n * m, 3)), np.empty((3, n, m))
    offset = np.empty((n, m))
    lost(mesh, flows[0], flows[1], P0, offset)
    for i in range(n):
        for j in range(m):
            own[i, j] = A[i, j] * alpha[i, j] - T[i, j] * beta[i, j]
            offset[i, j] += feeding[i, j] * P0[i, j] - T[i, j] * v0[i, j]
            row = mesh.order[i] * m + j
            right[row, 0] = -loss[0, i, j] - offset[i, j]
            right[row, 1], right[row, 2] = -loss[1, i, j], -loss[2, i, j]
    eliminate(matrix(mesh, flows[0], flows[1], alpha, own), right)
    for i in range(n):
        for j in range(m):
            for c in range(3):
                k[c, i, j] = right[mesh.order[i] * m + j, c]
    return k


@compiled
def displaced(
    mesh: Mesh, e: Array, P: Array, k: Array, alpha: Array, P0: Array, S: Array, mass: float, inertia: Array
) -> tuple[float, float]:
    """Return the change of eccentricity for which the film balances the load and the journal's inertia."""
    n, m = P.shape
    x, y = S[0], S[1]
    for i in range(n):
        for j in range(m):
            line = (P[i, j] + P0[i, j] + alpha[i, j] * k[0, i, j]) * mesh.quadrature[j] * np.pi / n
            x -= line * mesh.normal[0, i]
            y -= line * mesh.normal[1, i]
    (xx, yx), (xy, yy) = borne(mesh, alpha, k[1]), borne(mesh, alpha, k[2])
    M = mass * inertia[0]
    x -= M * e[0] + mass * inertia[1]
    y -= M * e[1] + mass * inertia[2]
    return displacement(xx + M, xy, yx, yy + M, x, y)


@compiled
def solved(
    mesh: Mesh, state: tuple[Array, Array, Array], S: Array, seen: Array, supply: float,
    rate: float, rest: Array, mass: float, inertia: Array, smooth: bool,
) -> tuple[bool, Array, Array, Array, float, float]:  # fmt: skip
    """Return whether Newton's method converged, then eccentricity, pressure, void, feed and side flow.

    Feed and side flow are multiplied by 24. Pressure and void may be below 0 by the residual of Newton's
    method.

    The balances are d(oil)/dtheta = rate·oil + rest and acceleration = inertia[0]·e + inertia[1:]; `state` is
    the initial guess.
    """
    e, P, void = state[0].copy(), state[1].copy(), state[2].copy()
    n, m = P.shape
    store = 24 * np.pi / n * rate
    for _ in range(MOST):
        flows, A, T, feeding, loss = balances(mesh, e, P, void, seen, supply, store, rest)
        law = complement(P, void, A, T, smooth)
        alpha, beta, P0, v0 = law
        k = responses(mesh, flows, A, T, feeding, loss, law)
        x, y = displaced(mesh, e, P, k, alpha, P0, S, mass, inertia)
        part, room, change = 1.0, 1 - np.hypot(e[0], e[1]), np.hypot(x, y)
        if not np.isfinite(change):
            break
        while 1 - np.hypot(e[0] + part * x, e[1] + part * y) < LEAVES * room:
            part /= 2
        lacks, stores, fed, side = 0.0, 0.0, 0.0, 0.0
        for i in range(n):
            for j in range(m):
                lacks, stores = max(lacks, abs(loss[0, i, j])), max(stores, T[i, j])
                move = k[0, i, j] + x * k[1, i, j] + y * k[2, i, j]
                P[i, j] += part * (alpha[i, j] * move + P0[i, j])
                void[i, j] += part * (beta[i, j] * move + v0[i, j])
                fed += feeding[i, j] * (supply - P[i, j])
            side += flows[1][i] * P[i, m - 1] / (mesh.zeta[m] - mesh.zeta[m - 1])
        e[0] += part * x
        e[1] += part * y
        if part == 1 and change < SETTLED * room and lacks < SETTLED * stores:
            return True, e, P, void, fed, side
    return False, e, P, void, 0.0, 0.0
