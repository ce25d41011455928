r"""A second method for the film in an elastic bore: finite elements in the film and in its gap.

`templates.physics.elastic.bore_film` balances flows between nodes, takes the gap midway between two as their
mean, and seeks the turn of the bore by secants around a balance. Here is the weak form

.. math:: \int \frac{H^3}{\bar\eta}\,\nabla P\cdot\nabla w - 6 H\,\partial_\phi w = 0 \text{ where } P > 0,
    \quad \ge 0 \text{ elsewhere}

on bilinear elements with four points of Gauss each, at which the gap has its own value; one Newton
iteration solves for pressure, eccentricity and turn together. Any number of modes may give way. Nodes lie
where the pressure rises and bends. The iteration begins at the other method's film.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import splu

from templates.core.arrays import Array, Mask
from templates.physics.elastic.bore_film import BoreFilm, BoreSoftness, bore_balances
from templates.physics.elastic.bore_modes import HIGHEST
from templates.physics.elastic.compliance import HARMONICS
from templates.physics.films.film_mesh import ring_mesh
from templates.physics.journals.static_journal import static_film_at

_STEPS = 60
_ACCURACY = 1e-9
_DTURN = 1e-6
_GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)


class Lost(ArithmeticError):
    """No film converges."""


@dataclass(frozen=True)
class Bore:
    """What gives way, dimensionless: deformation over the radial clearance per P = p psi²/(eta omega)."""

    matrix: Array
    """(M, M) between modes: harmonics 0 … N around, times Legendre's even polynomials along."""
    highest: int
    """N."""
    along: int
    """How many of these polynomials, from 1 on."""
    tail: Array
    """(41,) of the harmonics above N, even across the film."""
    liner: float
    share: float
    """Width of the film over that of the bore."""
    to_load: float
    """From the block to the load [rad]."""
    size: float = 0.0
    scale: float = 0.0
    power: float = 0.0
    """Roelands' law as in `Softness`."""

    def bending(self) -> Mask:
        """The modes that are no motion of the bore as a whole."""
        harmonics = np.repeat(np.arange(self.highest + 1), [1] + [2] * self.highest)
        return np.asarray((np.tile(harmonics, self.along) != 1) | (np.arange(len(self.matrix)) > 2))

    def shapes(self, theta: Array, zeta: Array) -> Array:
        """(K, M) the modes at places of the film."""
        n = np.arange(1, self.highest + 1)
        waves = np.sqrt(2) * np.stack([np.cos(np.outer(theta, n)), np.sin(np.outer(theta, n))], axis=-1)
        around = np.concatenate([np.ones((theta.size, 1)), waves.reshape(theta.size, -1)], axis=1)
        legendre = np.polynomial.legendre.legvander(self.share * zeta, 2 * (self.along - 1))[:, ::2]
        along = legendre * np.sqrt(4 * np.arange(self.along) + 1)
        return np.concatenate([around * column[:, None] for column in along.T], axis=1)

    def thickening(self, P: Array) -> tuple[Array, Array]:
        """Viscosity and its slope."""
        if self.power == 0:
            return np.ones_like(P), np.zeros_like(P)
        base = 1 + self.scale * np.maximum(P, 0)
        eta = np.exp(self.size * (base**self.power - 1))
        return eta, eta * self.size * self.power * self.scale * base ** (self.power - 1)


@dataclass(frozen=True)
class Elements:
    """A mesh of rectangles: values and slopes of a field at the points of Gauss from those at the nodes."""

    phi: Array
    zeta: Array
    value: csc_array
    around: csc_array
    across: csc_array
    weight: Array
    """(K,) of each point, over half the film's width."""
    at_phi: Array
    at_zeta: Array


def elements(phi: Array, zeta: Array) -> Elements:
    """Bilinear elements between nodes."""
    i, j, a, b = np.meshgrid(
        np.arange(phi.size - 1), np.arange(zeta.size - 1), *(np.arange(2),) * 2, indexing="ij"
    )
    i, j, s, t = (v.ravel() for v in (i, j, _GAUSS[a], _GAUSS[b]))
    dphi, dzeta = np.diff(phi)[i], np.diff(zeta)[j]
    point = np.arange(i.size)
    values: list[list[Array]] = [[], [], []]
    rows, columns = [], []
    for k in (0, 1):
        for m in (0, 1):
            by_s, by_t = (s if k else 1 - s), (t if m else 1 - t)
            rows.append(point)
            columns.append((i + k) * zeta.size + j + m)
            sign_s, sign_t = 2 * k - 1, 2 * m - 1
            for listed, value in zip(
                values, (by_s * by_t, sign_s * by_t / dphi, by_s * sign_t / dzeta), strict=True
            ):
                listed.append(value)
    places, shape = (np.concatenate(rows), np.concatenate(columns)), (i.size, phi.size * zeta.size)
    at_points, around, across = (coo_array((np.concatenate(v), places), shape=shape).tocsc() for v in values)
    at_phi, at_zeta = phi[i] + s * dphi, zeta[j] + t * dzeta
    return Elements(phi, zeta, at_points, around, across, dphi * dzeta / 4, at_phi, at_zeta)


@dataclass(frozen=True)
class Film:
    """Pressures at the nodes, eccentricity and turn, whether or not they balance anything."""

    mesh: Elements
    ratio: float
    bore: Bore
    P: Array
    eps: float
    turn: float

    def taken(self) -> tuple[Array, Array]:
        """Modes at the points (K, M), and how far each bends per unit of its pressure, (M, K)."""
        n = np.arange(self.bore.highest + 1, HARMONICS + 1)
        n = n[self.bore.tail[n] > 0]
        own = self.bore.shapes(self.mesh.at_phi + self.turn, self.mesh.at_zeta)
        angle = np.outer(self.mesh.at_phi, n)
        tail = np.concatenate([np.cos(angle), np.sin(angle)], axis=1)
        weight = self.mesh.weight[:, None]
        bends = self.bore.matrix[self.bore.bending()] @ (own * weight * self.bore.share / (2 * np.pi)).T
        tail_bends = np.tile(self.bore.tail[n], 2)[:, None] * (tail * weight / np.pi).T
        return np.concatenate([own[:, self.bore.bending()], tail], axis=1), np.concatenate(
            [bends, tail_bends]
        )

    def gap(self) -> Array:
        """At the points (K,)."""
        shapes, bends = self.taken()
        pressure = self.mesh.value @ self.P
        rigid = (1 - self.eps) + 2 * self.eps * np.sin(self.mesh.at_phi / 2) ** 2
        return np.asarray(rigid + self.bore.liner * pressure + shapes @ (bends @ pressure))

    def gap_at_nodes(self) -> Array:
        """(n + 1, m + 1)."""
        phi, zeta = (v.ravel() for v in np.meshgrid(self.mesh.phi, self.mesh.zeta, indexing="ij"))
        there = replace(self, mesh=replace(self.mesh, at_phi=phi, at_zeta=zeta, weight=np.zeros(phi.size)))
        shapes, _ = there.taken()
        _, bends = self.taken()
        rigid = (1 - self.eps) + 2 * self.eps * np.sin(phi / 2) ** 2
        bent = shapes @ (bends @ (self.mesh.value @ self.P))
        return np.asarray(rigid + self.bore.liner * self.P + bent).reshape(self.mesh.phi.size, -1)

    def loss(self, H: Array) -> Array:
        """The weak form's value for each node."""
        mesh, (eta, _) = self.mesh, self.bore.thickening(self.mesh.value @ self.P)
        conductance = mesh.weight * H**3 / eta
        onward = conductance * (mesh.around @ self.P) - 6 * mesh.weight * (H - (1 - self.eps))
        return np.asarray(
            mesh.around.T @ onward + mesh.across.T @ (conductance * (mesh.across @ self.P)) / self.ratio**2
        )

    def force(self) -> Array:
        """(2,) towards the narrowest gap and ahead of it, in So."""
        pull = self.mesh.weight * (self.mesh.value @ self.P) / 2
        return np.array([pull @ np.cos(self.mesh.at_phi), pull @ np.sin(self.mesh.at_phi)])


def balanced(film: Film, So: float) -> Film:
    """Newton's method on pressure, film or no film, eccentricity and turn at once.

    Raises
    ------
    Lost
        If it does not settle.
    """
    may = np.ones((film.mesh.phi.size, film.mesh.zeta.size), bool)
    may[[0, -1]], may[:, -1] = False, False
    may = may.ravel()
    inside = may & (film.P > 0)
    for _ in range(_STEPS):
        H = film.gap()
        dP, deps, dturn = _step(film, H, inside, So)
        worst = 1.0
        for share in (1.0, 0.5, 0.25, 0.1, 0.03, 0.01):
            P = np.where(inside, np.maximum(film.P + share * dP, 0.0), 0.0)
            after = replace(film, P=P, eps=film.eps + share * deps, turn=film.turn + share * dturn)
            worst = float((after.gap() / H).min())
            if worst > 0.3:
                break
        if not worst > 0:
            raise Lost("the gap closes")
        left = after.loss(after.gap())
        moved = may & np.where(inside, film.P + share * dP > 0, left < -1e-11 * np.abs(left).max())
        change = np.abs(after.P - film.P).max() / max(float(after.P.max()), 1e-300)
        done = share == 1 and change < _ACCURACY and abs(dturn) < _ACCURACY
        if done and np.array_equal(moved, inside):
            return after
        film, inside = after, moved
    raise Lost("the film does not converge")


def _step(film: Film, H: Array, inside: Mask, So: float) -> tuple[Array, float, float]:
    """Newton's step of pressure, eccentricity and turn."""
    mesh, bore = film.mesh, film.bore
    pressure, rise, side = (m @ film.P for m in (mesh.value, mesh.around, mesh.across))
    eta, thick = bore.thickening(pressure)
    by_gap = mesh.weight * (3 * H**2 / eta * rise - 6)
    by_gap_side = mesh.weight * 3 * H**2 / eta * side / film.ratio**2
    conductance = mesh.weight * H**3 / eta
    own = by_gap * bore.liner - conductance * thick / eta * rise
    own_side = by_gap_side * bore.liner - conductance * thick / eta * side / film.ratio**2
    onward = diags_array(conductance) @ mesh.around + diags_array(own) @ mesh.value
    outward = diags_array(conductance / film.ratio**2) @ mesh.across + diags_array(own_side) @ mesh.value
    local = mesh.around.T @ onward + mesh.across.T @ outward
    free = np.flatnonzero(inside)
    matrix = csc_array(local)[free][:, free]

    shapes, bends = film.taken()
    by_turn = (replace(film, turn=film.turn + _DTURN).gap() - H) / _DTURN
    widened = np.column_stack([shapes, -np.cos(mesh.at_phi), by_turn])
    moved = mesh.around.T @ (by_gap[:, None] * widened) + mesh.across.T @ (by_gap_side[:, None] * widened)
    right = np.column_stack([-film.loss(H)[free], np.asarray(moved)[free]])
    solved = splu(csc_array(matrix)).solve(right)
    plain, reply = solved[:, 0], solved[:, 1:]
    value = csc_array(mesh.value)[:, free]
    taken = bends @ value
    pull = mesh.weight / 2
    along, ahead = ((pull * f(mesh.at_phi)) @ value for f in (np.cos, np.sin))
    angle = film.turn - bore.to_load
    M = shapes.shape[1]
    left = np.zeros((M + 2, M + 2))
    left[:M] = taken @ reply
    left[:M, :M] += np.eye(M)
    left[M], left[M + 1] = -(along @ reply), -(ahead @ reply)
    left[M, M + 1] += So * np.sin(angle)
    left[M + 1, M + 1] += So * np.cos(angle)
    force = film.force()
    wanted = np.concatenate([
        taken @ plain,
        [So * np.cos(angle) - force[0] - along @ plain, -So * np.sin(angle) - force[1] - ahead @ plain],
    ])  # fmt: skip
    steps = np.linalg.solve(left, wanted)
    dP = np.zeros(film.P.size)
    dP[free] = plain - reply @ steps
    return dP, float(steps[M]), float(steps[M + 1])


@dataclass(frozen=True)
class Places:
    """Where nodes lie, for any number of them, so that meshes are finer everywhere alike."""

    around: tuple[Array, Array]
    """Angles, and the share of the nodes up to each."""
    gap: float

    def mesh(self, ratio: float, around: int, across: int) -> Elements:
        """A mesh of so many intervals."""
        angle, share = self.around
        phi = np.interp(np.linspace(0, 1, around + 1), share, angle)
        phi[[0, -1]] = -np.pi, np.pi
        return elements(phi, ring_mesh(1 - self.gap, ratio, 64, across).zeta)


def places_for(film: Film) -> Places:
    """Nodes where the pressure rises, where it bends, and a fifth of them evenly around."""
    P = film.P.reshape(film.mesh.phi.size, -1)
    angle = np.linspace(-np.pi, np.pi, 2001)
    density = np.full(angle.size, 0.2 / (2 * np.pi))
    for column in (0, P.shape[1] // 2, P.shape[1] - 2):
        line = np.interp(angle, film.mesh.phi, P[:, column])
        line = _smooth(line / max(line.max(), 1e-300), 5)
        slope = np.abs(np.gradient(line, angle))
        bend = np.sqrt(np.abs(np.gradient(_smooth(np.gradient(line, angle), 5), angle)))
        for part in (slope, bend):
            density += 0.8 / 6 * part / np.trapezoid(part, angle)
    density = _smooth(density, 25)
    share = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(angle))])
    return Places((angle, share / share[-1]), min(max(float(film.gap_at_nodes().min()), 1e-4), 1.0))


def _smooth(line: Array, half: int) -> Array:
    """Twice the mean over some places on either side."""
    kernel = np.ones(2 * half + 1) / (2 * half + 1)
    for _ in range(2):
        line = np.convolve(np.pad(line, half, mode="edge"), kernel, mode="valid")
    return line


def carried(film: Film, mesh: Elements) -> Film:
    """The same on another mesh."""
    before = film.P.reshape(film.mesh.phi.size, -1)
    rows = np.stack([np.interp(mesh.phi, film.mesh.phi, column) for column in before.T], axis=1)
    P = np.stack([np.interp(mesh.zeta, film.mesh.zeta, row) for row in rows])
    P[[0, -1]], P[:, -1] = 0.0, 0.0
    return replace(film, mesh=mesh, P=P.ravel())


def measured(film: Film) -> dict[str, float]:
    """Dimensionless as those of `elastic_journal.measured`."""
    H, P = film.gap_at_nodes(), film.P.reshape(film.mesh.phi.size, -1)
    eta, _ = film.bore.thickening(film.mesh.value @ film.P)
    rigid = (1 - film.eps) + 2 * film.eps * np.sin(film.mesh.phi / 2) ** 2
    return {
        "eps": film.eps,
        "attitude": film.turn - film.bore.to_load,
        "least": -_top(film.mesh.phi, -H),
        "P_max": _top(film.mesh.phi, P),
        "shear": float((eta / film.gap() * film.mesh.weight).sum() / 2),
        "deformation": float((H - rigid[:, None]).max()),
    }


def _top(phi: Array, values: Array) -> float:
    """The largest value, by a parabola over the angle through three nodes."""
    i, j = np.unravel_index(values.argmax(), values.shape)
    if not 0 < i < phi.size - 1:
        return float(values[i, j])
    x, y = phi[i - 1 : i + 2] - phi[i], values[i - 1 : i + 2, j]
    bend, slope, top = np.polyfit(x / x[2], y, 2)
    return float(top - slope**2 / (4 * bend)) if bend < 0 else float(y[1])


SIZES, SURE = ((96, 8), (192, 16), (384, 32)), 2e-3
"""Elements around and across, and the change over three at which they suffice."""


def second(So: float, film: Film) -> tuple[dict[str, float], float, Film]:
    """Extrapolated values of the second method, how far its smallest film is sure, and the finest film.

    A third mesh follows where the change between two says so.
    """
    places, solved = places_for(film), []
    unsure = np.inf
    for size in SIZES:
        film = balanced(carried(film, places.mesh(film.ratio, *size)), So)
        solved.append(measured(film))
        if len(solved) > 1:
            unsure = max(abs(solved[-1][name] / solved[-2][name] - 1) / 3 for name in ("least", "P_max"))
            if unsure < SURE:
                break
    coarse, fine = solved[-2:]
    return {name: fine[name] + (fine[name] - coarse[name]) / 3 for name in fine}, unsure, film


def begun(So: float, ratio: float, softness: BoreSoftness, to_load: float) -> Film:
    """The film of level elastic, for the second method to begin at."""
    eps = min(float(static_film_at("map", np.array(So), np.array(ratio)).eps), 1 - 1e-6)
    film = bore_balances(So, ratio, eps, softness, to_load)[-1][1].film
    assert isinstance(film, BoreFilm)
    bore = Bore(
        softness.matrix, HIGHEST, 2, softness.ring * (np.arange(HARMONICS + 1) > HIGHEST), softness.liner,
        softness.share, to_load, softness.size, softness.scale, softness.power,
    )  # fmt: skip
    mesh = elements(film.mesh.phi, film.mesh.zeta)
    return Film(mesh, ratio, bore, film.P.ravel(), film.eps, film.softness.turn)
